"""Write docs/validation.md and its figures: figures and claims of the paper, with bands of the doubtful inputs.

python -m benchmarks.validation
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks import bell_section, pictures, published_systems
from benchmarks.claims import VERDICTS, WING, Claim, all_claims, as_text, first_boundary, mode_boundaries
from benchmarks.paper_figures import NUMBERS, Analyses, csv_of, make_figure
from benchmarks.paper_figures.analyses import XV15
from benchmarks.paper_figures.drawing import draw, intervals
from benchmarks.paper_figures.input_ranges import V22, WRATS, InputRange
from benchmarks.paper_figures.input_ranges import XV15 as XV15_RANGES
from benchmarks.paper_figures.published import XV15_FLUTTER, XV15_MARK
from benchmarks.paper_figures.sample_band import Band
from benchmarks.paper_figures.wing_modes import OF_THE_ROTOR
from benchmarks.pictures import FOLDER
from benchmarks.semispan_band import as_built, first_of_wing
from proprotor.files.output import write_whole
from proprotor.model.provenance import reservations

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "validation.md"
_BLADES = {XV15: "Table 1", "xv15-mass-distribution": "mass distribution"}
_PITCH = {
    "couplings": "couplings",
    "pitch equations": "pitch equations",
    "pitch equations, section damping": "pitch equations, section damping",
}
_GROUPS = {
    "XV-15 semispan: damping": (4, 5, 6),
    "1/5-scale V-22 model": (7, 8),
    "WRATS model": (9, 10, 11, 12),
    "XV-15: low-frequency lag, coupled against given": (14,),
    "XV-15: flap-lag stiffness": (15, 16, 17),
    "XV-15: cyclic and collective flap": (18,),
    "XV-15: couplings": (21,),
    "XV-15: modelling of pitch": (22, 23, 24),
}


class Row(NamedTuple):
    """The boundary of one blade and model: nominal in kt, and of a sample."""

    blade: str
    pitch: str
    nominal: float
    band: Band

    @property
    def label(self) -> str:
        """For the figure."""
        return f"{self.blade}, {self.pitch}"


def xv15_rows(analyses: Analyses) -> list[Row]:
    """Return the boundaries of both blades with each way to model the pitch."""
    return [
        Row(blade, pitch, first_boundary(analyses, variant, deck), analyses.band(deck, variant))
        for deck, blade in _BLADES.items()
        for variant, pitch in _PITCH.items()
    ]


def page(analyses: Analyses, rows: list[Row], claims: list[Claim]) -> str:
    """Return the whole page."""
    parts = (
        [_HEAD],
        _summary(claims),
        _boundary_section(rows),
        _bell_section(analyses),
        _as_built_section(),
        _figures_section(),
        _claims_section(claims),
        _models_section(analyses),
        bell_section.section(),
        published_systems.section(),
        _ranges_section(),
    )
    return "\n".join(line for part in parts for line in part).rstrip() + "\n"


_HEAD = """# Validation against AIAA-2002-1604

Written by `python -m benchmarks.validation`, numbers, verdicts and figures included; `make figures` makes the
figures alone. Damping is in percent of critical, frequency per revolution, kt is KTAS.

The inputs decide what may be concluded. The rotor of the XV-15 is published; its wing is recalled or assumed, and two
inputs are calibrated to the paper ([xv15.md](xv15.md)). Of the two 1/5-scale models only the rotor of one is published,
so their boundaries are no prediction. Bands are Latin hypercubes of 300 designs over every input that was not
published, each within a [stated range](#ranges); the ranges are judgements, not measured scatter. Designs that cannot
be are left out. The paper's test data are not at hand as numbers; the published flutter speeds are.
"""


def _summary(claims: list[Claim]) -> Iterator[str]:
    counts = Counter(claim.verdict for claim in claims)
    each = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS if counts[verdict])
    yield f"Of {len(claims)} claims: {each}."
    yield ""


def _boundary_section(rows: list[Row]) -> Iterator[str]:
    low, high = min(XV15_FLUTTER.values()), max(XV15_FLUTTER.values())
    yield "## Boundary of the XV-15 semispan wing"
    yield ""
    yield "The lowest speed at which a mode that moves the wing (participation of the wing a tenth or more) becomes"
    yield f"unstable. Published: {low:.0f} to {high:.0f} kt:"
    yield "; ".join(f"{speed:.0f} ({source})" for source, speed in XV15_FLUTTER.items()) + "."
    yield "Sections turn without damping, as in the paper, unless a row says otherwise. Pitch equations with section"
    yield "damping are the default of `proprotor flutter xv15-uncoupled`."
    yield ""
    head = (
        "mass integrals",
        "pitch",
        "nominal",
        "5 %",
        "median",
        "95 %",
        f"< {low:.0f} kt",
        f"< {high:.0f} kt",
    )
    cells = [
        (
            row.blade,
            row.pitch,
            as_text(row.nominal),
            *map(as_text, row.band.speed_percentiles),
            f"{row.band.share_below(low):.0%}",
            f"{row.band.share_below(high):.0%}",
        )
        for row in rows
    ]
    yield from _table(head, cells)
    yield ""
    yield "![Boundaries of both blades with their bands](figures/xv15-boundary.png)"
    yield ""
    yield from _boundary_words(rows)
    yield ""


def _bell_section(analyses: Analyses) -> Iterator[str]:
    """Yield the boundaries with the builder's blade frequencies beside those with the springs of Table 1."""
    yield "### The same with Bell's blade frequencies"
    yield ""
    yield "Lag and coning as Bell calculated them (NASA TM X-62,407; deck `xv15-bell-frequencies`) in place of the"
    yield "springs of Table 1, all else as above: the springs are published as well, and the two sources do not agree"
    yield "([the lag frequency](lag-frequency.md)). Nominal, without a band; of the wing, and of the rotor's own modes."
    yield ""
    cells = []
    for variant, pitch in _PITCH.items():
        springs, bell = (analyses.wing(XV15, which + variant) for which in ("", "Bell's frequencies, "))
        rotor = (wing.speed(OF_THE_ROTOR) for wing in (springs, bell))
        speeds = (springs.first_speed, bell.first_speed, *rotor)
        cells.append((pitch, *map(as_text, speeds)))
    head = (
        "pitch",
        "wing: Table 1",
        "wing: Bell's frequencies",
        "rotor: Table 1",
        "rotor: Bell's frequencies",
    )
    yield from _table(head, cells)
    yield ""


def _as_built_section() -> Iterator[str]:
    """Yield the boundaries of the wing as built, for each lag and control stiffness with a source."""
    low, high = min(XV15_FLUTTER.values()), max(XV15_FLUTTER.values())
    yield "### The wing as built"
    yield ""
    yield "The deck `xv15` has a beam wing with the published stiffnesses, fitted to the frequencies of the test, whose"
    yield "modes couple ([the wing as built](xv15.md#the-wing-as-built)). Pitch equations with section damping; rows"
    yield "differ in their source of blade frequencies and control stiffness (`python -m benchmarks.semispan_band`)."
    yield ""
    names = (*WING, OF_THE_ROTOR)
    yield from _table(
        ("blade frequencies", "K_θ, ft lbf/rad", *WING, "rotor", "first of the wing"),
        (
            (
                lag,
                f"{stiffness:,}",
                *(as_text(found[name], 520) for name in names),
                as_text(first_of_wing(found)),
            )
            for lag, stiffness, found in as_built()
        ),
    )
    speeds = [first_of_wing(found) for _, _, found in as_built()]
    inside = sum(low <= speed <= high for speed in speeds)
    yield ""
    within = "lie within" if min(speeds) <= low and high <= max(speeds) else "do not lie within"
    yield f"The published {low:.0f} to {high:.0f} kt {within} the {min(speeds):.0f} to {max(speeds):.0f} kt of these"
    yield f"rows; rows between the published speeds: {inside or 'none'}. Lag and control stiffness are each worth as"
    yield "much as the distance from the published speeds."
    yield ""


def _boundary_words(rows: list[Row]) -> Iterator[str]:
    low, high = min(XV15_FLUTTER.values()), max(XV15_FLUTTER.values())
    nominal = [row.nominal for row in rows]
    share = [row.band.share_below(high) for row in rows]
    first = min(row.band.speed_percentiles[0] for row in rows)
    blades = len(_PITCH)
    moved = max(
        abs(one.nominal - other.nominal) for one, other in zip(rows[:blades], rows[blades:], strict=True)
    )
    inside = "reaches into" if first <= high else "ends above"
    yield f"- The nominal boundary is {min(nominal) - high:.0f} to {max(nominal) - low:.0f} kt above published ones."
    shares = f"{min(share):.0%} to {max(share):.0%}"
    yield f"- The 5 to 95 % band {inside} them; {shares} of the samples become unstable below"
    yield from _early_words([row for row in rows if row.band.share_below(high)], high)
    yield "- So the doubtful inputs, as judged here, do not explain the difference unless they conspire. What these"
    yield "  decks leave out are wing modes that couple, which [the wing as built](#the-wing-as-built) has, more than"
    yield "  one elastic bending mode of the blade, and airfoil tables; [xv15.md](xv15.md) discusses them."
    yield f"- One consistent blade in place of Table 1 moves the boundary by {moved:.1f} kt at most: Table 1's"
    yield "  inconsistent integrals are not the reason."


def _early_words(early: list[Row], high: float) -> Iterator[str]:
    """Yield which models have designs that are unstable at published speeds, from which speeds on, and how much."""
    if not early:
        yield f"  {high:.0f} kt."
        return
    speeds = np.concatenate([row.band.speeds_below(high) for row in early])
    models = " and ".join(dict.fromkeys(row.pitch for row in early))
    worst = -min(row.band.least_damping(high) for row in early)
    yield f"  {high:.0f} kt, all with {models}: pitch modes of soft controls, where they meet torsion,"
    yield f"  unstable from {speeds.min():.0f} to {speeds.max():.0f} kt on by {worst:.1f} % of critical at most."
    yield "  The damping of turning sections keeps them stable."


def _figures_section() -> Iterator[str]:
    yield "## Figures"
    yield ""
    yield "Axes are the paper's, extended below zero damping, and upwards where a curve needs it. Each figure has its"
    yield "numbers beside it as CSV. The model of the paper's figures has couplings in place of the pitch equations"
    yield "and no damping of turning sections (`section_damping=False`)."
    yield "In the lower half of the airspeeds a wing mode is the mode that moves the wing's coordinate most: where a"
    yield "rotor mode meets the wing mode, as the low-frequency lag mode meets chord bending at 130 kt, the line passes"
    yield "from one root to the other. In the upper half the line follows the root that has the name in the middle."
    yield ""
    for title, numbers in _GROUPS.items():
        yield f"### {title}"
        yield ""
        for number in numbers:
            yield f"![Fig. {number}](figures/figure-{number:02}.png)"
            yield ""


def _claims_section(claims: list[Claim]) -> Iterator[str]:
    yield "## Claims of the text"
    yield ""
    yield "In words of this page. Verdicts follow from the number by rules in `benchmarks/claims.py`."
    yield "No number here has section damping."
    yield ""
    yield from _table(("where", "the paper says", "here", ""), (tuple(claim) for claim in claims))
    yield ""


def _models_section(analyses: Analyses) -> Iterator[str]:
    yield "## Boundaries of the two models"
    yield ""
    yield "The wings are scaled from the XV-15: the table shows such a rotor on such a wing, not the tests. Off"
    yield "downstop and at higher rotor speed the wing is less stable."
    yield ""
    decks = ("v22-fifth-scale", "wrats-742-off", "wrats-888-off", "wrats-770-on", "wrats-888-on")
    cells = []
    for deck in decks:
        last = analyses.knots(deck)[-1]
        modes = mode_boundaries(analyses, "couplings", deck)
        percentiles = analyses.band(deck).speed_percentiles
        cells.append((f"`{deck}`", *(as_text(speed, last) for speed in (*modes.values(), *percentiles))))
    yield from _table(("deck", *WING, "first mode, 5 %", "median", "95 %"), cells)
    yield ""


def _ranges_section() -> Iterator[str]:
    yield "## Ranges"
    yield ""
    for title, ranges in (
        ("XV-15", XV15_RANGES),
        ("WRATS", WRATS),
        ("1/5-scale V-22, besides", V22[len(WRATS) :]),
    ):
        yield f"### {title}"
        yield ""
        yield from _table(("input", "range", "reason"), _range_cells(ranges))
        yield ""


def _range_cells(ranges: Iterable[InputRange]) -> Iterator[tuple[str, ...]]:
    for one in ranges:
        yield one.name, f"{one}{', logarithmic' if one.logarithmic else ''}", one.reason


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> Iterator[str]:
    yield "| " + " | ".join(head) + " |"
    yield "|" + "---|" * len(head)
    for row in rows:
        yield "| " + " | ".join(row) + " |"


def main() -> None:
    FOLDER.mkdir(parents=True, exist_ok=True)
    analyses = Analyses()
    for number in NUMBERS:
        content = make_figure(number, analyses)
        stem = f"figure-{number:02}"
        pictures.write(partial(draw, content), f"{stem}.png")
        write_whole(FOLDER / f"{stem}.csv", lambda file, it=content: file.write(csv_of(it)))
    rows = xv15_rows(analyses)
    shown = [(row.label, row.nominal, *row.band.speed_percentiles) for row in rows]
    notes = (*reservations(analyses.case(XV15)), "Sections turn without damping unless a row says otherwise.")
    label = "Boundary of the XV-15 semispan wing, KTAS"
    pictures.write(partial(intervals, shown, XV15_MARK, label, notes), "xv15-boundary.png")
    for name, picture in bell_section.FIGURES.items():
        pictures.write(partial(bell_section.draw, name), picture)
    text = page(analyses, rows, all_claims(analyses))
    write_whole(PAGE, lambda file: file.write(text.encode()))
    print(f"Wrote {PAGE.relative_to(ROOT)} and {FOLDER.relative_to(ROOT)}")


if __name__ == "__main__":
    main()

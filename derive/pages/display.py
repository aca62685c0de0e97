"""Equations of print and derivation side by side, as Markdown with mathematics: the layout of the notebooks.

Nothing is judged here; verdicts, invariants and consequences are the audit's.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp
from matplotlib.figure import Figure
from PIL import Image
from sympy.printing.latex import LatexPrinter

from derive import symbols as s
from derive.audit import consequences, invariants, printed, report
from derive.audit.comparison import (
    AFTER_READING,
    CONTRADICTS,
    REPRODUCED,
    VERDICTS,
    EquationVerdict,
    TermVerdict,
    audit_chain,
    derived_terms,
    terms_of,
)
from derive.audit.counterparts import meaning
from derive.audit.headings import anchor, heading
from derive.audit.printed import notation as n
from derive.audit.printed.flap import nu_beta_squared, radius
from derive.published import DROPPED_TERMS
from derive.symbols import QUANTITIES
from proprotor.plots.style import in_style

# From a notebook, and rewritten where a page is rendered into docs/notebooks.
INDEX = "../docs/equations.md"
_LINE = 29  # what one line of a column holds, in letters


@dataclass(frozen=True)
class Shown:
    """Markdown that a notebook renders."""

    text: str

    def _repr_markdown_(self) -> str:
        return self.text


class Picture:
    """A figure that a notebook renders, drawn under the style sheet of the runtime's plots.

    Its text is the first line of the docstring of the function that draws it.
    """

    def __init__(self, draw: Callable[[], Figure]):
        self.figure, self.alt = in_style(draw)(), (draw.__doc__ or "").partition("\n")[0]

    def _repr_png_(self) -> tuple[bytes, dict[str, str]]:
        drawn, small = io.BytesIO(), io.BytesIO()
        self.figure.savefig(drawn, format="png", metadata={"Software": None})
        Image.open(drawn).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(
            small, "png", optimize=True
        )
        return small.getvalue(), {"alt": self.alt}

    def __repr__(self) -> str:
        return self.alt


def in_index(number: int | str) -> str:
    return f"[index]({INDEX}#{anchor(heading(number))})"


# Mathematics

# Shorter notation for some symbols. The notebooks explain the one new letter.
STRUCTURAL_PITCH = r"\vartheta"
_NAMES = {
    s.structural_pitch: STRUCTURAL_PITCH,
    n.K_beta_H: r"K_{\beta H}",
    n.K_beta_B: r"K_{\beta B}",
    n.K_zeta_H: r"K_{\zeta H}",
    n.K_zeta_B: r"K_{\zeta B}",
    n.M_beta_elas: r"M_{\beta,\mathrm{elas}}",
    n.M_zeta_elas: r"M_{\zeta,\mathrm{elas}}",
    n.M_beta_aero: r"M_{\beta,\mathrm{aero}}",
    n.dM_theta_aero: r"dM_{\theta,\mathrm{aero}}",
    nu_beta_squared: r"\nu_\beta^2",
}
_PAIRS = {"bb": r"\beta\beta", "bz": r"\beta\zeta", "zz": r"\zeta\zeta"}
for _place, _flexibilities in (("in", n.flexibility_in), ("out", n.flexibility_out)):
    _NAMES |= {
        symbol: rf"K_{{\mathrm{{{_place}}},{_PAIRS[pair]}}}^{{-1}}" for pair, symbol in _flexibilities.items()
    }

_MOTIONS = [symbol for of in (n.TIME, n.AZIMUTH) for motion in of.values() for symbol in motion]
_FORCES = [n.a_i, n.a_j, n.a_k, n.F_x, n.F_z, n.F_r, n.M_beta, n.M_zeta, n.M_beta_elas, n.M_zeta_elas]
_FORCES += [n.M_beta_aero, n.dM_theta_aero]
_INBOARD = [n.beta_in, n.zeta_in, n.beta_out, n.zeta_out]
_TRIM = [s.precone, s.coning, s.lag]
# Factors of a product from left to right: constants, speed, length, trim angles, sums, motions, harmonics.
_CONSTANT, _SPEED, _LENGTH, _ANGLE, _SUM, _MOTION, _HARMONIC = range(7)
_KINDS = {
    **dict.fromkeys((s.rotor_speed, s.airspeed), _SPEED),
    **dict.fromkeys((radius, s.radial_station, n.e, s.flap_hinge_offset, s.lag_hinge_offset), _LENGTH),
    **dict.fromkeys(_TRIM, _ANGLE),
    **dict.fromkeys((*_FORCES, *_INBOARD, *_MOTIONS), _MOTION),
}
_ORDER = {symbol: place for place, symbol in enumerate((*QUANTITIES, *_FORCES, *_INBOARD, *_MOTIONS))}


def _kind(factor: sp.Expr) -> int:
    base = factor.base if factor.is_Pow else factor
    if base.is_Add:
        return _SUM
    return _HARMONIC if base.is_Function else _KINDS.get(base, _CONSTANT)


def _factor_key(factor: sp.Expr) -> tuple[Any, ...]:
    symbols = [symbol for symbol in factor.free_symbols if symbol in _ORDER]
    moves = any(_KINDS.get(symbol) == _MOTION for symbol in symbols)
    first = min(((_KINDS.get(symbol, _CONSTANT), _ORDER[symbol]) for symbol in symbols), default=(-1, -1))
    return (_kind(factor), moves, first, isinstance(factor, sp.cos), sp.default_sort_key(factor))


def _term_key(term: sp.Expr) -> tuple[Any, ...]:
    """Sort terms without motion first, then by coordinate, positive before negative."""
    motions = sorted(_ORDER[symbol] for symbol in term.free_symbols if _KINDS.get(symbol) == _MOTION)
    factors = [_factor_key(factor) for factor in sorted(sp.Mul.make_args(term), key=_factor_key)]
    harmonic = any(key[0] == _HARMONIC for key in factors)
    return (motions, harmonic, _is_negative(term), [key[:-1] for key in factors], sp.default_sort_key(term))


def _is_negative(term: sp.Expr) -> bool:
    return bool(term.as_coeff_Mul()[0] < 0)


def _index_first(name: str) -> str:
    """Put primes behind the index, because Markdown takes an underscore after a mark for emphasis."""
    return re.sub(r"^([^'_]+)('+)_(.*)$", r"\1_\3\2", name)


class _Notation(LatexPrinter):  # type: ignore[misc]  # SymPy has no types
    """Print products and sums in the usual order, without brackets around a single argument."""

    def __init__(self) -> None:
        names = {symbol: _index_first(name) for symbol, name in n.latex_names().items()} | _NAMES
        super().__init__({"symbol_names": names, "fold_func_brackets": True})

    def _print_Add(self, expr: sp.Expr, order: object = None) -> str:
        first, *rest = sorted(expr.args, key=_term_key)
        text: str = self._print(first)
        for term in rest:
            negative = _is_negative(term)
            text += (" - " if negative else " + ") + self._print(-term if negative else term)
        return text

    def _print_Mul(self, expr: sp.Expr) -> str:
        if _is_negative(expr):
            return "- " + self._in_sum(-expr)
        above, below = sp.fraction(expr, exact=True)
        if below == 1:
            return self._product(above)
        return rf"\frac{{{self._product(above)}}}{{{self._product(below)}}}"

    def _product(self, expr: sp.Expr) -> str:
        number, factors = expr.as_coeff_mul()
        factors = sorted(factors, key=_factor_key)
        if len(factors) == 1 and number == 1:
            return str(self._print(factors[0]))
        texts = [self._in_sum(factor) for factor in factors]
        return " ".join([self._print(number)] * (number != 1 or not texts) + texts)

    def _in_sum(self, factor: sp.Expr) -> str:
        return rf"\left({self._print(factor)}\right)" if factor.is_Add else str(self._print(factor))


_printer = _Notation()


def latex(expression: sp.Expr) -> str:
    """Return the expression in the notation of print and derivation."""
    return str(_printer.doprint(sp.sympify(expression)))


def _mathematics(expression: sp.Expr) -> str:
    return f"${latex(expression)}$"


def _letters(text: str) -> int:
    """Estimate the width of a formula in letters; a fraction is as wide as its wider half."""
    text = re.sub(r"\\(left|right|dot|ddot|bar|mathrm|quad|text)(?![a-z])", "", text)
    halves = re.compile(r"\\frac\{((?:[^{}]|\{[^{}]*\})*)\}\{((?:[^{}]|\{[^{}]*\})*)\}")
    text = halves.sub(lambda found: max(found.groups(), key=len), text)
    return len(re.sub(r"[{}_^\s\\]", "", re.sub(r"\\[A-Za-z]+", "x", text)))


def _turned(factor: sp.Expr) -> tuple[sp.Expr, int]:
    """Return a factor with the sign that makes the radius, or else most terms, positive; and that sign."""
    if factor.is_Pow and factor.base.is_Add and factor.exp.is_Integer:
        base, sign = _turned(factor.base)
        return base**factor.exp, sign ** (int(factor.exp) % 2)
    if not factor.is_Add:
        return factor, 1
    coefficients = [sp.expand(factor).coeff(symbol) for symbol in (s.radial_station, radius)]
    terms = next((sp.Add.make_args(c) for c in coefficients if c != 0), factor.args)
    negative = sum(map(_is_negative, terms)) - len(terms) / 2
    turn = negative > 0 or (negative == 0 and _is_negative(min(terms, key=lambda t: _term_key(t)[3:])))
    return (-factor, -1) if turn else (factor, 1)


def _factored(expression: sp.Expr) -> sp.Expr:
    sign, factors = 1, []
    for factor in sp.Mul.make_args(sp.factor(expression)):
        turned, one = _turned(factor)
        sign *= one
        factors.append(sp.collect(turned, _TRIM) if turned.has(s.radial_station) else turned)
    return sp.Mul(sign, *factors)


def _by_motion(expression: sp.Expr) -> list[sp.Expr]:
    """Group the addends of a sum by motion and trim angle of the springs, and factor each group."""
    groups: dict[tuple[Any, ...], list[sp.Expr]] = {}
    for term in sp.Add.make_args(sp.expand(expression)):
        motions = [symbol for symbol in term.free_symbols if _KINDS.get(symbol) == _MOTION]
        groups.setdefault(tuple(sorted(_ORDER[symbol] for symbol in motions)), []).append(term)
    return [addend for _, group in sorted(groups.items()) for addend in _fitting(group)]


def _fitting(group: list[sp.Expr]) -> list[sp.Expr]:
    """Write terms as one product if it fits a line, or else by harmonic, or else one by one."""
    whole = _factored(sp.Add(*group))
    if _letters(latex(whole)) <= 2 * _LINE:
        return [whole]
    by_harmonic: dict[tuple[str, ...], list[sp.Expr]] = {}
    for term in group:
        harmonics = sorted(str(factor) for factor in sp.Mul.make_args(term) if factor.has(sp.sin, sp.cos))
        by_harmonic.setdefault(tuple(harmonics), []).append(term)
    gathered = [_factored(sp.Add(*terms)) for _, terms in sorted(by_harmonic.items())]
    if all(_letters(latex(product)) <= 2 * _LINE for product in gathered):
        return gathered
    return sorted(group, key=_term_key)


def _doubled(expression: sp.Expr) -> sp.Expr:
    """Replace products of sine and cosine of the structural pitch by those of twice the angle."""
    angle = s.structural_pitch
    sine, cosine = sp.sin(angle), sp.cos(angle)
    double = sp.expand(sp.expand(expression).subs(sine * cosine, sp.sin(2 * angle) / 2))
    return sp.expand(double.subs(sine**2, (1 - sp.cos(2 * angle)) / 2))


def _with_common_factor(expression: sp.Expr) -> tuple[sp.Expr, list[sp.Expr]]:
    """Return a factor of the whole sum, and the addends of the rest by motion and trim angle."""
    common, sums = sp.Integer(1), []
    for factor in sp.Mul.make_args(_factored(expression)):
        if factor.is_Add and factor.has(sp.sin, sp.cos):
            sums.append(factor)
        else:
            common *= factor
    rest = sp.expand(sp.Mul(*sums))
    groups: dict[tuple[Any, ...], list[sp.Expr]] = {}
    for term in sp.Add.make_args(rest):
        named = [f for f in term.free_symbols if _KINDS.get(f) in (_MOTION, _ANGLE)]
        harmonic = [str(f) for f in sp.Mul.make_args(term) if f.is_Function]
        groups.setdefault((tuple(sorted(_ORDER[symbol] for symbol in named)), *harmonic), []).append(term)
    rest = [_factored(sp.Add(*group)) for _, group in sorted(groups.items())]
    turn = -1 if 2 * sum(map(_is_negative, rest)) > len(rest) else 1
    return turn * common, [turn * addend for addend in rest]


def _lines(addends: list[sp.Expr], width: int = _LINE) -> list[str]:
    """Break a sum into lines that fit a column."""
    lines: list[str] = []
    for addend in addends:
        text = latex(addend)
        text = text if text.startswith("-") or not lines else f"+ {text}"
        if lines and _letters(lines[-1] + text) <= width:
            lines[-1] += " " + text
        else:
            lines.append(text)
    return lines


def _column(terms: Mapping[sp.Expr, sp.Expr]) -> str:
    """Write a sum in lines, by motion or with a factor of the whole in front, whichever is shorter."""
    total = sp.Add(*(number * term for term, number in terms.items()))
    if total == 0:
        return "–"
    lines = _lines(_by_motion(total))
    if total.has(s.structural_pitch):
        common, rest = _with_common_factor(_doubled(total))
        if len(rest) > 1:
            inner = _lines(rest)
            factored = [
                rf"{latex(common)} \thinspace [ {inner[0]}" if common != 1 else f"[ {inner[0]}",
                *inner[1:],
            ]
            factored[-1] += " ]"
            lines = min(lines, factored, key=lambda text: sum(map(_letters, text)))
    return "<br>".join(f"${line}$" for line in lines)


def rows_of_table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a Markdown table."""
    header = list(header)
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


# Equations


def equation(number: int | str) -> Shown:
    """Show print and derivation of an equation side by side, with the verdict on every term."""
    result = report.equation_verdict(number)
    blocks = [_summary(result)]
    if _is_rearranged(result.equation):
        blocks.append(_as_printed(result.equation))
    blocks.append(_side_by_side(result))
    broken = [finding for finding in report.broken_invariants().get(number, [])] if result.conflicts else []
    blocks += [f"Breaks **{finding.invariant}**: {_in_notation(finding.evidence)}." for finding in broken]
    return Shown("\n\n".join(blocks))


def chain(
    name: int | str, found: Mapping[str, sp.Expr], derived: Mapping[str, sp.Expr] | None = None
) -> Shown:
    """Show whether a chain of SymPy has every term of the derivation, and print the terms that differ.

    Parameters
    ----------
    name : int or str
        An equation of the paper, whose counterpart is what the derivation has; or any name beside `derived`.
    found : mapping
        What the chain gives for each part.
    derived : mapping, optional
        What the derivation has for each part.

    Raises
    ------
    ValueError
        For a part that the derivation does not have, and when nothing was found to compare.
    """
    expected = derived_terms(name) if derived is None else {part: terms_of(e) for part, e in derived.items()}
    if not found:
        raise ValueError(f"found: must give one of the parts {', '.join(expected)}")
    for part in found:
        if part not in expected:
            raise ValueError(f"found = {part}: is no part of this equation, which has {', '.join(expected)}")
    verdicts = audit_chain(found, expected)
    other = [verdict for verdict in verdicts if verdict.verdict == CONTRADICTS]
    of = heading(name) if derived is None else str(name)
    if not other:
        return Shown(
            f"{of}, by this chain: all {len(verdicts)} terms are those of the derivation: {REPRODUCED}."
        )
    rows = []
    for part in dict.fromkeys(verdict.part for verdict in other):
        rows.append((part, *_both([verdict for verdict in other if verdict.part == part])))
    text = f"{of}, by this chain: {len(other)} of {len(verdicts)} terms differ from the derivation: **{CONTRADICTS}**."
    return Shown(f"{text}\n\n{rows_of_table(('', 'this chain', 'derived'), rows)}")


def _summary(result: EquationVerdict) -> str:
    equation = result.equation
    counts = ", ".join(f"{result.count(v)} {report.LETTERS[v]}" for v in VERDICTS if result.count(v))
    text = f"**{equation.title[0].upper()}{equation.title[1:]}** (page {equation.page}): {_marked(result.verdict)}. "
    text += f"Terms: {counts}. See the {in_index(equation.number)}."
    return f"{text}  \nDoubt: {equation.doubt}." if equation.doubt else text


def _marked(verdict: str) -> str:
    return f"**{verdict}**" if verdict == CONTRADICTS else verdict


def _is_rearranged(equation: printed.PrintedEquation) -> bool:
    """Tell whether the comparison shows the print in other symbols, or expanded."""
    return bool(meaning(equation.number)) or any(sp.expand(e) != e for e in equation.parts.values())


def _as_printed(equation: printed.PrintedEquation) -> str:
    """Write the print as it stands, in one display for each part or in several for a long part."""
    displays = []
    for part, expression in equation.parts.items():
        first, *rest = _lines(sorted(sp.Add.make_args(expression), key=_term_key), 2 * _LINE)
        displays += [f"{_name_of_part(part)} {first}", *rest]
    return "\n\n".join(f"$$\n{line}\n$$" for line in displays)


_GREEK = {"α": "alpha", "β": "beta", "δ": "delta", "Δ": "Delta", "ζ": "zeta", "θ": "theta", "ν": "nu"}


def _name_of_part(part: str) -> str:
    """Return the name of a part in notation with a sign of equality, or in words with a colon."""
    name = part.partition(" by ")[0]
    if " " in name or (name.isascii() and name.islower() and len(name) > 1):
        return rf"\text{{{name}:}}\quad"
    base, _, index = name.partition("_")
    spelled = ("".join(rf"\{_GREEK[c]} " if c in _GREEK else c for c in text) for text in (base, index))
    base, index = (text.strip() for text in spelled)
    index, square = index.removesuffix("²"), "^2" * name.endswith("²")
    index = rf"\mathrm{{{index}}}" if index in ("in", "out") else index
    return (rf"{base}_{{{index}}}" if index else base) + f"{square} ="


def _side_by_side(result: EquationVerdict) -> str:
    """Write a row for the terms of a part that agree, and one for each reason of a difference."""
    rows = []
    for part in result.equation.parts:
        terms = [term for term in result.terms if term.part == part]
        groups: dict[tuple[str, ...], list[TermVerdict]] = {}
        for term in sorted(terms, key=lambda t: VERDICTS.index(t.verdict)):
            agrees = term.verdict in (REPRODUCED, AFTER_READING)
            groups.setdefault(("agrees",) if agrees else (term.verdict, term.note), []).append(term)
        for place, group in enumerate(groups.values()):
            rows.append(("" if place else part, *_both(group), _reason(group)))
    return rows_of_table(("", "printed", "derived", "verdict"), rows)


def _both(group: list[TermVerdict]) -> list[str]:
    return [_column({t.term: getattr(t, side) for t in group}) for side in ("printed", "derived")]


def _reason(group: list[TermVerdict]) -> str:
    verdict = group[0].verdict
    if verdict in (REPRODUCED, AFTER_READING):
        readings = dict.fromkeys(term.note for term in group if term.note)
        return "reproduced" + "".join(f"<br>{reading}" for reading in readings)
    names = "".join(f"<br>`{name}`" for name in group[0].note.split(", ") if name)
    return f"{_marked(verdict)}{names}"


_CODE = re.compile(r"-?[\w.]+\*[^,;]*")


def _in_notation(evidence: str) -> str:
    """Write the expressions of an evidence as mathematics."""
    known = {symbol.name: symbol for symbol in n.latex_names()}
    return _CODE.sub(lambda found: _mathematics(sp.sympify(found.group(), locals=known)), evidence)


# Tables


def table(number: int) -> Shown:
    """Show a printed table, and the verdicts on relations between its values."""
    result = report.table_verdicts()[f"Table {number}"]
    of = result.table
    values = rows_of_table(of.values, [(value.text for value in of.values.values())])
    rows = [
        (relation.name, _marked(relation.verdict), relation.evidence, relation.invariant * relation_is_broken)
        for relation in result.relations
        for relation_is_broken in [relation in result.conflicts]
    ]
    text = (
        f"**{of.title}** (page {of.page}): {_marked(result.verdict)}. See the {in_index(f'Table {number}')}."
    )
    judged = rows_of_table(("relation", "verdict", "evidence", "breaks"), rows)
    return Shown("\n\n".join((text, f"Doubt: {of.doubt}.", values, judged)))


# Terms and invariants


def dropped_terms(*names: str) -> Shown:
    """Show the terms that the paper leaves out, and why."""
    terms = ((f"`{name}`", DROPPED_TERMS[name]) for name in names or DROPPED_TERMS)
    rows = ((name, term.term, term.equation, term.reason) for name, term in terms)
    return Shown(rows_of_table(("term", "what it is", "where", "why it is not in the print"), rows))


def invariants_checked() -> Shown:
    """Show every invariant, the number of equations checked, and the equations that break it."""
    found: dict[str, list[invariants.Finding]] = {}
    for finding in report.findings():
        found.setdefault(finding.invariant, []).append(finding)
    rows = (
        (
            name,
            str(len(of)),
            "<br>".join(f"{heading(f.number)}: {_in_notation(f.evidence)}" for f in of if not f.holds),
        )
        for name, of in found.items()
    )
    return Shown(rows_of_table(("invariant", "equations asked", "broken by"), rows))


def rest_of_rigid_tilt() -> Shown:
    """Show what Eq. 11 leaves with hub tilted and gimbal tilted back, as printed and with the Coriolis term alone."""
    added = {
        "as printed": sp.Integer(0),
        "with the gimbal's Coriolis term alone": invariants.coriolis_of_gimbal(),
    }
    rest = {
        label: invariants.rigid_tilt_rest(printed.EQUATIONS[11], term)[0] for label, term in added.items()
    }
    rows = ((label, _mathematics(_factored(value))) for label, value in rest.items())
    return Shown(rows_of_table(("Eq. 11", "acceleration along i that is left"), rows))


def steady_tilt() -> Shown:
    """Show the in-plane acceleration of the tip of the XV-15 under a steady tilt of one degree."""
    rows = (
        (label, f"{value:.2f}".replace("-0.00", "0.00"))
        for label, value in consequences.steady_tilt().items()
    )
    return Shown(rows_of_table(("terms", "along i at ψ = 0, m/s² per degree"), rows))


def boundaries(of: Mapping[str, float]) -> Shown:
    """Show boundaries of the XV-15 by what was changed."""
    return Shown(
        rows_of_table(("equations", "XV-15 boundary"), ((k, consequences.in_knots(v)) for k, v in of.items()))
    )


def errata() -> Shown:
    """Show every conflict: the print, the derivation, the broken invariant and the boundary of the XV-15."""
    rows = []
    for number in report.broken_invariants():
        unexplained = [
            t for t in report.equation_verdict(number).terms if t.printed != t.derived and not t.note
        ]
        columns = [
            _column({t.term: getattr(t, side) for t in unexplained}) for side in ("printed", "derived")
        ]
        breaks = ", ".join(report.invariants_of(number))
        rows.append((heading(number), *columns, breaks, report.consequence_of_conflict(number)))
    for name, result in report.table_verdicts().items():
        if result.conflicts:
            breaks = ", ".join(report.invariants_of(name))
            evidence = "<br>".join(relation.evidence for relation in result.conflicts[:1])
            rows.append((name, evidence, "≤ 1", breaks, report.consequence_of_conflict(name)))
    return Shown(rows_of_table(("", "printed", "derived", "breaks", "XV-15 boundary"), rows))

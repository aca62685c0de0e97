"""Compare a printed equation with its counterpart in the derivation, term by term.

Both sides are written in the symbols of the derivation and expanded. A term is a product of coordinates, harmonics and
parameters with one number in front. Terms that differ are compared again after the readings that the equation states,
and each term that still differs gets a verdict.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from derive import symbols as s
from derive.audit.counterparts import COUNTERPARTS, meaning
from derive.audit.printed import PrintedEquation
from derive.audit.printed import notation as n
from derive.published import CONSISTENT, DROPPED_TERMS

REPRODUCED = "reproduced"
AFTER_READING = "reproduced after a stated sign or subscript"
ABSENT_FROM_PRINT = "absent from the print"
ABSENT_FROM_DERIVATION = "absent from the derivation"
CONTRADICTS = "contradicts"
# From good to bad: the verdict on an equation is that on its worst term.
VERDICTS = (REPRODUCED, AFTER_READING, ABSENT_FROM_PRINT, ABSENT_FROM_DERIVATION, CONTRADICTS)

# Symbols of the paper that can be read in more than one way, and what each reading puts in their place.
READINGS: dict[str, dict[sp.Symbol, sp.Expr]] = {
    "one hinge offset": {
        s.flap_hinge_offset: n.e,
        s.lag_hinge_offset: n.e,
        s.flap_lag_inertia: s.flap_inertia,
    },
    "airload moment nose down": {n.dM_theta_aero: -n.dM_theta_aero},
}
_OF_PRINT_ALONE = ("airload moment nose down",)

Terms = dict[sp.Expr, sp.Expr]  # product of symbols: number


_NO_LINKAGES = dict.fromkeys(s.HINGE_LINKAGES, 0)


@dataclass(frozen=True)
class TermVerdict:
    """One term: the number in front of it in the print, the number in the derivation, and the verdict."""

    part: str
    term: sp.Expr
    printed: sp.Expr
    derived: sp.Expr
    verdict: str
    note: str = ""  # the reading, or the dropped terms without which the derivation agrees

    @property
    def is_conflict(self) -> bool:
        """Whether the term is printed and neither a reading nor a dropped term explains the difference."""
        return self.verdict in (ABSENT_FROM_DERIVATION, CONTRADICTS) and not self.note


@dataclass(frozen=True)
class EquationVerdict:
    """The verdicts on all terms of an equation."""

    equation: PrintedEquation
    terms: tuple[TermVerdict, ...]

    @property
    def verdict(self) -> str:
        """The worst verdict on any term."""
        return max((term.verdict for term in self.terms), key=VERDICTS.index)

    def count(self, verdict: str) -> int:
        """Count the terms with a verdict."""
        return sum(term.verdict == verdict for term in self.terms)

    @property
    def conflicts(self) -> list[TermVerdict]:
        """The terms that nothing explains."""
        return [term for term in self.terms if term.is_conflict]

    def of(self, verdict: str) -> list[TermVerdict]:
        """Return the terms with a verdict."""
        return [term for term in self.terms if term.verdict == verdict]


def terms_of(expression: sp.Expr) -> Terms:
    """Return the terms of an expression in one form: expanded, with squares of cosines replaced by sines."""
    expanded = _without_squared_cosines(sp.expand(expression))
    return {term: number for term, number in expanded.as_coefficients_dict().items() if number != 0}


def _without_squared_cosines(expression: sp.Expr) -> sp.Expr:
    def reduced(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
        if isinstance(base, sp.cos) and exponent.is_Integer and exponent >= 2:
            return (1 - sp.sin(*base.args) ** 2) ** (exponent // 2) * base ** (exponent % 2)
        return base**exponent

    if not any(isinstance(power.base, sp.cos) for power in expression.atoms(sp.Pow)):
        return expression
    return sp.expand(expression.replace(sp.Pow, reduced))


@functools.cache
def derived_terms(number: int | str, dropped: frozenset[str] = CONSISTENT) -> dict[str, Terms]:
    """Return the terms of the derivation by part; the paper's blade has no linkages on its own hinges."""
    parts = COUNTERPARTS[number](dropped)
    return {part: terms_of(expression.subs(_NO_LINKAGES)) for part, expression in parts.items()}


@functools.cache
def _meaning_of(number: int | str, printed_term: sp.Expr) -> sp.Expr:
    return sp.expand(printed_term.subs(meaning(number)))


def printed_terms(equation: PrintedEquation, part: str) -> Terms:
    """Return the terms of a printed part in the symbols of the derivation."""
    addends = sp.Add.make_args(sp.expand(equation.parts[part]))
    return terms_of(sp.Add(*(_meaning_of(equation.number, addend) for addend in addends)))


def audit(equation: PrintedEquation) -> EquationVerdict:
    """Judge every term of every part of an equation."""
    derived = derived_terms(equation.number)
    if set(derived) != set(equation.parts):
        raise ValueError(f"Eq. {equation.number}: parts {set(equation.parts)} against {set(derived)}")
    verdicts: list[TermVerdict] = []
    for part in equation.parts:
        verdicts += _judged(equation, part, printed_terms(equation, part), derived[part])
    return EquationVerdict(equation, tuple(verdicts))


def audit_chain(found: Mapping[str, sp.Expr], derived: Mapping[str, Terms]) -> tuple[TermVerdict, ...]:
    """Judge every term of what a reader found in place of the print: the derivation has it, or contradicts it."""
    verdicts: list[TermVerdict] = []
    for part, expression in found.items():
        agreed, own, others = _agreement(terms_of(sp.sympify(expression)), derived[part])
        zero = sp.Integer(0)
        verdicts += [TermVerdict(part, term, number, number, REPRODUCED) for term, number in agreed.items()]
        verdicts += [
            TermVerdict(part, term, own.get(term, zero), others.get(term, zero), CONTRADICTS)
            for term in sorted({*own, *others}, key=sp.default_sort_key)
        ]
    return tuple(verdicts)


def _judged(equation: PrintedEquation, part: str, printed: Terms, derived: Terms) -> Iterator[TermVerdict]:
    restored = f"restored: {equation.restored}" if equation.restored else ""
    agreed, printed, derived = _agreement(printed, derived)
    for term, number in agreed.items():
        yield TermVerdict(part, term, number, number, AFTER_READING if restored else REPRODUCED, restored)
    for name in equation.readings:
        derived = derived if name in _OF_PRINT_ALONE else _read(derived, name)
        agreed, printed, derived = _agreement(_read(printed, name), derived)
        for term, number in agreed.items():
            yield TermVerdict(part, term, number, number, AFTER_READING, name)
    for term in sorted({*printed, *derived}, key=sp.default_sort_key):
        yield _left_over(
            equation, part, term, printed.get(term, sp.Integer(0)), derived.get(term, sp.Integer(0))
        )


def _agreement(printed: Terms, derived: Terms) -> tuple[Terms, Terms, Terms]:
    """Return the terms that agree, and the terms that are left of each side."""
    agreed = {term: number for term, number in printed.items() if derived.get(term) == number}
    left, right = ({t: v for t, v in terms.items() if t not in agreed} for terms in (printed, derived))
    return agreed, left, right


def _read(terms: Terms, reading: str) -> Terms:
    return terms_of(sp.Add(*(number * term for term, number in terms.items())).subs(READINGS[reading]))


def _left_over(
    equation: PrintedEquation, part: str, term: sp.Expr, printed: sp.Expr, derived: sp.Expr
) -> TermVerdict:
    verdict = CONTRADICTS
    if printed == 0:
        verdict = ABSENT_FROM_PRINT
    elif derived == 0:
        verdict = ABSENT_FROM_DERIVATION
    return TermVerdict(part, term, printed, derived, verdict, _belongs_to(equation, part, term, printed))


# Dropped terms that an equation can lose. Other terms are not in the equation, or are of an order that the paper drops.
_ACCELERATIONS = ("hub_turn_of_raised_blade", "gimbal_coriolis", "yoke_roll", "radial_flap_acceleration")
CANDIDATES: dict[int | str, tuple[str, ...]] = {
    3: _ACCELERATIONS,
    11: _ACCELERATIONS,
    13: (*_ACCELERATIONS, "springs_follow_pitch"),
    14: ("yoke_roll", "cone_in_airloads"),
    15: ("yoke_roll", "cone_in_airloads"),
    16: ("yoke_roll",),
    32: ("gimbal_pitch_inertia", "propeller_moment", "yoke_roll"),
}


def _belongs_to(equation: PrintedEquation, part: str, term: sp.Expr, printed: sp.Expr) -> str:
    """Return the names of the dropped terms without which the derivation has the printed term."""
    number, readings = equation.number, equation.readings
    names = CANDIDATES.get(number, ())
    without = {name: _read_terms(number, part, readings, frozenset({name})).get(term, 0) for name in names}
    return ", ".join(name for name in names if without[name] == printed)


@functools.cache
def _read_terms(number: int | str, part: str, readings: tuple[str, ...], dropped: frozenset[str]) -> Terms:
    """Return the derived terms after the readings of the equation."""
    terms = derived_terms(number, dropped)[part]
    for name in readings:
        terms = terms if name in _OF_PRINT_ALONE else _read(terms, name)
    return terms


assert all(name in DROPPED_TERMS for names in CANDIDATES.values() for name in names)

"""Tables 1 and 2: the properties of the two rotors, in the units they are printed in (ft, slug, s)."""

from __future__ import annotations

from dataclasses import dataclass


class PrintedNumber(float):
    """A number that keeps the digits it is printed with: 0.200 is not 0.2."""

    text: str

    def __new__(cls, text: str) -> PrintedNumber:
        number = super().__new__(cls, text)
        number.text = text
        return number


def _numbers(**texts: str) -> dict[str, PrintedNumber]:
    return {symbol: PrintedNumber(text) for symbol, text in texts.items()}


@dataclass(frozen=True)
class PrintedTable:
    """One table: its values by the paper's symbols."""

    number: int
    page: int
    title: str
    values: dict[str, PrintedNumber]
    doubt: str = ""


LOST = "the text has lost the subscripts; their order is that of the nomenclature"
TABLES = (
    PrintedTable(
        1,
        12,
        "XV-15, full-scale test",
        _numbers(
            N="3",
            R="12.5",
            γ="3.83",
            σ="0.089",
            c_lα="5.7",
            rpm="458",
            K_PG="-0.268",
            I_b="105",
            I_β="81.8",
            I_βα="105",
            I_ζ="70.4",
            I_ζα="82.6",
            S_β="10.2",
            S_ζ="8.69",
            ω_β0="59.8",
            ω_ζ0="103",
            R_β="1",
            R_ζ="1",
        ),
        doubt=LOST,
    ),
    PrintedTable(
        2,
        12,
        "WRATS model",
        _numbers(
            N="3",
            R="3.8",
            γ="5.34",
            σ="0.105",
            c_lα="5.9",
            rpm="888",
            K_PG="-0.268",
            I_b="0.229",
            I_β="0.179",
            I_βα="0.200",
            I_ζ="0.159",
            I_ζα="0.185",
            S_β="0.0898",
            S_ζ="0.0771",
            ω_β0="31.9",
            ω_ζ0="134",
            R_β="0.10",
            R_ζ="0.23",
        ),
        doubt=LOST + "; rotational speed 742 to 888 RPM",
    ),
)

"""The equations and tables of AIAA-2002-1604 as they are printed: data, and nothing derived.

`EQUATIONS` has the numbered equations, `NOMENCLATURE` the two frequencies that the nomenclature defines, and `TABLES`
the two tables. Of the derivation the modules here use symbols alone.
"""

from derive.audit.printed import aerodynamics, flap, kinematics, pitch, springs
from derive.audit.printed.notation import PrintedEquation
from derive.audit.printed.tables import TABLES, PrintedTable

EQUATIONS: dict[int | str, PrintedEquation] = {
    equation.number: equation
    for part in (kinematics, flap, aerodynamics, springs, pitch)
    for equation in part.EQUATIONS
}
NOMENCLATURE: dict[int | str, PrintedEquation] = {equation.number: equation for equation in flap.NOMENCLATURE}

__all__ = ["EQUATIONS", "NOMENCLATURE", "TABLES", "PrintedEquation", "PrintedTable"]

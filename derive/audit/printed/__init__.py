"""The equations and tables of AIAA-2002-1604 as they are printed, as data: nothing here is derived."""

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

"""Rotor: a rotor trimmed in its air, with the section loads along its blades.

In: geometry, masses and springs of a rotor, its airfoil, its operation and the modelling options, all in SI. Out: the
trim of many points at once, with the quantities of the whole blade and of its segments from which `model` makes its
matrices. This room imports `errors`, `typing` and `files`, and the generated equations.

What a rotor is:
    rotor                a proprotor: geometry, mass, springs, chord and twist
    offset_mass          integrals of mass beside the pitch axis
    airfoil              section coefficients; the linear airfoil
    airfoil_regions      airfoils by region of the span
    airfoil_table        an airfoil from tables
    c81                  files of such tables in the C81 format, in the dialects of many programs
    c81_layouts          the rows of such files, in columns or separated
    c81_writer           writing such files
    coefficient_surface  the smooth surface through a table
    drive_train          engine and shaft
    smooth_table         smooth interpolation of a table, with exact derivatives
    blade_frequencies    frequencies given in tables, in place of springs

A rotor from a blade by stations:
    blade_stations       a table of stations, and how the pitch is held
    elastic_blade        rotating modes, flexibility and turn of the elastic blade
    element_chain        the sum of elements that follow one another
    hinged_blade         the hinged blade that is nearest to it
    from_stations        the rotor of such blades

How a rotor is used:
    operation            rotor speed, air and target of the trim
    atmosphere           the standard atmosphere
    options              modelling options
    generated            calls of the generated equations by names of quantities
    fused                matrices of a whole rotor by the fused functions, batches and one point
    kept                 results that are kept as long as the objects live from which they were made
    motions              coordinates as motions, and the names of their modes

Loads and trim:
    quadrature           stations along the blade and radial moments
    effective_sections   chord and twist from tables as polynomials between the stations
    section_loads        section loads gathered into radial moments
    lift_lag             circulation along the blade in shape functions, for lift that lags
    trim                 the trim, and the target that closes it
    fused_balance        the balance of one blade by the fused functions, for batches
    balance_of_one       the same for one point, by plain numbers
    trim_balance         the balance of one blade and its slopes
    elimination          linear equations of a few unknowns at many points
    trim_start           first guess and undeflected blade
    trim_bound           a bound that shows which equilibrium belongs to the undeflected blade
    trim_path            the path from the undeflected blade to the trim
    trim_reasons         reasons and warnings
    trim_of_one          Newton's method for one point, by plain numbers
    trim_solver          Newton's method for all points
    trim_compiled        the steps of a stage of it by the compiled functions
    in_flight            trim and matrices of rotors without any reservation, in one compiled call
    momentum             the trim with induced velocity by momentum theory

A rotor at an angle to its flight, or in a pull-up:
    around_the_turn      periodic functions at equal steps of azimuth
    moving_blade         balance and matrices of a blade about a trim that moves
    periodic_trim        the trim that moves, by harmonic balance

All public names of the modules `around_the_turn`, `blade_stations`, `elastic_blade`, `element_chain`, `hinged_blade`,
`from_stations`, `fused`, `generated`, `kept`, `lift_lag`, `motions`, `moving_blade`, `options`, `periodic_trim`,
`section_loads` and `smooth_table` belong to the face.
"""

from proprotor.rotor.airfoil import Airfoil, SectionCoefficients, SectionModel, Warns
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.atmosphere import Air, standard_air
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.blade_stations import FEWEST_STATIONS, BladeStations
from proprotor.rotor.c81_writer import write_c81
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.in_flight import InFlight, find_in_flight, rotors_of, serves_in_flight
from proprotor.rotor.momentum import with_induced
from proprotor.rotor.offset_mass import OffsetMass
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import HELD, MASS_INTEGRALS, NOTHING, Rotor
from proprotor.rotor.trim import UNKNOWNS, Target, Trim, has_offset_mass, take, trim_target, with_trim
from proprotor.rotor.trim_solver import Settled, balance_of, settle_trim, solve_trim

__all__ = [
    "FEWEST_STATIONS",
    "HELD",
    "MASS_INTEGRALS",
    "NOTHING",
    "UNKNOWNS",
    "Air",
    "Airfoil",
    "AirfoilRegions",
    "AirfoilTable",
    "BladeFrequencies",
    "BladeStations",
    "DriveTrain",
    "InFlight",
    "OffsetMass",
    "Operation",
    "Rotor",
    "SectionCoefficients",
    "SectionModel",
    "Settled",
    "Target",
    "Trim",
    "Warns",
    "around_the_turn",
    "balance_of",
    "elastic_blade",
    "element_chain",
    "find_in_flight",
    "from_stations",
    "fused",
    "generated",
    "has_offset_mass",
    "hinged_blade",
    "kept",
    "lift_lag",
    "motions",
    "moving_blade",
    "options",
    "periodic_trim",
    "rotors_of",
    "section_loads",
    "serves_in_flight",
    "settle_trim",
    "smooth_table",
    "solve_trim",
    "standard_air",
    "take",
    "trim_target",
    "with_induced",
    "with_trim",
    "write_c81",
]

"""Numbers of datasets as tables.

In come the datasets of sweeps, sensitivities and studies; out come numbers in the units that people read, records (a
mapping for each row, with units in the names), lines for a terminal, and CSV.

====================  =========================================================================
sweep_summary         numbers of a sweep: frequency, damping, unstable ranges, leaps of names
sweep_table           a sweep as lines for a terminal, as records and as sentences
sensitivity_summary   sensitivities as records
study_summary         a study in a few numbers
sobol_table           shares of the variance of a flutter speed, with confidence intervals
study_table           a study as records: one for each design, with its inputs in the units of the deck
percentiles           percentiles of a sample as text, with bounds where designs lie beyond the airspeeds
robust_table          the worst flutter speed of a box: records, cells and sentences
csv_text              records of any kind as CSV
blade_table           the hinged blade of a table of stations: fields, comparison, lines of a deck
boundary_table        boundaries against an input: records and lines
envelope_table        an envelope as records, as lines and as sentences
margin_table          margins of control loops: records, cells and sentences
amounts_table         what the inputs of a case amount to, as lines for a terminal and a report
record_table          modes that were identified in a record, as rows of points
calibration_table     calibrated inputs and the test points, as records
response_table        responses to gusts, as records
digits                numbers with the same count of digits in each row
points                points of a CSV file, to stand on plots beside results
====================  =========================================================================

May import the engine, `stability` and `case`.
"""

__all__ = [
    "amounts_table",
    "blade_table",
    "boundary_table",
    "calibration_table",
    "csv_text",
    "digits",
    "envelope_table",
    "margin_table",
    "percentiles",
    "points",
    "record_table",
    "response_table",
    "robust_table",
    "sensitivity_summary",
    "sobol_table",
    "study_summary",
    "study_table",
    "sweep_summary",
    "sweep_table",
]

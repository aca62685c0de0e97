"""Numbers of datasets as tables.

In come the datasets of sweeps, sensitivities and studies; out come numbers in the units that people read, records (a
mapping for each row, with units in the names), lines for a terminal, and CSV.

====================  =========================================================================
sweep_summary         numbers of a sweep: frequency, damping, unstable ranges, leaps of names
sweep_table           a sweep as lines for a terminal, as records and as sentences
sensitivity_summary   sensitivities as records
study_summary         a study in a few numbers
csv_text              records of any kind as CSV
====================  =========================================================================

May import the engine, `stability` and `case`.
"""

__all__ = ["csv_text", "sensitivity_summary", "study_summary", "sweep_summary", "sweep_table"]

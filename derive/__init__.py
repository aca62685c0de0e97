"""Symbolic derivation of a gimballed proprotor's equations of motion, in the order of AIAA-2002-1604.

Run from the repository: ``python -m derive`` rewrites ``generated/proprotor_equations``;
``python -m derive --check`` fails when the checked-in files differ from the derivation.
"""

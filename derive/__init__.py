"""Symbolic derivation of a gimballed proprotor's equations of motion, in the order of AIAA-2002-1604.

Run from the repository: ``python -m derive`` rewrites ``generated/proprotor_equations``;
``python -m derive --check`` fails when the checked-in files differ from the derivation.
"""

import os

# SymPy reads this when it is imported. The same products and derivatives come again in every module: its cache of
# 1000 results forgets them in between, and deriving everything takes a third longer.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")

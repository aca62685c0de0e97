"""Compiled functions: C that the system's compiler turns into a library once, and that is called for whole batches.

In: arrays of many small problems. Out: their solutions, with NumPy's or LAPACK's in the places that the compiled
functions hand over. Nothing needs this room: without a compiler everything is computed by NumPy. This room imports
`errors`, `typing`, `needs` and `files`.

    library      builds, keeps and loads the library; says why there is none
    eigenvalues  eigenvalues and right vectors of many matrices
    lanes.h      vectors of numbers, one lane for each problem
    eigen.h, schur.c, vectors.c, eigenvalues.c
                 the QR iteration in lanes, and vectors by substitution

The public names of `eigenvalues` and `library` are the room's face.
"""

__all__ = ["eigenvalues", "library"]

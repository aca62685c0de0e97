"""Compiled functions: C that the system's compiler turns into a library once, and that is called for a point or many.

In: arrays of many small problems. Out: their solutions, with NumPy's or LAPACK's in the places that the compiled
functions hand over. Nothing needs this room: without a compiler everything is computed by NumPy. This room imports
`errors`, `typing`, `needs` and `files`.

    library      builds, keeps and loads the library; says why there is none
    eigenvalues  eigenvalues and right vectors of many matrices, roots of equations of motion
    plans        trims of blades and matrices of rotors by the plans of the derivation
    in_flight    trim and matrices of rotors without any reservation in one call
    bounds       the bound on the path to a trim
    motion       equations of motion on a support, whether every motion has mass, state matrices
    screening    nearest roots of the steps of scans, and which steps may hold a crossing
    shapes, shapes.c
                 motion of the coordinates in the modes
    single_file, interface.c, proprotor.h, proprotor.f90, matlab
                 the solver as one source for programs in C, Fortran or MATLAB
    columns, columns.h
                 how vectors of numbers, one lane for each problem, are read and written; their memory
    eigen.h, schur.c, vectors.c, eigenvalues.c
                 the QR iteration in lanes, and vectors by substitution
    motion.h, motion.c
                 equations of motion: on a support, and solved for the accelerations
    bounds.h, bounds.c, rows.h
                 the bound; linear equations of a few rows
    screening.h, screening.c, root_pairs.c
                 the same for the roots of a step in lanes, and for two roots that cannot be told apart
    points.h, trim.h, path.h, whole.h, plain.c, general.c
                 for each set of plans: at many points, Newton's method for the trim, trim and matrices in one go

The public names of these modules, but for `columns`, are the room's face.
"""

__all__ = [
    "bounds",
    "eigenvalues",
    "in_flight",
    "library",
    "motion",
    "plans",
    "screening",
    "shapes",
    "single_file",
]

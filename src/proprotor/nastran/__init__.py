"""Files of Nastran: modes at a grid point, and matrices of a reduced structure.

In: files of MSC Nastran, Simcenter (NX) Nastran and the programs that write the same formats. Out: eigenvectors,
eigenvalues and generalised masses of one grid point, and matrices with named coordinates, all in the units of the run.
This room imports `errors`, `typing`, `needs` and `files`.

    found          what a file of results holds: sets of eigenvectors, tables of eigenvalues
    kinds_of_file  the kind of a file by its content, and its modes
    selection      the eigenvectors of one subcase, and the table that belongs to them
    data_blocks    records of the binary files of OUTPUT2
    op2            modes from such files
    hdf5           modes from HDF5 files of MSC Nastran
    punch          modes from punch files
    printed        modes from print files
    bulk_data      fields and numbers of bulk data
    dmig           matrices as entries DMIG of bulk data, read and written
    op4            matrices from files of OUTPUT4
    reduced        mass, stiffness and damping of a reduced structure
    text_files     lines of text files

The public names of `dmig`, `found`, `kinds_of_file`, `reduced`, `selection` and `text_files` are the room's face.
"""

__all__ = ["dmig", "found", "kinds_of_file", "reduced", "selection", "text_files"]

"""Results for other programs.

In come linear models, datasets and cases; out come files, and components of an optimisation.

=========  ================================================================================
netcdf     `save_results` and `load_results`: datasets as netCDF, which every reader opens
matlab     `save_matlab`: models and datasets as files of MATLAB
dmig       `save_dmig`: a rotor as direct matrix input of Nastran
openmdao   `WhirlFlutter`, `GrowthConstraint`: components for OpenMDAO, with exact partial derivatives
=========  ================================================================================

May import the engine, `deck`, `stability` and `case`. The module `openmdao` needs the extra of that name.
"""

__all__ = ["dmig", "matlab", "netcdf", "openmdao"]

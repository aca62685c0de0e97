"""Matrices compared block by block: every entry on the scale of its own block, never of the whole matrix."""

from itertools import product

import numpy as np

from tests.oracles.nonlinear_rotor import DOFS

GROUPS = (
    DOFS[0:3],  # hub forces
    DOFS[3:6],  # hub moments
    DOFS[6:9],  # flap
    DOFS[9:12],  # lag
    DOFS[12:15],  # pitch
    DOFS[15:16],  # azimuth
    DOFS[16:18],  # gimbal
)


def picked(matrix, dofs):
    """Rows and columns of an eighteen-coordinate matrix that are left in `dofs`."""
    index = [DOFS.index(name) for name in dofs]
    return matrix[np.ix_(index, index)]


def assert_matrices_match(actual, expected, inertia, rotor_speed, dofs, relative, rounding):
    """Compare (M, C, K) entry by entry to `relative` of the largest expected entry of the block.

    A block that ought to vanish has no scale of its own. It is held to `rounding` of what inertia at 1/rev
    would put there: Ω^k √(M_ii M_jj), k = 0, 1, 2, with the largest M of each group. Matrices are sums of
    some hundred terms of that size or less, so rounding alone leaves 1e-15 to 1e-14 of it.
    """
    groups = [[dofs.index(dof) for dof in group if dof in dofs] for group in GROUPS]
    root_inertia = np.sqrt(np.diag(inertia))
    wrong = []
    for power, name in enumerate("MCK"):
        for rows, columns in product(filter(None, groups), repeat=2):
            block = np.ix_(rows, columns)
            natural = rotor_speed**power * root_inertia[rows].max() * root_inertia[columns].max()
            allowed = relative * np.abs(expected[power][block]).max() + rounding * natural
            for row, column in product(rows, columns):
                is_, should_be = actual[power][row, column], expected[power][row, column]
                if not abs(is_ - should_be) <= allowed:
                    entry = f"{name}[{dofs[row]}, {dofs[column]}]"
                    wrong.append(f"{entry} = {is_:.12g}, not {should_be:.12g} ± {allowed:.1g}")
    assert not wrong, "\n".join([f"{len(wrong)} entries disagree:", *wrong])

"""Matrices compared block by block: every entry against the scale of its own block, never of the whole matrix."""

import numpy as np

from tests.oracles.nonlinear_rotor import DOFS

GROUPS = {
    "hub force": DOFS[0:3],
    "hub moment": DOFS[3:6],
    "flap": DOFS[6:9],
    "lag": DOFS[9:12],
    "pitch": DOFS[12:15],
    "azimuth": DOFS[15:16],
    "gimbal": DOFS[16:18],
}


def picked(matrix, dofs):
    """Rows and columns of an eighteen-coordinate matrix that are left in `dofs`."""
    index = [DOFS.index(name) for name in dofs]
    return matrix[np.ix_(index, index)]


def assert_matrices_match(actual, expected, inertia, rotor_speed, dofs, relative, rounding=1e-12):
    """Compare (M, C, K) entry by entry to `relative` of the block's largest entry.

    A block that ought to vanish has no scale of its own. It is held to `rounding` of what inertia at 1/rev would put
    there, Ω^k √(M_ii M_jj) with the largest M of each group: a sum of a few hundred terms of that size is good to
    1e-13 or so.
    """
    groups = {name: [dofs.index(dof) for dof in members if dof in dofs] for name, members in GROUPS.items()}
    root_inertia = np.sqrt(np.diag(inertia))
    wrong = []
    for order, name in enumerate("MCK"):
        for row_group, rows in groups.items():
            for column_group, columns in groups.items():
                if not rows or not columns:
                    continue
                block = np.ix_(rows, columns)
                natural = rotor_speed**order * root_inertia[rows].max() * root_inertia[columns].max()
                allowed = relative * np.abs(expected[order][block]).max() + rounding * natural
                error = np.abs(actual[order][block] - expected[order][block])
                wrong += [
                    f"{name}[{dofs[i]}, {dofs[j]}] = {actual[order][i, j]:.12g}, expected {expected[order][i, j]:.12g}, "
                    f"allowed {allowed:.2g} ({row_group} by {column_group})"
                    for (a, b) in np.argwhere(~(error <= allowed))
                    for i, j in [(rows[a], columns[b])]
                ]
    assert not wrong, f"{len(wrong)} entries disagree:\n" + "\n".join(wrong)

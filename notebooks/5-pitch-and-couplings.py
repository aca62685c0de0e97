# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 5 Pitch and couplings
#
# Eqs. 32–37 of AIAA-2002-1604: the pitch equation, and the couplings that stand in for it.
#
# The derivation has energies: of the control system, of the springs as they turn with the pitch, and of the
# propeller moment (`derive/pitch.py`). Signs and subscripts that the text at hand has lost in Eqs. 32–37 are
# restored, and the audit says so on each term. $\vartheta = \Theta + \delta_s$ is the pitch of the blade's
# structural axes.

# %%
from derive.pages import figures
from derive.pages.display import Picture, equation

# %% [markdown]
# ## The pitch equation
#
# ### Eq. 32

# %%
equation(32)

# %% [markdown]
# Two terms of inertia are absent: the swashplate turns the blade as the gimbal tilts ($I_\theta K_{PG}$), and
# the propeller moment. The second is what moves the boundary of the XV-15 most of all absent terms ([notebook
# 6](6-assembly-and-errata.py)).
#
# ## The moment of a bent blade
#
# ### Eq. 33

# %%
equation(33)

# %% [markdown]
# ### Eq. 34
#
# Checked without the derivation as well: the moment is the gradient of the spring energy of Eqs. 20–22 with
# pitch.

# %%
equation(34)

# %% [markdown]
# ## The couplings
#
# ### Eq. 35

# %%
equation(35)

# %% [markdown]
# **The third erratum.** With $M_\theta$ counted as in Eqs. 33 and 34 the moment turns the control system its
# own way: work is done on the spring, not taken from it. With the printed sign the stored energy would be
# negative. Eqs. 36 and 37, as restored, have the derived sign; who takes Eq. 35 by its word turns both
# couplings round.
#
# ### Eq. 36

# %%
equation(36)

# %% [markdown]
# ### Eq. 37
#
# Reciprocity, without the derivation:
# $\partial K_{P\beta}/\partial\bar\zeta_0 = \partial K_{P\zeta}/\partial\bar\beta_0$.

# %%
equation(37)

# %% [markdown]
# Along the trim of the XV-15. Without trim lag $K_{P\zeta}$ vanishes at 45°, where $K_{\beta\zeta}$ is
# largest; the trim lag moves the zero up.

# %%
Picture(figures.couplings_against_collective)

# %% [markdown]
# And what the sign of Eq. 35 would do: the couplings, which bring the boundary down, would keep the chord
# mode stable.

# %%
Picture(figures.damping_by_coupling_sign)

# %% [markdown]
# ## The chain, for you to change
#
# Eqs. 36 and 37 from where the blade's springs are at pitch $\vartheta$: the derivative of their energy with
# pitch, the loads held, is the moment with which a bent blade turns itself, and the control system alone resists it.
# Change a sign, run the cells, and the lines below them list the terms that contradict the derivation: turn the
# sign of `twist`, and both couplings turn round, as after Eq. 35 by its word. [How to open a
# notebook](../docs/howto/lessons.md).

# %% tags=["chain"]
import sympy as sp

from derive import kinematics as kin
from derive import symbols as s
from derive.audit.printed import notation as n
from derive.flap_lag_springs import STIFFNESS
from derive.pages.display import chain

turn = sp.rot_ccw_axis2(s.structural_pitch)  # about the span, nose up
load = n.M_beta * kin.K_AXIS + n.M_zeta * kin.I_AXIS
flatwise, edgewise = load.dot(turn * kin.K_AXIS), load.dot(turn * kin.I_AXIS)
energy = (flatwise**2 / n.K_beta_B + edgewise**2 / n.K_zeta_B) / 2
K_bb, K_bz, K_zz = (STIFFNESS[pair] for pair in (("flap", "flap", 0), ("flap", "lag", 0), ("lag", "lag", 0)))
bent = {n.M_beta: K_bb * s.coning + K_bz * s.lag, n.M_zeta: K_bz * s.coning + K_zz * s.lag}
twist = energy.diff(s.structural_pitch).subs(bent) / s.control_stiffness
chain(36, {"K_Pβ": -twist.diff(s.coning)})

# %% tags=["chain"]
chain(37, {"K_Pζ": -twist.diff(s.lag)})

# %% [markdown]
# Next: [6 Assembly and errata](6-assembly-and-errata.py)

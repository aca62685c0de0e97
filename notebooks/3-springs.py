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
# # 3 Springs
#
# Eqs. 18–22 and 24–31 of AIAA-2002-1604: flap and lag springs inboard and outboard of the pitch bearing.
#
# The derivation adds two flexibilities, that of the hub, which stays, and that of the blade, which turns with
# the pitch $\vartheta = \Theta + \delta_s$ of its structural axes (`derive/flap_lag_springs.py`). The text of
# the paper at hand has lost subscripts β and ζ in Eqs. 21, 22, 30 and 31; they are restored, and the audit
# says so on each term.

# %%
from derive.pages import figures
from derive.pages.display import Picture, equation

# %% [markdown]
# ## Two springs in series
#
# ### Eq. 18

# %%
equation(18)

# %% [markdown]
# ### Eq. 19

# %%
equation(19)

# %% [markdown]
# ### Eq. 20

# %%
equation(20)

# %% [markdown]
# ## The effective stiffness
#
# ### Eq. 21

# %%
equation(21)

# %% [markdown]
# ### Eq. 22
#
# The derivation has $\Delta$ as the determinant of the summed flexibility times $K_\beta K_\zeta$.

# %%
equation(22)

# %% [markdown]
# What it means for the two rotors of the paper. On the XV-15 all flexibility lies outboard of the bearing, so
# from 0° to 90° flap and lag change places, and $K_{\beta\zeta}$ is largest between. On the model with
# $R_\beta$ and $R_\zeta$ near the hub's side little of it is left.

# %%
Picture(figures.frequencies_against_collective)

# %% [markdown]
# ## Deflections inboard and outboard
#
# ### Eq. 24

# %%
equation(24)

# %% [markdown]
# ### Eq. 25

# %%
equation(25)

# %% [markdown]
# ### Eq. 26

# %%
equation(26)

# %% [markdown]
# ### Eq. 27

# %%
equation(27)

# %% [markdown]
# ### Eq. 28

# %%
equation(28)

# %% [markdown]
# ### Eq. 29

# %%
equation(29)

# %% [markdown]
# ## Shares of the deflection
#
# ### Eq. 30

# %%
equation(30)

# %% [markdown]
# ### Eq. 31
#
# Checked without the derivation as well, with random springs: what is inboard and what is outboard adds up,
# $A + W = D + Z = 1$ and $B + X = C + Y = 0$.

# %%
equation(31)

# %% [markdown]
# ## The chain, for you to change
#
# Eqs. 21 and 22 from the places of four springs: two along the axes of the hub, two along those of a blade that has
# turned by $\vartheta$. A load does work on a spring in proportion to its component along that spring. The second
# derivatives of the energy are the flexibility, and its inverse is the effective stiffness. Change a sign, run the
# cells, and the lines below them list the terms that contradict the derivation. [How to open a
# notebook](../docs/howto/lessons.md).

# %% tags=["chain"]
import sympy as sp

from derive import flap_lag_springs
from derive import kinematics as kin
from derive import symbols as s
from derive.pages.display import chain

K_flap, R_flap = s.flap_stiffness, s.flap_outboard_fraction
K_lag, R_lag = s.lag_stiffness, s.lag_outboard_fraction
turn = sp.rot_ccw_axis2(s.structural_pitch)  # about the span, nose up
moments = sp.symbols("M_flap M_lag")
load = moments[0] * kin.K_AXIS + moments[1] * kin.I_AXIS
hub = (1 - R_flap) / K_flap * load.dot(kin.K_AXIS) ** 2 + (1 - R_lag) / K_lag * load.dot(kin.I_AXIS) ** 2
flatwise, edgewise = load.dot(turn * kin.K_AXIS), load.dot(turn * kin.I_AXIS)
flexibility = sp.hessian((hub + R_flap / K_flap * flatwise**2 + R_lag / K_lag * edgewise**2) / 2, moments)
chain(22, {"Δ": flexibility.det() * K_flap * K_lag})

# %% tags=["chain"]
stiffness = flexibility.adjugate() * K_flap * K_lag / flap_lag_springs.series_determinant
chain(21, {"K_ββ": stiffness[0, 0], "K_ζζ": stiffness[1, 1], "K_βζ": stiffness[0, 1]})

# %% [markdown]
# Next: [4 Airloads](4-airloads.py)

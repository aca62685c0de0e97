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
# # 1 Kinematics
#
# Eqs. 1–11 of AIAA-2002-1604 (E. L. Hathaway and F. Gandhi, *Modeling Refinements in Simple Tiltrotor Aeroelastic
# Stability Analyses*): where a point of the blade is, and how it accelerates.
#
# The derivation starts from one position vector (`derive/kinematics.py`) and nothing else. Each equation
# below stands beside what that vector gives to the paper's own order: first order in the cone
# $\beta_P + \bar\beta_0$, no trim lag. Both columns are in the derivation's symbols, and each adds up to the
# whole equation; a row that the print lacks names the term of `derive/published.py` it belongs to. Every
# verdict is computed when the page is made.

# %%
from derive.pages import figures
from derive.pages.display import Picture, equation, rest_of_rigid_tilt, steady_tilt

# %% [markdown]
# ## The gimbal and the blade's position
#
# ### Eq. 1

# %%
equation(1)

# %% [markdown]
# ### Eq. 2
#
# The paper has one hinge offset $e$; the derivation has $e_\beta$ and $e_\zeta$, as Tables 1 and 2 need. A
# term that agrees once both are the same offset is counted as "after a reading".

# %%
equation(2)

# %% [markdown]
# ## Acceleration relative to the hub
#
# ### Eq. 3

# %%
equation(3)

# %% [markdown]
# **What Eq. 3 leaves out, and why one half of it is worse than none.** Component $i$ has the Coriolis term
# $2\Omega(r-e)(\beta_P+\bar\beta_0)\dot\beta$ of a blade that flaps, and no such term of a gimbal that tilts. But
# a constant-velocity joint tilts the yoke as a rigid body: seen from a blade the tilt is a flap angle
# $\beta_G$, which Eq. 2 has, and a roll $\gamma$ about the blade's own radius, which it has not. The roll
# swings the coned blade in-plane. Both halves together leave the second derivatives of the tilt alone, the
# row "absent from the print" of component $i$: what a held tilt would do there cancels, because seen in the
# tilted yoke nothing moves.
#
# With one half alone a gimbal tilted and held would shake each blade in-plane once per revolution:

# %%
steady_tilt()

# %%
Picture(figures.steady_tilt)

# %% [markdown]
# So the paper, with neither, is nearer to the rigid yoke than it would be with the "missing" Coriolis term
# put in. What either half does to the stability of the XV-15 is in [notebook 6](6-assembly-and-errata.py).
#
# ## The moving hub
#
# ### Eq. 4

# %%
equation(4)

# %% [markdown]
# ### Eq. 5
#
# Angular velocity and acceleration come from the rotation matrix of the hub, differentiated at no rotation.

# %%
equation(5)

# %% [markdown]
# ### Eq. 6

# %%
equation(6)

# %% [markdown]
# ### Eq. 7
#
# Eqs. 7–9 are checked with the very transformation that the sum over the blades uses.

# %%
equation(7)

# %% [markdown]
# ### Eq. 8

# %%
equation(8)

# %% [markdown]
# ### Eq. 9

# %%
equation(9)

# %% [markdown]
# ### Eq. 10
#
# Three axes, any three: the second derivative of hub plus turned vector.

# %%
equation(10)

# %% [markdown]
# ## The acceleration of the blade
#
# ### Eq. 11

# %%
equation(11)

# %% [markdown]
# Two kinds of terms are absent, all of first order in the cone: those of the gimbal in Eq. 3, and the same of
# the hub (`hub_turn_of_raised_blade`), whose tilt moves the raised part of the blade sideways.
#
# **A check without the derivation.** Tilt the hub by $\alpha_x$ and $\alpha_y$, and the gimbal back by as
# much: every mass stays where it was, so every acceleration along the blade's axes has to vanish. Eq. 11 as
# printed passes. With the gimbal's Coriolis term alone it does not:

# %%
rest_of_rigid_tilt()

# %% [markdown]
# ## The chain, for you to change
#
# Eq. 3 in a dozen lines: the position of a point, differentiated twice in axes that turn with $\Omega$. Change a
# sign, run the cell, and the line below it lists the terms that contradict the derivation. With
# `velocity = rate(position) - spin.cross(position)`, for instance, axes turn the wrong way for the first derivative
# and the right way for the second, and nearly every term of $\Omega$ is wrong. Every `+` and `-` of the cell
# changes the verdict; a test tries them all. [How to open a notebook](../docs/howto/lessons.md).

# %% tags=["chain"]
from derive import kinematics as kin
from derive import symbols as s
from derive.pages.chain import first_order, moving, rate
from derive.pages.display import chain

r, e_flap, e_lag = s.radial_station, s.flap_hinge_offset, s.lag_hinge_offset
outward = kin.flapped(s.precone + s.coning + kin.q["flap"])  # along the blade, flapped
swing = kin.lagged(outward, kin.q["lag"]) - outward
blade = e_flap * kin.flapped(s.precone) + (r - e_flap) * outward + (r - e_lag) * swing
position = moving(kin.GIMBAL_TILT * kin.rotation(kin.q["azimuth"] * kin.K_AXIS) * blade)
spin = s.rotor_speed * kin.K_AXIS
velocity = rate(position) + spin.cross(position)
acceleration = rate(velocity) + spin.cross(velocity)
chain(3, dict(zip("ijk", map(first_order, acceleration), strict=True)))

# %% [markdown]
# Next: [2 Inertia](2-inertia.py)

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
# # 2 Inertia
#
# Eqs. 12 and 13 of AIAA-2002-1604, and the rotating frequencies: from acceleration to the flap equation of
# one blade.
#
# The derivation does not integrate Eq. 11. It takes $M$, $C$ and $K$ of a blade from the position vector and
# its derivatives (`derive/inertia.py`), so the two are independent down to the vector itself.

# %%
from derive.pages import figures
from derive.pages.display import Picture, equation

# %% [markdown]
# ## Moments about the flap hinge
#
# ### Eq. 12

# %%
equation(12)

# %% [markdown]
# ## The flap equation
#
# ### Eq. 13

# %%
equation(13)

# %% [markdown]
# **The first erratum.** The sign of $\zeta'$. Coriolis forces do no work, so the flap row's coefficient of
# the lag rate and the lag row's coefficient of the flap rate are equal and opposite. The paper prints the lag
# row's in Eq. 11, along $i$: it is $+2\Omega(\beta_P+\bar\beta_0)(r-e)\dot\beta$. Then the flap row's is
# negative, which Eq. 12 with Eq. 11 along $j$ also gives; Eq. 13 prints a plus.
#
# With the printed sign a rotor in a vacuum, without a damper and on a hub that is held, gains energy from
# nowhere. Its eigenvalues should lie on the imaginary axis at every collective:

# %%
Picture(figures.false_growth)

# %% [markdown]
# In flight the airloads hide it: the boundary of the XV-15 hardly moves ([notebook
# 6](6-assembly-and-errata.py)), so no published result tells which sign it was computed with.
#
# What the print lacks in Eq. 13 are springs that follow the pitch: $K_{\beta\beta}'$ is
# $dK_{\beta\beta}/d\vartheta$, which multiplies the change of pitch by the gimbal ($K_{PG}$), by elastic
# pitch, and by the roll of the yoke.
#
# ## Rotating frequencies
#
# ### Nomenclature ν_β

# %%
equation("ν_β")

# %% [markdown]
# ### Nomenclature ν_ζ

# %%
equation("ν_ζ")

# %% [markdown]
# **The second erratum.** $S_\beta/I_\beta$ is one over a length, so $e/(R-e)$ cannot stand beside it: the
# offset itself can. The paper's own special case settles it.
#
# ### Eq. 23
#
# For a uniform blade of length $R - e$, $S_\beta/I_\beta = \tfrac32/(R-e)$, and Eq. 23 follows from
# $1 + e S_\beta/I_\beta$ with $\bar e = e/(R-e)$.

# %%
equation(23)

# %% [markdown]
# ## The chain, for you to change
#
# Eq. 13 from the position: two derivatives with time give the acceleration, one with the flap angle the direction
# in which the blade may move, and an integral over the mass their work. The springs of [notebook
# 3](3-springs.py) are added. Change a sign, run the cell, and the line below it lists the terms that contradict the
# derivation: try the lag angle, `-kin.q["lag"]`, and then look which terms of Eq. 13 above the change turns round.
# [How to open a notebook](../docs/howto/lessons.md).

# %% tags=["chain"]
from derive import flap_lag_springs
from derive import kinematics as kin
from derive import symbols as s
from derive.inertia import MASS_INTEGRALS, integrate_mass
from derive.pages.chain import by_azimuth, moving, perturbation, rate, times_motion
from derive.pages.display import chain

outward = kin.flapped(s.precone + s.coning + kin.q["flap"])
swing = kin.lagged(outward, kin.q["lag"]) - outward
blade = kin.inboard_arm * kin.flapped(s.precone) + kin.outboard_arm * outward + kin.lag_arm * swing
point = kin.HUB + kin.BLADE_TO_ROTATING * blade
spin = s.rotor_speed * kin.K_AXIS
position = moving(point)
velocity = rate(position) + spin.cross(position)
acceleration = rate(velocity) + spin.cross(velocity)
work = moving(point.diff(kin.q["flap"])).dot(acceleration)
flap_row = integrate_mass(perturbation(work), MASS_INTEGRALS)
flap_row += times_motion(lambda name: flap_lag_springs.stiffness("flap", name))
chain(13, {"inertia and springs": by_azimuth(flap_row) / (s.blade_inertia * s.rotor_speed**2)})

# %% [markdown]
# Next: [3 Springs](3-springs.py)

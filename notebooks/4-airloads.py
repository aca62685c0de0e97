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
# # 4 Airloads
#
# Eqs. 14–16 of AIAA-2002-1604: what each motion does to the air a section sees.
#
# The derivation takes the velocity of the section from the same position vector, along the section's own axes
# (`derive/airloads.py`); the virtual work of lift and drag then needs no equation of its own.

# %%
from derive.pages import figures
from derive.pages.display import Picture, dropped_terms, equation

# %% [markdown]
# ## Perturbation velocities
#
# ### Eq. 14

# %%
equation(14)

# %% [markdown]
# ### Eq. 15

# %%
equation(15)

# %% [markdown]
# ### Eq. 16

# %%
equation(16)

# %% [markdown]
# **The rows of `yoke_roll` are one change of axes.** The derivation's axes of a section roll with the yoke,
# by $\gamma = \beta_{GS}\cos\psi - \beta_{GC}\sin\psi$; the paper's do not. Turned axes take $\Omega r\gamma$
# from $\delta u_P$ (printed, and absent from the derivation), add $V\gamma$ to $\delta u_T$ and take $\gamma$
# from the pitch relative to them. Neither the angle of attack nor the speed of the section changes: at zero
# cone the roll does nothing to the airloads, which is why the paper's equations do without it.

# %% [markdown]
# ## What the print leaves out
#
# With $u_T = \Omega r$ and $u_P = V$ the cone stays out of the airloads. These are the terms of the three
# equations:

# %%
dropped_terms("cone_in_airloads", "yoke_roll")

# %% [markdown]
# Neither shows in the regressive lag mode, which falls with airspeed as in Fig. 14 of the paper. That is the
# work of springs that turn and of airloads that both sets of equations have:

# %%
Picture(figures.lag_frequency)

# %% [markdown]
# The chord mode of the wing notices a little more:

# %%
Picture(figures.published_and_consistent)

# %% [markdown]
# ## The chain, for you to change
#
# Eqs. 14 and 15 from the position: its derivative with time is the velocity of a section through the air, and its
# derivatives with lag and flap are the directions of the chord and of the normal. The integral of the loads that
# follow is not in the paper, so the audit has nothing to compare it with. Change a sign, run the cells, and the
# lines below them list the terms that contradict the derivation. [How to open a notebook](../docs/howto/lessons.md).

# %% tags=["chain"]
from derive import kinematics as kin
from derive import symbols as s
from derive.pages.chain import moving, perturbation, rate
from derive.pages.display import chain

r, e_flap, e_lag = s.radial_station, s.flap_hinge_offset, s.lag_hinge_offset
outward = kin.flapped(s.precone + s.coning + kin.q["flap"])
lagged = kin.lagged(outward, kin.q["lag"])
blade = e_flap * kin.flapped(s.precone) + (r - e_flap) * outward + (r - e_lag) * (lagged - outward)
position = moving(kin.HUB + kin.BLADE_TO_ROTATING * blade)
velocity = rate(position) + s.rotor_speed * kin.K_AXIS.cross(position) + s.airspeed * kin.K_AXIS
chord = moving(kin.BLADE_TO_ROTATING * lagged.diff(kin.q["lag"]))  # towards the trailing edge
chain(14, {"δu_T": perturbation(-chord.dot(velocity))})

# %% tags=["chain"]
normal = moving(kin.BLADE_TO_ROTATING * outward.diff(kin.q["flap"]))
chain(15, {"δu_P": perturbation(normal.dot(velocity))})

# %% [markdown]
# Next: [5 Pitch and couplings](5-pitch-and-couplings.py)

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
# Next: [6 Assembly and errata](6-assembly-and-errata.py)

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
# # 6 Assembly and errata
#
# Eq. 17 and Tables 1 and 2 of AIAA-2002-1604, what contradicts the derivation, and what all of it does to the
# XV-15.

# %%
from derive.audit import consequences
from derive.pages import figures
from derive.pages.display import (
    Picture,
    boundaries,
    dropped_terms,
    equation,
    errata,
    invariants_checked,
    table,
)

# %% [markdown]
# ## Coordinates
#
# ### Eq. 17
#
# The order of rows and columns of every matrix in the fixed frame.

# %%
equation(17)

# %% [markdown]
# ## Tables
#
# The mass integrals of a blade are not free: they belong to one mass distribution, which is nowhere negative.
# A linear programme looks for it, to the last printed digit, over the hinge offsets.
#
# ### Table 1

# %%
table(1)

# %% [markdown]
# **The fourth erratum.** $I_{\beta\alpha}$ of the XV-15 is printed as 105 slug ft², its $I_b$. No blade has
# that, by Cauchy and Schwarz: $I_{\beta\alpha}^2 \le I_b I_\beta$. Each integral is left out in turn; without
# $I_{\beta\alpha}$, and without it alone, the others belong to a blade. In the figure grey is what no mass
# distribution reaches, whatever it is; the lines are the definition $I_\alpha = I + eS$.

# %%
Picture(figures.flap_hub_inertia_of_tables)

# %% [markdown]
# It is no matter of a few per cent. Past the bound the mass matrix has a negative eigenvalue, cyclic flap
# against the gimbal, and with it a mode that diverges at once, at every airspeed. So `proprotor.Rotor` does
# not ask for $I_{\beta\alpha}$ and takes it from the hinge offset.

# %%
Picture(figures.damping_against_flap_hub_inertia)

# %% [markdown]
# ### Table 2

# %%
table(2)

# %% [markdown]
# ## Errata
#
# Everything that contradicts the derivation breaks an invariant that does not know it, and nothing else does.

# %%
errata()

# %%
invariants_checked()

# %% [markdown]
# ## The gimbal question in knots
#
# [Notebook 1](1-kinematics.py) has the kinematics of it: Eq. 3 lacks the gimbal's Coriolis term and the roll
# of the yoke. A boundary is the lowest speed at which any mode loses its damping.

# %%
boundaries(consequences.gimbal_question())

# %% [markdown]
# The chord mode of the wing hardly notices. What does is regressive flap against the gimbal, damped by a few
# tenths of a per cent of critical: the roll without the Coriolis term makes it unstable, in either set of
# equations.

# %%
Picture(figures.gimbal_question)

# %% [markdown]
# ## What the print leaves out
#
# Thirteen named terms are all the difference between the consistent and the published equations; both come from
# the same derivation. The last one, the damping of turning sections, is dropped by the option `section_damping`:
# the boundaries on these pages are without it.

# %%
dropped_terms()

# %% [markdown]
# Those that show in a numbered equation, each alone, by the boundary of the chord mode:

# %%
Picture(figures.boundaries_without_terms)

# %% [markdown]
# ## The chain, for you to change
#
# From one blade to the rotor, for an angle in three multiblade coordinates: its place at azimuth $\psi$, two
# derivatives with time while $\psi$ advances with $\Omega$, and the mean of each row over the azimuth. The rows of
# $\beta_{1C}$ and $\beta_{1S}$ get the coupling $\pm 2\Omega$ and the stiffness $-\Omega^2$ by which a rotor differs
# from its blades. Change a sign, run the cell, and the line below it lists the terms that contradict the
# derivation. [How to open a notebook](../docs/howto/lessons.md).

# %% tags=["chain"]
import sympy as sp

from derive import symbols as s
from derive.audit.counterparts import time_derivative
from derive.multiblade import psi
from derive.pages.chain import MULTIBLADE_ANGLE, rotor_rows
from derive.pages.display import chain

mass, damping, stiffness = sp.symbols("m c k")  # of one blade
waves = {"flap_0": sp.Integer(1), "flap_1c": sp.cos(psi), "flap_1s": sp.sin(psi)}
angle = sum(MULTIBLADE_ANGLE[name] * wave for name, wave in waves.items())
rate = time_derivative(angle)
moment = mass * time_derivative(rate) + damping * rate + stiffness * angle
means = {name: sp.integrate(sp.expand(wave * moment), (psi, 0, 2 * sp.pi)) for name, wave in waves.items()}
rows = {name: s.n_blades * mean / (2 * sp.pi) for name, mean in means.items()}
chain("Flap of the rotor", rows, rotor_rows(waves, mass, damping, stiffness))

# %% [markdown]
# Several inputs of the XV-15 deck are assumed or recalled: differences between boundaries mean something
# here, the boundary itself is another matter ([the XV-15](../docs/xv15.md)). All verdicts in one table: [the
# audit](../docs/audit.md).

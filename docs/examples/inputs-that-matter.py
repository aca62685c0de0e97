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
# # Which inputs move the flutter speed
#
# The exact slope of the flutter speed by each input of the deck, as the change for one percent.

# %%
import proprotor as pp
from proprotor import plots

case = pp.load_case("xv15")
slopes = case.sensitivity(airspeed="200:440:20kt")
ax = plots.plot_sensitivity(slopes)
plots.rests_on(ax, case).figure.savefig("inputs-that-matter.png")

# %% [markdown]
# One of the slopes against two whole searches, with one percent less and one percent more of the stiffness:

# %%
name = "rotor.control_stiffness"
value = case.rotor.control_stiffness
found = case.boundary_against({name: [0.99 * value, 1.01 * value]}, "200:440:20kt")
low, high = found["first"].values / 0.514444
print(f"slope {float(slopes.relative.sel(input=name)) / 100 / 0.514444:.3f} KTAS for 1 %")
print(f"two searches {(high - low) / 2:.3f} KTAS for 1 %")

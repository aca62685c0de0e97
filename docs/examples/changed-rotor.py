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
# # The flutter speed of a changed rotor
#
# A deck of a few lines changes the XV-15, `softer-flapping.toml`. Its modes over airspeed, and the airspeed at
# which the first of them loses its damping, exact to rounding.

# %%
import proprotor as pp
from proprotor import plots

case = pp.load_case("softer-flapping.toml")
modes = case.sweep("100:440:10kt")
figure = plots.plot_sweep(modes, rotor_speed=case.operation.rotor_speed, title=case.title)
figure.savefig("changed-rotor.png")

# %%
found = case.flutter_point("200:440:20kt")
print(f"flutter at {found.speed / 0.514444:.1f} KTAS")

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
# # A whole aircraft
#
# The XV-15 that flies free with two rotors: symmetric and antisymmetric modes, and the least damping among each at some
# airspeeds.

# %%
import proprotor as pp
from proprotor import plots

case = pp.load_case("xv15-aircraft")
modes = case.sweep("200:400:20kt")
wing = [str(name) for name in modes.mode.values if str(name).endswith(("beam", "chord", "torsion"))]
damping = 100 * modes.damping_ratio.sel(mode=wing)
for name in wing:
    least = damping.sel(mode=name)
    speed = float(least.airspeed[int(least.argmin("airspeed"))]) / 0.514444
    print(f"{name:24} {float(least.min()):6.2f} % at {speed:.0f} KTAS")

# %%
figure = plots.plot_sweep(modes.sel(mode=wing), rotor_speed=case.operation.rotor_speed, title=case.title)
figure.savefig("whole-aircraft.png")

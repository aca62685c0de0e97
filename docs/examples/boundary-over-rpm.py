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
# # Boundaries over rotor speed
#
# Every boundary of the XV-15 with uncoupled wing modes, from 400 to 520 rpm; the lowest first.

# %%
import proprotor as pp
from proprotor import plots

case = pp.load_case("xv15-uncoupled")
found = case.boundary_against({"operation.rotor_speed": "400:520:30 rpm"}, "280:440:20ktas")
for speed, branch in zip(found["first"].values / 0.514444, found.first_branch.values, strict=True):
    print(f"{speed:6.1f} KTAS  {branch}")

# %%
ax = plots.plot_boundary_against(found, unit="rpm")
plots.rests_on(ax, case).figure.savefig("boundary-over-rpm.png")

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
# # How sure is the flutter speed
#
# Three inputs are uncertain. Forty designs drawn from their ranges give a distribution of the flutter speed; use
# hundreds for a result that you need.

# %%
import proprotor as pp
from proprotor import plots

case = pp.load_case("xv15")
inputs = {
    "rotor.control_stiffness": pp.sampling.Relative(0.9, 1.1),
    "rotor.precone": pp.sampling.Normal(0.0436, 0.002),  # rad
    "support.chord_frequency": ("5 Hz", "5.6 Hz"),
}
plan = pp.sampling.latin_hypercube(inputs, 40, seed=1)
found = pp.study(case, plan, "260:460:40kt", "flutter", workers=1)
print(f"below 330 kt: {float(pp.share_below(found, 330 * 0.514444)):.2f} of the designs")

# %%
ax = plots.plot_distribution(found)
plots.rests_on(ax, case).figure.savefig("uncertain-inputs.png")

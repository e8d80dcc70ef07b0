# %% [markdown]
# # Monte Carlo
# Young's modulus of the boom and the rate of the spin-up scatter: a campaign of a Latin hypercube, its table, and two
# checks against closed forms.

# %%
import os

import matplotlib.pyplot as plt
import numpy as np

import bough

CASES = int(os.environ.get("CASES", "60"))
bough.call("init", "spinup", "--force")
with open("spinup/scatter.toml", "w") as f:
    f.write(f"""
[campaign]
method = "latin-hypercube"
samples = {CASES}
seed = 1
steps = ["reduce boom.toml", "run spinup.toml -o spinup.h5"]

[[parameter]]
name = "E"
file = "boom.bdf"
card = "MAT1"
id = 1
field = "E"
range = [6.2e10, 7.6e10]

[[parameter]]
name = "rate"
file = "spinup.toml"
key = "function.angle.rate"
range = [3.0, 4.0]

[[collect]]
name = "hz"
file = "boom.h5"
dataset = "/modes/frequency_hz"

[[collect]]
name = "tip"
file = "spinup.h5"
dataset = "/sensors/tip_deflection"
column = 2
take = "min"
""")
assert bough.call("batch", "spinup/scatter.toml", "-o", "scatter") == 0

# %%
table = np.genfromtxt("scatter/outcomes.csv", delimiter=",", names=True, deletechars="", dtype=float)
modulus, rate, tip = table["E"], table["rate"], table["tip"]
first = 2 * np.pi * table["hz.1"]
print(f"{len(table)} cases; tip {tip.mean():.4f} m, deviation {tip.std(ddof=1):.4f}, from {tip.min():.4f} to {tip.max():.4f}")
plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=["#0072B2", "#D55E00"]), "axes.grid": True, "grid.alpha": 0.4,
                     "axes.titlelocation": "left", "axes.titleweight": "bold"})
figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="tight")
axes[0].hist(tip, bins=15, edgecolor="white")
axes[0].set(xlabel="least deflection of the tip [m]", ylabel="cases", title=f"Tip in {CASES} spin-ups")
points = axes[1].scatter(rate, tip, c=modulus / 1e9)
axes[1].set(xlabel="rate [rad/s]", ylabel="least deflection of the tip [m]", title="Faster and softer bends further")
figure.colorbar(points, label="Young's modulus [GPa]")
figure.savefig("scatter.png")

# %% [markdown]
# The frequency is 3.51602 / L^2 sqrt(E I / rho A) in every case. A Latin hypercube has one sample in each n-th of the
# range. A faster spin-up, and a softer boom, bend the tip further.

# %%
assert len(table) == CASES
assert np.allclose(first, 3.51602 / 64 * np.sqrt(modulus * 8.2181e-9 / (2766.67 * 7.2986e-5)), rtol=2e-5)
strata = np.sort(np.floor((rate - 3.0) / 1.0 * CASES))
assert np.array_equal(strata, np.arange(CASES))
slopes = np.linalg.lstsq(np.column_stack([np.ones(CASES), rate - rate.mean(), modulus / 1e10 - 6.9]), tip, rcond=None)[0]
print(f"slopes: {slopes[1]:.3f} m per rad/s, {slopes[2]:.3f} m per 10 GPa")
assert slopes[1] < 0 < slopes[2]

# %% [markdown]
# # A boom spins up
# From the deck to the deflection of the tip, with and without geometric stiffness, next to linear theory
# (NASA-CR-202063, 4.1.4.1).

# %%
import matplotlib.pyplot as plt
import numpy as np

import bough

bough.call("init", "spinup", "--force")
body = bough.reduce("spinup/boom.toml")
print("frequencies [rad/s]:", np.sqrt(np.diag(body.modal_stiffness) / np.diag(body.modal_mass)))

# %%
results = {}
for name in ("spinup", "spinup-no-kg"):
    results[name] = bough.System(f"spinup/{name}.toml", bodies={"boom.h5": body}).run()

plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=["#0072B2", "#D55E00"]), "axes.grid": True, "grid.alpha": 0.4})
figure, axes = plt.subplots(layout="tight")
for name, run in results.items():
    axes.plot(run.time, run["tip_deflection"][:, 1], label={"spinup": "with K_G", "spinup-no-kg": "without K_G"}[name])
axes.set(xlabel="time [s]", ylabel="deflection of the tip [m]", xlim=(0, 20), ylim=(-1.2, 0.2),
         title="Spin-up of a boom to 4 rad/s")
axes.legend()
figure.savefig("spinup.png")

# %% [markdown]
# Three modes come within 0.3 % of theory's -0.5346 m at 6.77 s. Without K_G the boom diverges: 4 rad/s is above its
# first frequency.

# %%
tip = results["spinup"]["tip_deflection"][:, 1]
time = results["spinup"].time
print(f"minimum {tip.min():.4f} m at {time[tip.argmin()]:.2f} s")
assert abs(tip.min() + 0.5346) < 0.005 * 0.5346
assert abs(time[tip.argmin()] - 6.77) < 0.05
assert np.abs(results["spinup-no-kg"]["tip_deflection"][:, 1]).max() > 6

# %% [markdown]
# # The attitude loop of a satellite
# A hub with two flexible wings and three laws: poles of the closed loop and the history.

# %%
import matplotlib.pyplot as plt
import numpy as np

import bough

bough.call("init", "satellite", "--force")
wing = bough.reduce("satellite/wing.toml")
system = bough.System("satellite/pointing.toml", bodies={"wing.h5": wing})
poles = system.linearize().poles
print(poles[(np.abs(poles) > 1e-6) & (poles.imag > 0)])

# %% [markdown]
# The rigid pair about z and the wings against each other's sense, as `bough linearize` has them: none is unstable.

# %%
for near in (-0.1738 + 0.2107j, -0.5101 + 10.1407j):
    assert np.abs(poles - near).min() < 5e-4 * abs(near), near
assert poles.real.max() < 1e-9

# %%
results = system.run()
angle = results["tracker"][:, 0]
plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=["#0072B2", "#D55E00"]), "axes.grid": True, "grid.alpha": 0.4})
figure, axes = plt.subplots(2, layout="tight")
axes[0].plot(results.time, angle)
axes[0].set(xlabel="time [s]", ylabel="tracker [rad]", title="Attitude about z")
axes[1].plot(poles.real, poles.imag, "x")
axes[1].set(xlabel="real [1/s]", ylabel="imaginary [rad/s]", ylim=(-30, 30), title="Poles")
figure.savefig("satellite.png")

# %% [markdown]
# The slow pair decays by its real part: from the envelope of the history to within what its ripple allows.

# %%
late = np.abs(angle[results.time > 0.8 * results.time[-1]]).max()
print(f"largest {np.abs(angle).max():.3e}, at the end {late:.3e}")
assert late < 1e-2 * np.abs(angle).max()

# %% [markdown]
# # K_G by hand
# The geometric stiffness of the boom for a steady spin about z, assembled here from its modes and the string stiffness
# of its bars, next to what stands in the file as the ninth of the twelve (NASA-CR-202063, eqs. 13-15).

# %%
import h5py
import matplotlib.pyplot as plt
import numpy as np

import bough

bough.call("init", "spinup", "--force")
bough.call("reduce", "spinup/boom.toml", "-o", "boom.h5")
with h5py.File("boom.h5") as f:
    in_file = f["/stiffening/kg_inertial"][8]
body = bough.read_flex_body("boom.h5")
x = np.array(body.node_xyz)[:, 0]
phi = np.array(body.phi)                  # node, direction, mode

# %% [markdown]
# At 1 rad/s a section is pulled by the mass further out: N(x) = m/2 (L^2 - x^2), m the mass per length. Within a bar
# the slope v' follows from the displacement and the turn of its ends (cubic); K_G is the integral of N v'_j v'_l, taken
# by four Gauss points, which are exact for it.

# %%
line_mass, length = body.mass / x[-1], x[-1]
by_hand = np.zeros_like(in_file)
points, weights = np.polynomial.legendre.leggauss(4)
for a in range(len(x) - 1):
    b, h = a + 1, x[a + 1] - x[a]
    ends = np.array([phi[a, 1], phi[a, 5], phi[b, 1], phi[b, 5]])
    for s, weight in zip((points + 1) / 2, weights * h / 2):
        slope = np.array([(6 * s**2 - 6 * s) / h, 1 - 4 * s + 3 * s**2, (6 * s - 6 * s**2) / h, 3 * s**2 - 2 * s]) @ ends
        by_hand += weight * line_mass / 2 * (length**2 - (x[a] + s * h)**2) * np.outer(slope, slope)
print("by hand\n", by_hand, "\nfile\n", in_file)
assert np.allclose(by_hand, in_file, rtol=0, atol=1e-6 * np.abs(in_file).max())

# %% [markdown]
# The first entry is Southwell's coefficient of a clamped beam: omega^2 = omega_0^2 + 1.193 Omega^2 out of the plane of
# rotation.

# %%
closed_form = 1.1933
assert abs(in_file[0, 0] - closed_form) < 1e-3
plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=["#0072B2", "#D55E00"]), "axes.grid": True, "grid.alpha": 0.4,
                     "axes.titlelocation": "left", "axes.titleweight": "bold"})
figure, axes = plt.subplots(layout="tight")
rates = np.linspace(0, 6, 61)
flap = [np.sqrt(np.linalg.eigvalsh(body.modal_stiffness + r**2 * in_file)) for r in rates]
axes.plot(rates, np.array(flap)[:, :2], label=["flap 1", "flap 2"])
axes.plot(rates, rates, "k:", label="1 per revolution")
axes.set(xlabel="spin [rad/s]", ylabel="frequency [rad/s]",
         title="Flap of the boom over its spin", xlim=(0, 6), ylim=(0, None))
axes.legend()
figure.savefig("southwell.png")

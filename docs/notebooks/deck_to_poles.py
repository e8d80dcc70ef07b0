# %% [markdown]
# # A deck of one's own, to poles
# A cantilever of 2 m is written as a deck, becomes a flexible body, hangs on a hinge with a spring, and is linearized:
# the poles next to the closed form.

# %%
import matplotlib.pyplot as plt
import numpy as np

import bough

N, LENGTH, E, I, A, RHO = 20, 2.0, 7e10, 1e-8, 1e-4, 2700.0
lines = ["SOL 103", "CEND", "SPC = 1", "METHOD = 1", "BEGIN BULK", "EIGRL,1,,,4", "SPC1,1,123456,1",
         f"PBAR,1,1,{A:.1E},{I:.1E},{I:.1E},{I:.1E}", f"MAT1,1,{E:.1E},,.3,{RHO:.1f}"]
lines += [f"GRID,{k + 1},,{LENGTH * k / N:.3f},0.,0." for k in range(N + 1)]
lines += [f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,1.,0." for k in range(N)]
with open("own.bdf", "w") as f:
    f.write("\n".join([*lines, "ENDDATA", ""]))
body = bough.reduce("own.bdf", modes=4, interface=[1, N + 1], name="own")

# %% [markdown]
# Clamped, the first frequency is 3.51602 sqrt(EI / rho A L^4), in two planes.

# %%
found = np.sqrt(np.diag(body.modal_stiffness) / np.diag(body.modal_mass))
closed = np.array([3.51602, 22.0345]) * np.sqrt(E * I / (RHO * A * LENGTH**4))
print("found ", found)
print("closed", closed)
assert np.allclose(found[:2], closed[0], rtol=2e-3) and np.allclose(found[2:], closed[1], rtol=5e-3)

# %% [markdown]
# On a revolute hinge with a spring k: the roots of the frequency equation of a beam with a rotational spring at its
# root and a free tip, k L / EI (1 + c ch) = z (s ch - c sh) with z = beta L.

# %%
SPRING = 200.0
system = bough.System.from_text(f"""
[[body]]
name = "beam"
file = "own.h5"
[[hinge]]
name = "root"
type = "revolute"
child = "beam"
axis = [0.0, 0.0, 1.0]
stiffness = {SPRING}
[simulation]
duration = 1.0
""", ".", bodies={"own.h5": body})
poles = system.linearize().poles
rates = np.sort(poles.imag[poles.imag > 1e-6])

z = np.linspace(0.1, 6.0, 200001)
value = SPRING * LENGTH / (E * I) * (1 + np.cos(z) * np.cosh(z)) - z * (np.sin(z) * np.cosh(z) - np.cos(z) * np.sinh(z))
roots = z[:-1][value[:-1] * value[1:] < 0]
hinged = roots**2 * np.sqrt(E * I / (RHO * A * LENGTH**4))
print("poles on the spring [rad/s]", rates, "closed form", hinged)

plt.rcParams.update({"axes.prop_cycle": plt.cycler(color=["#0072B2", "#D55E00"]), "axes.grid": True, "grid.alpha": 0.4})
figure, axes = plt.subplots(layout="tight")
axes.plot(poles.real, poles.imag, "x")
axes.set(xlabel="real [1/s]", ylabel="imaginary [rad/s]", xlim=(-1, 1),    # undamped
         title="Poles of the beam on its spring")
figure.savefig("poles.png")
assert np.abs(rates / hinged[0] - 1).min() < 2e-3

"""Motion of points x(η), polynomials of the amplitudes, with masses: a sum of squares. Prescribed spin about z."""
import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from structure import Polynomial, Table


class Points:
    """x = x0 + tables(η) of points (m, 3), masses (m), V: tables of energy."""

    def __init__(self, x0, tables, mass, V):
        self.n = tables[0].e.shape[1]
        self.shape = x0.shape
        self.root = np.sqrt(mass)[:, None]
        scaled = [Table(self.n, t.degree, coefficients=t.c.reshape((len(t.e),) + x0.shape) * self.root) for t in tables]
        self.x0, self.x, self.V = x0 * self.root, Polynomial(scaled), Polynomial(V)

    def accelerate(self, eta, rate, spin=0., spin_rate=0.):
        x, J, H = self.x.all(eta)
        x = x.reshape(self.shape) + self.x0
        J, H = J.reshape((self.n,) + self.shape), H.reshape((self.n, self.n) + self.shape)
        v = np.tensordot(rate, J, 1)
        a = np.tensordot(rate, np.tensordot(rate, H, 1), 1)
        if spin or spin_rate:
            turn = lambda y: np.stack([-y[:, 1], y[:, 0], 0 * y[:, 0]], 1)      # noqa: E731
            a = a + 2 * spin * turn(v) + spin_rate * turn(x) - spin**2 * x * (1, 1, 0)
        Jm = J.reshape(self.n, -1)
        force = -Jm @ a.ravel() - self.V.all(eta)[1][:, 0]
        return np.linalg.solve(Jm @ Jm.T, force)

    def integrate(self, t, spin=None, start=None, rtol=1e-8):
        """spin(t) -> rate and its derivative. start: [η, rates]."""
        def f(t, y):
            return np.r_[y[self.n:], self.accelerate(y[:self.n], y[self.n:], *(spin(t) if spin else ()))]
        start = np.zeros(2 * self.n) if start is None else start
        return solve_ivp(f, (0, t), start, method="DOP853", rtol=rtol, atol=rtol * 1e-3, dense_output=True)

    def find_backbone(self, tip, amplitudes, omega):
        """Frequencies of symmetric free motions with tip(η) at rest = amplitude; Φ symmetric about η = 0."""
        guess = np.zeros(self.n)
        guess[0] = np.pi / 2 / omega
        out = []
        for a in amplitudes:
            def close(z):
                eta = np.r_[0, z[1:] * a]
                for _ in range(20):                         # η_1 by the tip
                    eta[0] -= (tip.value(eta)[0] - a) / tip.all(eta)[1][0, 0]
                s = self.integrate(z[0], start=np.r_[eta, np.zeros(self.n)], rtol=1e-7)
                return s.y[:self.n, -1] / a
            guess = fsolve(close, guess, xtol=1e-7)
            out.append(np.pi / 2 / guess[0])
        return np.array(out)

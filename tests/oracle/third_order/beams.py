"""Straight beams without shear flexibility: K, forces and geometric stiffness of a unit of each, in basic axes."""
import numpy as np

FORCES = 8        # N Vy Vz T My(A) Mz(A) My(B) Mz(B)


def hermite(t, length):
    """Values of v for (v_A, θ_A, v_B, θ_B) and derivatives, at t = x/L."""
    H = np.array([1 - 3 * t**2 + 2 * t**3, length * (t - 2 * t**2 + t**3), 3 * t**2 - 2 * t**3, length * (t**3 - t**2)])
    D = np.array([-6 * t + 6 * t**2, length * (1 - 4 * t + 3 * t**2), 6 * t - 6 * t**2, length * (3 * t**2 - 2 * t)])
    S = np.array([-6 + 12 * t, length * (-4 + 6 * t), 6 - 12 * t, length * (6 * t - 2)])
    return H, D / length, S / length**2


def calc_motion(t, length):
    """Rows u' v' w' θx θy θz θx' θy' θz' per end displacements (12) in element axes."""
    _, D, S = hermite(t, length)
    q = np.zeros((9, 12))
    q[0, [0, 6]] = -1 / length, 1 / length
    q[1, [1, 5, 7, 11]] = D
    q[2, [2, 4, 8, 10]] = D * (1, -1, 1, -1)
    q[3, [3, 9]] = 1 - t, t
    q[4], q[5] = -q[2], q[1]
    q[6, [3, 9]] = -1 / length, 1 / length
    q[7, [2, 4, 8, 10]] = -S * (1, -1, 1, -1)
    q[8, [1, 5, 7, 11]] = S
    return q


def calc_beam(length, EA, GJ, EIy, EIz, r2):
    """K (12, 12), F (8, 12), P (8, 12, 12) in element axes. EIy bends about y. r2: polar radius² of the section."""
    K, F = np.zeros((12, 12)), np.zeros((FORCES, 12))
    P = np.zeros((FORCES, 12, 12))
    for x, weight in zip(*np.polynomial.legendre.leggauss(4)):
        t, w = (1 + x) / 2, weight * length / 2
        q = calc_motion(t, length)
        D = np.diag([EA, 0, 0, 0, 0, 0, GJ, EIy, EIz])
        K += w * q.T @ D @ q

        def add(force, share, *terms):
            for i, j, factor in terms:
                P[force] += w * share * factor * (np.outer(q[i], q[j]) + np.outer(q[j], q[i])) * (0.5 if i == j else 1)
        u, v, ww, rx, ry, rz, drx, dry, drz = range(9)
        add(0, 1, (v, v, 1), (ww, ww, 1), (drx, drx, r2))
        add(1, 1, (rx, ww, 1), (rx, ry, 0.5), (rz, u, -1))
        add(2, 1, (rx, v, -1), (rx, rz, 0.5), (ry, u, 1))
        add(3, 1, (rz, dry, 0.5), (ry, drz, -0.5))
        for end, share in ((0, 1 - t), (2, t)):
            add(4 + end, share, (v, drx, -1), (rx, drz, 0.5), (rz, drx, 0.5))
            add(5 + end, share, (ww, drx, -1), (rx, dry, -0.5), (ry, drx, -0.5))
    end = K[6:]
    F[:4] = end[:4]
    F[4] = end[4] - length * end[2]
    F[5] = end[5] + length * end[1]
    F[6], F[7] = end[4], end[5]
    return K, F, P


def make_beams(X, nodes, axes, EA, GJ, EIy, EIz, r2):
    """X (nodes, 3), nodes (e, 2), axes (e, 3, 3): columns x y z of each element in basic. Keywords of Elements."""
    K, F, P = [], [], []
    for (a, b), R in zip(nodes, axes):
        length = np.linalg.norm(X[b] - X[a])
        k, f, p = calc_beam(length, EA, GJ, EIy, EIz, r2)
        T = np.kron(np.eye(4), R.T)
        K.append(T.T @ k @ T)
        F.append(f @ T)
        P.append(T.T @ p @ T)
    return dict(nodes=nodes, X=X[np.asarray(nodes)], K=np.array(K), F=np.array(F), P=np.array(P))


def axes_along(X, nodes, y):
    """Element axes with y in the plane of x and the given vector."""
    out = []
    for a, b in nodes:
        x = (X[b] - X[a]) / np.linalg.norm(X[b] - X[a])
        z = np.cross(x, y)
        z /= np.linalg.norm(z)
        out.append(np.stack([x, np.cross(z, x), z], 1))
    return np.array(out)

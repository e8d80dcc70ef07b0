"""From the exported g-set matrices to the free dofs: T of the generator's own constraint equations, and AUTOSPC."""
import numpy as np


class Unclear(Exception):
    """The rules leave more than one answer (a tie within round-off): nothing to compare with."""


def index_dofs(dof_map):
    """(id, component) -> row, and the scalar points."""
    index = {(int(g), int(c)): row for row, (g, c) in enumerate(dof_map)}
    return index


def displacement_axes(model, index):
    """R: basic from displacement components, square on the g-set."""
    R = np.eye(len(index))
    for g, grid in model.grids.items():
        at, axes = index[g, 1], grid.axes()
        R[at:at + 3, at:at + 3] = R[at + 3:at + 6, at + 3:at + 6] = axes
    return R


def eliminate(model, index, held):
    """C with u = C u_free in displacement components, and the free dofs: G_m u_m + G_n u_n = 0, u_held = 0."""
    n = len(index)
    dependent = sorted(index[d] for d in model.dependent)
    others = sorted(set(range(n)) - set(dependent))
    C = np.zeros((n, n))
    C[others, others] = 1
    if dependent:
        G = np.zeros((len(model.rows), n))
        for k, row in enumerate(model.rows):
            for dof, value in row.items():
                G[k, index[dof]] += value
        C[np.ix_(dependent, others)] = -np.linalg.solve(G[:, dependent], G[:, others])
        # what is left of a cancellation
        C[np.abs(C) < 1e-13 * max(1, np.abs(C).max())] = 0
    free = [d for d in others if d not in held]
    return C[:, free], free


def find_autospc(K, free, index, model, epsilon=1e-8):
    """The dofs that Nastran's grid-point test holds: per grid and triple the direction whose stiffness is below
    epsilon of the triple's largest."""
    names = {row: dof for dof, row in index.items()}
    blocks = {}
    for k, row in enumerate(free):
        g, c = names[row]
        blocks.setdefault((g, 0 if c < 4 else 1), []).append(k)
    largest = np.abs(np.diag(K)).max() if len(K) else 0
    by_kind = [max([K[k, k] for (g, kind), ks in blocks.items() if kind == which for k in ks] + [0])
               for which in (0, 1)]
    size = 2 * model.length
    held = []
    for (g, kind), ks in blocks.items():
        block = 0.5 * (K[np.ix_(ks, ks)] + K[np.ix_(ks, ks)].T)
        # round-off of stiffness on arms
        near = max([K[k, k] for k in blocks.get((g, 0), [])] + [0])
        noise = 1e-14 * (by_kind[0] if kind == 0 else max(by_kind[1], near * size ** 2, 1e-2 * largest * size ** 2))
        scale = block.diagonal().max()
        if scale == 0:
            held += ks
            continue
        if scale < 1e3 * noise:
            raise Unclear(f"grid {g}: stiffness {scale:.1e} near round-off {noise:.1e}")
        ks = list(ks)
        while ks:
            values, vectors = np.linalg.eigh(block)
            ratios = values / scale
            spread = 0.01 * noise / scale
            if np.any((np.abs(ratios) + spread > 0.3 * epsilon) & (np.abs(ratios) - spread < 3 * epsilon)):
                raise Unclear(f"grid {g}: stiffness ratio {ratios.min():.1e}")
            low = int((ratios < epsilon).sum())
            if low == 0:
                break
            zero = [i for i in range(len(ks)) if np.abs(block[i]).max() < 1e-12 * scale]
            if zero:
                chosen = zero[0]
            elif low > 1:
                raise Unclear(f"grid {g}: a plane without stiffness across the axes")
            else:
                share = np.abs(vectors[:, 0])
                order = np.argsort(share)
                if len(ks) > 1 and share[order[-1]] - share[order[-2]] < 1e-4:
                    raise Unclear(f"grid {g}: a tie of two components")
                chosen = int(order[-1])
            held.append(ks.pop(chosen))
            block = np.delete(np.delete(block, chosen, 0), chosen, 1)
    return held


class Truth:
    """Dense K, M and T of the free dofs."""

    def __init__(self, model, K, M, dof_map):
        self.index = index_dofs(dof_map)
        expected = {(g, c) for g in model.grids for c in range(1, 7)} | {(s, 0) for s in model.points}
        if set(self.index) != expected:
            raise AssertionError(f"dofs of the export and of the deck differ: {sorted(set(self.index) ^ expected)[:5]}")
        self.R = displacement_axes(model, self.index)
        held = {self.index[d] for d in model.fixed}
        self.T_all = self.R @ eliminate(model, self.index, set())[0]
        C, free = eliminate(model, self.index, held)
        T = self.R @ C
        if model.params.get("AUTOSPC") != "NO":
            self.autospc = find_autospc(T.T @ K @ T, free, self.index, model)
            T = np.delete(T, self.autospc, axis=1)
            held |= {free[k] for k in self.autospc}
            free = [row for k, row in enumerate(free) if k not in set(self.autospc)]
        self.T, self.free, self.K_g, self.M_g, self.held_rows = T, free, K, M, held
        self.K, self.M = T.T @ K @ T, T.T @ M @ T
        # what round-off of the terms can leave in each entry
        size = np.abs(T)
        self.K_size, self.M_size = size.T @ np.abs(K) @ size, size.T @ np.abs(M) @ size

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


class Wrong(Exception):
    """AUTOSPC constrains a DOF with stiffness, or does not constrain one without."""


def accept_autospc(K, K_size, free, index, reported, epsilon=1e-8):
    """The positions in `free` of the dofs that the program says AUTOSPC holds, once its choice is proved: of each triple
    what is left has stiffness, as much as the triple has directions with it, and no direction less than it must.
    Directions near epsilon or near round-off may be held or not."""
    names = {row: dof for dof, row in index.items()}
    place = {names[row]: k for k, row in enumerate(free)}
    strangers = sorted(set(reported) - set(place))
    if strangers:
        raise Wrong(f"AUTOSPC holds {strangers[:5]}, which are not free")
    held, triples = {place[d] for d in reported}, {}
    for k, row in enumerate(free):
        g, c = names[row]
        triples.setdefault((g, 0 if c < 4 else 1), []).append(k)
    for (g, kind), ks in triples.items():
        block = 0.5 * (K[np.ix_(ks, ks)] + K[np.ix_(ks, ks)].T)
        size, scale = K_size.diagonal()[ks].max(), block.diagonal().max()
        out = [k in held for k in ks]
        who = f"grid {g}: of {[names[free[k]][1] for k in ks]} AUTOSPC holds {[names[free[k]][1] for k in ks if k in held]}"
        if scale <= 1e-15 * size:
            if not all(out):
                raise Wrong(f"{who}, but its stiffness {scale:.1e} is round-off of {size:.1e}")
            continue
        if scale < 1e-12 * size and all(out):
            continue
        ratios = np.linalg.eigvalsh(block) / scale
        doubt = 1e-13 * size / scale
        num_stiff = int((ratios > 3 * epsilon + doubt).sum())
        num_soft = int((ratios < 0.3 * epsilon - doubt).sum())
        left = [i for i, is_out in enumerate(out) if not is_out]
        if len(left) < num_stiff:
            raise Wrong(f"{who}, but {num_stiff} directions have stiffness: ratios {ratios}")
        if len(ks) - len(left) < num_soft:
            raise Wrong(f"{who}, but {num_soft} directions have none: ratios {ratios}")
        if left and len(left) == num_stiff:
            lowest = np.linalg.eigvalsh(block[np.ix_(left, left)])[0] / scale
            if lowest < 0.1 * ratios[len(ks) - num_stiff]:
                raise Wrong(f"{who}: what is left has {lowest:.1e}, its directions {ratios}")
    return sorted(held)


def follow_directions(K, T, free, index, reported, epsilon=1e-8):
    """T with the columns of the held dofs in those that they follow, once it is proved that what a grid loses so has no
    stiffness: the directions orthogonal to what is left of the triple."""
    place = {dof: k for k, dof in enumerate({row: dof for dof, row in index.items()}[row] for row in free)}
    triples = {}
    for g, c, follows in reported:
        if follows:
            triples.setdefault((g, c > 3), []).append((c, dict(follows)))
    T = T.copy()
    for (g, is_rotation), held in triples.items():
        ks = [place[g, c] for c in (range(4, 7) if is_rotation else range(1, 4)) if (g, c) in place]
        lost = np.zeros((len(ks), len(held)))
        for j, (c, follows) in enumerate(held):
            lost[ks.index(place[g, c]), j] = 1
            for other, factor in follows.items():
                lost[ks.index(place[g, other]), j] = -factor
                T[:, place[g, other]] += factor * T[:, place[g, c]]
        lost /= np.linalg.norm(lost, axis=0)
        block = K[np.ix_(ks, ks)]
        if np.abs(block @ lost).max() > 3 * epsilon * block.diagonal().max():
            raise Wrong(f"grid {g}: the direction that AUTOSPC holds has stiffness: {block @ lost}")
    return T


class Truth:
    """Dense K, M and T of the free dofs; `reported`: what the program says AUTOSPC holds, to prove and take over."""

    def __init__(self, model, K, M, dof_map, reported=None):
        self.index = index_dofs(dof_map)
        expected = {(g, c) for g in model.grids for c in range(1, 7)} | {(s, 0) for s in model.points}
        if set(self.index) != expected:
            raise AssertionError(f"dofs of the export and of the deck differ: {sorted(set(self.index) ^ expected)[:5]}")
        self.R = displacement_axes(model, self.index)
        held = {self.index[d] for d in model.fixed}
        self.T_all = self.R @ eliminate(model, self.index, set())[0]
        C, free = eliminate(model, self.index, held)
        T = self.R @ C
        self.oblique = []      # row that AUTOSPC holds, and rows and factors that it follows: held along that direction
        if model.params.get("AUTOSPC") != "NO":
            size = np.abs(T)
            K_f = T.T @ K @ T
            self.autospc = (find_autospc(K_f, free, self.index, model) if reported is None else
                            accept_autospc(K_f, size.T @ np.abs(K) @ size, free, self.index,
                                           [(g, c) for g, c, _ in reported]))
            T = follow_directions(K_f, T, free, self.index, reported or [])
            self.oblique = [(self.index[g, c], [(self.index[g, o], factor) for o, factor in dict(follows).items()])
                            for g, c, follows in reported or [] if follows]
            T = np.delete(T, self.autospc, axis=1)
            held |= {free[k] for k in self.autospc}
            free = [row for k, row in enumerate(free) if k not in set(self.autospc)]
        self.T, self.free, self.K_g, self.M_g, self.held_rows = T, free, K, M, held
        self.K, self.M = T.T @ K @ T, T.T @ M @ T
        # what round-off of the terms can leave in each entry
        size = np.abs(T)
        self.K_size, self.M_size = size.T @ np.abs(K) @ size, size.T @ np.abs(M) @ size

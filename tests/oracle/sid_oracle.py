"""Standard Input Data read from the format's description alone, and the equations of motion that the blocks state.

read(path) gives a Sid: .mass, .mode_names, .nodes (id -> {block: Taylor}), .blocks (name -> Taylor). Taylor: .m0 (rows
x columns), .m1 (rows x nq x columns). Motion: O. Wallrapp, Mech. Struct. & Mach. 22 (1994) 283-304,

    | m 1    -mc~   Ct' |  | a  |   | w x (w x mc) + 2 w x Ct' qd           |
    | mc~     J     Cr' |  | wd | + | sum Gr_k qd_k w + w x J w              |  =  forces
    | Ct      Cr    Me  |  | qdd|   | sum Ge_k qd_k w + Oe W + Ke q + De qd  |

with W = (w1^2, w2^2, w3^2, w1 w2, w2 w3, w1 w3) and mc, J, Ct, Cr, Oe taken at q.
"""
import re

import numpy as np

BLOCKS = ["mdCM", "J", "Ct", "Cr", "Me", "Gr", "Ge", "Oe", "ksigma", "Ke", "De"]
NODE_BLOCKS = ["origin", "phi", "psi", "AP", "sigma"]


class Taylor:
    def __init__(self, head):
        self.order, self.structure = head["order"], head["structure"]
        self.m0 = np.zeros((head["nrow"], head["ncol"]))
        self.m1 = np.zeros((head["nrow"], head["nq"], head["ncol"]))
        self.listed = 0

    def at(self, q):
        return self.m0 + np.einsum("iqj,q->ij", self.m1, q)


class Sid:
    def __init__(self):
        self.mass, self.mode_names, self.nodes, self.blocks = 0.0, [], {}, {}


def real(text):
    return float(text.replace("D", "E"))


def read_taylor(lines, name):
    head, taylor = {}, None
    for line in lines:
        if line == "end " + name:
            if taylor.structure == 4 and not taylor.listed:
                taylor.m0 = np.eye(len(taylor.m0))
            return taylor
        key, value = (part.strip() for part in line.split("=", 1))
        if re.match(r"m[01]\s*\(", key):
            index = [int(v) - 1 for v in re.findall(r"\d+", key[2:])]
            (taylor.m0 if key[1] == "0" else taylor.m1)[tuple(index)] = real(value)
            if key[1] == "0":
                taylor.listed += 1
                if taylor.structure == 2:
                    taylor.m0[index[1], index[0]] = real(value)
            continue
        head[key] = int(value)
        if len(head) == 6:
            assert set(head) == {"order", "nrow", "ncol", "nq", "nqn", "structure"}
            taylor = Taylor(head)
    raise AssertionError("no end of " + name)


def read(path):
    with open(path) as file:
        head, *rest = [line.strip() for line in file if line.strip()]
    num_nodes, num_modes = (int(v) for v in head.split(":")[0].split())
    lines = iter(rest)
    assert next(lines) == "part"
    sid = Sid()
    node = None
    for line in lines:
        if line in BLOCKS:
            sid.blocks[line] = read_taylor(lines, line)
        elif line in NODE_BLOCKS:
            node[line] = read_taylor(lines, line)
        elif line.startswith("new node"):
            node = sid.nodes[int(line.split("=")[1])] = {}
        elif re.match(r"mass\s*=", line):
            sid.mass = real(line.split("=")[1])
        elif line.startswith("ielastq"):
            sid.mode_names.append(line.split("=")[1].strip())
        elif re.match(r"nelastq\s*=", line):
            assert int(line.split("=")[1]) == num_modes
        else:
            known = r"(new modal\s*=|refmod$|end refmod$|frame$|end frame$|rframe\s*=|end node$|end modal$|end part$)"
            assert re.match(known, line), line
    assert len(sid.nodes) == num_nodes and len(sid.mode_names) == num_modes
    return sid


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def inertia(J):
    """The tensor from 3 x 3 or from 6 x 1 = 11 22 33 12 13 23."""
    if J.shape == (3, 3):
        return J
    a, b, c, d, e, f = J[:, 0]
    return np.array([[a, d, e], [d, b, f], [e, f, c]])


def motion(sid, q, qd, w):
    """Mass matrix (6 + nq) and h."""
    b, n = sid.blocks, len(q)
    mc, J = b["mdCM"].at(q)[:, 0], inertia(b["J"].at(q))
    Ct, Cr = b["Ct"].at(q), b["Cr"].at(q)
    M = np.block([[sid.mass * np.eye(3), -skew(mc), Ct.T], [skew(mc), J, Cr.T], [Ct, Cr, b["Me"].m0]])
    Gr = np.einsum("ikc,k->ic", b["Gr"].m0.reshape(3, n, 3), qd)
    Ge = np.einsum("ikc,k->ic", b["Ge"].m0.reshape(n, n, 3), qd)
    W = np.array([w[0]**2, w[1]**2, w[2]**2, w[0] * w[1], w[1] * w[2], w[0] * w[2]])
    h = np.concatenate([np.cross(w, np.cross(w, mc)) + 2 * np.cross(w, b["Ct"].m0.T @ qd),
                        Gr @ w + np.cross(w, J @ w),
                        Ge @ w + b["Oe"].at(q) @ W + b["ksigma"].m0[:, 0] + b["Ke"].m0 @ q + b["De"].m0 @ qd])
    return M, h

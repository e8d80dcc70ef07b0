"""Rotors as decks, and their matrices in the fixed frame by NumPy: Timoshenko beams with rotary inertia and gyroscopic
terms (Nelson, J. Mech. Des. 102 (1980) 793), discs, bearings with full tables. Axis x; unknowns y, z, rz, ry of a station.
"""
import math

import numpy as np
import scipy.linalg

RPM = math.pi / 30
# Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines (2010), 5.9.
LENGTH, DIAMETER, WIDTH, DENSITY, E, G = 1.5, 0.05, 0.07, 7810.0, 2.11e11, 8.12e10
KAPPA = 6 * (1 + E / (2 * G) - 1) / (7 + 6 * (E / (2 * G) - 1))   # Cowper 1966, circular section
GAUSS = np.polynomial.legendre.leggauss(6)


def make_disc(outer, place):
    """(place, mass, polar, diametral) of a disc on the shaft."""
    mass = DENSITY * math.pi * (outer**2 - DIAMETER**2) / 4 * WIDTH
    polar = mass * (outer**2 + DIAMETER**2) / 8
    return place, mass, polar, polar / 2 + mass * WIDTH**2 / 12


def make_beam(length, EI, shear, mass, inertia):
    """Stiffness, mass and the integral of the rotations' products of one plane: 4 x 4 on v, θ of both ends."""
    phi = 12 * EI / (shear * length**2) if shear else 0
    K, M, R = np.zeros((3, 4, 4))
    for x, w in zip(*GAUSS):
        s, w = (x + 1) / 2, w * length / 2
        v = np.array([1 + phi * (1 - s) - 3 * s**2 + 2 * s**3, length * (s - 2 * s**2 + s**3 + phi / 2 * (s - s**2)),
                      3 * s**2 - 2 * s**3 + phi * s, length * (s**3 - s**2 - phi / 2 * (s - s**2))]) / (1 + phi)
        slope = np.array([phi * -1 - 6 * s + 6 * s**2, length * (1 - 4 * s + 3 * s**2 + phi / 2 * (1 - 2 * s)),
                          6 * s - 6 * s**2 + phi, length * (3 * s**2 - 2 * s - phi / 2 * (1 - 2 * s))]) / (1 + phi) / length
        turn = np.array([6 * (s**2 - s) / length, 1 - 4 * s + 3 * s**2 + phi * (1 - s), 6 * (s - s**2) / length,
                         3 * s**2 - 2 * s + phi * s]) / (1 + phi)
        bend = np.array([6 * (2 * s - 1) / length, 6 * s - 4 - phi, 6 * (1 - 2 * s) / length, 6 * s - 2 + phi]) / (1 + phi) / length
        K += w * EI * np.outer(bend, bend) + (w * shear * np.outer(slope - turn, slope - turn) if shear else 0)
        M += w * (mass * np.outer(v, v) + inertia * np.outer(turn, turn))
        R += w * np.outer(turn, turn)
    return K, M, R


class Rotor:
    """Station i has y, z, rz, ry at 4 i ... 4 i + 3; the slopes are v' = rz, w' = -ry."""
    def __init__(self, places, EI, shear, mass, inertia, discs=()):
        self.places = list(places)
        n = 4 * len(places)
        self.K, self.M, self.Gyro, self.B = np.zeros((4, n, n))
        self.K_shaft = np.zeros((n, n))
        for i in range(len(places) - 1):
            K, M, R = make_beam(places[i + 1] - places[i], EI, shear, mass, inertia)
            planes = [[4 * j + (0 if c == 0 else 2) for j in (i, i + 1) for c in (0, 1)],
                      [4 * j + (1 if c == 0 else 3) for j in (i, i + 1) for c in (0, 1)]]
            for dofs, sign in zip(planes, (1, -1)):
                S = np.diag([1, sign, 1, sign])
                self.K_shaft[np.ix_(dofs, dofs)] += S @ K @ S
                self.M[np.ix_(dofs, dofs)] += S @ M @ S
            S = np.diag([1, -1, 1, -1])
            # α = rz, β = -ry: M_α = 2I Ω β̇, M_β = -2I Ω α̇.
            self.Gyro[np.ix_(planes[0], planes[1])] += 2 * inertia * R @ S
            self.Gyro[np.ix_(planes[1], planes[0])] -= 2 * inertia * S @ R
        self.K += self.K_shaft
        for place, m, polar, across in discs:
            i = 4 * self.find(place)
            self.M[[i, i + 1], [i, i + 1]] += m
            self.M[[i + 2, i + 3], [i + 2, i + 3]] += across
            self.Gyro[i + 2, i + 3] -= polar
            self.Gyro[i + 3, i + 2] += polar
        # Cross product with the axis: (y, z) -> (-z, y), (ry, rz) -> (-rz, ry).
        self.spin = np.zeros((n, n))
        for i in range(0, n, 4):
            self.spin[i, i + 1], self.spin[i + 1, i] = -1, 1
            self.spin[i + 3, i + 2], self.spin[i + 2, i + 3] = -1, 1

    def find(self, place):
        return int(np.argmin(np.abs(np.array(self.places) - place)))

    def add_bearing(self, place, K, B=np.zeros((2, 2))):
        i = 4 * self.find(place)
        self.K[i:i + 2, i:i + 2] += K
        self.B[i:i + 2, i:i + 2] += B

    def matrices(self, speed, B_rotor=None):
        """M, B, K at a speed [rad/s], with internal damping B_rotor and its circulation."""
        B, K = self.B + speed * self.Gyro, self.K.copy()
        if B_rotor is not None:
            B, K = B + B_rotor, K - speed * B_rotor @ self.spin
        return self.M, B, K


def solve(M, B, K, vectors=False):
    """Poles with Im > 0, ascending, and their shapes."""
    n = len(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, B)]])
    values, shapes = scipy.linalg.eig(A)
    kept = np.where(values.imag > 1e-6 * np.abs(values))[0]
    kept = kept[np.argsort(values[kept].imag)]
    return (values[kept], shapes[:n, kept]) if vectors else values[kept]


def make_friswell(num_elements, bearings, discs, EI_only=False):
    """Rotor of bearings (place, K 2x2, B 2x2) and discs (place, outer diameter)."""
    area, I = math.pi * DIAMETER**2 / 4, math.pi * DIAMETER**4 / 64
    rotor = Rotor(np.linspace(0, LENGTH, num_elements + 1), E * I, KAPPA * G * area, DENSITY * area, DENSITY * I,
                  [make_disc(outer, place) for place, outer in discs])
    for place, K, B in bearings:
        rotor.add_bearing(place, np.array(K, float), np.array(B, float))
    return rotor


def number(x):
    return f"{x:.12e}"


def make_friswell_deck(num_elements, bearings, discs, case, bulk, sol=107, modes=8, rotor=True, bars=False):
    """Bending alone: axial motion and torsion are fixed. Unsymmetric bearings by DMIG KBRG and BBRG, if they have terms.
    `bars`: CBAR, without rotary inertia of the shaft."""
    area, I = math.pi * DIAMETER**2 / 4, math.pi * DIAMETER**4 / 64
    last = num_elements + 1
    find = lambda place: 1 + round(place / LENGTH * num_elements)
    lines = [f"SOL {sol}", "CEND", "SPC = 1", "METHOD = 1", "CMETHOD = 2", *case, "BEGIN BULK", "PARAM,COUPMASS,1",
             "EIGRL,1,,,40", f"EIGC,2,LAN,,,,,{modes}", f"SPC1,1,14,1,THRU,{last}",
             *([f"PBAR,1,1,{number(area)},{number(I)},{number(I)},{number(2 * I)}", ",", f",{number(KAPPA)},{number(KAPPA)}"] if bars else
               [f"PBEAM,1,1,{number(area)},{number(I)},{number(I)},,{number(2 * I)}", ",", ",YES,1.", ",",
                f",{number(KAPPA)},{number(KAPPA)}"]), f"MAT1,1,{number(E)},{number(G)},,{number(DENSITY)}"]
    for i in range(last):
        lines.append(f"GRID,{i + 1},,{number(i * LENGTH / num_elements)},0.,0.")
        if i < num_elements:
            lines.append(f"{'CBAR' if bars else 'CBEAM'},{i + 1},1,{i + 1},{i + 2},0.,1.,0.")
    tables = {"KBRG": [], "BBRG": []}
    for j, (place, K, B) in enumerate(bearings):
        for c in (0, 1):
            lines.append(f"CELAS2,{1000 + 10 * j + c},{number(K[c][c])},{find(place)},{2 + c}")
            if B[c][c]:
                lines.append(f"CDAMP2,{2000 + 10 * j + c},{number(B[c][c])},{find(place)},{2 + c}")
            for name, table in (("KBRG", K), ("BBRG", B)):
                if table[1 - c][c]:
                    tables[name].append(f"DMIG,{name},{find(place)},{2 + c},,{find(place)},{3 - c},{number(table[1 - c][c])}")
    for name, terms in tables.items():
        lines += [f"DMIG,{name},0,1,1,0", *terms] if terms else []
    for j, (place, outer) in enumerate(discs):
        _, m, polar, across = make_disc(outer, place)
        lines += [f"CONM2,{3000 + j},{find(place)},,{number(m)}", f",{number(polar)},,{number(across)},,,{number(across)}"]
    if rotor:
        lines += [f"ROTORG,1,1,THRU,{last}", f"RSPINR,1,1,{last},RPM,1."]
    return "\n".join([*lines, *bulk, "ENDDATA", ""])


def springs(k_y, k_z=None, c=0.0):
    return [[k_y, 0], [0, k_y if k_z is None else k_z]], [[c, 0], [0, c]]

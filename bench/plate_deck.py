#!/usr/bin/env python3
"""bench/plate_deck.py N [--ccx] [--rbe3 mass|mast]: a simply supported square plate of N x N quadrilaterals, on stdout.

10 m x 10 m x 0.05 m, steel, w and the membrane held on the four edges; 6 (N+1)^2 - 12 N free dofs. As a Nastran deck,
or with --ccx as a CalculiX deck of S4 elements on the same grids. With --rbe3 all grids carry a mass, or a mast with a
mass, at the reference of an RBE3.
"""
import argparse

SIDE, THICKNESS, E, NU, RHO = 10.0, 0.05, 2.0e11, 0.3, 8000.0


def fit(value):
    """In a field of eight characters, with as many digits as there is room for."""
    return next(text for text in (f"{value:<8.{digits}g}" for digits in (6, 5, 4)) if len(text) == 8)


def write_nastran(n, modes, rbe3, out):
    out.append(f"SOL 103\nCEND\nTITLE = SIMPLY SUPPORTED PLATE {n} X {n}\nSPC = 1\nMETHOD = 1\nBEGIN BULK\n"
               f"EIGRL,1,,,{modes}\nPARAM,COUPMASS,1\nMAT1,1,{E:.3E},,{NU},{RHO}\nPSHELL,1,1,{THICKNESS},1,,1\n")
    for j in range(n + 1):
        for i in range(n + 1):
            out.append(f"GRID    {j * (n + 1) + i + 1:<8d}        {fit(SIDE * i / n)}{fit(SIDE * j / n)}0.0\n")
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            out.append(f"CQUAD4  {j * n + i + 1:<8d}1       {a:<8d}{a + 1:<8d}{a + n + 2:<8d}{a + n + 1:<8d}\n")
    for j in range(n + 1):
        for i in range(n + 1):
            if i in (0, n) or j in (0, n):
                out.append(f"SPC1,1,123,{j * (n + 1) + i + 1}\n")
    if rbe3:
        out.append(f"GRID,9000001,,{SIDE / 2},{SIDE / 2},.5\nCONM2,9000001,9000001,,500.\nRBE3,9000001,,9000001,123456,1.,123")
        for k in range(1, (n + 1) ** 2 + 1):
            out.append(("\n," if k > 2 and k % 8 == 3 else ",") + str(k))
        out.append("\n")
    if rbe3 == "mast":
        out.append(f"GRID,9000002,,{SIDE / 2},{SIDE / 2},3.\nCONM2,9000002,9000002,,50.\n"
                   "CBAR,9000003,9,9000001,9000002,1.,0.,0.\nPBAR,9,1,1.-3,1.-6,2.-6,1.-6\n")
    out.append("ENDDATA\n")


def write_calculix(n, modes, rbe3, out):
    out.append("*NODE,NSET=NALL\n")
    edge = []
    for j in range(n + 1):
        for i in range(n + 1):
            k = j * (n + 1) + i + 1
            out.append(f"{k},{SIDE * i / n:.9g},{SIDE * j / n:.9g},0.\n")
            if i in (0, n) or j in (0, n):
                edge.append(k)
    out.append("*ELEMENT,TYPE=S4,ELSET=EALL\n")
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            out.append(f"{j * n + i + 1},{a},{a + 1},{a + n + 2},{a + n + 1}\n")
    out.append("*NSET,NSET=EDGE\n" + "".join(f"{k}\n" for k in edge))
    out.append(f"*MATERIAL,NAME=M\n*ELASTIC\n{E:.3E},{NU}\n*DENSITY\n{RHO}\n"
               f"*SHELL SECTION,ELSET=EALL,MATERIAL=M\n{THICKNESS}\n*BOUNDARY\nEDGE,1,3\n"
               f"*STEP\n*FREQUENCY\n{modes}\n*END STEP\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("n", type=int)
    parser.add_argument("--modes", type=int, default=20)
    parser.add_argument("--ccx", action="store_true")
    parser.add_argument("--rbe3", choices=["mass", "mast"])
    options = parser.parse_args()
    out = []
    (write_calculix if options.ccx else write_nastran)(options.n, options.modes, options.rbe3, out)
    print("".join(out), end="")


if __name__ == "__main__":
    main()

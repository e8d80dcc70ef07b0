"""Cards of Nastran decks that several tests need."""

# m = 4 at grid 1, k = 36 to a fixed grid, moves along x.
OSCILLATOR = """GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
CONM2,1,1,,4.0
CELAS2,2,36.0,1,1,2,1
SPC1,1,23456,1
SPC1,1,123456,2
"""
# Three masses that move along x: 1 - 2 - 3 to ground, dampers that no mode shape makes diagonal.
THREE_MASSES = """GRID,1,,0.,0.,0.
GRID,2,,1.,0.,0.
GRID,3,,2.,0.,0.
GRID,4,,3.,0.,0.
CONM2,11,1,,1.0
CONM2,12,2,,2.0
CONM2,13,3,,3.0
CELAS2,21,100.0,1,1,2,1,0.05
CELAS2,22,200.0,2,1,3,1
CELAS2,23,300.0,3,1,4,1
CDAMP2,24,1.5,1,1,2,1
CDAMP2,25,0.4,3,1,4,1
SPC1,1,23456,1,2,3
SPC1,1,123456,4
"""


def begin(solution, *case):
    """Executive and case control, up to BEGIN BULK."""
    return "\n".join([f"SOL {solution}", "CEND", *case, "BEGIN BULK", ""])


def write_real(value):
    """A real field as decks are typed: 1. and .25."""
    text = repr(float(value))
    return text.removesuffix("0") if text.endswith(".0") else text.removeprefix("0") if text.startswith("0.") else text


def grids(*places, first=1):
    """GRID cards at these places, numbered from `first`."""
    return "".join(f"GRID,{first + k},,{','.join(map(write_real, place))}\n" for k, place in enumerate(places))


def row(number, step=1.0):
    """GRID cards along x from 0."""
    return grids(*((k * step, 0, 0) for k in range(number)))


def mesh(nx, ny, write_place, property_id=1):
    """GRID j (nx + 1) + i + 1 with the fields of write_place(i, j), and the CQUAD4 between them."""
    text = "".join(f"GRID,{j * (nx + 1) + i + 1},,{write_place(i, j)}\n" for j in range(ny + 1) for i in range(nx + 1))
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i + 1
            text += f"CQUAD4,{j * nx + i + 1},{property_id},{a},{a + 1},{a + nx + 2},{a + nx + 1}\n"
    return text


def bent_cantilever(number, write_end=lambda k: ""):
    """GRID and CBAR of a line that turns from x to y at its fifth grid; write_end(k) follows the place."""
    places = [(1.0 * k, 0.0) if k < 5 else (4.0, 1.0 * (k - 4)) for k in range(number)]
    return "".join(f"GRID,{k + 1},,{x},{y},0.{write_end(k)}\n" for k, (x, y) in enumerate(places)) + "".join(
        f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,0.,1.\n" for k in range(number - 1))

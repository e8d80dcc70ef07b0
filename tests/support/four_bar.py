"""Bodies of a four-bar linkage whose base is 1 long, for tests of closed loops."""
from toml_text import table


def write_bars(*bars):
    """Tables of uniform bars along x: (name, mass, length, moments of inertia), with node 1 at the end."""
    return "".join(table("body", name, mass=mass, cg=[length / 2, 0.0, 0.0], inertia=inertia,
                         nodes=[{"id": 1, "position": [length, 0.0, 0.0]}]) for name, mass, length, inertia in bars)

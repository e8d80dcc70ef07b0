"""Spacecraft that several tests and the verification share."""
import math

from toml_text import table


def write_panels():
    """Hub and two panels of Basilisk's test_hingedRigidBodyStateEffector.py (AVS Laboratory, University of Colorado)."""
    return "".join([
        table("body", "hub", mass=750.0, cg=[0.0, 0.0, 1.0], inertia=[900.0, 800.0, 600.0]),
        table("body", "panel1", mass=100.0, cg=[1.5, 0.0, 0.0], inertia=[100.0, 50.0, 50.0]),
        table("body", "panel2", mass=100.0, cg=[-1.5, 0.0, 0.0], inertia=[100.0, 50.0, 50.0]),
        table("hinge", "flight", "free", child="hub", rate=[0.1, -0.1, 0.1, 0.0, 0.0, 0.0]),
        table("hinge", "root1", "revolute", parent="hub", child="panel1", parent_position=[0.5, 0.0, 1.0],
              axis=[0.0, -1.0, 0.0], position=[math.radians(5)], stiffness=[100.0]),
        table("hinge", "root2", "revolute", parent="hub", child="panel2", parent_position=[-0.5, 0.0, 1.0],
              axis=[0.0, 1.0, 0.0], stiffness=[100.0])])

"""Coordinate systems: CORD1x and CORD2x, places in them and the displacement axes that they give a grid."""
import math

import numpy as np


class System:
    """kind R, C or S; origin and axes (columns x, y, z) in basic."""

    def __init__(self, kind="R", origin=(0, 0, 0), axes=None):
        self.kind, self.origin = kind, np.array(origin, float)
        self.axes = np.eye(3) if axes is None else axes

    @staticmethod
    def from_points(kind, a, b, c):
        z = (b - a) / np.linalg.norm(b - a)
        y = np.cross(z, c - a)
        y /= np.linalg.norm(y)
        return System(kind, a, np.column_stack([np.cross(y, z), y, z]))

    def to_basic(self, p):
        if self.kind == "C":
            t = math.radians(p[1])
            p = [p[0] * math.cos(t), p[0] * math.sin(t), p[2]]
        elif self.kind == "S":
            t, f = math.radians(p[1]), math.radians(p[2])
            p = [p[0] * math.sin(t) * math.cos(f), p[0] * math.sin(t) * math.sin(f), p[0] * math.cos(t)]
        return self.origin + self.axes @ np.array(p, float)

    def from_basic(self, x):
        x, y, z = self.axes.T @ (np.asarray(x, float) - self.origin)
        r = math.hypot(x, y)
        if self.kind == "C":
            return np.array([r, math.degrees(math.atan2(y, x)), z])
        if self.kind == "S":
            return np.array([math.hypot(r, z), math.degrees(math.atan2(r, z)), math.degrees(math.atan2(y, x))])
        return np.array([x, y, z])

    def axes_at(self, x):
        """Columns: the displacement axes of a grid at x (basic) with this system as CD."""
        if self.kind == "R":
            return self.axes
        x, y, z = self.axes.T @ (np.asarray(x, float) - self.origin)
        r = math.hypot(x, y)
        c, s = x / r, y / r
        if self.kind == "C":
            local = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        else:
            d = math.hypot(r, z)
            st, ct = r / d, z / d
            local = np.array([[st * c, ct * c, -s], [st * s, ct * s, c], [ct, -st, 0]])
        return self.axes @ local

    def distance_to_axis(self, x):
        """How far x is from where the axes are undefined; infinite for a rectangular system."""
        if self.kind == "R":
            return math.inf
        x, y, _ = self.axes.T @ (np.asarray(x, float) - self.origin)
        return math.hypot(x, y)

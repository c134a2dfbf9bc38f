"""Limits that the project file's schema and the functions of the library have in common."""

from __future__ import annotations

# m; a thousand times smaller and larger than any model or building, so that no figure can overflow
LEAST_LENGTH, MOST_LENGTH = 1e-6, 1e6
# in the unit of a table: survey coordinates in millimetres
MOST_COORDINATE = 1e11
# of one list; a curve drawn by hand has hundreds
MOST_POINTS = 10_000
# waves along a boundary curve
MOST_WAVES = 4
# how far a boundary curve may be changed: shifts in m, a change of size as a share, a tilt in degrees
MOST_MOVE, MOST_SCALE, MOST_TILT = 1000, 0.5, 45
# of a net: a number of cells where neither that nor a spacing is given, and the least one
DEFAULT_CELLS, CELLS_MIN = 24, 3
# size of a load by kind, with its unit; what is beyond is a load in another unit: kN for N, N for kN, mm for m
LOAD_LIMITS: dict[str, tuple[str, float, float]] = {
    "self_weight": ("times the weight", 1e-3, 100),
    "area": ("N/m2", 5, 1e5),
    "line": ("N/m", 1, 1e6),
    "point": ("N", 1, 1e7),
    "temperature": ("K", 0.1, 500),
    "settlement": ("m", 1e-6, 1),
}
# N/m and N m/rad of springs of supports and joints
LEAST_STIFFNESS, MOST_STIFFNESS = 1e-3, 1e15

LEAST_NODE_ANGLE, LARGEST_NODE_ANGLE = 30.0, 150.0
"""deg; between lamellas of surfaces found for another angle than 90: beyond, hardly any surface exists."""

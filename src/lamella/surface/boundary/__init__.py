"""Boundary curves of surfaces between curves: exact, by arc length, checked."""

from lamella.surface.boundary.checks import check_loops
from lamella.surface.boundary.curve import CORNER_ANGLE, Loop, Slide, Sliding, make_loop

__all__ = ["CORNER_ANGLE", "Loop", "Slide", "Sliding", "check_loops", "make_loop"]

"""Boundary curves of form-found surfaces: exact, by arc length, checked, and read from project tables and files."""

from lamella.surface.boundary.checks import check_loops
from lamella.surface.boundary.curve import CORNER_ANGLE, Loop, Slide, Sliding, make_loop
from lamella.surface.boundary.tables import boundary_loops, with_origin

__all__ = ["CORNER_ANGLE", "Loop", "Slide", "Sliding", "boundary_loops", "check_loops", "make_loop", "with_origin"]

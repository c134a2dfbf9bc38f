"""Boundary loops as a user gives them: named, and measured from a point beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.drawing_origin import Origin, origin_of
from lamella.base.errors import InputError
from lamella.surface.boundary.curve import Loop
from lamella.surface.boundary.curves import as_loop


def given_loops(
    loops: Sequence[Loop | ArrayLike] | Loop, origin: Origin | None = None
) -> tuple[tuple[Loop, ...], Origin]:
    """Loops with names, measured from a point of the drawing, and that point, m.

    Parameters
    ----------
    loops : sequence of Loop or points, or one Loop
        The outer one first.
    origin : (x, y, z), optional
        The point, m; beside the outer loop when not given.

    Raises
    ------
    InputError
        There is no loop.
    """
    given = [loops] if isinstance(loops, Loop) else list(loops)
    if not given:
        raise InputError("there is no loop", "give at least one closed curve", "loops")
    curves = tuple(_named(as_loop(loop), k) for k, loop in enumerate(given))
    if origin is None:
        origin = origin_of(curves[0].at(np.arange(8) / 8))
    if any(origin):
        curves = tuple(curve.scaled(1.0, -np.array(origin)) for curve in curves)
    return curves, origin


def refuse_both(mean_curvature: float, volume: float | None) -> None:
    """Refuse H (1/m) together with a volume (m^3).

    Raises
    ------
    InputError
    """
    if volume is not None and mean_curvature:
        raise InputError(
            f"mean_curvature = {mean_curvature:g} and volume = {volume:g} are given", "leave one of them out", "volume"
        )


def _named(loop: Loop, k: int) -> Loop:
    """Loops have names in messages and files."""
    return loop if loop.name else replace(loop, name="outer" if k == 0 else f"hole {k}")

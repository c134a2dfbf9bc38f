"""Which nets are traced line by line, and on what."""

from __future__ import annotations

from typing import Any, Literal

from lamella.base.errors import InputError
from lamella.network.pattern import Pattern
from lamella.surface.surface import Surface


def is_traced(surface: Surface[Any], pattern: Pattern) -> bool:
    """Whether the curves of a net follow no lattice: they are traced one by one, as streamlines."""
    return not surface.has_lattice(pattern.normal_curvature)


def reported_mean_curvature(surface: Surface[Any], pattern: Pattern) -> float:
    """What a net tells as its surface's mean curvature, 1/m: where that varies, the lamellas' normal curvature.

    So the radius of the unrolled strips is 1 / |mean_curvature| for those who know of nothing else.
    """
    if not surface.has_lattice() and pattern.normal_curvature is not None:
        return pattern.normal_curvature
    return surface.mean_curvature


def check_traced(surface: Surface[Any], pattern: Pattern, closing: Literal["open", "round", "adjust"] = "open") -> None:
    """Refuse what a net without a lattice cannot have.

    Raises
    ------
    InputError
    """
    if pattern.kind == "lamellas" and pattern.normal_curvature is None:
        raise InputError(
            "the surface's mean curvature varies: no lamellas of one normal curvature cross at 90 deg on it",
            'write normal_curvature (0 for asymptotic lines), or kind = "principal"; or let the mesh become a surface '
            'of constant mean curvature: mean_curvature = "fit"',
            "normal_curvature",
        )
    refuse_lattice_options(pattern, closing)


def refuse_lattice_options(pattern: Pattern, closing: Literal["open", "round", "adjust"]) -> None:
    """Refuse what asks for a lattice, of lines that have none.

    Raises
    ------
    InputError
    """
    if pattern.every != (1, 1):
        p, q = pattern.every
        raise InputError(
            f"every = {p if p == q else [p, q]} leaves out curves of an isothermic lattice, and these lines have none",
            "leave every out and take a larger spacing, or fewer cells",
            "every",
        )
    if closing != "open":
        raise InputError(
            f'closing = "{closing}" moves a net whose lines follow from one another; lines of a given normal curvature '
            "start from seeds, and there is nothing to close",
            'leave closing out, or write closing = "open"',
            "closing",
        )

"""Strips along curves on a surface, bent towards developable ones (paper, Figures 7 and 10)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats
from lamella.base.errors import InputError, require_positive
from lamella.base.result import Result
from lamella.base.sparse import Backend
from lamella.base.vectors import diagonal
from lamella.base.wording import counted
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.closeness import Closeness
from lamella.projection.constraints.fairness import THIRD, Fairness
from lamella.projection.constraints.fixed import Fixed
from lamella.projection.constraints.planar_face import PlanarFace
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.constraints.upright import Upright
from lamella.projection.foot_points import FootSurface
from lamella.projection.report import Iteration, Solution
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block
from lamella.strip.developable import buildable_height
from lamella.strip.planarity import planarity_score

# weights of third differences along the borders and of staying at the curve, and what they keep per iteration
STRIPS_FAIRNESS, STRIPS_STAY, STRIPS_FADE = 0.1, 0.03, 0.5
# from this planarity score on the paper colours a quad in full red
RED = 0.005


@dataclass(frozen=True, eq=False, repr=False)
class PlanarStrips(Result):
    """Strips of quads, each between a border on the surface and one on its parallel surface.

    Attributes
    ----------
    lower, upper : tuple of (k, 3)
        Borders of each strip, ruling by ruling, m.
    before, after : tuple of (k - 1,)
        Planarity score of each quad (paper, section 2.3): of strips along the normals at the same spacing, and of
        these.
    buildable : tuple of (j,)
        Height up to which a developable strip along the given curve is regular, at its given points, m; 0 where none
        of positive height exists.
    height : float
        m.
    shift : tuple of (k,)
        How far each ruling's foot is from the given curve, m.
    tilt : tuple of (k,)
        Of each ruling sideways out of the plane of normal and curve, degrees; 0: the strip stands upright.
    turn : tuple of (k - 1,)
        Between the rulings of each quad, degrees: a large one bridges a place where no developable strip exists.
    solutions : tuple of Solution
        Of each round, with the remainder by constraint.
    """

    lower: tuple[Floats, ...]
    upper: tuple[Floats, ...]
    before: tuple[Floats, ...]
    after: tuple[Floats, ...]
    buildable: tuple[Floats, ...]
    height: float
    shift: tuple[Floats, ...]
    tilt: tuple[Floats, ...]
    turn: tuple[Floats, ...]
    solutions: tuple[Solution, ...]

    def _line(self) -> str:
        worst = float(np.concatenate(self.after).max())
        return f"{counted(len(self.lower), 'strip')} {self.height:g} m high, planarity up to {worst:.2g}"

    def figures(self) -> dict[str, float]:
        """Scores before and after, shares of quads in full red, what it took, share that cannot be developable."""
        before, after = np.concatenate(self.before), np.concatenate(self.after)
        return {
            "median_before": float(np.median(before)),
            "median_after": float(np.median(after)),
            "largest_before": float(before.max()),
            "largest_after": float(after.max()),
            "red_before": float((before >= RED).mean()),
            "red_after": float((after >= RED).mean()),
            "largest_shift": float(max(x.max() for x in self.shift)),
            "largest_tilt": float(max(x.max() for x in self.tilt)),
            "largest_turn": float(max(x.max() for x in self.turn)),
            "not_developable": float((np.concatenate(self.buildable) < self.height).mean()),
        }


def planar_strips(
    curves: Sequence[ArrayLike],
    surface: FootSurface,
    height: float,
    *,
    rounds: int = 2,
    iterations: int = 20,
    tolerance: float = 1e-8,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> PlanarStrips:
    """Turn the rulings of strips until their quads are planar and upright, lower border on S, upper one at distance h.

    Both borders may slide over their surfaces, so curves are left a little (`PlanarStrips.shift`): a net has one curve
    where a strip may need another. Starts from strips along the surface normals; each round halves the spacing of the
    rulings and solves again.

    Parameters
    ----------
    curves : sequence of (k, 3)
        Points of each curve in order, m, k >= 4: polylines of a net. They are moved onto the surface.
    surface : FootSurface
    height : float
        h, m, to the side of the surface's normal; below 0: to the other.
    rounds, iterations : int
        Rounds of subdivision, and most steps in each.
    tolerance, on_iteration, backend
        See `solve`.

    Returns
    -------
    PlanarStrips
        Where a developable strip of this height cannot exist, `buildable` is below it, and planar quads bridge the
        place by a jump of the rulings (`turn`).

    Raises
    ------
    InputError
        Curves with too few points; a height of 0, beyond the centres of curvature, or larger than the curves.

    Examples
    --------
    >>> import lamella, numpy as np
    >>> surface = lamella.Catenoid(2.0, (-2.0, 2.0))
    >>> steps = np.linspace(-0.3, 0.3, 9)
    >>> curve = surface.at(steps + 1j * steps).position
    >>> strips = lamella.planar_strips([curve], lamella.foot_surface(surface), 0.05, rounds=1)
    >>> bool(strips.after[0].max() < strips.before[0].max())
    True
    """
    lower = [_curve(curve, number) for number, curve in enumerate(curves)]
    if not lower:
        raise InputError("no curves", "give at least one polyline")
    require_positive(height=abs(height))
    lower = _split(surface.foot(np.concatenate(lower)).position, lower)
    normals = _split(surface.foot(np.concatenate(lower)).normal, lower)
    side = float(np.sign(height))
    buildable = tuple(buildable_height(c, side * n) for c, n in zip(lower, normals, strict=True))
    upper = [c + height * n for c, n in zip(lower, normals, strict=True)]
    _check_height(lower, upper, height)
    solutions: list[Solution] = []
    plain = lower
    for _ in range(rounds):
        plain = _on(surface, [_halved(c) for c in plain], 0.0)
        lower = _on(surface, [_halved(c) for c in lower], 0.0)
        upper = _on(surface, [_halved(c) for c in upper], height)
        solution = _solve(lower, upper, surface, height, iterations, tolerance, on_iteration, backend)
        solutions.append(solution)
        both = solution.values["vertices"]
        lower, upper = _split(both[: len(both) // 2], lower), _split(both[len(both) // 2 :], upper)
    along = _on(surface, plain, height)
    upright = _split(surface.foot(np.concatenate(lower)).normal, lower)
    return PlanarStrips(
        tuple(lower),
        tuple(upper),
        tuple(_scores(a, b) for a, b in zip(plain, along, strict=True)),
        tuple(_scores(a, b) for a, b in zip(lower, upper, strict=True)),
        buildable,
        abs(height),
        tuple(_distance(a, c) for a, c in zip(lower, plain, strict=True)),
        tuple(_tilt(a, b, n) for a, b, n in zip(lower, upper, upright, strict=True)),
        tuple(_turn(a, b) for a, b in zip(lower, upper, strict=True)),
        tuple(solutions),
    )


def _solve(
    lower: list[Floats],
    upper: list[Floats],
    surface: FootSurface,
    height: float,
    iterations: int,
    tolerance: float,
    on_iteration: Callable[[Iteration], None] | None,
    backend: Backend | None,
) -> Solution:
    points = np.concatenate([*lower, *upper])
    half = len(points) // 2
    starts = np.cumsum([0, *(len(c) for c in lower)])
    first = np.concatenate([np.arange(a, b - 1) for a, b in pairwise(starts)])
    faces = np.column_stack([first, first + 1, first + 1 + half, first + half])
    a, b = points[faces[:, 2]] - points[faces[:, 0]], points[faces[:, 3]] - points[faces[:, 1]]
    normals = np.cross(a, b)
    edge = float(np.linalg.norm(points[first + 1] - points[first], axis=1).mean())
    runs = np.concatenate([np.arange(a, b - 3) for a, b in pairwise(starts)])
    stencils = np.concatenate([runs, runs + half])[:, None] + np.arange(4)
    hard: list[Constraint] = [
        PlanarFace(name="planar quads", faces=faces, edge=edge),
        UnitLength(name="unit normals", block="face normals", index=np.arange(len(faces))),
        Upright(name="upright", edges=faces[:, :2], surface=surface),
        Closeness(name="lower border", index=np.arange(half), surface=surface, edge=edge),
        Closeness(name="upper border", index=np.arange(half, 2 * half), surface=surface, edge=edge, offset=height),
    ]
    soft = [
        Fairness(
            name="fair borders",
            stencils=stencils,
            coefficients=THIRD,
            edge=edge,
            weight=STRIPS_FAIRNESS,
            fade=STRIPS_FADE,
        ),
        Fixed(
            name="start",
            index=np.arange(2 * half),
            points=points,
            edge=edge,
            weight=STRIPS_STAY,
            fade=STRIPS_FADE,
            hard=False,
        ),
    ]
    return solve(
        [Block("vertices", points, edge), Block("face normals", normals / np.linalg.norm(normals, axis=1)[:, None])],
        [*hard, *soft],
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )


def _curve(curve: ArrayLike, number: int) -> Floats:
    points = np.asarray(curve, np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 4 or not np.isfinite(points).all():
        raise InputError(
            f"curve {number} has shape {points.shape}", "at least four points (k, 3) of finite coordinates are expected"
        )
    if (np.linalg.norm(np.diff(points, axis=0), axis=1) == 0).any():
        raise InputError(f"curve {number} has a point twice in a row", "list each point once")
    return points


def _check_height(lower: list[Floats], upper: list[Floats], height: float) -> None:
    """Refuse heights at which strips along the normals fold, or that are no strips."""
    size = max(diagonal(curve) for curve in lower)
    if abs(height) > size:
        raise InputError(
            f"height = {height:g} m is more than the largest curve measures, {size:.4g} m", "give the height in m"
        )
    for number, (a, b) in enumerate(zip(lower, upper, strict=True)):
        back = np.flatnonzero(np.einsum("kc,kc->k", np.diff(a, axis=0), np.diff(b, axis=0)) <= 0)
        if len(back):
            raise InputError(
                f"height = {height:g} m reaches beyond the centre of curvature of curve {number} after its point "
                f"{back[0]}: normals cross below it",
                "less height, or the other side of the surface",
            )


def _split(points: Floats, like: list[Floats]) -> list[Floats]:
    return np.split(points, np.cumsum([len(c) for c in like])[:-1])


def _on(surface: FootSurface, curves: list[Floats], height: float) -> list[Floats]:
    """Points moved onto the surface, or onto its parallel surface."""
    foot = surface.foot(np.concatenate(curves))
    return _split(foot.position + height * foot.normal, curves)


def _halved(curve: Floats) -> Floats:
    """With a point in the middle of each piece, on the cubic through its neighbours; on the last ones the end's."""
    middle = np.empty((len(curve) - 1, 3))
    middle[1:-1] = (9 * (curve[1:-2] + curve[2:-1]) - curve[:-3] - curve[3:]) / 16
    middle[0] = (5 * curve[0] + 15 * curve[1] - 5 * curve[2] + curve[3]) / 16
    middle[-1] = (5 * curve[-1] + 15 * curve[-2] - 5 * curve[-3] + curve[-4]) / 16
    found = np.empty((2 * len(curve) - 1, 3))
    found[::2], found[1::2] = curve, middle
    return found


def _scores(lower: Floats, upper: Floats) -> Floats:
    return planarity_score(lower[:-1], lower[1:], upper[1:], upper[:-1])


def _distance(points: Floats, curve: Floats) -> Floats:
    """Of points from a polyline, point k from its pieces next to k or one further, m."""
    found = np.full(len(points), np.inf)
    for ahead in range(-2, 2):
        piece = np.clip(np.arange(len(points)) + ahead, 0, len(curve) - 2)
        a, d = curve[piece], curve[piece + 1] - curve[piece]
        share = np.clip(np.einsum("kc,kc->k", points - a, d) / np.einsum("kc,kc->k", d, d), 0, 1)
        found = np.minimum(found, np.linalg.norm(points - a - share[:, None] * d, axis=1))
    return found


def _tilt(lower: Floats, upper: Floats, normals: Floats) -> Floats:
    """Of rulings out of the plane of normal and curve, degrees."""
    across = np.cross(normals, np.gradient(lower, axis=0))
    ruling = upper - lower
    sine = np.einsum("kc,kc->k", across, ruling) / (np.linalg.norm(across, axis=1) * np.linalg.norm(ruling, axis=1))
    return np.asarray(np.degrees(np.abs(np.arcsin(np.clip(sine, -1, 1)))))


def _turn(lower: Floats, upper: Floats) -> Floats:
    """Between successive rulings, degrees."""
    ruling = upper - lower
    a, b = ruling[:-1], ruling[1:]
    return np.asarray(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), np.einsum("kc,kc->k", a, b))))

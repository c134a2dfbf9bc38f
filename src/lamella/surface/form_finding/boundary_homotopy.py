"""Films followed while their loops move: from simpler loops, where a film is found, to the given ones.

The simpler loops are flat, or the given ones drawn together: two rings far apart have a film of mean curvature H where
no minimal one spans them, and near each other Newton's method arrives at it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats
from lamella.base.progress import Progress, Report
from lamella.base.vectors import diagonal
from lamella.surface.form_finding.chart import Chart, vector_area
from lamella.surface.form_finding.continuation import Reached
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film, Loop, Slide, moved_with_rim
from lamella.surface.form_finding.meshing import SAMPLES_OF_A_LOOP, is_worn, on_surface, renewed
from lamella.surface.form_finding.newton import Equilibrium, FixedH, NoFilmError, Volume, find_equilibrium
from lamella.surface.remesh.remesh import TriangleMesh

# of the whole way: first step, and the least one; Newton steps of a film, and after which a path that fails ends
FIRST_STEP, LEAST_STEP = 1 / 8, 1 / 256
HOMOTOPY_STEPS_MAX, HOMOTOPY_NEWTON_MAX = 15, 150
# loops drawn together keep this far apart, and move by this much at least, over the size of the largest
LOOPS_APART = 0.05


class BreakError(ArithmeticError):
    """A path of films along moving loops breaks.

    Attributes
    ----------
    share : float
        Part of the way that was possible.
    steps : int
        Newton steps so far.
    """

    def __init__(self, share: float, steps: int, reason: str) -> None:
        super().__init__(reason)
        self.share, self.steps = share, steps


class Begin(Protocol):
    """Where a loop begins: points (n, 3) over the parameter (n,)."""

    def __call__(self, t: Floats) -> Floats: ...


@dataclass(frozen=True)
class Moving:
    """A loop on its way to where it is given.

    Attributes
    ----------
    loop : Loop
        Where it ends.
    begin : callable
        Where it begins.
    share : float
        Part of the way.
    """

    loop: Loop
    begin: Begin
    share: float
    slides: Sequence[Slide] = ()

    @property
    def name(self) -> str:
        """Name in the project."""
        return self.loop.name

    @property
    def length(self) -> float:
        """That of the loop where it ends, m."""
        return self.loop.length

    @property
    def corners(self) -> Floats:
        """Parameters of the corners, sorted."""
        return self.loop.corners

    @property
    def smooth(self) -> Booleans:
        """Which corners are none to the eye, see `lamella.surface.boundary.curve.Loop`."""
        return self.loop.smooth

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""
        t = np.asarray(t, float) % 1
        return np.asarray(self.share * self.loop.at(t) + (1 - self.share) * self.begin(t))


Loops = tuple[Loop, ...]
Path = Callable[[float], Loops]


def drawn_together(loops: Loops) -> Path:
    """Loops moved towards their common middle and turned to face it: at 0 they are all there, at 1 all is as given.

    Turned about the middle of a loop, so that its vector area points from the others' middles or to them: rings at the
    ends of a bent tube become the ends of a straight one.
    """
    middles = np.array([_points(loop).mean(0) for loop in loops])
    size = _size(loops)

    def begin(k: int) -> Begin:
        axis = middles[k] - np.delete(middles, k, 0).mean(0) if len(loops) > 1 else np.zeros(3)
        turn = np.eye(3) if np.linalg.norm(axis) < LOOPS_APART * size else _turn(vector_area(_points(loops[k])), axis)
        return lambda t: (loops[k].at(t) - middles[k]) @ turn.T + middles.mean(0)

    starts = [begin(k) for k in range(len(loops))]
    return lambda share: tuple(Moving(loop, first, share) for loop, first in zip(loops, starts, strict=True))


def _turn(first: Floats, second: Floats) -> Floats:
    """Least rotation (3, 3) that brings one direction onto a line along another."""
    a, b = first / max(float(np.linalg.norm(first)), 1e-300), second / np.linalg.norm(second)
    b = b if a @ b >= 0 else -b
    cross, cosine = np.cross(a, b), float(a @ b)
    across = np.cross(np.eye(3), cross)
    return np.asarray(np.eye(3) + across + across @ across / (1 + cosine))


def _size(loops: Loops) -> float:
    return max(diagonal(_points(loop)) for loop in loops)


def is_moved(begin: Loops, end: Loops) -> bool:
    """Whether a path moves its loops by more than a little."""
    size = _size(end)
    return any(np.abs(_points(a) - _points(b)).max() > LOOPS_APART * size for a, b in zip(begin, end, strict=True))


def _points(loop: Loop) -> Floats:
    return loop.at(np.arange(SAMPLES_OF_A_LOOP) / SAMPLES_OF_A_LOOP)


def are_apart(loops: Loops) -> bool:
    """Whether loops keep clear of each other."""
    points = [_points(loop) for loop in loops]
    size = _size(loops)
    return all(cKDTree(p).query(q)[0].min() > LOOPS_APART * size for k, p in enumerate(points) for q in points[k + 1 :])


def from_flat(chart: Chart, loops: Loops) -> tuple[Path, TriangleMesh]:
    """Loops that begin as the rims of the chart, mapped affinely as near to the given ones as they can; and the chart.

    There the minimal film is the chart itself.
    """
    on_rim = chart.loop >= 0
    plane = np.column_stack([chart.points, np.ones(len(chart.points))])
    given = np.zeros((len(plane), 3))
    for index, loop in enumerate(loops):
        mine = chart.loop == index
        given[mine] = loop.at(chart.parameter[mine])
    affine, *_ = np.linalg.lstsq(plane[on_rim], given[on_rim], rcond=None)
    flat = plane @ affine
    splines = []
    for index in range(len(loops)):
        mine = np.flatnonzero(chart.loop == index)
        mine = mine[np.argsort(chart.parameter[mine])]
        t, points = chart.parameter[mine], flat[mine]
        splines.append(CubicSpline(np.append(t, t[0] + 1), np.vstack([points, points[:1]]), bc_type="periodic"))

    def held(share: float) -> Loops:
        return tuple(Moving(loop, spline, share) for loop, spline in zip(loops, splines, strict=True))

    return held, TriangleMesh(flat, chart.faces, chart.loop, chart.parameter)


def along_flat(chart: Chart, loops: Loops, order: int, progress: Progress) -> Reached:
    """Follow the minimal films from flat loops to the given ones.

    Raises
    ------
    BreakError
    """
    held, mesh = from_flat(chart, loops)
    try:
        flat = on_surface(Film.on_mesh(mesh, held(0.0), 1), order, 0.7)
    except NoFilmError as error:
        raise BreakError(0.0, 0, str(error)) from None
    return along_loops(Equilibrium(flat, 0.0, 0, 0, ()), held, 0.0, loops, progress, finer=0.7)


def along_loops(
    start: Equilibrium,
    path: Path,
    share: float,
    loops: Loops,
    progress: Progress,
    *,
    volume: float | None = None,
    stable: bool = True,
    finer: float = 1.0,
) -> Reached:
    """Follow the films of one H, or of a volume that goes evenly to a given one, from a share of a path to its end.

    Parameters
    ----------
    start : Equilibrium
    path : callable
        Loops at a share of the way.
    share : float
        Where the start is.
    loops : tuple of Loop
        The end of the path.
    progress : callable
    volume : float, optional
        Enclosed at the end, m^3.
    stable : bool
        See `find_equilibrium`.
    finer : float
        Share of the sizes of elements that the loops ask for.

    Raises
    ------
    BreakError
    """
    first = share
    begin = enclosed_volume(start.film) if volume is not None else 0.0
    film, curvature = start.film, start.mean_curvature
    step, steps = min(FIRST_STEP, (1 - share) / 2), 0

    def found(film: Film, there: Loops, at: float) -> Equilibrium:
        moved = _moved(film, there)
        if volume is None:
            return find_equilibrium(moved, curvature, FixedH(stable), most_steps=HOMOTOPY_STEPS_MAX)
        wanted = begin + (volume - begin) * (at - first) / (1 - first)
        missing = wanted - enclosed_volume(moved)
        return find_equilibrium(moved, curvature, Volume(missing), most_steps=HOMOTOPY_STEPS_MAX)

    try:
        while share < 1:
            wanted = min(1.0, share + step)
            try:
                here = found(film, path(wanted), wanted)
            except NoFilmError as error:
                steps += HOMOTOPY_STEPS_MAX
                step /= 2
                if step < LEAST_STEP or steps > HOMOTOPY_NEWTON_MAX:
                    raise BreakError(share, steps, str(error)) from None
                continue
            steps += here.steps
            progress(
                Report.detail(
                    f"loops at {wanted:.3f} of their way: H = {here.mean_curvature:.6g} 1/m ({here.steps} steps)"
                )
            )
            share, step = wanted, step * 1.5
            film, curvature = here.film, here.mean_curvature
            if is_worn(film):
                film = renewed(film, finer)
        final = found(Film.on_mesh(film.mesh, loops, film.connectivity.basis.order).at(film.nodes), loops, 1.0)
    except NoFilmError as error:
        raise BreakError(share, steps, str(error)) from None
    return Reached(final, steps + final.steps)


def _moved(film: Film, loops: Loops) -> Film:
    """A film after its loops have moved."""
    moved = Film.on_mesh(film.mesh, loops, film.connectivity.basis.order)
    return moved.at(moved_with_rim(film, moved.nodes).nodes)

"""Films that Newton's method does not reach from afar: followed along a path of films.

Along the volume a family of films runs smoothly through the folds of its mean curvature: a soap bubble on a ring grows
through the hemisphere, where H is largest, to a large sphere; a catenoid gets a thinner neck until H is 0 again, the
unstable one. On stable films H falls as the volume grows (dH/dV < 0), behind a fold it rises.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from lamella.surface.element.remesh import TriangleMesh
from lamella.surface.found.chart import Chart
from lamella.surface.found.film import Film, Loop, harmonic_over_itself
from lamella.surface.found.meshing import (
    least_angle,
    on_surface,
    start_sizes,
    straightened,
    with_sizes,
)
from lamella.surface.found.newton import Detail, Equilibrium, NoFilmError, find_equilibrium
from lamella.surface.found.slid_rim import settled_rims
from lamella.surface.points import Floats

MOST_STEPS = 80
# Newton steps after which a path that fails once more ends
MOST_NEWTON = 100
# of the first step; a path that needs smaller ones ends
LEAST_STEP = 2e-3
# elements are made anew below this angle, deg
SLENDER = 18.0


class FoldError(ArithmeticError):
    """The family of films turns back before the wanted mean curvature.

    Attributes
    ----------
    mean_curvature : float
        H at the fold, 1/m.
    steps : int
        Newton steps so far.
    """

    def __init__(self, mean_curvature: float, steps: int) -> None:
        super().__init__(f"fold at H = {mean_curvature:.6g}")
        self.mean_curvature, self.steps = mean_curvature, steps


@dataclass(frozen=True)
class Reached:
    """A film reached along a path.

    Attributes
    ----------
    equilibrium : Equilibrium
    steps : int
        Newton steps on the whole path.
    """

    equilibrium: Equilibrium
    steps: int


def along_volume(
    start: Equilibrium, target: float, detail: Detail, *, sign: float = 0.0, unstable: bool = False
) -> Reached:
    """Follow the films of growing or falling volume until their mean curvature is the wanted one.

    Parameters
    ----------
    start : Equilibrium
        A stable film.
    target : float
        H, 1/m.
    detail : callable
    sign : float
        Of the volume steps; 0: towards the target.
    unstable : bool
        Stop at the target only behind a fold.

    Raises
    ------
    FoldError
        The stable films end before the target.
    NoFilmError
        The path breaks.
    """
    sign = sign or -float(np.sign(target - start.mean_curvature))
    film = start.film
    area = float(np.linalg.norm(np.ptp(film.nodes, axis=0))) ** 2 / 3
    first = step = 0.04 * film.size * area
    # points of the path: volume, mean curvature, film
    path = [(0.0, start.mean_curvature, film)]
    steps, folded = 0, False
    for _ in range(MOST_STEPS):
        volume, curvature, film = path[-1]
        try:
            here = find_equilibrium(film, curvature, volume=sign * step, stable=False, most_steps=12)
            steps += here.steps
        except NoFilmError as error:
            steps += 12
            step /= 2
            if step < LEAST_STEP * first or steps > MOST_NEWTON:
                raise NoFilmError(f"the path of films breaks at H = {curvature:.5g} 1/m ({error})") from None
            continue
        now = here.mean_curvature
        detail(f"    volume {volume + sign * step:+.5g} m3: H = {now:.6g} 1/m ({here.steps} steps)")
        turned = (now - curvature) * sign > 0
        if turned and len(path) == 1 and step > LEAST_STEP * first:
            # the fold lies within the first step: it has to be seen from this side
            step /= 4
            continue
        if len(path) > 1 and turned and not folded:
            extreme = _extreme([*path[-2:], (volume + sign * step, now, film)])
            passed = (extreme - target) * (curvature - target) <= 0
            if not unstable and passed and step > LEAST_STEP * first:
                # the target lies within this step, twice: once before the fold
                path.pop()
                step /= 4
                continue
            if not unstable:
                raise FoldError(extreme, steps)
        folded = folded or turned
        if (now - target) * (curvature - target) <= 0 and now != curvature and folded == unstable:
            nearer = here.film if abs(now - target) < abs(curvature - target) else film
            final = find_equilibrium(nearer, target, stable=False, detail=detail)
            return Reached(final, steps + final.steps)
        film = here.film
        if least_angle(film).min() < SLENDER:
            film = renewed(film)
        path.append((volume + sign * step, now, film))
        if here.steps <= 5:
            step *= 1.4
    raise NoFilmError(f"no film of H = {target:.5g} 1/m within {MOST_STEPS} steps of volume (last H = {now:.5g} 1/m)")


def _extreme(points: Sequence[tuple[float, float, Film]]) -> float:
    """Extreme of the parabola through three points (volume, H)."""
    volume, curvature = (np.array([point[k] for point in points], float) for k in (0, 1))
    a, b, c = np.polyfit(volume - volume[1], curvature, 2)
    return float(c - b * b / (4 * a))


def renewed(film: Film, share: float = 1.0) -> Film:
    """The film with elements made anew, as small as its loops and its bend ask for."""
    film = settled_rims(film)
    return straightened(with_sizes(film, start_sizes(film, film.loops, share)))


@dataclass(frozen=True)
class Morphed:
    """A loop on its way from a flat one.

    Attributes
    ----------
    loop : Loop
        Where it ends.
    flat : CubicSpline
        Where it begins: points (n, 3) over the parameter.
    share : float
        Part of the way.
    """

    loop: Loop
    flat: CubicSpline
    share: float
    slides: tuple[()] = ()

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

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""
        t = np.asarray(t, float) % 1
        return np.asarray(self.share * self.loop.at(t) + (1 - self.share) * self.flat(t))


class BreakError(ArithmeticError):
    """The path of films from flat loops breaks.

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


def along_boundary(chart: Chart, loops: tuple[Loop, ...], order: int, detail: Detail) -> Reached:
    """Follow the minimal films from flat loops to the given ones.

    The flat loops are the rims of the chart, mapped affinely to lie as near to the given ones as they can: there the
    film is the chart itself.

    Raises
    ------
    BreakError
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

    def held(share: float) -> tuple[Morphed, ...]:
        return tuple(Morphed(loop, spline, share) for loop, spline in zip(loops, splines, strict=True))

    share, step, steps = 0.0, 0.125, 0
    try:
        chart_mesh = TriangleMesh(flat, chart.faces, chart.loop, chart.parameter)
        film = on_surface(Film.on_mesh(chart_mesh, held(0.0), 1), order, 0.7)
        while share < 1:
            wanted = min(1.0, share + step)
            moved = Film.on_mesh(film.mesh, held(wanted), order)
            nodes = film.nodes.copy()
            rim = film.connectivity.rim_nodes
            nodes[rim] = moved.nodes[rim]
            try:
                here = find_equilibrium(harmonic_over_itself(moved.at(nodes)), 0.0, most_steps=15)
            except NoFilmError as error:
                steps += 15
                step /= 2
                if step < 1 / 256 or steps > MOST_NEWTON:
                    raise BreakError(share, steps, str(error)) from None
                continue
            steps += here.steps
            detail(f"    boundary at {wanted:.3f} of its way from flat ({here.steps} steps)")
            share, step = wanted, step * 1.5
            film = here.film
            if least_angle(film).min() < SLENDER:
                film = renewed(film, 0.7)
        film = Film.on_mesh(film.mesh, loops, order).at(film.nodes)
        final = find_equilibrium(film, 0.0, detail=detail)
    except NoFilmError as error:
        raise BreakError(share, steps, str(error)) from None
    return Reached(final, steps + final.steps)

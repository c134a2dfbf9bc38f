"""Films and directions of lamellas: this program beside mesh tools, on the same boundary curves.

The curves lie on surfaces known in closed form, so every error is known: a patch of Enneper's surface (H = 0) and one
of an unduloid. Each program gets points of the curve and H, finds the surface and tells the principal directions
inside; lamellas bisect these, so an error of a direction is one of the lamella, and what a node gets off its place in
the net. Angles in degrees to the exact directions at the closest point of the exact surface: the median, 95 % and the
largest over the inner vertices (mesh tools: without those on the boundary) or over all places of the elements
(this program: up to the boundary). CPU seconds of one thread from the curve to the directions, imports left out.

Peers run in an environment of their own, `.venv-bench` (`make bench` makes it from pins-bench.txt).
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from bench import Limit, Table, clocked, factorisations, show
from scipy.spatial import cKDTree

import lamella
from lamella.surface.closed_forms.closed_form import ClosedForm

HERE = Path(__file__).parent
PYTHON = HERE.parent / ".venv-bench" / ("Scripts" if os.name == "nt" else "bin") / "python"
PEERS = {
    "linear_newton": ("P1 Newton (scipy), libigl directions", "libigl", (16, 32, 64, 128)),
    "scikit_fem": ("scikit-fem, P2 graph", "scikit-fem", (8, 16, 32, 64)),
}
"""Program: name, the distribution that it needs, rings of its meshes."""

OURS = "this program"
TOLERANCES = (2e-2, 2e-3, 5e-4, 1e-4)
POINTS = 1600
"""Of a boundary curve; every fourth makes the spline that this program gets."""

SLOPE_STEP = 1e-6
"""Of the parameters, for slopes: they lead to the closest point, whose own error is that of its surface alone."""


class Patch(NamedTuple):
    """A piece of a closed form inside a closed curve of its parameter plane, turned so that it lies over a plan."""

    name: str
    surface: ClosedForm
    middle: complex
    radius: float

    def curve(self) -> Any:
        """Points (n, 3), counter-clockwise about the normal."""
        t = np.arange(POINTS) * 2 * np.pi / POINTS
        points = self.surface.at(self.middle + self.radius * np.exp(1j * t)).position
        area = np.cross(points, np.roll(points, -1, 0)).sum(0)
        return points if area @ self.surface.at(np.array([self.middle])).normal[0] > 0 else points[::-1].copy()

    def turned(self) -> Any:
        """Rotation (3, 3) that takes the vector area of the curve to the z axis."""
        points = self.curve()
        up = np.cross(points, np.roll(points, -1, 0)).sum(0)
        up /= np.linalg.norm(up)
        first = np.linalg.svd(up[None])[2][1]
        return np.array([first, np.cross(up, first), up])

    def errors(self, points: Any, one: Any, other: Any | None = None) -> Any:
        """Degrees between directions and the exact ones at the closest points."""
        grid = self.middle + self.radius * 1.05 * _disc_grid()
        where = grid[cKDTree(self.surface.at(grid).position).query(points)[1]]
        # Gauss and Newton; the parameters are conformal: both slopes are of one length and square to each other
        for _ in range(20):
            gap, along_u, along_v = points - self._position(where), self._slope(where, 1), self._slope(where, 1j)
            shift = ((gap * along_u).sum(1) + 1j * (gap * along_v).sum(1)) / (along_u**2).sum(1)
            where = where + shift
            if abs(shift).max() < 1e-12:
                break
        first = self.surface.at(where).principal_directions[0]
        angles = [_line_angle(first, one)] + ([] if other is None else [_line_angle(first, other)])
        # which of its two directions a program puts first depends on its normal
        return min(angles, key=np.median)

    def _position(self, where: Any) -> Any:
        return self.surface.at(where).position

    def _slope(self, where: Any, direction: complex) -> Any:
        step = SLOPE_STEP * direction
        return (self._position(where + step) - self._position(where - step)) / (2 * SLOPE_STEP)


def _disc_grid() -> Any:
    steps = np.linspace(-1, 1, 121)
    grid = (steps[:, None] + 1j * steps).ravel()
    return grid[abs(grid) <= 1]


def _line_angle(one: Any, other: Any) -> Any:
    other = other / np.linalg.norm(other, axis=1)[:, None]
    return np.rad2deg(np.arcsin(np.minimum(np.linalg.norm(np.cross(one, other), axis=1), 1)))


PATCHES = (
    Patch("Enneper", lamella.Enneper(2, 0.9, 1.0), 0.0, 0.6),
    Patch("unduloid", lamella.Unduloid(1.6, 2.8, (-4.0, 4.0)), 0.15 + 0.2j, 0.6),
)


def ours(patch: Patch, tolerance: float) -> dict[str, Any]:
    """A row of this program."""
    points = patch.curve()
    loop = lamella.spline(points[::4])

    def work() -> Any:
        film = lamella.film([loop], mean_curvature=patch.surface.mean_curvature, tolerance=tolerance)
        return film, film.at(film.check_places())

    with factorisations() as inside:
        seconds, (film, found) = clocked(work)
    angles = patch.errors(found.position, found.principal_directions[0])
    return _row(OURS, f"tolerance {tolerance:g}", len(film.nodes), seconds, angles) | {
        "s / factorisations": seconds / inside.total
    }


def peer(program: str, patch: Patch, size: int) -> dict[str, Any]:
    """A row of another one."""
    turn = patch.turned()
    with tempfile.TemporaryDirectory() as folder:
        given, result = Path(folder) / "given.npz", Path(folder) / "result.npz"
        curve = patch.curve() @ turn.T
        np.savez(given, curve=curve, mean_curvature=patch.surface.mean_curvature, size=size)
        subprocess.run([PYTHON, HERE / "peers" / f"{program}.py", given, result], check=True)
        found = dict(np.load(result))
    angles = patch.errors(found["points"] @ turn, found["one"] @ turn, found["other"] @ turn)
    return _row(PEERS[program][0], f"{size} rings", int(found["unknowns"]), float(found["seconds"]), angles)


def _row(program: str, size: str, unknowns: int, seconds: float, angles: Any) -> dict[str, Any]:
    return {
        "program": program,
        "size": size,
        "nodes": unknowns,
        "CPU s": seconds,
        "median, deg": float(np.median(angles)),
        "95 %, deg": float(np.quantile(angles, 0.95)),
        "largest, deg": float(angles.max()),
    }


def available() -> tuple[dict[str, str], list[str]]:
    """Versions of the peers' packages, and why others are left out."""
    if not PYTHON.exists():
        return {}, [f"peers: no {PYTHON.parent.parent.name} (`make bench` makes it from pins-bench.txt)"]
    versions, missing = {}, []
    for program, (name, package, _) in PEERS.items():
        code = f"from importlib.metadata import version; print(version({package!r}))"
        done = subprocess.run([PYTHON, "-c", code], capture_output=True, text=True, check=False)
        if done.returncode:
            missing.append(f"{name}: no {package} in {PYTHON.parent.parent.name}")
        else:
            versions[program] = f"{package} {done.stdout.strip()}"
    return versions, missing


ABOUT = " ".join(__doc__.split("\n\n")[1].split()) if __doc__ else ""


def tables() -> Iterator[Table]:
    """A table a patch."""
    versions, missing = available()
    for patch in PATCHES:
        rows = [ours(patch, tolerance) for tolerance in (TOLERANCES[0], *TOLERANCES)][1:]
        for program in versions:
            rows += [peer(program, patch, size) for size in PEERS[program][2]]
        name, curvature = patch.name, patch.surface.mean_curvature
        yield Table(
            f"Directions of lamellas: a patch of the {name}, H = {curvature:.4g} 1/m",
            ABOUT + f" Peers: {', '.join(versions.values()) or 'none'}.",
            tuple(rows),
            tuple(_limits(rows)),
            tuple(missing),
        )


def _limits(rows: list[dict[str, Any]]) -> Iterator[Limit]:
    """The same largest error, or a smaller one, in less time than any peer takes for its best."""
    for name in dict.fromkeys(row["program"] for row in rows if row["program"] != OURS):
        error, best = min((row["largest, deg"], row["CPU s"]) for row in rows if row["program"] == name)
        as_good = [row["CPU s"] for row in rows if row["program"] == OURS and row["largest, deg"] <= error]
        if as_good:
            yield Limit(f"CPU s of this program for an error of {error:.2g} deg / {name}", min(as_good) / best, 1.0)


if __name__ == "__main__":
    show(tables())

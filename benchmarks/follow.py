"""What a moved boundary point costs: frames of the oculus example, followed, beside their factorisations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from bench import Limit, Row, Table, clocked, factorisations, show

import lamella
from lamella import read_project

EXAMPLE = Path(__file__).parents[1] / "examples" / "13_oculus.toml"
# tolerances of films with about 1,300, 3,600 and 9,300 nodes, with the limits of a whole net, s
SIZES: tuple[tuple[float, float | None], ...] = ((3e-2, None), (1e-2, 0.35), (2e-3, 1.0))
COARSE_LIMIT, COARSE_RATIO = 0.15, 6.0
FRAMES, MOVES, FROM_NOTHING = 9, 200, 2


def points() -> np.ndarray:
    """Of the rim, (24, 3), m."""
    surface: Any = read_project(EXAMPLE).surface
    return np.array(surface.boundary[0].points)


def boundary(rim: np.ndarray) -> list[lamella.Loop]:
    """Rim and oculus."""
    return [lamella.spline(rim), lamella.circle((0, 0, 2.0), 1.3)]


def moved(draws: np.random.Generator) -> np.ndarray:
    """The rim with one of its points moved by some centimetres."""
    rim = points()
    rim[draws.integers(len(rim))] += 0.02 * draws.normal(size=3)
    return rim


def tables() -> Iterator[Table]:
    """Frames by size, and the drift after many."""
    yield _frames()
    yield _drift()


def _frames() -> Table:
    rows: list[Row] = []
    limits: list[Limit] = []
    for tolerance, whole_limit in SIZES:
        row = _row(tolerance)
        rows.append(row)
        nodes = f"{row['surface nodes']:,} nodes"
        if whole_limit:
            limits.append(Limit(f"whole net at {nodes}, s", float(row["whole net, s"]), whole_limit))
        else:
            limits.append(Limit(f"level lines at {nodes}, s", float(row["level lines, s"]), COARSE_LIMIT))
            ratio = float(row["level lines / factorisations"])
            limits.append(Limit(f"level lines / factorisations at {nodes}", ratio, COARSE_RATIO))
    return Table(
        "A boundary that is followed",
        "The oculus example with one point of its rim moved at random by some centimetres: loops made and checked, "
        "film, isothermic coordinates and level lines (what is drawn while a point is dragged), or the whole net with "
        "its figures; medians.",
        tuple(rows),
        tuple(limits),
    )


def _row(tolerance: float) -> dict[str, Any]:
    """Frames of films of one tolerance."""
    film = lamella.follow(boundary(points()), tolerance=tolerance)
    net = lamella.follow_net(film.surface, cells=24)
    # what is worked out once a reference
    net.at(film.surface).lines, replace(net).network
    draws = np.random.default_rng(13)
    coarse, ratios, whole, anew = [], [], [], 0
    for _ in range(FRAMES):
        rim = moved(draws)
        with factorisations() as inside:
            seconds, made_anew = clocked(partial(_lines, film, net, rim))
        coarse.append(seconds)
        ratios.append(seconds / inside.total)
        whole.append(clocked(partial(_whole, film, net, rim))[0])
        anew += made_anew
    nothing = [clocked(partial(_from_nothing, moved(draws), tolerance))[0] for _ in range(FROM_NOTHING)]
    return {
        "surface nodes": len(film.surface.nodes),
        "net's elements, nodes": net.coordinates.mesh.connectivity.node_count,
        "level lines, s": median(coarse),
        "level lines / factorisations": median(ratios),
        "whole net, s": median(whole),
        "from nothing, s": median(nothing),
        "made anew": anew,
    }


def _lines(film: lamella.FollowedFilm, net: lamella.FollowedNet, rim: np.ndarray) -> bool:
    """Level lines of a changed rim; whether anything was made anew."""
    there = film.at(boundary(rim))
    followed = net.at(there.surface)
    followed.lines  # noqa: B018
    return bool(there.made_anew or followed.made_anew)


def _whole(film: lamella.FollowedFilm, net: lamella.FollowedNet, rim: np.ndarray) -> lamella.Network:
    """The whole net of a changed rim."""
    return net.at(film.at(boundary(rim)).surface).network


def _from_nothing(rim: np.ndarray, tolerance: float) -> lamella.Network:
    return lamella.net(lamella.film(boundary(rim), tolerance=tolerance), cells=24)


def _drift() -> Table:
    first = lamella.follow(boundary(points()), tolerance=SIZES[0][0])
    net = lamella.follow_net(first.surface, cells=24)
    draws = np.random.default_rng(200)
    film, there, anew = first, net, 0
    for _ in range(MOVES):
        film = film.at(boundary(moved(draws)))
        there = there.at(film.surface)
        anew += bool(film.made_anew) + bool(there.made_anew)
    film = film.at(boundary(points()))
    there = there.at(film.surface)
    size = film.equilibrium.film.size
    film_drift = float(np.abs(film.surface.nodes - first.surface.nodes).max()) / size
    net_drift = float(np.abs(there.network.node_points - net.network.node_points).max()) / size
    return Table(
        f"{MOVES} moves and back",
        "The same film and net after as many random moves of single points, and back: largest distance from the first "
        "ones over the size.",
        ({"moves": MOVES, "made anew": anew, "film": film_drift, "nodes of the net": net_drift},),
        (Limit("drift of the film", film_drift, 1e-9), Limit("drift of the net", net_drift, 1e-9)),
    )


if __name__ == "__main__":
    show(tables())

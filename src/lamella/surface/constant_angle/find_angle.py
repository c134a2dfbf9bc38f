"""From boundary loops to the surface on which lamellas of one normal curvature cross at one angle.

The film of mean curvature c is the surface of 90 degrees. From there one step leads to the angle, or, where it fails,
smaller ones: the angle, and c where that film does not exist, go on a straight way, elements being made anew on it.
Only a surface whose own second derivatives keep the relation is taken: on coarse elements rounds settle beyond the last
surface too. Where no step leads on the surface there is the last, and its angle is told.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, patient, silent
from lamella.base.wording import counted, rounded
from lamella.surface.constant_angle.angle_surface import AngleSurface
from lamella.surface.constant_angle.refined import Refined, refined
from lamella.surface.constant_angle.relation import Relation
from lamella.surface.constant_angle.rounds import varying_of
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.form_finding.film import Film, Loop, NoFilmError
from lamella.surface.form_finding.find import find_film
from lamella.surface.form_finding.self_crossing import self_crossing

WAY_TOLERANCE = 1e-2
"""Of the elements on the way."""
START_TOLERANCE = 2e-2
"""Of the film that it starts from."""
LEAST_ANGLE_STEP = 0.1
"""deg: the last angle is told to about this."""
WAY_STEPS_MAX = 40
TOLERANCE_SHARE = 0.5
"""What A k1 + B k2 may be off by, of the tolerance: directions come from the measured curvature, not from a known H."""
MOST_TOLD = 6
"""Umbilics that a note names by their places."""


@dataclass(frozen=True)
class FoundAngle:
    """A surface of constant node angle and how it was found.

    Attributes
    ----------
    refined : Refined
    relation : Relation
    steps : int
        On the way from 90 degrees.
    """

    refined: Refined
    relation: Relation
    steps: int

    def surface(self, kind: str, notes: tuple[Message, ...] = (), **figures: Any) -> AngleSurface:
        """The surface as later stages see it, with further figures for the summary."""
        film, deviation = self.refined.film, self.refined.deviation
        rim = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
        known = {
            "stability": None,
            "order": film.connectivity.basis.order,
            "surface_nodes": film.connectivity.node_count,
            "elements": len(film.connectivity.elements),
            "rounds": self.refined.rounds,
            "continuation": self.steps > 1,
            "curvature_scale": deviation.scale,
            "mean_curvature_deviation": deviation.largest,
            "mean_curvature_deviation_max": deviation.largest * deviation.scale,
        }
        mean, area = _mean_curvatures(film)
        return AngleSurface(
            kind,
            float((mean * area).sum() / area.sum()),
            film.connectivity,
            film.nodes,
            rim,
            known | figures,
            notes,
            film.loop_starts(),
            film.slide_ends(),
            angle=self.relation.angle,
            normal_curvature=self.relation.normal_curvature,
        )


def find_angle(
    loops: tuple[Loop, ...],
    angle: float,
    normal_curvature: float = 0.0,
    *,
    order: int = 4,
    tolerance: float = 2e-3,
    most_nodes: int = 100_000,
    progress: Progress = silent,
) -> FoundAngle:
    """The surface in boundary loops on which lamellas of one normal curvature cross at one angle.

    Parameters
    ----------
    loops : tuple of Loop
        The outer one first; the surface's normal follows it by the right-hand rule.
    angle : float
        Between the lamellas, bisected by the direction of the larger principal curvature, degrees.
    normal_curvature : float
        Of the lamellas, c, 1/m.
    order, most_nodes
        Of the elements, see `find_film`.
    tolerance : float
        Half of it is the largest |A k1 + B k2 - c| at the check points, over the curvature scale.
    progress : callable

    Raises
    ------
    InputError
        There is no such surface, or none could be found: with the last angle that was.
    """
    progress = patient(progress)
    wanted = Relation(angle, normal_curvature)
    if any(loop.slides for loop in loops):
        raise InputError(
            "parts of the boundary slide, and a surface of another node angle than 90 deg is in no equilibrium that "
            "slides",
            "hold the whole boundary: take slide out, or write angle = 90",
            "loops",
        )
    aim = TOLERANCE_SHARE * tolerance
    start, film = _begin(loops, wanted, order, most_nodes, progress)
    try:
        last, steps = _way(film, start, wanted, max(aim, WAY_TOLERANCE), most_nodes, progress)
        found = refined(last, wanted, aim, most_nodes, progress)
    except NoFilmError as error:
        raise InputError(
            f"a surface of {angle:g} deg breaks on finer elements: {error}",
            "choose an angle nearer to 90, or make the boundary less bent",
            "angle",
        ) from None
    off = found.deviation
    if found.shortfall and off.largest > aim:
        raise InputError(
            f"A k1 + B k2 is off by up to {off.largest:.2g} of the curvature scale {off.scale:.3g} 1/m, more than "
            f"half of tolerance = {tolerance:g}, near ({coordinates(_worst(found))}) m: {found.shortfall}",
            f"write tolerance = {rounded(2.4 * off.largest, up=True, digits=1):g}, raise most_nodes, or make the "
            "boundary smoother there",
            "tolerance",
        )
    progress(Report.step(f"{angle:g} deg: {found.rounds} rounds on {found.film.connectivity.node_count:,} nodes"))
    return FoundAngle(found, wanted, steps)


def _begin(
    loops: tuple[Loop, ...], wanted: Relation, order: int, most_nodes: int, progress: Progress
) -> tuple[Relation, Film]:
    """The film that the way starts from: of mean curvature c, or the minimal one where there is none of that.

    Raises
    ------
    InputError
        There is neither.
    """
    for curvature in dict.fromkeys((wanted.normal_curvature, 0.0)):
        try:
            found = find_film(
                loops, curvature, order=order, tolerance=START_TOLERANCE, most_nodes=most_nodes, progress=progress
            )
        except InputError as error:
            refused = error
            continue
        return Relation(90.0, curvature), found.equilibrium.film
    raise refused


def _way(
    film: Film, start: Relation, wanted: Relation, tolerance: float, most_nodes: int, progress: Progress
) -> tuple[Film, int]:
    """A film near that of the wanted relation, and in how many steps it was reached.

    Raises
    ------
    InputError
        The way ends before.
    """
    least = LEAST_ANGLE_STEP / max(abs(wanted.angle - start.angle), LEAST_ANGLE_STEP)
    done, step = 0.0, 1.0
    for number in range(1, WAY_STEPS_MAX + 1):
        next_ = min(done + step, 1.0)
        here = wanted.between(next_, start) if next_ < 1 else wanted
        try:
            made = refined(film, here, tolerance, most_nodes, progress)
            if made.shortfall:
                raise NoFilmError(made.shortfall, made.film)
        except NoFilmError as error:
            progress(Report.step(f"{here.angle:.5g} deg: {error}"))
            step /= 2
            if step < least:
                break
            continue
        film, done = made.film, next_
        if done >= 1:
            return film, number
    reached = wanted.between(done, start)
    raise InputError(
        f"no surface of angle = {wanted.angle:g} deg and normal curvature {wanted.normal_curvature:g} 1/m was found in "
        f"this boundary: the way from 90 deg ends at {reached.angle:.5g} deg"
        + (f" and {reached.normal_curvature:.4g} 1/m" if start.normal_curvature != wanted.normal_curvature else ""),
        f"write angle = {_inside(reached.angle):g}, or bring the loops nearer to each other",
        "angle",
    )


def _mean_curvatures(film: Film) -> tuple[Floats, Floats]:
    """H at places of a film, 1/m, and the area that each stands for, m2."""
    points, weights = triangle_rule(6)
    surface = varying_of(film)
    there = surface.frames_everywhere(points)
    area = np.tile(weights, len(film.connectivity.elements)) / np.abs(np.linalg.det(there.to_local))
    return surface.shape_everywhere(points)[0], area


def _inside(angle: float) -> float:
    """An angle a little nearer to 90, of one decimal."""
    return float(np.floor(10 * angle) / 10 if angle > 90 else np.ceil(10 * angle) / 10)


def _worst(found: Refined) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Middle of the element that is farthest off, (3,), m."""
    film = found.film
    return np.asarray(film.nodes[film.connectivity.faces[found.deviation.of_element.argmax()]].mean(0))


def notes_on_angle(found: FoundAngle) -> tuple[Message, ...]:
    """What a user should know about such a surface before building it."""
    notes = []
    umbilics = varying_of(found.refined.film).umbilics
    if len(umbilics.orders):
        places = "; ".join(f"({coordinates(point)}) m" for point in umbilics.position[:MOST_TOLD])
        c = found.relation.normal_curvature
        what = "flat points" if c == 0 else f"points of curvature {c:g} 1/m to all sides"
        notes.append(
            Message(
                "angle_umbilics",
                f"{counted(len(umbilics.orders), 'umbilic')} ({what}) at {places}"
                f"{'; ...' if len(umbilics.orders) > MOST_TOLD else ''}: lamellas have no direction there, and turn "
                "quickly beside them",
            )
        )
    crossing = self_crossing(found.refined.film)
    if crossing is not None:
        place = crossing[np.linalg.norm(crossing - crossing.mean(0), axis=1).argmin()]
        notes.append(
            Message(
                "surface_crosses",
                f"the surface passes through itself, as near ({coordinates(place)}) m: it is a surface of this "
                "boundary, but cannot be built",
            )
        )
    return tuple(notes)

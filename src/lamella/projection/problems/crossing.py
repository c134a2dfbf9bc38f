"""The angle at which both families of polylines cross, as blocks and constraints of a problem."""

from __future__ import annotations

from typing import Literal

import numpy as np

from lamella.projection.constraint import Constraint
from lamella.projection.constraints.circle_angle import CircleAngle
from lamella.projection.constraints.equal_diagonals import EqualDiagonals
from lamella.projection.constraints.node_angle import NodeAngle
from lamella.projection.constraints.right_angle import RightAngle
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.unknowns import Block, Integers, dot

RightAngleForm = Literal["circles", "chords", "faces"]
"""Where a right angle between polylines is measured: three answers that differ by O(e^2).

circles
    At the vertices, between the circles through previous, own and next vertex (`CircleAngle`).
chords
    At the vertices, between the chords of opposite neighbours (`RightAngle`).
faces
    In the faces, between the lines that join the middles of opposite sides (`EqualDiagonals`).
"""


def crossing(mesh: QuadMesh, angle: float, form: RightAngleForm) -> tuple[list[Block], list[Constraint]]:
    """What is needed for the angle, besides the vertices.

    Parameters
    ----------
    mesh : QuadMesh
        Where the problem starts.
    angle : float
        Degrees; it or its supplement, whichever is nearer to the mesh.
    form : "circles", "chords" or "faces"
        Of a right angle; other angles are between chords.

    Raises
    ------
    InputError
        For angles other than 90: the polylines form no two families.
    """
    if angle == 90:
        return [], [_right_angle(mesh, form)]
    stars = _ordered_stars(mesh)
    v = mesh.vertices[stars]
    p, q = v[:, 0] - v[:, 2], v[:, 1] - v[:, 3]
    # acute in one family is obtuse in the other: which of both the net has already
    angle = angle if dot(p, q).mean() * np.cos(np.radians(angle)) >= 0 else 180 - angle
    chords = Block("chords", np.sqrt(np.concatenate([dot(p, p), dot(q, q)], 1)), mesh.mean_edge)
    return [chords], [NodeAngle(name="angle", stars=stars, angle=angle, edge=mesh.mean_edge)]


def _right_angle(mesh: QuadMesh, form: RightAngleForm) -> Constraint:
    if form == "faces":
        # around a singular vertex corners share a full turn in other parts than quarters
        regular = ~np.isin(mesh.faces, mesh.singular).any(1)
        return EqualDiagonals(name="right angle", faces=mesh.faces[regular], edge=mesh.mean_edge)
    stars = mesh.stars(mesh.inner)
    if form == "chords":
        return RightAngle(name="right angle", stars=stars, edge=mesh.mean_edge)
    return CircleAngle(name="right angle", middles=mesh.inner, stars=stars, edge=mesh.mean_edge)


def _ordered_stars(mesh: QuadMesh) -> Integers:
    """Stars of the regular inner vertices that begin with a neighbour along the first family."""
    stars, families = mesh.stars(mesh.inner), mesh.families
    second = families[mesh.leaving(mesh.inner)] == 1
    return np.where(second[:, None], np.roll(stars, 1, axis=1), stars)

"""The angle at which both families of polylines cross, as blocks and constraints of a problem."""

from __future__ import annotations

from typing import Literal

import numpy as np

from lamella.base.arrays import Integers
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.equal_diagonals import EqualDiagonals
from lamella.projection.constraints.inverted_edge import InvertedEdge, inverses
from lamella.projection.constraints.node_angle import NodeAngle
from lamella.projection.constraints.right_angle import RightAngle, chords
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.unknowns import Block, dot

AngleForm = Literal["circles", "chords", "faces"]
"""Where the angle between polylines is measured: three answers that differ by O(e^2).

circles
    At the vertices, between the circles through previous, own and next vertex (`InvertedEdge`).
chords
    At the vertices, between the chords of opposite neighbours.
faces
    In the faces, between the lines that join the middles of opposite sides (`EqualDiagonals`): right angles only.
"""


def crossing(mesh: QuadMesh, angle: float, form: AngleForm) -> tuple[list[Block], list[Constraint]]:
    """What is needed for the angle, besides the vertices.

    Parameters
    ----------
    mesh : QuadMesh
        Where the problem starts.
    angle : float
        Degrees; it or its supplement, whichever is nearer to the mesh.
    form : "circles", "chords" or "faces"
        How it is measured; "faces" for right angles only.

    Raises
    ------
    InputError
        For angles other than 90: the polylines form no two families.
    """
    edge = mesh.mean_edge
    if angle == 90 and form == "faces":
        # around a singular vertex corners share a full turn in other parts than quarters
        regular = ~np.isin(mesh.faces, mesh.singular).any(1)
        return [], [EqualDiagonals(name="right angle", faces=mesh.faces[regular], edge=edge)]
    blocks: list[Block] = []
    constraints: list[Constraint] = []
    stars = mesh.stars(mesh.inner) if angle == 90 else _ordered_stars(mesh)
    points, block, size = mesh.vertices, "vertices", edge
    if form == "circles":
        # each leg its own, though an edge is a leg of two stars: unknowns of one star only cause no fill
        legs = np.column_stack([np.repeat(mesh.inner, 4), stars.ravel()])
        points, block, size = inverses(mesh.vertices, legs, edge), "inverse edges", 1.0
        stars = np.arange(len(legs)).reshape(-1, 4)
        blocks.append(Block(block, points))
        constraints.append(InvertedEdge(name="inverse edges", edges=legs, edge=edge))
    if angle == 90:
        constraints.append(RightAngle(name="right angle", stars=stars, edge=size, block=block))
        return blocks, constraints
    p, q = chords(tuple(points[stars[:, j]] for j in range(4)))
    # acute in one family is obtuse in the other: which of both the net has already
    angle = angle if dot(p, q).mean() * np.cos(np.radians(angle)) >= 0 else 180 - angle
    blocks.append(Block("chords", np.sqrt(np.concatenate([dot(p, p), dot(q, q)], 1)), size))
    constraints.append(NodeAngle(name="angle", stars=stars, angle=angle, edge=size, block=block))
    return blocks, constraints


def _ordered_stars(mesh: QuadMesh) -> Integers:
    """Stars of the regular inner vertices that begin along the first family."""
    spokes = mesh.spokes(mesh.inner)
    second = mesh.families[spokes[:, 0]] == 1
    return np.asarray(mesh.head[np.where(second[:, None], np.roll(spokes, 1, axis=1), spokes)])

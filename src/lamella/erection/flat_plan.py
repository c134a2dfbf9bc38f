"""The flat net in its plane: curves of its lamellas, their order on the floor, joints and angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ties import grid_of, rounded
from lamella.erection.erection import Erection
from lamella.network.network import FAMILIES
from lamella.structure.beam.helices import points_between

# pieces an element that its curve is drawn with
DRAWN_PIECES = 4


@dataclass(frozen=True, eq=False)
class FlatPlan:
    """A flat net as it is drawn, m, along the axes of its floor.

    Attributes
    ----------
    lines, sides : tuple of (k, 2)
        Of each lamella: points, and unit vectors to its left.
    joints : (j, 2)
        Places of `Model.joint_nodes`.
    nodes : (n, 2)
        Of the network.
    order : (m,) int
        Lamellas in the order in which they are laid: all A from one side to the other, then all B.
    """

    lines: tuple[Floats, ...]
    sides: tuple[Floats, ...]
    joints: Floats
    nodes: Floats
    order: Integers

    @classmethod
    def of(cls, erection: Erection) -> FlatPlan:
        """Of the first state."""
        model, plane = erection.model, erection.flat.plane
        lines, poses = model.lines, erection.states[0].poses
        points, frames = model.structure.beams.attachment.ends(poses)
        own = slice(0, len(lines.length))
        along, turned = points_between(points[own], frames[own], np.arange(DRAWN_PIECES + 1) / DRAWN_PIECES)
        centre, left = plane.project(along), (turned[..., 1] @ plane.axes[:2].T)
        elements = [np.flatnonzero(lines.lamella == number) for number in range(len(model.lamellas.network.ids))]
        drawn = tuple(_joined(centre[one]) for one in elements)
        nodes = plane.project(poses.points[: model.nodes])
        return cls(
            drawn,
            tuple(_joined(left[one]) for one in elements),
            nodes[model.joint_nodes],
            nodes,
            _order(drawn, model.lamellas.network.families),
        )


def _joined(pieces: Floats) -> Floats:
    """Points (e, p + 1, 2) of elements one behind the other as one line."""
    return np.concatenate((pieces[:, :-1].reshape(-1, 2), pieces[-1:, -1]))


def _order(lines: tuple[Floats, ...], families: np.ndarray) -> Integers:
    """All of a family across their mean direction, by the middle of each."""
    found = []
    size = max(float(np.abs(line).max(initial=0.0)) for line in lines)
    for family in FAMILIES:
        own = np.flatnonzero(families == family)
        if not len(own):
            continue
        chords = np.array([lines[k][-1] - lines[k][0] for k in own.tolist()])
        # lamellas have no sense: directions are added up to it
        angle = 0.5 * np.arctan2((2 * chords[:, 0] * chords[:, 1]).sum(), (chords[:, 0] ** 2 - chords[:, 1] ** 2).sum())
        across = np.array([-np.sin(angle), np.cos(angle)])
        places = np.array([lines[k][len(lines[k]) // 2] @ across for k in own.tolist()])
        # from the side of the first one
        places *= -1.0 if places[0] > places[-1] else 1.0
        found.append(own[np.argsort(rounded(places, grid_of(size)), kind="stable")])
    return np.concatenate(found)

"""A plate that is folded once: as it is cut, and as it is built."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.flat import outline_points
from lamella.hardware.edge_rules import END_PITCH, FOLD_BEND
from lamella.hardware.item import Fold, Places
from lamella.hardware.shape import Bent, Prism, circle, rectangle

FINE = 0.002
"""m; longest piece of a plate's edges where it is drawn in place."""


@dataclass(frozen=True, eq=False)
class FoldedPlate:
    """Equal measures of end plates: fold (rad), thickness, height and legs from the corner, m."""

    fold: float
    thickness: float
    height: float
    leg: float
    first: float
    rest: float
    hole: float

    @property
    def radius(self) -> float:
        """Of the fold's middle surface, m."""
        return (FOLD_BEND + 0.5) * self.thickness

    @property
    def straight(self) -> tuple[float, float]:
        """Flat lengths of the legs: between the layers and on the beam, m."""
        tangent = self.radius * np.tan(self.fold / 2)
        return self.first + self.rest - tangent, self.leg - tangent

    def flat(self) -> Prism:
        """What is cut: x from the inner end on, y along the normal."""
        inner, outer = self.straight
        length = inner + self.radius * self.fold + outer
        screws = (self.rest - END_PITCH * self.hole, self.rest)
        holes = tuple(circle(self.hole, (x, 0.0)) for x in screws)
        half = self.thickness / 2
        return Prism(rectangle(length, self.height, (length / 2, 0.0)), -half, half, holes)

    def folds(self) -> tuple[Fold, ...]:
        """The fold: its middle is a line across the plate."""
        x = self.straight[0] + self.radius * self.fold / 2
        line = np.array([[x, -self.height / 2], [x, self.height / 2]])
        return (Fold(line, self.fold, FOLD_BEND * self.thickness),)

    def folded(self, flat: Floats, offset: float) -> Floats:
        """Points (v, 2) of the flat plate, `offset` above its middle, as it is folded, (v, 3), m.

        The corner of the legs' middle planes is the origin, the first leg ends there along x; it is folded towards z.
        """
        inner, _ = self.straight
        tangent = self.radius * np.tan(self.fold / 2)
        arc = np.clip((flat[:, 0] - inner) / self.radius, 0.0, self.fold)
        beyond = flat[:, 0] - inner - self.radius * arc
        # from the centre of the fold
        r = self.radius - offset
        x = -tangent + r * np.sin(arc) + beyond * np.cos(arc)
        z = self.radius - r * np.cos(arc) + beyond * np.sin(arc)
        return np.column_stack([x, flat[:, 1], z])


def folded_plates(plates: FoldedPlate, flat: Prism, places: Places) -> tuple[Bent, ...]:
    """The plates as they are folded, in their places."""
    rings = [_fine(outline_points(flat.outline)[:-1]), *(outline_points(hole)[-2::-1] for hole in flat.holes)]
    corners = np.concatenate(rings)
    low, high = (places.world(plates.folded(corners, side * plates.thickness / 2)) for side in (-1, 1))
    # across the plate a face is straight: flattened, triangles reach across it and not far along it
    flattened = np.array([1.0, FINE / plates.height])
    shape = tuple(ring * flattened for ring in rings)
    return tuple(Bent(shape, one, other) for one, other in zip(low, high, strict=True))


def _fine(corners: Floats) -> Floats:
    """A polygon with points at most `FINE` apart along x."""
    following = np.roll(corners, -1, axis=0)
    pieces = np.maximum(np.ceil(np.abs(following - corners)[:, 0] / FINE), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(corners)), pieces)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[owner]
    return np.asarray(corners[owner] + share[:, None] * (following - corners)[owner])

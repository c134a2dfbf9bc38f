"""Hardware: kinds of parts beside the strips, how many of each there are and where."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.message import Message
from lamella.base.result import Result
from lamella.base.wording import counted
from lamella.hardware.shape import Bent, Prism, Sweep


@dataclass(frozen=True, eq=False)
class Places:
    """Where equal pieces are: frames whose axes a piece's own are laid on.

    Attributes
    ----------
    origins : (q, 3)
        m.
    axes : (q, 3, 3)
        Rows are the unit vectors of the piece's x, y and z, right-handed.
    labels : tuple of str
        Where each of them is, in words of the lists: "node 12", "A3 at 1250 mm".
    """

    origins: Floats
    axes: Floats
    labels: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.origins)

    def chosen(self, some: Booleans | Integers) -> Places:
        """Those of some indices, or where a mask is true."""
        kept = np.flatnonzero(some) if some.dtype == bool else some
        return Places(self.origins[kept], self.axes[kept], tuple(self.labels[i] for i in kept.tolist()))

    def moved(self, by: Floats) -> Places:
        """The same frames, moved along their z axes by (q,), m."""
        return Places(self.origins + np.asarray(by)[:, None] * self.axes[:, 2], self.axes, self.labels)

    def world(self, points: Floats) -> Floats:
        """Points (v, 3) of a piece, in every place, (q, v, 3), m."""
        return np.asarray(self.origins[:, None] + np.einsum("vi,qij->qvj", points, self.axes))


@dataclass(frozen=True, eq=False)
class Fold:
    """A fold of a flat plate.

    Attributes
    ----------
    line : (2, 2)
        Middle of the fold across the plate as it is drawn, m.
    angle : float
        By which it is folded, up: towards who looks at the drawing, rad.
    radius : float
        Inside, m.
    """

    line: Floats
    angle: float
    radius: float

    @property
    def text(self) -> str:
        """What is engraved beside it: up, by so many degrees."""
        return f"UP {round(float(np.degrees(self.angle)), 2):g}"


@dataclass(frozen=True, eq=False, repr=False)
class Item(Result):
    """One kind of part: all its pieces are equal.

    Attributes
    ----------
    id : str
        "washer-1".
    kind : str
        "washer", "key", "bolt", "nut", "block", ...: figures are counted by it.
    description : str
        For the lists: size, standard.
    material : str
        Name.
    density : float
        kg/m3.
    shape : tuple of Prism or Sweep
    places : Places
        One a piece.
    plate : bool
        Whether it is cut from a sheet and drawn for the laser.
    length : float
        Of what is bought by the metre, m; 0 where that says nothing.
    bent : tuple of Bent
        Plates that are bent into place: each one as it is built; else empty.
    folds : tuple of Fold
        Where and how a plate is folded.
    pattern : Prism, optional
        What a bar is cut as before it is bent and twisted; of what has its shape when it is cut it is None.
    """

    id: str
    kind: str
    description: str
    material: str
    density: float
    shape: tuple[Prism | Sweep, ...]
    places: Places
    plate: bool = False
    length: float = 0.0
    bent: tuple[Bent, ...] = ()
    folds: tuple[Fold, ...] = ()
    pattern: Prism | None = None

    def _line(self) -> str:
        return f"{self.id}: {self.quantity} x {self.description}, {self.mass:.4g} kg each"

    @property
    def quantity(self) -> int:
        """Number of pieces."""
        return len(self.places)

    @property
    def mass(self) -> float:
        """Of one piece, kg."""
        return self.density * sum(one.volume for one in self.shape)

    @property
    def thickness(self) -> float:
        """Of a plate, m."""
        return self.cut.high - self.cut.low

    @property
    def cut(self) -> Prism:
        """What a plate is cut as.

        Raises
        ------
        ValueError
            It is none.
        """
        if self.pattern is not None:
            return self.pattern
        (shape,) = self.shape
        if not isinstance(shape, Prism):
            raise ValueError(f"{self.id} is no plate")
        return shape


@dataclass(frozen=True, eq=False, repr=False)
class Hardware(Result):
    """All parts of a structure beside its strips.

    Attributes
    ----------
    items : tuple of Item
    warnings : tuple of Message
        What the user should know about them.
    """

    items: tuple[Item, ...] = ()
    warnings: tuple[Message, ...] = ()

    def _line(self) -> str:
        pieces = sum(item.quantity for item in self.items)
        return f"{counted(len(self.items), 'kind')}, {counted(pieces, 'piece')}, {self.mass:.4g} kg"

    def __iter__(self) -> Iterator[Item]:
        return iter(self.items)

    def of(self, kind: str) -> tuple[Item, ...]:
        """The items of one kind."""
        return tuple(item for item in self.items if item.kind == kind)

    @property
    def mass(self) -> float:
        """Of all pieces, kg."""
        return sum(item.quantity * item.mass for item in self.items)

"""Named blocks of unknowns, and where each is in the one vector the solver moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError

Values = Mapping[str, Floats]
"""Values of all blocks by name, each (n, d)."""


@dataclass(frozen=True)
class Block:
    """Unknowns of one kind.

    Attributes
    ----------
    name : str
    values : (n, d)
        Where they start: n things of d components each; (n,) is n numbers.
    scale : float
        A change that counts as one: the mean edge for points, 1 for unit vectors. Steps and damping are measured
        in it.
    origin : (n, d), optional
        What drift is measured from; default: the start.
    """

    name: str
    values: Floats
    scale: float = 1.0
    origin: Floats | None = None


@dataclass(frozen=True)
class Slot:
    """One argument of a constraint: for each of its m items, a thing of a block or a single component of it.

    Attributes
    ----------
    block : str
    index : (m,) int
        Which thing of the block.
    component : (m,) int, optional
        Which component; None: all of them.
    """

    block: str
    index: Integers
    component: Integers | None = None


@dataclass(frozen=True)
class Layout:
    """The order of all unknowns: block after block, thing after thing.

    Attributes
    ----------
    shapes : name to (n, d)
    starts : name to int
        First unknown of each block.
    size : int
    scale : (size,)
    """

    shapes: dict[str, tuple[int, int]]
    starts: dict[str, int]
    size: int
    scale: Floats = field(repr=False)

    @classmethod
    def of(cls, blocks: Sequence[Block]) -> tuple[Layout, Floats]:
        """The layout of blocks and the vector of their values.

        Raises
        ------
        InputError
            A name given twice, values that are not finite, a scale that is not above 0.
        """
        shapes: dict[str, tuple[int, int]] = {}
        starts: dict[str, int] = {}
        vectors, scales, size = [], [], 0
        for block in blocks:
            values = np.asarray(block.values, np.float64)
            if block.name in shapes:
                raise InputError(f"two blocks are called {block.name!r}", "give each block a name of its own")
            if values.ndim not in (1, 2):
                raise InputError(f"block {block.name!r} has shape {values.shape}", "(n,) or (n, d) is expected")
            if not np.isfinite(values).all():
                bad = int((~np.isfinite(values)).sum())
                raise InputError(
                    f"block {block.name!r} has {bad} values that are no numbers", "start from finite values"
                )
            if not 0 < block.scale < np.inf:
                raise InputError(f"block {block.name!r} has scale {block.scale!r}", "a number above 0 is expected")
            shapes[block.name] = (len(values), 1 if values.ndim == 1 else values.shape[1])
            starts[block.name] = size
            size += values.size
            vectors.append(values.ravel())
            scales.append(np.full(values.size, block.scale))
        return cls(shapes, starts, size, np.concatenate(scales)), np.concatenate(vectors)

    def values(self, vector: Floats) -> dict[str, Floats]:
        """The blocks of a vector, (n, d) each, without a copy."""
        return {
            name: vector[start : start + np.prod(self.shapes[name])].reshape(self.shapes[name])
            for name, start in self.starts.items()
        }

    def unknowns(self, slot: Slot) -> Integers:
        """Unknowns behind an argument, (m, d) or (m, 1).

        Raises
        ------
        InputError
            There is no such block, or no such thing in it.
        """
        if slot.block not in self.shapes:
            known = ", ".join(sorted(self.shapes))
            raise InputError(f"there is no block {slot.block!r}", f"blocks are: {known}")
        count, size = self.shapes[slot.block]
        index = np.asarray(slot.index, np.int64)
        if len(index) and (index.min() < 0 or index.max() >= count):
            raise InputError(
                f"index {index.max() if index.max() >= count else index.min()} is outside block {slot.block!r}",
                f"its indices run from 0 to {count - 1}",
            )
        first = self.starts[slot.block] + size * index
        if slot.component is not None:
            return np.asarray(first + slot.component)[:, None]
        return np.asarray(first[:, None] + np.arange(size))


def dot(a: Floats, b: Floats) -> Floats:
    """Scalar products row by row, (m, 1)."""
    return np.asarray(np.einsum("mc,mc->m", a, b)[:, None])

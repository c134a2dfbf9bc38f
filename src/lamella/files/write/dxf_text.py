"""DXF files of many polylines, written quickly and the same each time.

`ezdxf` makes the file's frame (header, tables, layers); the entities are put into it as text, since an
object for each of a million vertices would take minutes. Coordinates are formatted in bulk.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from io import StringIO
from pathlib import Path

import ezdxf
import numpy as np
import orjson
from ezdxf import units

from lamella.base.arrays import Floats
from lamella.base.wording import one_line

APPLICATION = "LAMELLA"
LAYERS = {"CUT": 1, "MARK": 5, "TEXT": 3, "SHEET": 8}
# decimals of a millimetre kept in the file: far below the 0.01 mm promised, above rounding at a kilometre
DECIMALS = 8
COPY = "\0"


@dataclass(frozen=True, eq=False)
class Drawn:
    """A polyline of a block.

    Attributes
    ----------
    layer : str
    first, end : int
        Its points among those of the block.
    bulges : (end - first,) array or None
        Of the segments to the next points; None where all are straight.
    closed : bool
    tag : str
        What it belongs to.
    """

    layer: str
    first: int
    end: int
    bulges: Floats | None
    closed: bool
    tag: str


@dataclass(frozen=True)
class Block:
    """Entities that are placed together, as a text to be filled in.

    Attributes
    ----------
    template : str
        DXF entities with ``%X`` for each handle, ``%%s`` for each coordinate and `COPY` for the number of
        the copy.
    points : (n, 2)
        Coordinates in the template's order, mm.
    entities : int
        Number of handles.
    drawn : tuple of Drawn
        The same entities for other formats.
    """

    template: str
    points: Floats
    entities: int
    drawn: tuple[Drawn, ...] = ()

    @cached_property
    def ends(self) -> tuple[Floats, Floats]:
        """Least and greatest coordinates, (2,) each, mm."""
        return self.points.min(axis=0), self.points.max(axis=0)


class BlockWriter:
    """Collects entities into a `Block`.

    Parameters
    ----------
    owner : str
        Handle of the model space's block record.
    """

    def __init__(self, owner: str) -> None:
        self._owner = owner
        self._text: list[str] = []
        self._points: list[Floats] = []
        self._entities = 0
        self._drawn: list[Drawn] = []
        self._count = 0

    def polyline(self, layer: str, points: Floats, *, closed: bool, tag: str) -> None:
        """Add a polyline of (n, 2) points or of (n, 3) points with bulges, mm."""
        self._text.append(f"{self._begun('LWPOLYLINE', layer, 'AcDbPolyline')} 90\n{len(points)}\n 70\n{int(closed)}\n")
        vertex = " 10\n%%s\n 20\n%%s\n"
        if points.shape[1] == 2:
            self._text.append(vertex * len(points))
        else:
            self._text += [f"{vertex} 42\n{b!r}\n" if b else vertex for b in points[:, 2].tolist()]
        self._text.append(_tagged(tag))
        self._points.append(points[:, :2])
        self._entities += 1
        bulges = points[:, 2] if points.shape[1] == 3 and points[:, 2].any() else None
        self._note(layer, len(points), bulges, closed, tag)

    def lines(self, layer: str, points: Floats, *, tag: str) -> None:
        """Add straight lines, (n, 2, 2), mm."""
        line = self._begun("LINE", layer, "AcDbLine")
        line += " 10\n%%s\n 20\n%%s\n 30\n0.0\n 11\n%%s\n 21\n%%s\n 31\n0.0\n" + _tagged(tag)
        self._text.append(line * len(points))
        self._points.append(points.reshape(-1, 2))
        self._entities += len(points)
        for _ in points:
            self._note(layer, 2, None, False, tag)

    def block(self) -> Block:
        """What has been added so far."""
        points = np.concatenate(self._points) if self._points else np.empty((0, 2))
        return Block("".join(self._text), points, self._entities, tuple(self._drawn))

    def _note(self, layer: str, count: int, bulges: Floats | None, closed: bool, tag: str) -> None:
        self._drawn.append(Drawn(layer, self._count, self._count + count, bulges, closed, tag))
        self._count += count

    def _begun(self, kind: str, layer: str, subclass: str) -> str:
        return f"  0\n{kind}\n  5\n%X\n330\n{self._owner}\n100\nAcDbEntity\n  8\n{layer}\n100\n{subclass}\n"


def _tagged(tag: str) -> str:
    """Extended data of an entity: the part, and the number of the copy."""
    return f"1001\n{APPLICATION}\n1000\n{tag}\n1071\n{COPY}\n" if tag else ""


@dataclass(frozen=True)
class Placed:
    """A block, turned by 0 or 180 degrees, then moved by x, y (mm); which copy of its part it is."""

    block: Block
    x: float
    y: float
    turned: bool = False
    copy: int = 1

    @property
    def points(self) -> Floats:
        """Where the block's points come to lie, (n, 2), mm."""
        return (-self.block.points if self.turned else self.block.points) + (self.x, self.y)

    @property
    def ends(self) -> tuple[Floats, Floats]:
        """Least and greatest of these, (2,) each, mm."""
        low, high = self.block.ends
        if self.turned:
            low, high = -high, -low
        shift = np.array((self.x, self.y))
        return low + shift, high + shift


@contextmanager
def _fixed_meta_data() -> Iterator[None]:
    """Dates and random ids would make equal drawings differ."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


class DxfFile:
    """One drawing in millimetres.

    Parameters
    ----------
    name, version : str
        Of the project and of the program, for the header's custom properties.
    further : mapping of str to int, optional
        Layers beside `LAYERS`, with their colours.
    """

    def __init__(self, *, name: str, version: str, further: Mapping[str, int] | None = None) -> None:
        with _fixed_meta_data():
            self._document = ezdxf.new("R2010", units=units.MM)
        self._document.header["$MEASUREMENT"] = 1
        for layer, colour in (LAYERS | dict(further or {})).items():
            self._document.layers.add(layer, color=colour)
        self._document.appids.add(APPLICATION)
        self._document.header.custom_vars.append("Program", f"lamella {version}")
        self._document.header.custom_vars.append("Project", one_line(name))
        self.owner: str = self._document.modelspace().layout_key

    def write(self, path: Path, placed: Iterable[Placed]) -> None:
        """Write the drawing.

        Parameters
        ----------
        path : Path
        placed : iterable of Placed
            The drawing's entities.

        Raises
        ------
        OSError
            Where the file cannot be written whole.
        """
        items = [item for item in placed if item.block.entities]
        head, tail, handle = self._frame(items)
        with path.open("w", encoding="utf-8", newline="\n") as file:
            file.write(head)
            for item in items:
                handles = tuple(range(handle, handle + item.block.entities))
                handle += item.block.entities
                # adding zero turns -0.0 into 0.0
                values = np.round(item.points, DECIMALS).ravel() + 0.0
                numbers = orjson.dumps(values, option=orjson.OPT_SERIALIZE_NUMPY)[1:-1].decode().split(",")
                template = item.block.template.replace(COPY, str(item.copy))
                file.write(template % handles % tuple(numbers))
            file.write(tail)

    def _frame(self, items: list[Placed]) -> tuple[str, str, int]:
        """Text before and after the entities, and their first handle."""
        ends = [item.ends for item in items] or [(np.zeros(2),) * 2]
        low = np.min([end[0] for end in ends], axis=0)
        high = np.max([end[1] for end in ends], axis=0)
        centre, size = (0.5 * (low + high)).tolist(), float(np.max(high - low))
        corners = (*low.tolist(), 0.0), (*high.tolist(), 0.0)
        self._document.modelspace().reset_extents(*corners)
        # ezdxf does not carry extents into the header where one corner is the origin
        self._document.header["$EXTMIN"], self._document.header["$EXTMAX"] = corners
        self._document.set_modelspace_vport(height=max(size, 1.0), center=centre)
        # ezdxf registers what a drawing uses in the order of a set, which differs from process to process
        classes = self._document.classes
        classes.add_required_classes(self._document.dxfversion)
        classes.classes = OrderedDict(sorted(classes.classes.items()))
        stream = StringIO()
        with _fixed_meta_data():
            self._document.write(stream)
        first = int(str(self._document.entitydb.handles), 16)
        after = first + sum(item.block.entities for item in items)
        before_seed, seed, text = stream.getvalue().partition(f"$HANDSEED\n  5\n{first:X}\n")
        head, mark, tail = text.partition("  2\nENTITIES\n")
        if not (seed and mark):
            raise RuntimeError("ezdxf lays out its files in a way this program does not know")
        return f"{before_seed}$HANDSEED\n  5\n{after:X}\n{head}{mark}", tail, first

"""Polygon files .ply, text and binary of either byte order."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.files.read.file_mesh import MAXIMUM_FACES, Polygons, blocks, mesh_error

TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
MOST_WALKED = 4_000_000
"""Rows of an element whose lists differ in length; a second for each million."""

FACE_LISTS = ("vertex_indices", "vertex_index")
BROKEN = "is the file cut off or damaged? Export it again"


@dataclass(frozen=True)
class Property:
    """A number of an element (`counter` is empty) or a list of numbers behind their count; types as in numpy."""

    name: str
    kind: str
    counter: str = ""


@dataclass
class Element:
    """A table of the file: `count` rows of `properties`."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)


@dataclass(frozen=True)
class Lists:
    """One list property of all rows: sizes (rows,) and their values one after the other."""

    sizes: Integers
    values: Floats | Integers


Column = Floats | Lists


def read_ply(data: bytes) -> Polygons:
    """Read vertices and faces; other elements and properties are passed over, whatever their types and order."""
    order, elements, start = _header(data)
    body = Text(data[start:]) if order == "" else Binary(data[start:], order)
    points: Floats | None = None
    faces: Lists | None = None
    for element in elements:
        if points is not None and faces is not None:
            break
        wanted = {"vertex": ("x", "y", "z"), "face": FACE_LISTS}.get(element.name, ())
        columns = body.rows(element, wanted)
        if element.name == "vertex":
            points = _points(element, columns)
        elif element.name == "face":
            faces = next((found for key in FACE_LISTS if isinstance(found := columns.get(key), Lists)), None)
    if points is None:
        raise mesh_error("the .ply has no element vertex", "export a mesh with vertices and faces")
    if faces is None or not len(faces.sizes):
        strips = any(element.name == "tristrips" for element in elements)
        what = "its faces as triangle strips, which are not read" if strips else "no faces"
        raise mesh_error(f"the .ply has {what} ({len(points)} vertices)", "export a mesh with faces")
    if faces.sizes.min() < 3:
        raise mesh_error(f"a face of the .ply has {faces.sizes.min()} corners", BROKEN)
    return Polygons(points, faces.sizes, np.asarray(faces.values, dtype=np.int64))


def _points(element: Element, columns: dict[str, Column]) -> Floats:
    missing = [key for key in "xyz" if not isinstance(columns.get(key), np.ndarray)]
    if missing:
        raise mesh_error(f"the vertices of the .ply have no {', '.join(missing)}", "export the file again")
    if not element.count:
        raise mesh_error("the .ply has no vertices", "export a mesh with vertices and faces")
    return np.column_stack([np.asarray(columns[key], dtype=np.float64) for key in "xyz"])


def _header(data: bytes) -> tuple[str, list[Element], int]:
    """Byte order ("" for text), elements, and where the body begins."""
    opening = re.match(rb"ply[ \t]*(\r\n|\n|\r)", data)
    if not opening:
        raise mesh_error("the file does not begin with 'ply'", "is it another format? The ending tells how it is read")
    newline = opening[1]
    ending = re.search(rb"(?<=[\r\n])end_header[ \t]*" + newline, data)
    if not ending:
        raise mesh_error("the header of the .ply has no end", BROKEN)
    order: str | None = None
    elements: list[Element] = []
    for line in data[opening.end() : ending.start()].decode("latin-1").split(newline.decode()):
        words = line.split()
        try:
            match words:
                case [] | ["comment" | "obj_info", *_]:
                    pass
                case ["format", name, *_]:
                    order = FORMATS[name]
                case ["element", name, count]:
                    elements.append(Element(name, int(count)))
                    if elements[-1].count < 0:
                        raise ValueError
                case ["property", "list", counter, kind, name]:
                    if TYPES[counter][0] == "f":
                        raise ValueError
                    elements[-1].properties.append(Property(name, TYPES[kind], TYPES[counter]))
                case ["property", kind, name]:
                    elements[-1].properties.append(Property(name, TYPES[kind]))
                case _:
                    raise ValueError
        except (KeyError, ValueError, IndexError):
            raise mesh_error(
                f"the header of the .ply has a line that is not known: {line.strip()[:60]!r}", BROKEN
            ) from None
    if order is None:
        raise mesh_error("the header of the .ply does not say its format", BROKEN)
    return order, elements, ending.end()


def _require_few(element: Element) -> None:
    most = {"vertex": 3 * MAXIMUM_FACES, "face": MAXIMUM_FACES}.get(element.name, 10 * MAXIMUM_FACES)
    if element.count > most:
        raise mesh_error(
            f"the .ply has {element.count} rows of the element {element.name[:40]}; at most {most} are read",
            "reduce the mesh: curvature needs a few thousand faces",
        )


class Body:
    """What follows the header, as a sequence of items: numbers of a text, bytes of a binary file."""

    length: int
    position: int = 0

    def width(self, kind: str) -> int:
        """Items a number of type `kind` takes."""
        raise NotImplementedError

    def count_at(self, position: int, kind: str) -> int:
        """The list count at `position`."""
        raise NotImplementedError

    def take(self, positions: Integers, kind: str) -> Floats | Integers:
        """Numbers of type `kind` at `positions`."""
        raise NotImplementedError

    def rows(self, element: Element, wanted: tuple[str, ...]) -> dict[str, Column]:
        """Read past an element and return its wanted columns."""
        narrowest = sum(self.width(p.counter or p.kind) for p in element.properties)
        if element.count * narrowest > self.length - self.position:
            raise _cut_off(element)
        _require_few(element)
        if not element.count or not narrowest:
            return {
                p.name: Lists(np.zeros(0, np.int64), np.zeros(0)) if p.counter else np.zeros(0)
                for p in element.properties
            }
        return self._alike(element, wanted) or self._walked(element, wanted)

    def _alike(self, element: Element, wanted: tuple[str, ...]) -> dict[str, Column] | None:
        """Columns if all rows have lists of the same lengths as the first one, which most files have."""
        offsets, lengths, here = [], [], self.position
        for p in element.properties:
            length = 1
            if p.counter:
                if here + self.width(p.counter) > self.length:
                    return None
                length = self.count_at(here, p.counter)
                here += self.width(p.counter)
            if length < 0:
                return None
            offsets.append(here - self.position)
            lengths.append(length)
            here += length * self.width(p.kind)
        stride = here - self.position
        if self.position + stride * element.count > self.length:
            return None
        first = self.position + stride * np.arange(element.count)
        columns: dict[str, Column] = {}
        for p, offset, length in zip(element.properties, offsets, lengths, strict=True):
            if p.counter and (self.take(first + offset - self.width(p.counter), p.counter) != length).any():
                return None
            if p.name in wanted and p.counter:
                places = (first + offset)[:, None] + self.width(p.kind) * np.arange(length)
                sizes = np.full(element.count, length, dtype=np.int64)
                columns[p.name] = Lists(sizes, self.take(places.ravel(), p.kind))
            elif p.name in wanted:
                columns[p.name] = np.asarray(self.take(first + offset, p.kind), dtype=np.float64)
        self.position += stride * element.count
        return columns

    def _walked(self, element: Element, wanted: tuple[str, ...]) -> dict[str, Column]:
        """Columns row by row: where a row begins is known only at the end of the one before."""
        if element.count > MOST_WALKED:
            raise mesh_error(
                f"the element {element.name} of the .ply has {element.count:,} rows of different lengths; at most "
                f"{MOST_WALKED:,} are read",
                "export vertices and faces alone",
            )
        here, length = self.position, self.length
        steps = [(p.counter, self.width(p.kind), self.width(p.counter) if p.counter else 0) for p in element.properties]
        starts: list[list[int]] = [[] for _ in steps]
        sizes: list[list[int]] = [[] for _ in steps]
        for _ in range(element.count):
            for k, (counter, width, counter_width) in enumerate(steps):
                count = 1
                if counter:
                    if here + counter_width > length:
                        raise _cut_off(element)
                    count = self.count_at(here, counter)
                    if count < 0:
                        raise mesh_error(f"a list of the element {element.name} of the .ply has {count} values", BROKEN)
                    here += counter_width
                    sizes[k].append(count)
                starts[k].append(here)
                here += count * width
            if here > length:
                raise _cut_off(element)
        self.position = here
        columns: dict[str, Column] = {}
        for p, start, size in zip(element.properties, starts, sizes, strict=True):
            if p.name not in wanted:
                continue
            first = np.array(start, dtype=np.int64)
            if not p.counter:
                columns[p.name] = np.asarray(self.take(first, p.kind), dtype=np.float64)
                continue
            many = np.array(size, dtype=np.int64)
            within = np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
            columns[p.name] = Lists(many, self.take(np.repeat(first, many) + self.width(p.kind) * within, p.kind))
        return columns


class Text(Body):
    """Body of a text file: every number is one item."""

    def __init__(self, data: bytes) -> None:
        try:
            parts = [np.array(list(map(float, block.split())), np.float64) for block in blocks(data, b" \n\r\t")]
        except ValueError as bad:
            raise mesh_error(f"the .ply has something that is not a number ({str(bad)[:80]})", BROKEN) from None
        self.numbers = np.concatenate([np.zeros(0), *parts])
        self.length = len(self.numbers)

    def width(self, kind: str) -> int:
        return 1

    def count_at(self, position: int, kind: str) -> int:
        number = float(self.numbers[position])
        return int(number) if number.is_integer() else int(self._whole(self.numbers[position : position + 1])[0])

    def take(self, positions: Integers, kind: str) -> Floats | Integers:
        found = self.numbers[positions]
        return found if kind[0] == "f" else self._whole(found)

    @staticmethod
    def _whole(numbers: Floats) -> Integers:
        if not (np.abs(numbers) < 2.0**53).all() or (numbers != np.floor(numbers)).any():
            raise mesh_error("the .ply has a number that should be a whole one and is not", BROKEN)
        return numbers.astype(np.int64)


class Binary(Body):
    """Body of a binary file: every byte is one item."""

    def __init__(self, data: bytes, order: str) -> None:
        self.data, self.order = data, order
        self.bytes = np.frombuffer(data, np.uint8)
        self.length = len(data)

    def width(self, kind: str) -> int:
        return int(kind[1])

    def count_at(self, position: int, kind: str) -> int:
        chunk = self.data[position : position + int(kind[1])]
        return int.from_bytes(chunk, "little" if self.order == "<" else "big", signed=kind[0] == "i")

    def take(self, positions: Integers, kind: str) -> Floats | Integers:
        raw = self.bytes[positions[:, None] + np.arange(int(kind[1]))]
        found = np.ascontiguousarray(raw).view(self.order + kind)[:, 0]
        # bytes that are no numbers are found out later
        with np.errstate(invalid="ignore"):
            return found.astype(np.float64) if kind[0] == "f" else found.astype(np.int64)


def _cut_off(element: Element) -> Exception:
    return mesh_error(f"the .ply ends before its {element.count} rows of the element {element.name}", BROKEN)

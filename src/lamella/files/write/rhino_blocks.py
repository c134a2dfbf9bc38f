"""Blocks of a .3dm file whose ids follow from names.

rhino3dm gives every block and the objects in it ids of chance, and offers no way to set them: equal models would differ
in every run. So a block is encoded, its ids are replaced, and it is decoded again. An encoded object is a tree of
chunks: a type code of 4 bytes and a length of 8, then the content, whose last 4 bytes are the CRC-32 of what of it is
in no chunk below.
"""

from __future__ import annotations

import base64
import struct
import uuid
import zlib
from collections.abc import Iterator

import rhino3dm

# type codes of chunks with a checksum: "anonymous", and those of model components
CODES = frozenset({0x40008000, 0x40008001, 0x40008002, 0x40008003})
HEAD = struct.Struct("<Iq")
SUM = struct.Struct("<I")


def add_block(
    file: rhino3dm.File3dm, name: str, mesh: rhino3dm.Mesh, identity: uuid.UUID, attributes: rhino3dm.ObjectAttributes
) -> None:
    """Add a block of one mesh.

    Parameters
    ----------
    file : File3dm
    name : str
        Of the block.
    mesh : Mesh
        In the block's own axes.
    identity : UUID
        Id of the block.
    attributes : ObjectAttributes
        Of the mesh in it; its id is kept.

    Raises
    ------
    RuntimeError
        rhino3dm encodes blocks in another way than this program knows.
    """
    scratch = rhino3dm.File3dm()
    number = scratch.InstanceDefinitions.Add(
        name, "", "", "", rhino3dm.Point3d(0, 0, 0), (mesh,), (rhino3dm.ObjectAttributes(),)
    )
    block = scratch.InstanceDefinitions[number]
    (inside,) = block.GetObjectIds()
    ids = {block.Id: identity, inside: attributes.Id}
    encoded = block.Encode()
    data = base64.b64decode(encoded["data"])
    renamed = _renamed(data, {uuid.UUID(str(old)): uuid.UUID(str(new)) for old, new in ids.items()})
    encoded["data"] = base64.b64encode(renamed).decode()
    attributes.Mode = rhino3dm.ObjectMode.InstanceDefinitionObject
    file.Objects.AddMesh(mesh, attributes)
    file.InstanceDefinitions.AddInstanceDefinition(rhino3dm.CommonObject.Decode(encoded))


def _renamed(data: bytes, ids: dict[uuid.UUID, uuid.UUID]) -> bytes:
    """The same object with other ids, and the checksums that follow from them."""
    result = data
    for old, new in ids.items():
        if data.count(old.bytes_le) != 1:
            raise RuntimeError("rhino3dm encodes blocks in a way this program does not know")
        result = result.replace(old.bytes_le, new.bytes_le)
    found = list(_chunks(data, 0, len(data)))
    if not found:
        raise RuntimeError("rhino3dm encodes blocks in a way this program does not know")
    mended = bytearray(result)
    for start, length in found:
        _mend(data, mended, start, length)
    return bytes(mended)


def _mend(before: bytes, after: bytearray, start: int, length: int) -> None:
    """Write the checksums of a chunk and of those in it."""
    first, last = start + HEAD.size, start + HEAD.size + length - SUM.size
    inner = list(_chunks(before, first, last))
    for chunk in inner:
        _mend(before, after, *chunk)
    SUM.pack_into(after, last, zlib.crc32(_own(bytes(after), first, last, inner)))


def _chunks(data: bytes, first: int, last: int) -> Iterator[tuple[int, int]]:
    """Beginnings and lengths of the chunks with a right checksum between two places."""
    at = first
    while at + HEAD.size <= last:
        code, length = HEAD.unpack_from(data, at)
        begin, end = at + HEAD.size, at + HEAD.size + length
        if code in CODES and SUM.size <= length and end <= last:
            inner = list(_chunks(data, begin, end - SUM.size))
            if zlib.crc32(_own(data, begin, end - SUM.size, inner)) == SUM.unpack_from(data, end - SUM.size)[0]:
                yield at, length
                at = end
                continue
        at += 1


def _own(data: bytes, first: int, last: int, inner: list[tuple[int, int]]) -> bytes:
    """What of a chunk's content is in no chunk below."""
    bounds = [first, *(place for start, length in inner for place in (start, start + HEAD.size + length)), last]
    return b"".join(data[begin:end] for begin, end in zip(bounds[::2], bounds[1::2], strict=True))

"""Text that begins with a byte order mark, as editors and shells of Windows write it."""

from __future__ import annotations

import codecs

# that of UTF-32 LE begins with that of UTF-16 LE
_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


def unmarked(data: bytes) -> bytes:
    """The bytes of a text file in UTF-8 and without a byte order mark; as they are where there is none."""
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            body = data[len(mark) :]
            # half a character at the end is damage, which the reader of the format tells of
            return body if encoding == "utf-8" else body.decode(encoding, "replace").encode("utf-8")
    return data

"""A single-line stroke font for engraving: 0-9, A-Z, full stop, hyphen, slash and space.

A glyph is drawn on a grid 4 wide and 6 high. It is written down as its strokes, each a row of two-digit
grid points "xy"; no segment is drawn twice, so that a laser does not burn it deeper.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats

GLYPH_WIDTH, GLYPH_HEIGHT, GLYPH_ADVANCE = 4, 6, 6

_STROKES = {
    "0": "10 30 41 45 36 16 05 01 10",
    "1": "05 26 20|10 30",
    "2": "05 16 36 45 44 00 40",
    "3": "05 16 36 45 44 33 13|33 42 41 30 10 01",
    "4": "30 36 02 42",
    "5": "46 06 03 33 42 41 30 10 01",
    "6": "45 36 16 05 01 10 30 41 42 33 13 02",
    "7": "06 46 10",
    "8": "13 04 05 16 36 45 44 33 42 41 30 10 01 02 13 33",
    "9": "01 10 30 41 45 36 16 05 04 13 33 44",
    "A": "00 26 40|12 32",
    "B": "00 06 36 45 44 33 03|33 42 41 30 00",
    "C": "45 36 16 05 01 10 30 41",
    "D": "00 06 26 44 42 20 00",
    "E": "40 00 06 46|03 33",
    "F": "00 06 46|03 33",
    "G": "45 36 16 05 01 10 30 41 43 23",
    "H": "00 06|40 46|03 43",
    "I": "10 30|16 36|20 26",
    "J": "46 41 30 10 01",
    "K": "00 06|46 03 40",
    "L": "06 00 40",
    "M": "00 06 23 46 40",
    "N": "00 06 40 46",
    "O": "20 42 44 26 04 02 20",
    "P": "00 06 36 45 44 33 03",
    "Q": "20 42 44 26 04 02 20|22 40",
    "R": "00 06 36 45 44 33 03|23 40",
    "S": "45 36 16 05 04 13 33 42 41 30 10 01",
    "T": "06 46|20 26",
    "U": "06 01 10 30 41 46",
    "V": "06 20 46",
    "W": "06 10 24 30 46",
    "X": "00 46|06 40",
    "Y": "06 23 46|23 20",
    "Z": "06 46 00 40",
    ".": "10 20 21 11 10",
    "-": "13 33",
    "/": "00 46",
    " ": "",
}

GLYPHS: dict[str, tuple[Floats, ...]] = {
    character: tuple(
        np.array([(int(point[0]), int(point[1])) for point in stroke.split()], float)
        for stroke in strokes.split("|")
        if stroke
    )
    for character, strokes in _STROKES.items()
}


def text_width(text: str) -> float:
    """Width of a text of letter height 1."""
    return (GLYPH_ADVANCE * len(text) - (GLYPH_ADVANCE - GLYPH_WIDTH)) / GLYPH_HEIGHT if text else 0.0


def text_strokes(text: str) -> tuple[Floats, ...]:
    """Strokes of a text of letter height 1 that begins at the origin.

    Parameters
    ----------
    text : str
        Lower case is written as upper case; characters the font has not are left blank.

    Returns
    -------
    tuple of (k, 2) arrays
        Polylines.
    """
    return tuple(
        (stroke + np.array([GLYPH_ADVANCE * place, 0.0])) / GLYPH_HEIGHT
        for place, character in enumerate(text.upper())
        for stroke in GLYPHS.get(character, ())
    )

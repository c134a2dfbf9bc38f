"""Contours as they are cut: with half a kerf beside the part, lead-ins, and micro-tabs that hold the part."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.fabrication.cut_length import segment_lengths
from lamella.fabrication.offset import offset_outline

if TYPE_CHECKING:
    from lamella.files.write.dxf_text import BlockWriter

LEAD = "LEAD"
"""Layer of the lead-ins."""
MM = 1e3


@dataclass(frozen=True)
class CutOptions:
    """How contours are cut, m.

    Attributes
    ----------
    kerf : float
        Width of the cut: outlines lie half of it outside of the part, holes inside.
    lead_in : float
        Length of the line from waste to each contour; 0: none.
    tabs : int
        Gaps of each outer contour that hold the part in its sheet.
    tab_width : float
    """

    kerf: float = 0.0
    lead_in: float = 0.0
    tabs: int = 0
    tab_width: float = 0.0005

    @property
    def layers(self) -> dict[str, int]:
        """Layers that drawings have for it, with their colours."""
        return {LEAD: 6} if self.lead_in else {}


PLAIN = CutOptions()


def draw_contours(
    writer: BlockWriter, outline: Floats, holes: tuple[Floats, ...], options: CutOptions, *, tag: str
) -> None:
    """Draw a part's outline and holes on layer CUT, lead-ins on layer LEAD.

    Parameters
    ----------
    writer : BlockWriter
    outline : (v, 3)
        Counter-clockwise, m and bulge; so are the holes.
    holes : tuple of (w, 3)
    options : CutOptions
    tag : str
        The part's id.

    Raises
    ------
    InputError
        The kerf closes a slot or hole, or tabs take more than the contour.
    """
    for k, contour in enumerate((outline, *holes)):
        moved = _moved(contour, options.kerf / 2 * (-1 if k else 1), options.kerf, tag)
        if options.tabs and not k:
            for piece in open_pieces(moved, options.tabs, options.tab_width):
                writer.polyline("CUT", piece * (MM, MM, 1.0), closed=False, tag=tag)
                if options.lead_in:
                    writer.lines(LEAD, MM * _to_begin(piece, options.lead_in)[None], tag=tag)
        else:
            writer.polyline("CUT", moved * (MM, MM, 1.0), closed=True, tag=tag)
            if options.lead_in:
                writer.lines(LEAD, MM * _to_middle(moved, options.lead_in, inner=k > 0)[None], tag=tag)


def check_contours(outline: Floats, holes: tuple[Floats, ...], options: CutOptions, *, tag: str) -> None:
    """Refuse what `draw_contours` would.

    Raises
    ------
    InputError
    """
    for k, contour in enumerate((outline, *holes) if options.kerf or options.tabs else ()):
        moved = _moved(contour, options.kerf / 2 * (-1 if k else 1), options.kerf, tag)
        if options.tabs and not k:
            open_pieces(moved, options.tabs, options.tab_width)


def _moved(contour: Floats, distance: float, kerf: float, tag: str) -> Floats:
    try:
        return offset_outline(contour, distance)
    except ValueError:
        raise InputError(
            f"a kerf of {MM * kerf:g} mm closes a slot, a hole or a side of {tag}",
            "choose a kerf narrower than slots and holes",
            "kerf",
        ) from None


def _to_begin(piece: Floats, length: float) -> Floats:
    """A line (2, 2), m, from waste to the beginning of an open contour."""
    begin, end = piece[0, :2] @ (1, 1j), piece[1, :2] @ (1, 1j)
    along = (end - begin) / abs(end - begin) * np.exp(-2j * np.arctan(piece[0, 2]))
    away = begin - 1j * along * length
    return np.array([[away.real, away.imag], [begin.real, begin.imag]])


def _to_middle(contour: Floats, length: float, *, inner: bool) -> Floats:
    """A line (2, 2), m, from waste to the middle of the longest segment; in a hole at most to its middle."""
    k = int(np.argmax(np.round(segment_lengths(contour), 9)))
    begin, end = contour[k, :2] @ (1, 1j), contour[(k + 1) % len(contour), :2] @ (1, 1j)
    chord, bulge = end - begin, contour[k, 2]
    right = -1j * chord / abs(chord)
    middle = 0.5 * (begin + end) + right * bulge * abs(chord) / 2
    # half of a hole's width is there at least
    reach = min(length, 0.5 * float(np.ptp(contour[:, :2], axis=0).max())) if inner else length
    away = middle + (-right if inner else right) * reach
    return np.array([[away.real, away.imag], [middle.real, middle.imag]])


def open_pieces(contour: Floats, tabs: int, width: float) -> list[Floats]:
    """A closed contour with gaps, as open ones.

    Each gap lies where the longest of the segments, shared among its gaps, leaves most room: strips are held along
    their plain edge.

    Parameters
    ----------
    contour : (v, 3)
        m and bulge.
    tabs : int
        Number of gaps, 1 at least.
    width : float
        Of a gap along the contour, m.

    Returns
    -------
    list of (w, 3)
        As many open polylines; the last bulge of each is 0.

    Raises
    ------
    InputError
        Where segments are too short for the gaps.
    """
    lengths = segment_lengths(contour)
    counts = np.zeros(len(contour), np.int64)
    for _ in range(tabs):
        counts[int(np.argmax(np.round(lengths / (counts + 1), 9)))] += 1
    room = lengths / (counts + 1)
    if np.any(room[counts > 0] <= 2 * width):
        raise InputError(
            f"{tabs} tabs {MM * width:g} mm wide leave next to nothing of a side {MM * lengths.max():.4g} mm long",
            "write fewer or narrower tabs",
            "tabs",
        )
    starts = np.cumsum(lengths) - lengths
    gaps = np.concatenate([starts[k] + room[k] * np.arange(1, counts[k] + 1) for k in np.flatnonzero(counts).tolist()])
    ends = np.roll(gaps - width / 2, -1)
    ends[-1] += lengths.sum()
    return [_between(contour, lengths, begin, end) for begin, end in zip(gaps + width / 2, ends, strict=True)]


def _between(contour: Floats, lengths: Floats, begin: float, end: float) -> Floats:
    """The part of a contour between two places along it, m, the second one maybe a turn farther."""
    several = np.concatenate([contour, contour])
    along = np.concatenate([[0.0], np.cumsum(np.tile(lengths, 2))])
    first, last = int(np.searchsorted(along, begin, side="right")) - 1, int(np.searchsorted(along, end)) - 1
    kept = several[first : last + 1].copy()
    points = [_place(contour, first, (begin - along[first]) / lengths[first % len(lengths)])]
    points += list(kept[1:, :2])
    points.append(_place(contour, last, (end - along[last]) / lengths[last % len(lengths)]))
    shares = np.ones(len(kept))
    shares[0] = (along[first + 1] - begin) / lengths[first % len(lengths)]
    shares[-1] = (end - max(along[last], begin)) / lengths[last % len(lengths)]
    bulges = np.tan(shares * np.arctan(kept[:, 2]))
    return np.column_stack([np.array(points), np.append(bulges, 0.0)])


def _place(contour: Floats, segment: int, share: float) -> Floats:
    """Point at a share of a segment's length, (2,), m."""
    k = segment % len(contour)
    begin, end = contour[k, :2] @ (1, 1j), contour[(k + 1) % len(contour), :2] @ (1, 1j)
    half = 2 * np.arctan(contour[k, 2])
    # chord of the share over that of the whole arc, turned
    part = share * np.sinc(half * share / np.pi) / np.sinc(half / np.pi) * np.exp(1j * half * (share - 1))
    point = begin + (end - begin) * part
    return np.array([point.real, point.imag])

"""Details of one node, from the solids of its strips and hardware: seen from above and cut; slots of both families."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.built import Built, Piece, hardware_near, strips_near
from lamella.drawings.clipping import between_uprights
from lamella.drawings.page import HEAD_EM, NOTE_EM, TEXT_EM, Page, shortened
from lamella.drawings.paper import Paper, scale_text, standard_scale
from lamella.drawings.placing import spread
from lamella.drawings.solid_view import draw_section, draw_seen, within
from lamella.drawings.terms import Terms
from lamella.drawings.view import View
from lamella.fabrication.flat import outline_points
from lamella.fabrication.part import Part
from lamella.hardware.item import Item
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.shape import Prism

ON_AXIS = 1e-6
"""m: what is nearer to a node's axis is on it."""
LEGEND = 78.0
"""mm: width of the names of parts beside a section."""
FINE_ARCS = 200
"""Straight parts of an arc of a strip."""
DETAIL_BORDER = 16.0
"""mm: beside a view, for its dimensions."""


def joint_pages(built: Built, paper: Paper, words: Terms) -> list[Page]:
    """The node with the most pieces of hardware around it, where lamellas of both families cross; none: no sheet."""
    frames = NodeFrames.of(built.network)
    if not len(frames):
        return []
    k = _richest(built, frames)
    centre, axes = frames.origins[k], frames.axes[k]
    section = built.lamellas.section
    reach = _reach(built, centre, axes)
    radius = float(np.hypot(2**0.5 * reach, section.height))
    pieces = [*hardware_near(built, centre, radius), *strips_near(built, centre, radius)]
    page = Page(f"{words('node_detail')}: {words('at_node', node=int(frames.nodes[k]))}")
    left, low, right, high = paper.room
    third = (high - low) * 0.34
    split = left + (right - left - LEGEND) / 2
    size = (2 * reach, 2 * reach)
    room = min(split - left, high - low - third) - 2 * DETAIL_BORDER
    scale = standard_scale(size, (room, room - HEAD_EM))
    page.scale = scale_text(scale)
    above = draw_top(page, words, pieces, (centre, axes), reach, (left, low + third, split, high), scale)
    cut_room = (split, low + third, right, high)
    beside = draw_cut(page, words, pieces, (centre, axes), reach, cut_room, scale, words("section"))
    _tell_top(page, words, above, built, frames, k, pieces, reach)
    _tell_cut(page, words, beside, built, centre, axes, pieces, reach)
    _slots(page, built, words, (left, low, right, low + third))
    return [page]


def draw_top(
    page: Page,
    words: Terms,
    pieces: Sequence[Piece],
    frame: tuple[Floats, Floats],
    reach: float,
    room: tuple[float, float, float, float],
    scale: float,
) -> View:
    """A node seen from above, within a square of half the side `reach`, m; the frame is its point and axes."""
    centre, axes = frame
    left, low, right, high = room
    at = np.array([(left + right) / 2, (low + high - HEAD_EM) / 2])
    view = View(axes[:2], centre, at, scale)
    box = np.array([reach, reach, np.inf])
    solids = [within(piece.solid, centre, axes, box) for piece in pieces]
    draw_seen(page, view, [solid for solid in solids if len(solid.triangles)])
    page.label(f"{words('top_view')}  {scale_text(scale)}", left, high - HEAD_EM, HEAD_EM, bold=True)
    for axis in axes[:2]:
        page.line(view.place(centre + np.array([[-1.1], [1.1]]) * reach * axis), "centre")
    return view


def draw_cut(
    page: Page,
    words: Terms,
    pieces: Sequence[Piece],
    frame: tuple[Floats, Floats],
    reach: float,
    room: tuple[float, float, float, float],
    scale: float,
    name: str,
) -> View:
    """A node cut along the first axis of its frame, with the names of the parts on its axis to the right."""
    centre, axes = frame
    left, low, right, high = room
    at = np.array([(left + right - LEGEND) / 2, (low + high - HEAD_EM) / 2])
    view = View(axes[[0, 2]], centre, at, scale)
    box = np.array([reach, reach, np.inf])
    shown = [replace(piece, solid=within(piece.solid, centre, axes, box)) for piece in pieces]
    shown = [piece for piece in shown if len(piece.solid.triangles)]
    draw_section(page, view, [piece.solid for piece in shown], [piece.solid for piece in pieces], centre, reach)
    page.label(f"{name}  {scale_text(scale)}", left, high - HEAD_EM, HEAD_EM, bold=True)
    page.line(view.place(centre + np.array([[-0.9], [0.9]]) * reach * axes[2]), "centre")
    _legend(page, words, view, shown, centre, (right - LEGEND, low, right, high - 3 * HEAD_EM))
    return view


def _legend(
    page: Page,
    words: Terms,
    view: View,
    pieces: Sequence[Piece],
    centre: Floats,
    room: tuple[float, float, float, float],
) -> None:
    """Names of the kinds of hardware, one below the other, each with a line to one of its pieces."""
    left, low, right, high = room
    first: dict[str, Piece] = {}
    for piece in pieces:
        if piece.item is None:
            continue
        known = first.get(piece.name)
        if known is None or np.linalg.norm(piece.middle - centre) < np.linalg.norm(known.middle - centre) - ON_AXIS:
            first[piece.name] = piece
    ends = {name: view.place(piece.middle) for name, piece in first.items()}
    names = sorted(first, key=lambda name: (-round(float(ends[name][1]), 6), name))
    line = 2.6 * TEXT_EM
    heights = -spread(np.array([-ends[name][1] for name in names]), line, -high, -low)
    for name, y in zip(names, heights.tolist(), strict=True):
        item = first[name].item
        assert item is not None
        page.line(np.array([ends[name], (left - 3, y + 1), (left, y + 1)]), "fine")
        page.line([ends[name] - 0.3, ends[name] + 0.3], "thick")
        page.label(name, left + 1, y, TEXT_EM, bold=True)
        page.label(
            shortened(words.description(item.description), right - left - 1, NOTE_EM),
            left + 1,
            y - 1.1 * NOTE_EM,
            NOTE_EM,
        )


def _richest(built: Built, frames: NodeFrames) -> int:
    """The first of the nodes with the most pieces of hardware within half a strip's height."""
    origins = [item.places.origins for item in built.hardware if not item.bent]
    if not origins:
        return 0
    points = np.concatenate(origins)
    reach = built.lamellas.section.height
    near = np.array([np.sum(np.linalg.norm(points - centre, axis=1) < reach) for centre in frames.origins])
    return int(np.argmax(near))


def _reach(built: Built, centre: Floats, axes: Floats) -> float:
    """Half the side of what is shown around a node, m."""
    section = built.lamellas.section
    reach = 0.6 * section.height + section.layers * section.offset / 2
    for piece in hardware_near(built, centre, ON_AXIS):
        if piece.item is not None and piece.item.plate:
            flat = (piece.solid.vertices - centre) @ axes[:2].T
            reach = max(reach, 1.25 * float(np.abs(flat).max()))
    return reach


def _on_axis(pieces: Sequence[Piece], centre: Floats, normal: Floats) -> list[tuple[Item, Floats, Floats]]:
    """Kinds of hardware on a node's axis: with the origin and the axes of the uppermost of their pieces there."""
    found: dict[str, tuple[float, Item, Floats, Floats]] = {}
    for item in dict.fromkeys(piece.item for piece in pieces if piece.item is not None):
        away = item.places.origins - centre
        along = away @ normal
        beside = np.linalg.norm(away - along[:, None] * normal, axis=1)
        reach = max(float(np.abs(piece.middle - centre).max()) for piece in pieces if piece.item is item)
        for k in np.flatnonzero((beside < ON_AXIS) & (np.abs(along) < 3 * reach + item.length)).tolist():
            if item.id not in found or along[k] > found[item.id][0]:
                found[item.id] = (float(along[k]), item, item.places.origins[k], item.places.axes[k])
    return [entry[1:] for entry in found.values()]


def _tell_top(
    page: Page,
    words: Terms,
    view: View,
    built: Built,
    frames: NodeFrames,
    k: int,
    pieces: Sequence[Piece],
    reach: float,
) -> None:
    """Distances of the layers, size of the washer."""
    centre, axes = frames.origins[k], frames.axes[k]
    of_a, of_b = frames.layer_distances(built.lamellas)
    x, y, normal = axes
    if len(of_a) > 1:
        across = np.sort(of_a[:, k])
        for low, high in zip(across[:-1].tolist(), across[1:].tolist(), strict=True):
            ends = centre - reach * x + np.array([[high], [low]]) * y
            view.dimension(page, words, ends, -DETAIL_BORDER * 0.5)
        sideways = np.cross(normal, frames.tangents_b[k])
        across = np.sort(of_b[:, k])
        for low, high in zip(across[:-1].tolist(), across[1:].tolist(), strict=True):
            ends = centre - reach * frames.tangents_b[k] + np.array([[low], [high]]) * sideways
            view.dimension(page, words, ends, DETAIL_BORDER * 0.5)
    for item, origin, frame in _on_axis(pieces, centre, normal):
        if item.kind == "washer":
            corners = outline_points(item.cut.outline)
            ends = np.array([[corners[:, 0].min()], [corners[:, 0].max()]]) * frame[0]
            view.dimension(page, words, origin + ends, reach * view.mm + DETAIL_BORDER * 0.35)


def _tell_cut(
    page: Page,
    words: Terms,
    view: View,
    built: Built,
    centre: Floats,
    axes: Floats,
    pieces: Sequence[Piece],
    reach: float,
) -> None:
    """Height of the strips, length of the bolt."""
    x, _, normal = axes
    half, level = built.lamellas.section.height / 2, built.lamellas.section.level
    # the A lamella's own height, on its level
    ends = centre - reach * x + np.array([[half - level], [-half - level]]) * normal
    view.dimension(page, words, ends, -DETAIL_BORDER * 0.4)
    for item, origin, frame in _on_axis(pieces, centre, normal):
        tips = [one.low for one in item.shape if isinstance(one, Prism)]
        if item.kind == "bolt" and tips:
            # a bolt's length is told below its head
            ends = origin + np.array([[min(tips) + item.length], [min(tips)]]) * frame[2]
            view.dimension(page, words, ends, -(reach * view.mm + DETAIL_BORDER * 0.85))


def _slots(page: Page, built: Built, words: Terms, room: tuple[float, float, float, float]) -> None:
    """A slot of either family, the one in the middle of its first part that has any."""
    left, low, right, high = room
    width = (right - left) / 2
    for column, family in enumerate("AB"):
        part = next((part for part in built.parts.parts if part.family == family and len(part.slots)), None)
        if part is not None:
            _slot(page, words, part, (left + column * width, low, left + (column + 1) * width, high))


def _slot(page: Page, words: Terms, part: Part, room: tuple[float, float, float, float]) -> None:
    """A piece of a part around a slot."""
    left, low, right, high = room
    half = 0.75 * part.height
    inside = (
        min(0.6 * (right - left), (right - left) - 4 * DETAIL_BORDER),
        high - low - HEAD_EM - 1.2 * DETAIL_BORDER,
    )
    scale = standard_scale((2 * half, part.height), inside)
    station = float(part.slots[len(part.slots) // 2])
    centre = part.place(np.array(station), 0.0)
    heading = float(part.axis.heading(np.array([station]))[0])
    ahead = np.array([np.cos(heading), np.sin(heading)])
    up = np.array([-ahead[1], ahead[0]])
    view = View(np.stack([ahead, up]), centre, np.array([(left + right) / 2, (low + high - HEAD_EM) / 2]), scale)
    page.label(f"{words('slot', id=part.id)}  {scale_text(scale)}", left, high - HEAD_EM, HEAD_EM, bold=True)
    middle, reach = float(view.at[0]), half * view.mm
    flat = between_uprights(view.place(outline_points(part.outline, FINE_ARCS)[:-1]), middle - reach, middle + reach)
    page.shape([flat], 0.93)
    page.line(flat, "medium", closed=True)
    sign = 1.0 if part.from_above else -1.0
    foot = -sign * part.slot_play
    edge = sign * part.height / 2
    across = part.slot_width / 2
    mouth = centre + np.array([[-across], [across]]) * ahead + edge * up
    view.dimension(page, words, mouth, sign * DETAIL_BORDER * 0.3)
    depth = centre + across * ahead + np.array([[edge], [foot]]) * up
    view.dimension(page, words, depth if sign < 0 else depth[::-1], -DETAIL_BORDER * 0.6)
    whole = centre - 0.6 * half * ahead + np.array([[part.height / 2], [-part.height / 2]]) * up
    view.dimension(page, words, whole, -(0.4 * half * view.mm + DETAIL_BORDER * 0.4))
    text = words("thickness", value=words.mm(part.thickness))
    page.label(text, middle + reach + 3, float(view.at[1]), TEXT_EM)

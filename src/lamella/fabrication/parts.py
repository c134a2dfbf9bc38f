"""From the lamellas of a network to flat parts: ends, slots, splits and what the user should know of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.axis import Axis, outline
from lamella.fabrication.collisions import end_collisions
from lamella.fabrication.defaults import default_end_distance, default_hub_radius, default_slot_width
from lamella.fabrication.flat import outline_area
from lamella.fabrication.layer_strips import LayerStrip, LayerStrips
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.rules import LENGTH_ROUNDING, Rules
from lamella.fabrication.spans import SQUARE, Span
from lamella.fabrication.splits import split
from lamella.fabrication.stock import Supply
from lamella.fabrication.trims import Trims
from lamella.fabrication.warnings import FabricationWarnings
from lamella.network.network import SINGULAR, Network
from lamella.strip.lamellas import Lamellas, Section, crossings, slotted


def make_parts(
    network: Network,
    lamellas: Lamellas,
    *,
    density: float,
    end_distance: float | None = None,
    rim_overhang: float = 0.01,
    hub_radius: float | None = None,
    slot_width: float | None = None,
    slot_play: float = 0.0,
    foot_radius: float = 0.0,
    sheet: tuple[float, float] = (12.0, 2.0),
    gap: float = 0.01,
    transport_length: float | None = None,
    supply: Supply | None = None,
    borders: Sequence[Integers] | None = None,
    splice_room: float = 0.0,
    trims: Trims | None = None,
    others: Callable[[Callable[[Network, Lamellas], bool]], str] | None = None,
) -> Parts:
    """Flat parts of every lamella.

    Parameters
    ----------
    network : Network
    lamellas : Lamellas
        Of that network.
    density : float
        kg/m3.
    end_distance : float, optional
        Least distance from the outermost slot's axis to the strip's end, m; `default_end_distance` if not given.
    rim_overhang : float
        Least distance from the rim's node to the strip's end, m.
    hub_radius : float, optional
        From a singular node to the strip's end, m; `default_hub_radius` of what keeps the strips of neighbouring rays
        clear of each other if not given.
    slot_width : float, optional
        m; `default_slot_width` if not given.
    slot_play : float
        How far the slots' feet lie beyond the centre line, m.
    foot_radius : float
        Of the corners of the slots' feet, m.
    sheet : (float, float)
        Length and width of the sheets parts are cut from, m.
    gap : float
        Between parts, and from parts to the sheet's edge, m.
    transport_length : float, optional
        Longest part allowed, m.
    supply : Supply, optional
        Stock with which the splices of long strips are chosen, instead of the sheet.
    borders : sequence of (b,) int, optional
        Of each lamella: cells in whose middle it is cut, by the number of the node before.
    splice_room : float
        Half a splice and what it keeps from a slot, m; with stock no cut is nearer to a slot.
    trims : Trims, optional
        Where strips end at edge beams; every layer is then a part of its own.
    others : callable, optional
        Finds another number of cells whose net and lamellas have no such fault, in words.

    Returns
    -------
    Parts

    Raises
    ------
    InputError
        Where the measures contradict each other.
    """
    make = partial(
        make_parts,
        density=density,
        end_distance=end_distance,
        rim_overhang=rim_overhang,
        hub_radius=hub_radius,
        slot_width=slot_width,
        slot_play=slot_play,
        foot_radius=foot_radius,
        sheet=sheet,
        gap=gap,
        transport_length=transport_length,
        supply=supply,
        splice_room=splice_room,
    )
    if slot_width is None:
        slot_width = default_slot_width(lamellas.section.thickness)
    if end_distance is None:
        end_distance = default_end_distance(slot_width, network.normal_curvature, lamellas.section.height)
    strips = LayerStrips.of(network, lamellas, slot_width, own=trims is not None)
    notes = FabricationWarnings()
    hub_radius = _hub_radius(network, strips, hub_radius, slot_width, notes)
    rules = _rules(network, lamellas.section, density, strips.bow)(
        end_distance=end_distance,
        rim_overhang=rim_overhang,
        hub_radius=hub_radius,
        slot_width=slot_width,
        slot_play=slot_play,
        foot_radius=foot_radius,
        sheet=sheet,
        gap=gap,
        transport_length=np.inf if transport_length is None else transport_length,
    )
    rules.check()
    spans = _spans(network, strips, rules, trims, notes)
    cuts = split(
        spans,
        rules,
        notes,
        quantity=1 if strips.kinds > 1 else rules.layers,
        supply=supply,
        borders=borders,
        reach=splice_room,
    )
    parts, before, after = _all_parts(network, spans, cuts, rules, notes)
    if not lamellas.section.level:
        notes.collisions, notes.too_far = end_collisions(network, before, after, strips.reach)
    if others and notes.collisions and not notes.ends_help(rules):
        notes.other_cells = others(lambda net, there: make(net, there).colliding)
    warnings = tuple(notes.sentences(rules, len(network.ids) * strips.kinds, len(parts)))
    return Parts(tuple(parts), warnings, bool(notes.collisions))


def _rules(network: Network, section: Section, density: float, bow: float) -> Callable[..., Rules]:
    """The measures of all parts but for those that a project gives."""
    return partial(
        Rules,
        layers=section.layers,
        offset=section.offset,
        height=section.height,
        thickness=section.thickness,
        curvature=float(network.normal_curvature),
        density=density,
        bow=bow,
    )


def _hub_radius(
    network: Network, strips: LayerStrips, given: float | None, slot_width: float, notes: FabricationWarnings
) -> float:
    """From a singular node to the strips' ends, m; where it is shorter than given, or than needed, notes say so."""
    degree_a, degree_b = network.node_degrees()
    rays = int((degree_a + degree_b)[network.node_kinds == SINGULAR].max(initial=0))
    clear = strips.clear_hub(rays)
    wanted = default_hub_radius(clear) if given is None else given
    # the first slot of a ray stays on it
    radius = min(wanted, max(strips.first_slot(crossings(network)) - 1.5 * slot_width, 0.0))
    if radius < wanted:
        notes.hub_cut = wanted
    if radius < clear - LENGTH_ROUNDING:
        notes.hub_needed = clear
    return radius


def _spans(
    network: Network, strips: LayerStrips, rules: Rules, trims: Trims | None, notes: FabricationWarnings
) -> list[Span]:
    """All strips of which something remains between their ends."""
    crossing, singular = slotted(network, strips.lamellas.section), network.node_kinds == SINGULAR
    spans = []
    for index in range(len(network.ids)):
        nodes = network.stop_nodes[int(network.stop_offsets[index]) : int(network.stop_offsets[index + 1])]
        family, closed = str(network.families[index]), bool(network.closed[index])
        for strip in strips.of_lamella(index):
            ends = SQUARE if trims is None else trims.of(index, strip.layer or 1)
            span = Span.of(strip, family, closed, crossing[nodes], singular[nodes], rules, ends)
            if span.length > rules.slot_width:
                spans.append(span)
            else:
                notes.left_out.append(strip.name)
    return spans


def _all_parts(
    network: Network, spans: Sequence[Span], cuts: Sequence[Floats], rules: Rules, notes: FabricationWarnings
) -> tuple[list[Part], Floats, Floats]:
    """Parts of all strips; how far each lamella's reach beyond its first and its last node at most, m, (m,)."""
    parts: list[Part] = []
    before, after = np.full((2, len(network.ids)), -np.inf)
    for span, own in zip(spans, cuts, strict=True):
        if span.length > rules.longest_ring and not len(own):
            notes.left_out.append(span.strip.name)
            continue
        parts.extend(_pieces(span, own, rules, notes))
        index, stations = span.strip.lamella, span.strip.stations
        before[index] = max(before[index], stations[0] - span.start)
        after[index] = max(after[index], span.end - stations[-1])
    return parts, before, after


def _pieces(span: Span, cuts: Floats, rules: Rules, notes: FabricationWarnings) -> Iterator[Part]:
    """Parts of one strip."""
    strip, stations, crossing, width = span.strip, span.stations, span.crossing, span.width
    bounds = np.concatenate(([span.start], cuts, [span.end]))
    for piece, (low, high) in enumerate(zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True)):
        # a hub's node lies beyond the strip's end but belongs to its first or last piece
        inside = (stations > (low if piece else -np.inf)) & (stations < (high if piece < len(cuts) else np.inf))
        corners = np.array([[low, low], [high, high]])
        for side, at_end in enumerate((piece == 0, piece == len(cuts))):
            if at_end and not np.isnan(span.trims[side, 0]):
                corners[side] = span.trims[side]
        yield _part(
            f"{strip.name}.{piece + 1}" if len(cuts) else strip.name,
            strip,
            span.family,
            strip.axis(low, high),
            corners,
            stations[inside],
            int(np.argmax(inside)),
            (stations[:, None] + span.shifts)[inside & crossing],
            float(width[inside & crossing].max(initial=rules.slot_width)),
            rules,
            notes,
        )


def _part(
    name: str,
    strip: LayerStrip,
    family: str,
    axis: Axis,
    corners: Floats,
    nodes: Floats,
    first_node: int,
    wanted: Floats,
    slot_width: float,
    rules: Rules,
    notes: FabricationWarnings,
) -> Part:
    """One part with its slots, all as wide as its widest one, or without where they would come too close."""
    slots = np.sort(wanted.ravel())
    left_out = 0
    if len(slots):
        scale = axis.least_scale(0.5 * rules.height if family == "A" else -0.5 * rules.height)
        between = scale * np.diff(slots)
        outside = scale * min(slots[0] - corners[0].max(), corners[1].min() - slots[-1])
        needed = 2 * slot_width - LENGTH_ROUNDING
        if outside < 0.75 * needed or (len(between) and between.min() < needed):
            left_out, slots = len(slots), slots[:0]
            notes.unslotted.append((name, float(np.diff(nodes).min()) if len(nodes) > 1 else np.inf))
    vertices = outline(
        axis,
        rules.height,
        slots,
        slot_width,
        family == "A",
        slot_play=rules.slot_play,
        foot_radius=rules.foot_radius,
        ends=corners,
    )
    area = outline_area(vertices)
    return Part(
        id=name,
        lamella=strip.lamella,
        family=family,
        quantity=1 if strip.layer else rules.layers,
        height=rules.height,
        thickness=rules.thickness,
        curvature=strip.curvature,
        axis=axis,
        layer=strip.layer,
        side=strip.side,
        distance=strip.distance,
        nodes=nodes,
        first_node=first_node,
        slots=slots,
        slot_width=slot_width,
        slot_play=rules.slot_play,
        slots_left_out=left_out,
        outline=vertices,
        area=area,
        mass=rules.density * rules.thickness * area,
        corners=corners,
    )

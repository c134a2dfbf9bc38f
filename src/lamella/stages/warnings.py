"""What a run warns about: results that are computed rightly and yet should make the designer look twice."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import coordinates
from lamella.base.limits import CELLS_MIN
from lamella.base.material import Material
from lamella.base.message import Message
from lamella.base.vectors import diagonal
from lamella.base.wording import counted, rounded
from lamella.network.cell_sizes import EDGE_RATIO_MAX, large_cells, small_cells
from lamella.network.density_request import NODES_MAX
from lamella.network.network import SINGULAR, Network
from lamella.stages.keys import with_keys
from lamella.strip.lamellas import Lamellas, Section, layer_drift
from lamella.strip.overstress import Used, ways_to_stand
from lamella.surface.element.surface import SMOOTHED_ORDER, ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface

# m; the largest timber gridshells span well under 200 m
LARGE = 250.0
# surfaces this many strip heights across are a unit mistake more often than a building
SLENDER = 2500.0
# of the strip's height: nodes closer to each other are reported
SMALL = 0.1
# of the strip's height: one lower than that is another design, and is not offered
LOWER_SHARE = 0.5
# of SMALL: shorter edges than this are in no net that is offered, so that there are none on finer elements either
CLEARLY = 1.2
# share of the radius of curvature beyond which half the strip's height is no small strip any more
DEEP = 0.5
# share of the strength beyond which the stress of layers beside the centre line matters
LAYER_SHARE = 0.2
# of the mean distance of layers on lamella curves: farther off than by this factor they are worth a look
UNEVEN = 1.5


def size_cautions(mesh: SurfaceMesh, height: float) -> Iterator[Message]:
    """Sizes that look like millimetres taken for metres."""
    size = diagonal(mesh.points)
    if size > LARGE or size > SLENDER * height:
        yield Message(
            "unit_large",
            f"the surface is {size:,.0f} m across and the lamella {height:g} m high: all lengths in a project file are "
            "metres, were millimetres meant?",
        )
    elif size < 5 * height:
        yield Message(
            "unit_small",
            f"the surface is only {size:.3g} m across for a lamella {height:g} m high: all lengths in a project file "
            "are metres",
        )


def order_caution(order: int, tolerance: float, most_nodes: int) -> Message | None:
    """That elements of order 2 will need too many nodes, before they are made; None: they will not.

    Their curvature is off by the first power of their size: 0.6 to 2.4 / sqrt(nodes) of the curvature scale on films
    between rings, caps and saddles.
    """
    nodes = 2 / tolerance**2
    if order > 2 or nodes <= most_nodes:
        return None
    return Message(
        "order_low",
        f"order = 2 takes about {nodes:,.0f} nodes for tolerance = {tolerance:g} (most_nodes = {most_nodes:,}): order "
        "= 3 or 4 keeps it with a few thousand",
    )


def surface_file_cautions(surface: Surface[Any]) -> Iterator[Message]:
    """A surface.3dm that is no NURBS."""
    if not isinstance(surface, ElementSurface):
        return
    from lamella.files.write.surface_3dm import MESH_TOLERANCE, MOST_PATCHES

    count = 3 * len(surface.connectivity.elements)
    if count > MOST_PATCHES:
        yield Message(
            "surface_3dm_mesh",
            f"surface.3dm holds one mesh, within about {MESH_TOLERANCE:g} of the surface's size, and exact boundary "
            f"curves: NURBS would be {count:,} patches (limit {MOST_PATCHES:,}); a larger surface.tolerance"
            + (" or a higher surface.order" if surface.connectivity.basis.order < max(SMOOTHED_ORDER) else "")
            + " takes fewer",
        )


def network_cautions(
    network: Network,
    height: float,
    closing: str = "open",
    *,
    traced: bool = False,
    without: Callable[[Callable[[Network], bool]], str] | None = None,
) -> Iterator[Message]:
    """Lamellas left out, cells much larger than others or too small for the strip, needless wishes.

    `traced` is whether the lines come from seeds, one by one, and not from a lattice; `without` finds
    another number of cells whose net has no such fault, in words (`lamella.stages.other_cells`).
    """
    if closing != "open":
        yield Message(
            "closing_idle",
            f"network.closing = {closing!r} has nothing to do: every net of a closed-form surface closes by itself",
        )
    if network.left_out:
        yield Message(
            "lamellas_short",
            f"{network.left_out} lamellas shorter than network.minimum_length are left out"
            if network.left_out > 1
            else "1 lamella shorter than network.minimum_length is left out",
        )
    if len(network.faces_left_out):
        places = "; ".join(coordinates(point, 3) for point in network.node_points[network.faces_left_out[:3]])
        other = without(lambda net: len(net.faces_left_out) > 0) if without else ""
        yield Message(
            "faces_left_out",
            f"{counted(len(network.faces_left_out), 'face')} of more than six corners between lamellas and rim left "
            f"out (near {places} m): {other or f'with {2 * network.cells} cells they are about half as large'}",
        )
    count, large = large_cells(network)
    if large:
        places = "; ".join(f"{one.edge:.3g} m at ({coordinates(one.point, 3)}) m" for one in large)
        yield Message(
            "cells_large",
            f"{count} cell edge{'s are' if count > 1 else ' is'} over {EDGE_RATIO_MAX:g} x the median, up to "
            f"{large[0].ratio:.3g} x ({places}): {_why_large(network, traced, large[0].ratio)}",
        )
    if network.pattern.kind == "lamellas":
        yield from _small_cells(network, height, without)
    median = float(np.median(network.cell_edges))
    if median < height and network.pattern.kind == "lamellas":
        yield Message(
            "cells_narrow",
            f"half of the cell edges are shorter than {median * 1000:.3g} mm, less than the strip's height of "
            f"{height * 1000:g} mm: {_fewer(network, median, height)}a strip up to "
            f"{rounded(median * 1000, up=False):g} mm high",
        )


def _fewer(network: Network, median: float, height: float) -> str:
    """How many cells have edges as long as the strip is high, where that many make a net."""
    cells = int(0.95 * network.cells * median / height)
    return f"at most {cells} cells, or " if cells >= CELLS_MIN else ""


def _small_cells(
    network: Network, height: float, without: Callable[[Callable[[Network], bool]], str] | None
) -> Iterator[Message]:
    """Nodes so close to each other that no two slots fit."""
    count, small = small_cells(network, SMALL * height)
    if small:
        places = "; ".join(f"{1000 * one.edge:.2g} mm at ({coordinates(one.point, 3)}) m" for one in small)
        are = "is" if count == 1 else "are"
        lower = rounded(1000 * small[0].edge / SMALL, up=False)
        other = without(lambda net: small_cells(net, CLEARLY * SMALL * height)[0] > 0) if without else ""
        yield Message(
            "cells_small",
            f"{counted(count, 'cell edge')} {are} shorter than a tenth of the strip's height ({100 * height:.3g} mm), "
            f"down to {1000 * small[0].edge:.2g} mm ({places}): a lamella ends just behind a node there"
            + (f"; {other}" if other else "")
            + (f"; a strip up to {lower:g} mm high has room there" if lower >= 1000 * LOWER_SHARE * height else ""),
        )


def _why_large(network: Network, traced: bool, ratio: float) -> str:
    """What makes cells large, and what to do about it."""
    finer = (ratio / EDGE_RATIO_MAX) ** _slowness(network)
    more = ""
    if len(network.node_points) * finer**2 < NODES_MAX:
        cells = 2 * int(np.ceil(network.cells * finer / 2))
        more = f"{cells} cells make them about {EDGE_RATIO_MAX:g} x the median of now, or "
    if not traced:
        return (
            f"the surface is nearly planar or spherical there; {more}a boundary that bends it more makes them shorter"
        )
    if network.pattern.kind == "principal":
        return f"principal lines draw apart there; {more}a smaller spacing makes them shorter"
    return (
        "lines of one normal curvature draw apart there, or cross at flat angles; a smaller spacing, or another "
        "normal_curvature"
    )


def _slowness(network: Network) -> float:
    """Power of the number of cells by which one over the largest cell edge grows at most.

    Around a zero of order m of the Hopf differential, which has 2 (m + 2) rays, u + v goes like r^((m + 2) / 2).
    """
    singular = network.node_kinds == SINGULAR
    rays = np.bincount(network.stop_nodes, minlength=len(singular))[singular]
    return max(float(rays.max(initial=0)) / 4, 1.0)


def lamella_cautions(
    mesh: SurfaceMesh,
    network: Network,
    lamellas: Lamellas,
    slot_width: float,
    material: Material,
    known: Mapping[str, Material],
    used: Used,
    at_corner: Callable[[Floats], str] | None = None,
) -> Iterator[Message]:
    """Overstress, strips too high for the surface's curvature, layers that differ by more than their slots allow.

    `known` are materials by name, `used` is the largest utilisation of another section and material; `at_corner` what
    helps at a point next to a corner of the boundary.
    """
    worst = int(np.argmax(lamellas.utilisation))
    if lamellas.utilisation[worst] > 1:
        lamella = int(np.searchsorted(network.sample_offsets, worst, "right")) - 1
        point = coordinates(network.sample_points[worst], 3)
        over = int((np.add.reduceat(lamellas.utilisation > 1, network.sample_offsets[:-1]) > 0).sum())
        yield Message(
            "overstressed",
            f"utilisation reaches {lamellas.utilisation[worst]:.2f} in lamella {network.ids[lamella]} at ({point}) m "
            f"({over} of {len(network.ids)} lamellas {'is' if over == 1 else 'are'} over 1): "
            + (at_corner(network.sample_points[worst]) if at_corner else "")
            + with_keys(ways_to_stand(network, lamellas, material, known, used), "lamella.material ="),
        )
    half = lamellas.section.height / 2
    curvature = float(max(np.abs(mesh.k1).max(), np.abs(mesh.k2).max()))
    if half * curvature > DEEP:
        yield Message(
            "strip_high",
            f"half the strip's height ({half:g} m) is {half * curvature:.2f} of the surface's smallest radius of "
            f"curvature ({1 / curvature:.3g} m): the strips' edges are far from their centre lines",
        )
    section = lamellas.section
    if section.layers > 1 and not section.own_parts:
        drift = layer_drift(network) * section.offset * (section.layers - 1)
        # a lamella's layers sit in the crossing ones' slots and these in its own
        play = 2 * (slot_width - section.thickness)
        over = int((drift > play).sum())
        if over:
            yield Message(
                "layers_drift",
                f"the {section.layers} layers are cut alike, but on their own curves nodes lie at other distances: in "
                f"{over} of {len(drift)} lamellas the outer layers drift apart by more than the slots' play of "
                f"{play * 1000:.3g} mm, up to {drift.max() * 1000:.3g} mm: write lamella.layer_lengths = 'own', or "
                "choose one layer",
            )


def _nearer(section: Section, share: float) -> str:
    """The offset with which layers have a stress that does not matter: it goes with their distance."""
    offset = rounded(section.offset * LAYER_SHARE / share, up=False)
    return f"lamella.offset = {offset:g} m, or " if offset > section.thickness else ""


def layer_cautions(network: Network, lamellas: Lamellas, material: Material) -> Iterator[Message]:
    """Layers that are bent about their strong axis, or whose distances vary much."""
    section, starts = lamellas.section, network.sample_offsets[:-1]
    share = lamellas.layer / material.strength
    worst = int(np.argmax(share))
    if share[worst] > LAYER_SHARE:
        over = int((np.maximum.reduceat(share, starts) > LAYER_SHARE).sum())
        point = coordinates(network.sample_points[worst], 3)
        yield Message(
            "layers_bent",
            f"layers {np.abs(section.layer_offsets).max() * 1000:.3g} mm beside the centre line are bent about their "
            f"strong axis, up to {lamellas.layer[worst] / 1e6:.3g} MPa at ({point}) m, by more than {LAYER_SHARE:.0%} "
            f"of the strength in {over} of {len(network.ids)} lamellas: cut them to their own outlines "
            f"(lamella.layer_curves = 'cut'), or choose {_nearer(section, float(share[worst]))}one layer",
        )
    if section.layer_curves != "lamella" or section.layers == 1:
        return
    apart = np.diff(lamellas.layers.distances, axis=0)[:, lamellas.layers.followed]
    least, most = float(apart.min()), float(apart.max())
    if least < section.offset / UNEVEN or most > UNEVEN * section.offset:
        close = f"; strips {section.thickness * 1000:g} mm thick touch" if least <= section.thickness else ""
        yield Message(
            "layers_uneven",
            f"on lamella curves of their own layers are {least * 1000:.3g} to {most * 1000:.3g} mm apart, where offset "
            f"= {section.offset * 1000:g} mm is the mean{close}: lamella.layer_curves = 'cut' keeps them parallel",
        )

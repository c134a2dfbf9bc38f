"""What a run warns about nets: lamellas left out, cells much larger than others or too small for the strip."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.limits import CELLS_MIN
from lamella.base.message import Message
from lamella.base.wording import counted, rounded
from lamella.network.cell_sizes import EDGE_RATIO_MAX, large_cells, small_cells
from lamella.network.density_request import NODES_MAX
from lamella.network.network import SINGULAR, Network

# of the strip's height: nodes closer to each other are reported
SMALL = 0.1
# of the strip's height: one lower than that is another design, and is not offered
LOWER_SHARE = 0.5
# of SMALL: shorter edges than this are in no net that is offered, so that there are none on finer elements either
CLEARLY = 1.2


def network_warnings(
    network: Network,
    height: float,
    closing: str = "open",
    *,
    traced: bool = False,
    without: Callable[[Callable[[Network], bool]], str] | None = None,
) -> Iterator[Message]:
    """Lamellas left out, cells much larger than others or too small for the strip, needless wishes.

    `traced` is whether the lines come from seeds, one by one, and not from a lattice; `without` finds
    another number of cells whose net has no such fault, in words (`lamella.stages.network.other_cells`).
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

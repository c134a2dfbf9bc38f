"""What a run warns about: results that are computed rightly and yet should make the designer look twice."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas
from lamella.surface.mesh import SurfaceMesh

# m; the largest timber gridshells span well under 200 m
LARGE = 250.0
# surfaces this many strip heights across are a unit mistake more often than a building
SLENDER = 2500.0
# share of the radius of curvature beyond which half the strip's height is no small strip any more
DEEP = 0.5
# m; the drawings' own accuracy
WORTH_TELLING = 1e-5


def size_cautions(mesh: SurfaceMesh, height: float) -> Iterator[str]:
    """Sizes that look like millimetres taken for metres."""
    size = float(np.linalg.norm(np.ptp(mesh.points, axis=0)))
    if size > LARGE or size > SLENDER * height:
        yield (
            f"the surface is {size:,.0f} m across and the lamella {height:g} m high: all lengths in a project file are "
            "metres, were millimetres meant?"
        )
    elif size < 5 * height:
        yield (
            f"the surface is only {size:.3g} m across for a lamella {height:g} m high: all lengths in a project file "
            "are metres"
        )


def network_cautions(network: Network, height: float, closing: str = "open") -> Iterator[str]:
    """Lamellas left out, cells too small for the strip, and a wish to close a net that closes anyway."""
    if closing != "open":
        yield f"network.closing = {closing!r} has nothing to do: every net of a closed-form surface closes by itself"
    if network.left_out:
        yield (
            f"{network.left_out} lamellas shorter than network.minimum_length are left out"
            if network.left_out > 1
            else "1 lamella shorter than network.minimum_length is left out"
        )
    median = float(np.median(network.cell_edges))
    if median < height:
        yield (
            f"half of the cell edges are shorter than {median * 1000:.3g} mm, less than the strip's height of "
            f"{height * 1000:g} mm: choose fewer cells or a lower strip"
        )


def lamella_cautions(mesh: SurfaceMesh, network: Network, lamellas: Lamellas, slot_width: float) -> Iterator[str]:
    """Overstress, strips too high for the surface's curvature, layers that differ by more than their slots allow."""
    worst = int(np.argmax(lamellas.utilisation))
    if lamellas.utilisation[worst] > 1:
        lamella = int(np.searchsorted(network.sample_offsets, worst, "right")) - 1
        point = ", ".join(f"{x:.3g}" for x in network.sample_points[worst])
        over = int((np.add.reduceat(lamellas.utilisation > 1, network.sample_offsets[:-1]) > 0).sum())
        yield (
            f"utilisation reaches {lamellas.utilisation[worst]:.2f} in lamella {network.ids[lamella]} at ({point}) m "
            f"({over} of {len(network.ids)} lamellas {'is' if over == 1 else 'are'} over 1): a thinner or lower strip, "
            "a stronger material or a flatter surface helps"
        )
    half = lamellas.section.height / 2
    curvature = float(max(np.abs(mesh.k1).max(), np.abs(mesh.k2).max()))
    if half * curvature > DEEP:
        yield (
            f"half the strip's height ({half:g} m) is {half * curvature:.2f} of the surface's smallest radius of "
            f"curvature ({1 / curvature:.3g} m): the strips' edges are far from their centre lines"
        )
    layers, offset = lamellas.section.layers, lamellas.section.offset
    if layers > 1:
        # the layer at sideways distance d is shorter by the integral of kg d
        kg, s = network.sample_darboux.kg, network.sample_arclengths
        turn = np.append(0.0, np.cumsum((kg[1:] + kg[:-1]) / 2 * np.diff(s)))
        owner = network.stop_owner
        at = turn[network.sample_offsets[owner] + network.stop_samples]
        cell = np.abs(np.diff(at))[owner[1:] == owner[:-1]].max() * offset * (layers - 1) / 2
        play = slot_width - lamellas.section.thickness
        if cell >= WORTH_TELLING:
            verdict = (
                f"within the slots' play of {play * 1000:.3g} mm"
                if cell <= play
                else f"more than the slots' play of {play * 1000:.3g} mm: choose one layer, a smaller offset "
                "or wider slots"
            )
            yield (
                f"the {layers} layers are cut alike, with the centre line's node distances; on their own curves, "
                f"{offset * (layers - 1) / 2 * 1000:g} mm to the side, a cell differs by up to {cell * 1000:.2g} mm, "
                f"{verdict}"
            )

"""What a run warns about strips: overstress, strips too high for the curvature, layers that do not fit."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import coordinates
from lamella.base.material import Material
from lamella.base.message import Message
from lamella.base.wording import rounded
from lamella.network.network import Network
from lamella.stages.keys import with_keys
from lamella.strip.lamellas import Lamellas, Section, layer_drift
from lamella.strip.overstress import Used, ways_to_stand
from lamella.surface.mesh import SurfaceMesh

# share of the radius of curvature beyond which half the strip's height is no small strip any more
DEEP = 0.5
# share of the strength beyond which the stress of layers beside the centre line matters
LAYER_SHARE = 0.2
# of the mean distance of layers on lamella curves: farther off than by this factor they are worth a look
UNEVEN = 1.5


def lamella_warnings(
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
    if section.layers > 1 and not section.own_parts and not section.level:
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


def layer_warnings(network: Network, lamellas: Lamellas, material: Material) -> Iterator[Message]:
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

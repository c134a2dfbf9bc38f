"""What the view shows of strips: all layers at their thickness, stresses along the lamellas."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.arrays import Floats
from lamella.network.network import FAMILIES, Network
from lamella.solid.finish import finish
from lamella.stages.lamellas.sizing_scene import sizing_facts, sizing_plot, sizing_quantities
from lamella.stages.network.scene import CURVES, PALETTE, Thinned, curvature_quantities, thinned
from lamella.strip.lamellas import Lamellas
from lamella.strip.sizing import Sizing
from lamella.view.scene.curves import Curves, Fact, Plot, Series
from lamella.view.scene.layer import Material, StripsLayer
from lamella.view.scene.quantity import FAMILY_COLOURS, Quantity, magnitude
from lamella.view.scene.scene import Shown

LOOKS: dict[str, Material] = {"metal": "steel", "timber": "timber", "fibre": "fibre"}
"""What a finish looks like."""

LOW = 250.0
"""Strips lower than the size of the net over this are lines from afar: their centre lines are drawn too."""

PLANARITY = ("#e9e6e1", "#f3b9a4", "#f87a63", "#ff0000")
PLANARITY_HIGH = 0.005
"""Pure red from there on, as in the paper."""

STRESSES = (
    ("bending", "bending"),
    ("torsion", "torsion"),
    ("helix_edge", "helix edge"),
    ("helix_centre", "helix centre"),
    ("restraint", "restraint"),
    ("layer", "layers beside"),
    ("von_mises", "von Mises"),
)
TO_MPA = 1e-6


def lamellas_scene(lamellas: Lamellas, sizing: Sizing | None = None) -> Iterator[Shown]:
    """The strips of either family, the stresses along them, and how near to their limit they are."""
    network, section = lamellas.network, lamellas.section
    kept = thinned(network)
    quantities = _quantities(lamellas, kept)
    if sizing is not None:
        quantities += sizing_quantities(sizing, lamellas, kept)
    size = float(np.ptp(network.sample_points, axis=0).max()) if len(network.sample_points) else 0.0
    for family in FAMILIES:
        own_lamellas, own, offsets = kept.family(network, family)
        if not len(own_lamellas):
            continue
        samples = kept.samples[own]
        yield StripsLayer(
            name=f"strips {family}",
            label=f"Lamellas {family}",
            groups=(family,),
            material=LOOKS[finish(lamellas.material.density)],
            quantities=tuple(quantity.of(own) for quantity in quantities),
            quantity="utilisation",
            palette=PALETTE,
            colour=FAMILY_COLOURS[family],
            ids=tuple(network.ids[k] for k in own_lamellas.tolist()),
            replaces=() if section.height < size / LOW else (f"lines {family}",),
            # points of stacked lamellas are those of their own level
            positions=network.sample_points[samples],
            normals=network.sample_normals[samples],
            offsets=offsets,
            sides=lamellas.layers.distances[:, samples] if section.layer_curves == "lamella" else section.layer_offsets,
            height=section.height,
            thickness=section.thickness,
        )
    if len(network.ids):
        yield _curves(lamellas, kept, sizing)


def _quantities(lamellas: Lamellas, kept: Thinned) -> tuple[Quantity, ...]:
    some = kept.samples
    use = lamellas.utilisation[some]
    return (
        magnitude("utilisation", "Utilisation", "of strength", use, min(1.0, float(use.max(initial=0.0)))),
        magnitude("mises", "Von Mises stress", "MPa", lamellas.von_mises[some] * TO_MPA),
        magnitude("layers", "Stress of layers beside", "MPa", lamellas.layer[some] * TO_MPA),
        *curvature_quantities(lamellas.network, some),
        magnitude("planarity", "Planarity score", "", _planarity(lamellas, kept), PLANARITY_HIGH, PLANARITY),
    )


def _planarity(lamellas: Lamellas, kept: Thinned) -> Floats:
    """The worst score between a kept sample and the next; an end takes its neighbour's."""
    if not len(kept.samples):
        return np.zeros(0)
    worst = np.maximum.reduceat(lamellas.planarity, kept.samples)
    ends = kept.offsets[1:] - 1
    worst[ends] = worst[ends - 1]
    return np.asarray(worst, dtype=np.float64)


def _curves(lamellas: Lamellas, kept: Thinned, sizing: Sizing | None) -> Curves:
    """Facts and stresses, for the curves that the net has given."""
    network: Network = lamellas.network
    largest = np.maximum.reduceat(lamellas.utilisation, network.sample_offsets[:-1])
    series = tuple(Series(key, label, getattr(lamellas, key)[kept.samples] * TO_MPA) for key, label in STRESSES)
    empty = np.zeros(0, np.int64)
    return Curves(
        name=CURVES,
        noun="Lamella",
        ids=network.ids,
        offsets=kept.offsets,
        arclengths=network.sample_arclengths[kept.samples],
        stop_offsets=np.zeros(len(network.ids) + 1, np.int64),
        stop_nodes=empty,
        stop_samples=empty,
        facts=(
            Fact("Developed length", "m", lamellas.developed_lengths, 3),
            Fact("Largest utilisation", "", largest),
            *(() if sizing is None else sizing_facts(sizing)),
        ),
        plots=(
            Plot("Residual stress", "MPa", series),
            *(() if sizing is None else (sizing_plot(sizing, lamellas, kept),)),
        ),
        worst="Most stressed",
        worst_by="von_mises",
    )

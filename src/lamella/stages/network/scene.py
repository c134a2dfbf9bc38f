"""What the view shows of a net: centre lines, nodes, and curvatures along the lamellas."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.network import FAMILIES, NODE_KINDS, REGULAR, Network
from lamella.view.scene.curves import Curves, Fact, Plot, Series
from lamella.view.scene.layer import LinesLayer, PointsLayer
from lamella.view.scene.quantity import FAMILY_COLOURS, Quantity, magnitude, signed
from lamella.view.scene.scene import Labels, Remark, Shown
from lamella.view.scene.thinning import kept_samples, kept_stops, stop_stride

SAMPLE_LIMIT = 100_000
"""Centre line samples in a view; at 50 bytes each this keeps a large net's file at a few MB."""

STOP_LIMIT = 60_000
"""Nodes on lamellas, counted on each of them, in a view."""

CURVES = "lamellas"
"""Name of the curves: later stages add to them."""

PALETTE = "Lamellas"
"""List of what centre lines and strips are coloured by."""

NODE_STYLES = {
    "regular": ("#7b8796", 3.5, 0.6),
    "boundary": ("#7b8796", 3.5, 0.6),
    "singular": ("#d0103a", 12.0, 7.0),
    "seam": ("#1f9d55", 6.0, 1.5),
}
"""Colour, largest and least size on the screen, pixels."""


@dataclass(frozen=True, eq=False)
class Thinned:
    """The samples and nodes of a net that a view holds.

    Attributes
    ----------
    samples : (k,) int
        Of all samples.
    offsets : (m + 1,) int
        Where those of each lamella begin.
    stops : (q,) int
        Of all stops.
    """

    samples: Integers
    offsets: Integers
    stops: Integers

    def family(self, network: Network, family: str) -> tuple[Integers, Integers, Integers]:
        """Lamellas of a family, their samples among `samples`, and where those of each begin."""
        lamellas = np.flatnonzero(network.families == family)
        counts = np.diff(self.offsets)[lamellas]
        offsets = np.concatenate([[0], np.cumsum(counts)])
        own = np.arange(offsets[-1]) + np.repeat(self.offsets[:-1][lamellas] - offsets[:-1], counts)
        return lamellas, own, offsets


def thinned(network: Network) -> Thinned:
    """All samples and nodes, or some of them where there are too many for a view."""
    stops = kept_stops(network.stop_offsets, STOP_LIMIT)
    samples = kept_samples(network.sample_offsets, stop_places(network)[stops], SAMPLE_LIMIT)
    return Thinned(samples, np.searchsorted(samples, network.sample_offsets), stops)


def stop_places(network: Network) -> Integers:
    """The sample of each stop, counted over all lamellas."""
    starts = np.repeat(network.sample_offsets[:-1], np.diff(network.stop_offsets))
    return np.asarray(starts + network.stop_samples, dtype=np.int64)


def network_scene(network: Network) -> Iterator[Shown]:
    """Centre lines of either family, nodes by their kind, curvatures along the lamellas."""
    kept = thinned(network)
    total = len(network.sample_points)
    if len(kept.samples) < total:
        stride = stop_stride(len(network.stop_nodes), STOP_LIMIT)
        nodes = "every node" if stride == 1 else f"one node in {stride}"
        yield Remark(
            f"Drawn and plotted with {len(kept.samples):,} of {total:,} centre line samples, {nodes} among them."
        )
    quantities = curvature_quantities(network, kept.samples)
    for family in FAMILIES:
        lamellas, own, offsets = kept.family(network, family)
        if not len(lamellas):
            continue
        yield LinesLayer(
            name=f"lines {family}",
            label=f"Centre lines {family}",
            groups=(family,),
            colour=FAMILY_COLOURS[family],
            quantities=tuple(quantity.of(own) for quantity in quantities),
            quantity="layer",
            palette=PALETTE,
            ids=tuple(network.ids[k] for k in lamellas.tolist()),
            owner=np.repeat(np.arange(len(lamellas)), np.diff(offsets)),
            positions=network.sample_points[kept.samples[own]],
            offsets=offsets,
            width=2.5,
        )
    yield from _nodes(network, kept)
    if len(network.ids):
        yield _curves(network, kept)
    yield Labels("lamellas", "Lamella names", *_names(network))


def curvature_quantities(network: Network, samples: Integers) -> tuple[Quantity, ...]:
    """What centre lines and strips can be coloured by: curvatures at some samples."""
    darboux = network.sample_darboux
    return (
        signed("twist", "Geodesic torsion (twist) tg", "1/m", darboux.tg[samples]),
        magnitude("geodesic", "Geodesic curvature |kg|", "1/m", np.abs(darboux.kg[samples])),
    )


def _nodes(network: Network, kept: Thinned) -> Iterator[PointsLayer]:
    """Nodes of kept stops, and the few of other kinds."""
    drawn = network.node_kinds != REGULAR
    drawn[network.stop_nodes[kept.stops]] = True
    for kind, name in enumerate(NODE_KINDS):
        own: Booleans = drawn & (network.node_kinds == kind)
        if own.any():
            colour, size, least = NODE_STYLES[name]
            count = int(np.count_nonzero(network.node_kinds == kind))
            nodes = np.flatnonzero(own)
            yield PointsLayer(
                name=f"nodes {name}",
                label=f"{name} ({count})",
                groups=("Nodes",),
                colour=colour,
                ids=tuple(f"node {node}" for node in nodes.tolist()),
                owner=np.arange(len(nodes)),
                positions=network.node_points[nodes],
                size=size,
                least=least,
            )


def _curves(network: Network, kept: Thinned) -> Curves:
    darboux = network.sample_darboux
    samples = np.searchsorted(kept.samples, stop_places(network)[kept.stops])
    stop_offsets = np.searchsorted(kept.stops, network.stop_offsets)
    series = (
        Series("normalCurvature", "kn normal", darboux.kn[kept.samples]),
        Series("geodesicCurvature", "kg geodesic", darboux.kg[kept.samples]),
        Series("geodesicTorsion", "tg torsion", darboux.tg[kept.samples]),
    )
    return Curves(
        name=CURVES,
        noun="Lamella",
        ids=network.ids,
        offsets=kept.offsets,
        arclengths=network.sample_arclengths[kept.samples],
        stop_offsets=stop_offsets,
        stop_nodes=network.stop_nodes[kept.stops],
        stop_samples=samples - np.repeat(kept.offsets[:-1], np.diff(stop_offsets)),
        facts=(
            Fact("Family", "", tuple(network.families.tolist())),
            Fact("Length", "m", network.lengths, 3),
            Fact("Nodes", "", np.diff(network.stop_offsets).astype(float), 0),
        ),
        plots=(Plot("Curvature", "1/m", series, 4),),
    )


def _names(network: Network) -> tuple[Floats, tuple[str, ...]]:
    """The middle of each lamella, and its name."""
    middle = (network.sample_offsets[:-1] + network.sample_offsets[1:] - 1) // 2
    return network.sample_points[middle], network.ids

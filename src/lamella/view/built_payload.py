"""What is built, for the report's 3D view: strips as solids that take the lamellas' colours, hardware once a kind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.files.write.drawn_layer import DrawnLayer, Repeated
from lamella.network.network import Network
from lamella.view.encoding import float32, integers

PIECE_LIMIT = 20_000
"""Pieces of hardware in a report, 64 bytes each."""

STORED_TRIANGLES = 100_000
"""Triangles of all kinds, each counted once: 2 MB."""

SHOWN_TRIANGLES = 1_500_000
"""Triangles of all pieces of hardware together that a browser draws in time."""


def built_payload(
    layers: Sequence[DrawnLayer], network: Network, kept: Integers, centre: Floats
) -> tuple[dict[str, Any] | None, list[str]]:
    """What report.js reads of what is built, and remarks on what was left out; None where there is nothing.

    Parameters
    ----------
    layers : sequence of DrawnLayer
    network : Network
    kept : (k,) int
        Samples of the network that the report holds: the strips' colours are theirs.
    centre : (3,)
        Of the report's coordinates, m.
    """
    strips = [_strips(layer, network, kept, centre) for layer in layers if layer.bodies]
    kinds = [(layer, solid) for layer in layers for solid in layer.repeated]
    shown = _bounded(kinds)
    notes = []
    if len(shown) < len(kinds):
        left_out = sum(len(solid.origins) for _, solid in kinds) - sum(len(solid.origins) for _, solid in shown)
        notes.append(f"Drawn without {left_out:,} pieces of hardware; model.3dm and model.glb hold them.")
    if not strips and not shown:
        return None, notes
    return {"strips": strips, "hardware": [_kind(layer, solid, centre) for layer, solid in shown]}, notes


def _strips(layer: DrawnLayer, network: Network, kept: Integers, centre: Floats) -> dict[str, Any]:
    """The strips of one family as one mesh, and the sample that is nearest to each vertex."""
    family = layer.name.rpartition(" ")[2]
    starts = np.cumsum([0, *(len(body.vertices) for body in layer.bodies)])
    vertices = np.concatenate([body.vertices for body in layer.bodies])
    triangles = np.concatenate(
        [body.triangles + start for body, start in zip(layer.bodies, starts[:-1].tolist(), strict=True)]
    )
    owner = np.repeat(network.families, np.diff(network.sample_offsets))
    own = np.flatnonzero(owner[kept] == family)
    _, nearest = cKDTree(network.sample_points[kept[own]]).query(vertices)
    return {
        "family": family,
        "points": float32(vertices - centre),
        "triangles": integers(triangles),
        "samples": integers(own[nearest]),
    }


def _bounded(kinds: list[tuple[DrawnLayer, Repeated]]) -> list[tuple[DrawnLayer, Repeated]]:
    """The kinds that a report holds within its limits: those that take least for each of their pieces come first."""
    pieces = [len(solid.origins) for _, solid in kinds]
    stored = [len(solid.triangles) for _, solid in kinds]
    order = sorted(range(len(kinds)), key=lambda k: (stored[k] / max(pieces[k], 1), k))
    room = np.array([PIECE_LIMIT, STORED_TRIANGLES, SHOWN_TRIANGLES])
    kept = []
    for k in order:
        needs = np.array([pieces[k], stored[k], pieces[k] * stored[k]])
        if (needs <= room).all():
            room = room - needs
            kept.append(k)
    return [kinds[k] for k in sorted(kept)]


def _kind(layer: DrawnLayer, solid: Repeated, centre: Floats) -> dict[str, Any]:
    """A kind of hardware: its mesh, and the matrices of its places, columns first."""
    matrices = np.zeros((len(solid.origins), 4, 4))
    matrices[:, :3, :3], matrices[:, 3, :3], matrices[:, 3, 3] = solid.axes, solid.origins - centre, 1.0
    return {
        "id": solid.text.get("id", solid.name),
        "finish": solid.finish,
        "colour": "#{:02x}{:02x}{:02x}".format(*layer.colour),
        "points": float32(solid.vertices),
        "triangles": integers(solid.triangles),
        "matrices": float32(matrices),
    }

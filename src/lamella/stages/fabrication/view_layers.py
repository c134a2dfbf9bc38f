"""What the view shows of what is built: strips as solids with their slots and holes, and hardware."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Integers
from lamella.base.wording import counted
from lamella.files.write.drawn_layer import DrawnLayer, Repeated
from lamella.network.network import Network
from lamella.project.tables import Project
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.fabrication.scene import BEAM, report_layers
from lamella.stages.lamellas.scene import LOOKS
from lamella.stages.network.scene import thinned
from lamella.strip.lamellas import Lamellas
from lamella.view.scene.layer import InstancesLayer, MeshLayer
from lamella.view.scene.scene import Remark, Shown

PIECE_LIMIT = 20_000
"""Pieces of hardware in a view, 64 bytes each."""

STORED_TRIANGLES = 100_000
"""Triangles of all kinds, each counted once: 2 MB."""

SHOWN_TRIANGLES = 1_500_000
"""Triangles of all pieces of hardware together that a browser draws in time."""

PICTURE_TRIANGLES = 2_000_000
"""Triangles of all pieces of hardware together in a still picture: 0.5 GB."""

GROUPS = {"edge_beam": "Edge beams", "cable": "Cables", "turnbuckle": "Cables", "clamp": "Cables"}
"""Switches of kinds of hardware; the others are on one."""
OTHER_GROUP = "Hardware"


def fabrication_scene(
    project: Project, out: FabricationOutput, lamellas: Lamellas, *, still: bool = False
) -> Iterator[Shown]:
    """Solids of strips where there are joints or they were asked for, and hardware.

    Parameters
    ----------
    project : Project
    out : FabricationOutput
    lamellas : Lamellas
    still : bool
        Whether it is for a picture, which no browser has to hold.
    """
    if project.joint is None and not project.files.solids:
        return
    layers = list(report_layers(out, lamellas, project.lamella.material))
    for layer in layers:
        if layer.bodies:
            yield _strips(layer, lamellas.network)
    kinds = [(layer, solid) for layer in layers for solid in layer.repeated]
    beams = frozenset(k for k, (layer, _) in enumerate(kinds) if layer.name == BEAM)
    shown = bounded([(len(solid.origins), len(solid.triangles)) for _, solid in kinds], beams, still=still)
    if len(shown) < len(kinds):
        left_out = sum(len(solid.origins) for _, solid in kinds) - sum(len(kinds[k][1].origins) for k in shown)
        left = counted(left_out, "piece")
        yield Remark(f"Drawn without {left} of hardware; model.3dm and model.glb hold all hardware.")
    single: dict[str, list[Repeated]] = {}
    for layer, solid in (kinds[k] for k in shown):
        if len(solid.origins) == 1:
            single.setdefault(layer.name, []).append(solid)
        else:
            yield _instances(layer, solid)
    colours = {layer.name: layer.colour for layer in layers}
    for kind, solids in single.items():
        yield _merged(kind, colours[kind], solids)


def bounded(sizes: Sequence[tuple[int, int]], beams: frozenset[int] = frozenset(), *, still: bool = False) -> list[int]:
    """Which kinds of hardware a view holds within its limits: beams, then those that take least for each piece.

    Parameters
    ----------
    sizes : sequence of (pieces, triangles of one)
    beams : frozenset of int
        Which of them are edge beams.
    still : bool
        Whether it is a picture, of which nothing but its triangles is bounded.
    """
    order = sorted(range(len(sizes)), key=lambda k: (k not in beams, sizes[k][1] / max(sizes[k][0], 1), k))
    limits = (np.inf, np.inf, PICTURE_TRIANGLES) if still else (PIECE_LIMIT, STORED_TRIANGLES, SHOWN_TRIANGLES)
    room = np.array(limits)
    kept = []
    for k in order:
        pieces, triangles = sizes[k]
        needs = np.array([pieces, triangles, pieces * triangles])
        if (needs <= room).all():
            room = room - needs
            kept.append(k)
    return sorted(kept)


def _strips(layer: DrawnLayer, network: Network) -> MeshLayer:
    """The strips of one family as one mesh; every vertex has the colours of the sample nearest to it."""
    family = layer.name.rpartition(" ")[2]
    starts = np.cumsum([0, *(len(body.vertices) for body in layer.bodies)])
    vertices = np.concatenate([body.vertices for body in layer.bodies])
    triangles = np.concatenate(
        [body.triangles + start for body, start in zip(layer.bodies, starts[:-1].tolist(), strict=True)]
    )
    kept = thinned(network)
    _, own, _ = kept.family(network, family)
    _, nearest = cKDTree(network.sample_points[kept.samples[own]]).query(vertices)
    return MeshLayer(
        name=f"solids {family}",
        label=f"Lamellas {family} as built",
        groups=(family, "As built"),
        material=LOOKS[layer.bodies[0].finish],
        replaces=(f"strips {family}", f"lines {family}"),
        positions=vertices,
        faces=triangles,
        like=f"strips {family}",
        samples=np.asarray(nearest, np.int64),
    )


def _instances(layer: DrawnLayer, solid: Repeated) -> InstancesLayer:
    return InstancesLayer(
        name=f"{layer.name} {solid.name}",
        label=solid.text.get("description", solid.name),
        groups=(GROUPS.get(layer.name, OTHER_GROUP),),
        material=LOOKS[solid.finish],
        colour=_hex(layer.colour),
        ids=tuple(f"{solid.text.get('id', solid.name)}, {label}" for label in solid.labels),
        owner=np.arange(len(solid.origins)),
        positions=solid.vertices,
        faces=solid.triangles,
        origins=solid.origins,
        axes=solid.axes,
    )


def _merged(kind: str, colour: tuple[int, int, int], solids: Sequence[Repeated]) -> MeshLayer:
    """Pieces that stand in one place each, as one mesh."""
    counts = [len(solid.vertices) for solid in solids]
    starts = np.cumsum([0, *counts])
    owner: Integers = np.repeat(np.arange(len(solids)), counts)
    return MeshLayer(
        name=f"{kind} single",
        label=kind.replace("_", " ").replace("-", " "),
        groups=(GROUPS.get(kind, OTHER_GROUP),),
        material=LOOKS[solids[0].finish],
        colour=_hex(colour),
        ids=tuple(f"{solid.text.get('id', solid.name)}, {solid.labels[0]}" for solid in solids),
        owner=owner,
        positions=np.concatenate([solid.origins[0] + solid.vertices @ solid.axes[0] for solid in solids]),
        faces=np.concatenate([solid.triangles + start for solid, start in zip(solids, starts[:-1], strict=True)]),
    )


def _hex(colour: tuple[int, int, int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*colour)

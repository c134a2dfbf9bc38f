"""Developable strips in the model and in the view, beside the twisted ones."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.files.write.drawn_layer import Body, DrawnLayer
from lamella.network.network import FAMILIES
from lamella.solid.finish import finish
from lamella.strip.developable_solids import DevelopableSolid, developable_solids
from lamella.strip.developable_strips import DevelopableStrips
from lamella.strip.lamellas import Lamellas
from lamella.view.scene.layer import MeshLayer
from lamella.view.scene.quantity import FAMILY_COLOURS, magnitude
from lamella.view.scene.scene import Shown

DEVELOPABLE_COLOURS = {"A": (60, 130, 160), "B": (200, 140, 80)}
"""Of the layers of the model."""
TO_MPA = 1e-6


def developable_layers(lamellas: Lamellas, strips: DevelopableStrips) -> Iterator[DrawnLayer]:
    """Layers "developable A" and "developable B" of the model: a solid for each piece of each layer."""
    network = lamellas.network
    looks = finish(lamellas.material.density)
    bodies: dict[str, list[Body]] = {family: [] for family in FAMILIES}
    for solid in developable_solids(lamellas, strips):
        name = f"{network.ids[solid.lamella]}-{solid.layer + 1}.{solid.piece + 1}"
        text = {"family": str(network.families[solid.lamella]), "kind": "developable strip"}
        bodies[text["family"]].append(Body(name, solid.vertices, solid.triangles, text, looks))
    for family, made in bodies.items():
        if made:
            yield DrawnLayer(f"developable {family}", colour=DEVELOPABLE_COLOURS[family], bodies=tuple(made))


def developable_scene(lamellas: Lamellas, strips: DevelopableStrips) -> Iterator[Shown]:
    """The same in the view, coloured by their bending stress; a switch shows them."""
    network = lamellas.network
    stress = np.where(strips.exists, strips.bending, np.nan) * TO_MPA
    for family in FAMILIES:
        solids = [one for one in developable_solids(lamellas, strips) if network.families[one.lamella] == family]
        if not solids:
            continue
        begins = np.cumsum([0] + [len(one.vertices) for one in solids[:-1]])
        yield MeshLayer(
            name=f"developable {family}",
            label=f"Developable strips {family}",
            groups=(family, "Developable strips"),
            visible=False,
            material="steel",
            colour=FAMILY_COLOURS[family],
            quantities=(
                magnitude("developable_stress", "Bending stress, developable", "MPa", _on_vertices(solids, stress)),
            ),
            quantity="developable_stress",
            positions=np.concatenate([one.vertices for one in solids]),
            faces=np.concatenate([one.triangles + at for one, at in zip(solids, begins.tolist(), strict=True)]),
        )


def _on_vertices(solids: list[DevelopableSolid], values: np.ndarray) -> np.ndarray:
    return np.concatenate([np.repeat(values[one.samples], 4) for one in solids])

"""Layers of the model that show what is built: strips with their thickness, slots and holes, and hardware."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lamella.base.message import Message
from lamella.files.write.drawn_layer import Body, DrawnLayer, Repeated
from lamella.hardware.item import Item
from lamella.hardware.shape import Sweep
from lamella.project.tables import Project
from lamella.solid.bodies import TRIANGLE_LIMIT, StripBody, body_step, strip_bodies, triangle_count
from lamella.solid.coarser import coarser_sweep
from lamella.solid.extrusion import item_solid, item_solids
from lamella.solid.finish import finish
from lamella.stages.fabrication.output import FabricationOutput
from lamella.strip.lamellas import Lamellas

COLOURS = {
    "washer": (150, 150, 160),
    "key": (120, 120, 130),
    "bolt": (70, 70, 80),
    "nut": (70, 70, 80),
    "screw": (70, 70, 80),
    "splice": (120, 120, 130),
    "clamp": (120, 120, 130),
    "cable": (40, 40, 40),
    "block": (190, 170, 110),
    "packer": (190, 170, 110),
    "edge_beam": (90, 100, 120),
    "cross plate": (120, 120, 130),
    "spacer": (190, 170, 110),
    "turnbuckle": (40, 40, 40),
    "hub post": (150, 110, 160),
    "end plate": (120, 120, 130),
    "base plate": (120, 120, 130),
    "end-packer": (190, 170, 110),
    "hub plate": (150, 110, 160),
    "hub fin": (150, 110, 160),
}
"""Of the hardware's layers."""
OTHER = (110, 110, 110)
REPORT_TRIANGLES = 200_000
"""Of all strips in a report: some 3 MB."""
COARSER = 1.5
"""By how much steps are lengthened until the strips have no more."""
CHORD, CHORD_MOST = 0.02, 0.2
"""Chord errors of bars in a report over how far their sections reach: at first, and at most."""
BEAM, BEAM_TRIANGLES = "edge_beam", 60_000
"""Layer of edge beams, and how many triangles they have together until their chord error is larger."""
SOLIDS = {"A": (210, 130, 105), "B": (105, 150, 205)}
"""Of the strips' layers."""


def shows_solids(project: Project, out: FabricationOutput, lamellas: Lamellas) -> bool:
    """Whether files hold the strips as solids: where asked; unasked with [joint], up to `TRIANGLE_LIMIT`."""
    if project.files.solids is not None:
        return project.files.solids
    return (project.joint is not None or bool(project.files.ifc)) and triangle_count(
        out.parts, body_step(lamellas)
    ) <= TRIANGLE_LIMIT


def solids_left_out(project: Project, out: FabricationOutput, lamellas: Lamellas) -> Iterator[Message]:
    """The warning where strips are too many to be held as solids unasked."""
    if project.joint is None or project.files.solids is not None or shows_solids(project, out, lamellas):
        return
    count = triangle_count(out.parts, body_step(lamellas))
    yield Message(
        "solids_left_out",
        f"strips are left out of model.glb and are surfaces without thickness in model.3dm: as solids they have about "
        f"{count:,} triangles, more than {TRIANGLE_LIMIT:,}; write solids = true in [files] to have them",
    )


def report_layers(out: FabricationOutput, lamellas: Lamellas, material: str) -> Iterator[DrawnLayer]:
    """What the report shows: strips in longer steps where they would have too many triangles, hardware."""
    step = body_step(lamellas)
    least = triangle_count(out.parts, np.inf)
    while least < REPORT_TRIANGLES < triangle_count(out.parts, step):
        step *= COARSER
    if triangle_count(out.parts, step) <= REPORT_TRIANGLES:
        yield from strip_layers(out, lamellas, material, step)
    yield from _bounded_hardware(out.hardware.items)


def _bounded_hardware(items: tuple[Item, ...]) -> Iterator[DrawnLayer]:
    """Hardware whose bars have larger chord errors where they would have too many triangles."""
    share = CHORD
    layers = list(hardware_layers(items, share))
    while share < CHORD_MOST and _triangles(layers, BEAM) > BEAM_TRIANGLES:
        share *= COARSER
        layers = list(hardware_layers(items, share))
    yield from layers


def _triangles(layers: list[DrawnLayer], name: str) -> int:
    return sum(len(solid.triangles) for layer in layers if layer.name == name for solid in layer.repeated)


def strip_layers(
    out: FabricationOutput, lamellas: Lamellas, material: str, step: float | None = None
) -> Iterator[DrawnLayer]:
    """The strips of either family, in pieces of a length, m; `body_step` when not given."""
    bodies: dict[str, list[Body]] = {family: [] for family in SOLIDS}
    for one in strip_bodies(out.parts, lamellas, body_step(lamellas) if step is None else step):
        bodies[one.part.family].append(_body(one, material, finish(lamellas.material.density)))
    for family, colour in SOLIDS.items():
        yield DrawnLayer(f"solids {family}", colour=colour, bodies=tuple(bodies[family]))


def hardware_layers(items: tuple[Item, ...], chord: float = 0.0) -> Iterator[DrawnLayer]:
    """A layer for each kind of hardware; bars along polylines may have a chord error, over their section's reach."""
    for kind in dict.fromkeys(item.kind for item in items):
        of_kind = [one for item in items if item.kind == kind for one in _repeated(item, chord)]
        yield DrawnLayer(kind, colour=COLOURS.get(kind, OTHER), repeated=tuple(of_kind))


def _body(one: StripBody, material: str, look: str) -> Body:
    part = one.part
    text = {
        "id": part.id,
        "family": part.family,
        "layer_number": str(one.row + 1),
        "side": one.side,
        "material": material,
        "mass_kg": f"{part.mass:.6g}",
        "length_m": f"{part.length:.6g}",
        "thickness_m": repr(float(part.thickness)),
    }
    return Body(one.name, one.solid.vertices, one.solid.triangles, text, look)


def _repeated(item: Item, chord: float) -> Iterator[Repeated]:
    """A kind of hardware as a block of the model, or each piece as one of its own where pieces are bent."""
    places, look = item.places, finish(item.density)
    text = {
        "kind": item.kind,
        "description": item.description,
        "material": item.material,
        "mass_kg": f"{item.mass:.6g}",
    }
    if item.bent:
        here, axes = np.zeros((1, 3)), np.eye(3)[None]
        for number, (label, solid) in enumerate(item_solids(item)):
            inside = text | {"id": item.id}
            name = f"{item.id} {number + 1}"
            yield Repeated(name, solid.vertices, solid.triangles, here, axes, (label,), inside, look)
        return
    coarse = tuple(coarser_sweep(one, chord) if chord and isinstance(one, Sweep) else one for one in item.shape)
    solid = item_solid(replace(item, shape=coarse))
    yield Repeated(item.id, solid.vertices, solid.triangles, places.origins, places.axes, places.labels, text, look)

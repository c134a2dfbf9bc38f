"""Results of load cases as rows of tables: nodes, element ends, supports, cables, places of the largest stress.

Lamellas have the ids of the drawings, nodes the numbers of network.json. Forces of an element's end are those of the
section there, in the axes of the strip: x along it, y sideways (through its thickness, towards u = n x t), z upright
(along its height, n); My bends it about its strong axis, Mz about its weak one. Layers that are one line of beams share
them. Places are measured from `origin`, a point of the drawing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.edge_use import edge_use
from lamella.structure.beam.columns import turned_product
from lamella.structure.beam.fibre_stress import curvatures_at_ends, strip_stresses

MM, MPA = 1e3, 1e-6
EDGE_BEAM = "edge beam"
"""In the column of lamellas."""

PLACES = 10
"""Of the largest stress."""

NODES = ("case", "node", "ux_mm", "uy_mm", "uz_mm", "u_mm", "deflection_mm")
ELEMENTS = (
    *("case", "lamella", "layer", "element", "end", "at_m", "N_N", "Vy_N", "Vz_N", "Mx_Nm", "My_Nm", "Mz_Nm"),
    *("axial_MPa", "weak_bending_MPa", "strong_bending_MPa", "torsion_MPa", "helix_edge_MPa", "helix_centre_MPa"),
    *("left_face_MPa", "right_face_MPa", "von_mises_MPa", "utilisation"),
)
STRESSES = 9
"""Columns of stresses."""
SUPPORTS = ("case", "node", "x_m", "y_m", "z_m", "Fx_N", "Fy_N", "Fz_N", "Mx_Nm", "My_Nm", "Mz_Nm")
CABLES = ("case", "stretch", "from_node", "to_node", "length_m", "force_N", "slack")
STRESSED = ("rank", "case", "lamella", "layer", "at_m", "x_m", "y_m", "z_m", "von_mises_MPa", "utilisation")
LAMELLAS = ("case", "lamella", "N_min_N", "N_max_N", "von_mises_max_MPa", "utilisation_max")

Row = Sequence[object]


@dataclass(frozen=True)
class EndForces:
    """Section forces at both ends of m elements, (m, 2, 6): N, Vy, Vz, Mx, My, Mz; N and N m."""

    values: Floats

    @classmethod
    def of(cls, case: CaseResult) -> EndForces:
        """In a case's equilibrium."""
        state = case.equilibrium.state
        on_ends = state.on_ends(state.stress)
        motion = state.motion
        # what holds the first end is against the section's positive face
        parts = [(-1.0, motion.frame, on_ends[:6]), (1.0, motion.frame_at_b(), on_ends[6:])]
        ends = [
            sign * np.concatenate((turned_product(frame, both[:3]), turned_product(frame, both[3:])))
            for sign, frame, both in parts
        ]
        return cls(np.stack([end.T for end in ends], 1))


def node_rows(case: CaseResult) -> Iterator[Row]:
    """Displacements from the designed shape, and how far that is from the residual state."""
    shifts = case.displacements
    away = np.linalg.norm(shifts - case.rest.displacements[: case.model.nodes], axis=1)
    columns = np.column_stack((shifts, np.linalg.norm(shifts, axis=1), away))
    for node, row in enumerate(texts(MM * columns, 6)):
        yield (case.name, node, *row)


def element_rows(case: CaseResult) -> Iterator[Row]:
    """Forces and stresses at both ends of every element; faces at half the height, the left one towards u.

    Elements of edge beams come last, with forces and utilisation alone.
    """
    lines, ids = case.model.lines, case.model.lamellas.network.ids
    forces = texts(EndForces.of(case).values.reshape(-1, 6), 4)
    count = 2 * len(lines.length)
    stresses = texts(MPA * _stresses(case), 5)
    uses = texts(case.use.utilisation.reshape(-1, 1), 6)
    for k, (force, stress, use) in enumerate(zip(forces[:count], stresses, uses, strict=True)):
        element, end = divmod(k, 2)
        name, layer = ids[int(lines.lamella[element])], layer_number(int(lines.layer[element]))
        yield (case.name, name, layer, element, end, f"{lines.arclengths[element, end]:.6f}", *force, *stress, *use)
    for k, use in enumerate(texts(edge_use(case.model, case.equilibrium).reshape(-1, 1), 6), count):
        element, end = divmod(k, 2)
        yield (case.name, EDGE_BEAM, "", element, end, "", *forces[k], *[""] * STRESSES, *use)


def _stresses(case: CaseResult) -> Floats:
    """Of strips, as the columns of `ELEMENTS` have them, Pa, (2 m, 9)."""
    model, state = case.model, case.equilibrium.state
    section, material, lines = model.lamellas.section, model.lamellas.material, model.lines
    layers = 1 if (lines.layer >= 0).any() else section.layers
    kinds = strip_stresses(state, material, section.height, section.thickness, layers=layers)
    count = 2 * len(lines.length)
    axial = np.repeat(case.use.axial, 2)
    turn = curvatures_at_ends(state).reshape(-1, 3)[:count, 2]
    bending = -material.youngs_modulus * turn * section.thickness / 2
    bent, strong, torsion, edge, centre = (
        values[:count] for values in (kinds.bending, kinds.layer, kinds.torsion, kinds.helix_edge, kinds.helix_centre)
    )
    inside = axial + centre
    faces = (inside + bending, inside - bending)
    return np.column_stack((axial, bent, strong, torsion, edge, centre, *faces, case.use.von_mises.ravel()))


def support_rows(case: CaseResult, origin: Origin = NOWHERE) -> Iterator[Row]:
    """Forces and moments of supports and springs on the structure, at the nodes where there are any."""
    count = case.model.nodes
    nodes = np.flatnonzero(case.model.supports.supported)
    points = case.model.lamellas.network.node_points[nodes] + origin
    reactions = case.equilibrium.reactions[:count][nodes]
    for node, point, force in zip(nodes.tolist(), texts(points, 6), texts(reactions, 4), strict=True):
        yield (case.name, node, *point, *force)


def cable_rows(case: CaseResult) -> Iterator[Row]:
    """Tension of every stretch of cable between two clamps; of both cables of a pair together."""
    state = case.equilibrium.whole.cables
    slack = ~state.tight(state.force)
    ends = state.cables.attachment.nodes.tolist()
    values = texts(np.column_stack((state.cables.length, state.tension)), 4)
    for k, ((one, other), row) in enumerate(zip(ends, values, strict=True)):
        yield (case.name, k, one, other, *row, "slack" if slack[k] else "")


def lamella_rows(case: CaseResult) -> Iterator[Row]:
    """The largest of every lamella."""
    lines, ids = case.model.lines, case.model.lamellas.network.ids
    axial = EndForces.of(case).values[: len(lines.length), :, 0]
    count = len(ids)
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    stress, use = np.zeros(count), np.zeros(count)
    np.minimum.at(low, lines.lamella, axial.min(1))
    np.maximum.at(high, lines.lamella, axial.max(1))
    np.maximum.at(stress, lines.lamella, case.use.von_mises.max(1))
    np.maximum.at(use, lines.lamella, case.use.utilisation.max(1))
    there = np.flatnonzero(np.isfinite(low))
    columns = np.column_stack((low, high, MPA * stress, use))[there]
    for k, row in zip(there.tolist(), texts(columns, 5), strict=True):
        yield (case.name, ids[k], *row)


def stressed_rows(cases: Sequence[CaseResult], count: int = PLACES, origin: Origin = NOWHERE) -> Iterator[Row]:
    """Places of the largest utilisation in all cases, each place once, with the case that is worst there."""
    model = cases[0].model
    # ties by the order of cases and elements, whatever the last bits
    use = np.round(np.stack([case.use.utilisation.ravel() for case in cases]), 9)
    worst = use.argmax(0)
    order = np.argsort(-use.max(0), kind="stable")
    lines, ids = model.lines, model.lamellas.network.ids
    points, _ = model.structure.beams.attachment.ends(model.structure.poses)
    places: list[tuple[int, int, float]] = []
    for k in order.tolist():
        if len(places) == count:
            break
        element, end = divmod(k, 2)
        place = int(lines.lamella[element]), int(lines.layer[element]), round(float(lines.arclengths[element, end]), 6)
        # the ends of two elements that meet are one place
        if place in places:
            continue
        places.append(place)
        case = cases[int(worst[k])]
        stress = MPA * float(case.use.von_mises[element, end])
        numbers = texts(np.array([[*(points[element, end] + origin), stress, use[worst[k], k]]]), 6)[0]
        yield (len(places), case.name, ids[place[0]], layer_number(place[1]), f"{place[2]:.6f}", *numbers)


def layer_number(layer: int) -> object:
    """As drawings number layers, from 1; nothing where all are one line of beams."""
    return layer + 1 if layer >= 0 else ""


def texts(values: Floats, digits: int) -> list[list[str]]:
    """Numbers (r, c) with so many decimals and no negative zeros."""
    return [[f"{value:.{digits}f}" for value in row] for row in (np.round(values, digits) + 0.0).tolist()]

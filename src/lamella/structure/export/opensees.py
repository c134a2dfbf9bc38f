"""A structure as a script for OpenSees, which runs as it is and writes its displacements.

OpenSees has straight elements without a coupling of twist and stretch. A strip with the helix effect is made of four of
them, see `lamella.structure.export.element_laws`.

Initial strains make the stress that the structure has as it was designed. Given all at once they would be too much for
Newton's method: the script holds the structure by the forces they make and lets these go step by step.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin, measured_from
from lamella.base.vectors import crosses, lengths
from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.beam.attachment import Attachment
from lamella.structure.beam.beams import BeamState
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.export.element_laws import SOFT, ElementLaws
from lamella.structure.export.opensees_script import HEAD, TAIL
from lamella.structure.export.script_rows import listed, rounded, table
from lamella.structure.loads import Loads
from lamella.structure.model.case_loads import case_loads
from lamella.structure.model.model import Model, divided
from lamella.structure.structure import Structure

# of what it is beside: nearly rigid
RIGID = 100.0
# by which elements turn along themselves, times the root of the ratio of their axes' stiffness, rad
ELEMENT_TURN = 1.25
# of lamellas in a script: OpenSees takes half an hour for them, and in a cell edge
MOST_IN_A_SCRIPT, MOST_IN_AN_EDGE = 20_000, 64
# m; ends that are nearer are one node
ARM_GRAIN = 1e-9


@dataclass(frozen=True, eq=False)
class _Nodes:
    """Nodes of the script: those of the structure, then ends of arms."""

    points: Floats
    bases: Integers

    @classmethod
    def of(cls, points: Floats) -> _Nodes:
        return cls(points, np.arange(len(points)))

    def beside(self, bases: Integers, points: Floats) -> tuple[_Nodes, Integers]:
        """With ends of arms at places (p, 3), one for each place of a base, and their numbers (p,)."""
        key = np.column_stack((bases, np.rint((points - self.points[bases]) / ARM_GRAIN).astype(np.int64)))
        off = np.flatnonzero(key[:, 1:].any(1))
        _, first, inverse = np.unique(key[off], axis=0, return_index=True, return_inverse=True)
        ends = bases.copy()
        ends[off] = len(self.points) + inverse.reshape(-1)
        grown = np.concatenate((self.points, points[off][first]))
        return _Nodes(grown, np.concatenate((self.bases, bases[off][first]))), ends

    def doubled(self, nodes: Integers) -> tuple[_Nodes, Integers]:
        """With one more, free of it, at the place of each of some nodes (p,), and their numbers (p,)."""
        new = len(self.points) + np.arange(len(nodes))
        return _Nodes(np.concatenate((self.points, self.points[nodes])), np.concatenate((self.bases, new))), new


def opensees_script(
    structure: Structure,
    cases: Mapping[str, Loads],
    network_nodes: int,
    *,
    elements: int,
    name: str,
    version: str,
    origin: Origin = NOWHERE,
) -> str:
    """Text of the script.

    Parameters
    ----------
    structure : Structure
    cases : mapping
        Loads by the cases' names, at the load factor 1; those that change natural curvatures or lengths (temperature)
        are left out, and the script says so.
    network_nodes : int
        Nodes whose displacements it writes, the structure's first ones.
    elements : int
        In a cell edge, which the script says.
    name, version : str
        Of the project and of the program.
    origin : Origin
        Point of the drawing that the structure is measured from, which the script says.
    """
    poses = structure.poses
    state = structure.beams.at(poses)
    nodes, hinged, hinges = _hinges(structure)
    on = structure.beams.attachment
    points, frames = on.ends(poses)
    nodes, centre = nodes.beside(_bases(on, hinged).ravel(), points.reshape(-1, 3))
    laws = ElementLaws.of(state)
    nodes, ends, slots = _slots(structure, laws, nodes, centre.reshape(-1, 2), frames)
    upright = rounded(-(frames[:, 0, :, 1] + frames[:, 1, :, 1]) / 2)
    rows: list[tuple[object, ...]] = []
    some = np.flatnonzero(laws.radius > 0)
    for row, side in enumerate((1, -1)):
        at = points[some] + side * laws.radius[some, None, None] * frames[some, :, :, 2]
        nodes, tips = nodes.beside(ends[some].ravel(), at.reshape(-1, 3))
        rows += listed(tips.reshape(-1, 2), upright[some], laws.axial[some] / 2, laws.fibre_strains[row, some])
    little = SOFT * float(structure.beams.law.stiffness[3].max() / structure.beams.law.length.max())
    cables, nodes = _cables(structure, nodes)
    count = len(nodes.points)
    springs = structure.node_springs
    grounds = count + np.arange(len(springs))
    held = structure.held
    parts: dict[str, list[tuple[object, ...]]] = {
        "NODES": listed(rounded(nodes.points)),
        "FIXED": listed(np.flatnonzero(held.any(1)), held[held.any(1)].astype(int)),
        "ARMS": _arms(structure, nodes),
        "BEAMS": [
            (one, other, tuple(axis), *law)
            for (one, other), axis, law in zip(ends.tolist(), upright.tolist(), laws.beams, strict=True)
        ],
        "FIBRES": [(*row, little) for row in rows],
        "HINGES": hinges + slots,
        "CABLES": cables,
        "SPRINGS": listed(springs.nodes, grounds, springs.stiffness),
        "CASES": [
            ("residual", [], []),
            *(_case(structure, state, key, loads) for key, loads in cases.items() if not _strained(loads)),
        ],
        "LEFT_OUT": [(key,) for key, loads in cases.items() if _strained(loads)],
    }
    text = HEAD.format(title=name.replace('"""', "'''").replace("\\", "/"), version=version, elements=elements)
    if any(origin):
        text += f"# {measured_from(origin)}\n"
    text += f"NETWORK_NODES = {network_nodes}\n"
    return text + "".join(table(key, part) for key, part in parts.items()) + TAIL


def write_opensees(path: Path, analysis: Analysis, *, name: str, version: str, origin: Origin = NOWHERE) -> None:
    """Write the script of an analysis' model, in elements as short as `fine_elements` says, see `opensees_script`.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    elements = fine_elements(analysis.model)
    model = divided(analysis.model, elements) if elements > analysis.model.rules.elements else analysis.model
    cases = {case.name: case_loads(model, case, analysis.node_masses) for case in analysis.loads}
    signed = {"name": one_line(name), "version": version}
    text = opensees_script(model.structure, cases, model.nodes, elements=elements, origin=origin, **signed)
    write_whole(path, text.encode("utf-8"))


def fine_elements(model: Model) -> int:
    """Elements in a cell edge with which OpenSees' straight ones come within 1 % of where they converge to.

    What is wrong of a strip that an element stands for without turning along itself grows with the square of the angle
    by which it is twisted or bent, times the ratio of its axes' stiffness (`lamella.structure.beam.turning`): nine in
    ten elements turn by `ELEMENT_TURN` over the root of that ratio at most. At least as many as the model has; where
    these are more than `MOST_IN_A_SCRIPT` elements in all, fewer.
    """
    structure, count = model.structure, len(model.lines.length)
    sections = [structure.beams.sections[k] for k in structure.beams.section[:count]]
    slender = np.sqrt([kind.bending_u / kind.bending_n for kind in sections])
    turn = np.linalg.norm(structure.beams.at(structure.poses).motion.local_theta[:, :count], axis=0)
    own = model.rules.elements
    needed = own * float(np.round(np.quantile(slender * turn, 0.9) / ELEMENT_TURN, 6))
    most = min(MOST_IN_AN_EDGE, own * MOST_IN_A_SCRIPT // count)
    return max(own, min(int(np.ceil(needed)), most))


def _bases(on: Attachment, hinged: Integers) -> Integers:
    """Nodes that the ends of elements hang on, (m, 2): beyond a joint its own."""
    return np.where(on.joints >= 0, np.append(hinged, -1)[on.joints], on.nodes)


def _hinges(structure: Structure) -> tuple[_Nodes, Integers, list[tuple[object, ...]]]:
    """Nodes with one more for every joint that is free, the node beyond each joint, and the joints' rows."""
    poses, on = structure.poses, structure.beams.attachment
    base = np.zeros(len(poses.angles), np.int64)
    base[on.joints[on.joints >= 0]] = on.nodes[on.joints >= 0]
    free = np.flatnonzero(~structure.held_joints)
    beyond = base.copy()
    beyond[free] = len(poses.points) + np.arange(len(free))
    nodes = _Nodes.of(np.concatenate((poses.points, poses.points[base[free]])))
    stiff = _stiff(structure)
    turning = np.full(len(base), SOFT * stiff)
    turning[structure.joint_springs.joints] = structure.joint_springs.stiffness
    frames = poses.frames[base[free]]
    laws = np.column_stack((turning[free], np.full((len(free), 2), stiff)))
    rows = listed(base[free], beyond[free], rounded(frames[:, :, 2]), rounded(frames[:, :, 0]), laws)
    return nodes, beyond, rows


def _slots(
    structure: Structure, laws: ElementLaws, nodes: _Nodes, ends: Integers, frames: Floats
) -> tuple[_Nodes, Integers, list[tuple[object, ...]]]:
    """Hinges about u at both ends of elements that slots make softer: nodes, the elements' own ends, and rows."""
    some = np.flatnonzero(laws.hinges > 0)
    nodes, own = nodes.doubled(ends[some].ravel())
    stiff = _stiff(structure)
    about = np.repeat(2 / laws.hinges[some], 2)
    rows = listed(
        ends[some].ravel(),
        own,
        rounded(frames[some, :, :, 1].reshape(-1, 3)),
        rounded(frames[some, :, :, 0].reshape(-1, 3)),
        np.column_stack((rounded(about), np.full((len(own), 2), stiff))),
    )
    ends = ends.copy()
    ends[some] = own.reshape(-1, 2)
    return nodes, ends, rows


def _stiff(structure: Structure) -> float:
    """Of springs that hold, N m/rad."""
    law = structure.beams.law
    return RIGID * float((law.stiffness[4] / law.length**2).max(initial=1.0))


def _arms(structure: Structure, nodes: _Nodes) -> list[tuple[object, ...]]:
    """Nearly rigid arms from nodes to ends beside them: base, end, a direction across, E A, E I."""
    first = len(structure.poses.points) + int((~structure.held_joints).sum())
    ends = np.arange(first, len(nodes.points))
    ends = ends[nodes.bases[ends] != ends]
    if not len(ends):
        return []
    arms = nodes.points[ends] - nodes.points[nodes.bases[ends]]
    size = lengths(arms)
    # the axis that is most across
    axes = np.eye(3)[np.abs(arms).argmin(1)]
    across = crosses(arms, axes)
    law = structure.beams.law
    axial = float((law.stiffness[0] / law.length**2).max())
    return listed(
        nodes.bases[ends],
        ends,
        rounded(across / lengths(across)[:, None]),
        RIGID * axial * size,
        RIGID * axial * size**3 / 3,
    )


def _cables(structure: Structure, nodes: _Nodes) -> tuple[list[tuple[object, ...]], _Nodes]:
    cables = structure.cables
    if not len(cables):
        return [], nodes
    points, _ = cables.attachment.ends(structure.poses)
    nodes, ends = nodes.beside(cables.attachment.nodes.ravel(), points.reshape(-1, 3))
    span = lengths(points[:, 1] - points[:, 0])
    # over the distance they span, which their own length is not
    axial, strain = cables.axial * span / cables.length, 1 - cables.length / span
    return listed(ends.reshape(-1, 2), axial, strain), nodes


def _strained(loads: Loads) -> bool:
    """Whether a case changes what needs no force, which initial strains, fixed at the start, cannot follow."""
    return bool(loads.natural.any() or np.any(loads.swelling) or np.any(loads.cable_swelling))


def _case(structure: Structure, state: BeamState, name: str, loads: Loads) -> tuple[object, ...]:
    """Forces at the structure's nodes and motions of held ones."""
    rows = NODE_UNKNOWNS * len(structure.poses.points)
    forces = loads.forces_at(1.0)
    lines = loads.constant_lines + loads.lines
    if lines.any():
        loaded = structure.beams.at(structure.poses, lines)
        forces = forces + structure.vector([*loaded.on_nodes(loaded.lines.on_ends())])
    at_nodes = forces[:rows].reshape(-1, NODE_UNKNOWNS)
    loaded_nodes = np.flatnonzero(at_nodes.any(1))
    moved = np.flatnonzero(loads.motions[:rows])
    motions = zip(moved // NODE_UNKNOWNS, moved % NODE_UNKNOWNS + 1, loads.motions[moved], strict=True)
    return (
        name,
        listed(loaded_nodes, rounded(at_nodes[loaded_nodes])),
        [(int(node), int(way), float(value)) for node, way, value in motions],
    )

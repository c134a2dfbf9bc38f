r"""A structure as a script for OpenSees, which runs as it is and writes its displacements.

OpenSees has straight elements without a coupling of twist and stretch. A strip with the helix effect is three of them:
a beam on its axis and two fibres at the distance i, the polar radius of gyration, on either side. With all of E A in
the fibres, a fibre's length is that of the strip's stretch :math:`\varepsilon + i^2 \tau_g^2 / 2`, and
:math:`E A \, i^2` is the strong-axis stiffness :math:`E I_u` of a strip. What slots take from that, and the S-bend
with its shear, are in the beam: its law in the middle and at the outer two of three Gauss points differ, so that
:math:`\tfrac49 k_m + \tfrac59 k_e` is the stiffness of uniform bending and :math:`k_e` that of bending that changes
its sign.

Initial strains make the stress that the structure has as it was designed. Given all at once they would be too much for
Newton's method: the script holds the structure by the forces they make and lets these go step by step.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin, measured_from
from lamella.base.vectors import crosses, lengths
from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.structure.beam.attachment import Attachment
from lamella.structure.beam.beams import BeamState
from lamella.structure.beam.columns import turned_product
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.export.opensees_script import HEAD, TAIL
from lamella.structure.loads import Loads
from lamella.structure.structure import Structure

# of what it is beside: a law that only keeps the system regular, and one that is nearly rigid
SOFT, RIGID = 1e-6, 100.0
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


def opensees_script(
    structure: Structure,
    cases: Mapping[str, Loads],
    network_nodes: int,
    *,
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
    centre = centre.reshape(-1, 2)
    beams, fibres, radius = _laws(state)
    upright = _rounded(-(frames[:, 0, :, 1] + frames[:, 1, :, 1]) / 2)
    rows = []
    some = np.flatnonzero(radius > 0)
    for side in (1, -1):
        at = points[some] + side * radius[some, None, None] * frames[some, :, :, 2]
        nodes, ends = nodes.beside(_bases(on, hinged)[some].ravel(), at.reshape(-1, 3))
        rows += _listed(ends.reshape(-1, 2), upright[some], fibres[some, 0] / 2, fibres[some, 1 if side > 0 else 2])
    little = SOFT * float(structure.beams.law.stiffness[3].max() / structure.beams.law.length.max())
    cables, nodes = _cables(structure, nodes)
    count = len(nodes.points)
    springs = structure.node_springs
    grounds = count + np.arange(len(springs))
    held = structure.held
    parts: dict[str, list[tuple[object, ...]]] = {
        "NODES": _listed(_rounded(nodes.points)),
        "FIXED": _listed(np.flatnonzero(held.any(1)), held[held.any(1)].astype(int)),
        "ARMS": _arms(structure, nodes),
        "BEAMS": [
            (one, other, tuple(axis), *laws)
            for (one, other), axis, laws in zip(centre.tolist(), upright.tolist(), beams, strict=True)
        ],
        "FIBRES": [(*row, little) for row in rows],
        "HINGES": hinges,
        "CABLES": cables,
        "SPRINGS": _listed(springs.nodes, grounds, springs.stiffness),
        "CASES": [
            ("residual", [], []),
            *(_case(structure, state, key, loads) for key, loads in cases.items() if not _strained(loads)),
        ],
        "LEFT_OUT": [(key,) for key, loads in cases.items() if _strained(loads)],
    }
    text = HEAD.format(title=name.replace('"""', "'''").replace("\\", "/"), version=version)
    if any(origin):
        text += f"# {measured_from(origin)}\n"
    text += f"NETWORK_NODES = {network_nodes}\n"
    return text + "".join(_table(key, part) for key, part in parts.items()) + TAIL


def write_opensees(
    path: Path,
    structure: Structure,
    cases: Mapping[str, Loads],
    network_nodes: int,
    *,
    name: str,
    version: str,
    origin: Origin = NOWHERE,
) -> None:
    """Write the script, see `opensees_script`.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    text = opensees_script(structure, cases, network_nodes, name=one_line(name), version=version, origin=origin)
    write_whole(path, text.encode("utf-8"))


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
    law = structure.beams.law
    stiff = RIGID * float((law.stiffness[4] / law.length**2).max(initial=1.0))
    turning = np.full(len(base), SOFT * stiff)
    turning[structure.joint_springs.joints] = structure.joint_springs.stiffness
    frames = poses.frames[base[free]]
    laws = np.column_stack((turning[free], np.full((len(free), 2), stiff)))
    rows = _listed(base[free], beyond[free], _rounded(frames[:, :, 2]), _rounded(frames[:, :, 0]), laws)
    return nodes, beyond, rows


def _laws(state: BeamState) -> tuple[list[tuple[tuple[float, ...], ...]], Floats, Floats]:
    """Laws of the beams: axial, torsion, strong and weak; E A and strains of the fibres, (m, 3); and their radius."""
    law, strains = state.beams.law, state.strains
    stiffness = law.stiffness / law.length
    # strips have the helix effect, edge beams nearly none
    radius: Floats = np.where(law.stiffness[6] > 0, np.sqrt(law.gyration), 0.0)
    theta = state.motion.local_theta / law.length
    # the stress of what the helix stress deviates from its mean, and its derivatives by tg and kg
    only = np.zeros_like(state.stress)
    only[6] = state.stress[6]
    across = strains.first[6, 3:]
    more = (law.stiffness[6] * across**2 + np.einsum("iim->im", strains.second(only)[3:, 3:])) * law.length
    moments = turned_product(strains.first, state.stress)[3:]
    helix = radius > 0
    stretch, strong_strain = strains.values[0], strains.values[4]
    torsion = stiffness[3] + more[0]
    twisting = moments[0] - np.where(helix, stiffness[0] * stretch * law.gyration * theta[0], 0.0)
    weak = stiffness[5] + more[2]
    left = stiffness[4] - np.where(helix, stiffness[0] * law.gyration, 0.0)
    s_strong, s_weak = (stiffness[row] * law.length**2 / 12 for row in (2, 1))
    laws = (
        np.where(helix, SOFT, 1.0) * stiffness[0],
        np.where(helix, 0.0, stretch),
        torsion,
        twisting / torsion,
        s_strong,
        (left - 5 / 9 * s_strong) * 9 / 4,
        -strong_strain,
        s_weak,
        (weak - 5 / 9 * s_weak) * 9 / 4,
        moments[2] / weak,
    )
    beams: list[tuple[tuple[float, ...], ...]] = []
    for row in zip(*(_rounded(values).tolist() for values in laws), strict=True):
        beams.append((row[:2], row[2:4], row[4:7], row[7:]))
    strain = [stretch + side * radius * strong_strain for side in (1, -1)]
    return beams, np.column_stack((stiffness[0], *strain)), radius


def _arms(structure: Structure, nodes: _Nodes) -> list[tuple[object, ...]]:
    """Nearly rigid arms from nodes to ends beside them: base, end, a direction across, E A, E I."""
    first = len(structure.poses.points) + int((~structure.held_joints).sum())
    ends = np.arange(first, len(nodes.points))
    if not len(ends):
        return []
    arms = nodes.points[ends] - nodes.points[nodes.bases[ends]]
    size = lengths(arms)
    # the axis that is most across
    axes = np.eye(3)[np.abs(arms).argmin(1)]
    across = crosses(arms, axes)
    law = structure.beams.law
    axial = float((law.stiffness[0] / law.length**2).max())
    return _listed(
        nodes.bases[ends],
        ends,
        _rounded(across / lengths(across)[:, None]),
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
    return _listed(ends.reshape(-1, 2), axial, strain), nodes


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
        _listed(loaded_nodes, _rounded(at_nodes[loaded_nodes])),
        [(int(node), int(way), float(value)) for node, way, value in motions],
    )


def _rounded(values: ArrayLike) -> Floats:
    """Numbers without digits that differ between processors."""
    return np.asarray(np.round(np.asarray(values, float), 12) + 0.0)


def _listed(*columns: ArrayLike) -> list[tuple[object, ...]]:
    """Rows of columns; those of several numbers become tuples, but for the first."""
    parts: list[list[object]] = []
    first, *others = (np.asarray(column) for column in columns)
    rows = first.tolist() if first.ndim > 1 else [[value] for value in first.tolist()]
    for column in others:
        parts.append([tuple(row) if isinstance(row, list) else row for row in column.tolist()])
    return [(*row, *rest) for row, *rest in zip(rows, *parts, strict=True)]


def _table(name: str, rows: list[tuple[object, ...]]) -> str:
    """A list of the script, a row a line."""
    return f"{name} = [\n" + "".join(f"    {_text(row)},\n" for row in rows) + "]\n"


def _text(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, tuple | list):
        inside = ", ".join(_text(one) for one in value)
        if isinstance(value, list):
            return f"[{inside}]"
        return f"({inside},)" if len(value) == 1 else f"({inside})"
    return repr(value)

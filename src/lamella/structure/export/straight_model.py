"""A net's model in straight members, as programs without curved and twisted elements take it.

An element of the net is a member from end to end, upright as it is in its middle. What of it members cannot be is
turned into what they can have:

- Layers that slip on one another and are one line of beams have the section of one layer and a material so many times
  as stiff and as heavy.
- The bending that strips have as designed, and their stretch, are temperatures that grow linearly across a member, of
  a load case of their own. There is no such thing for their twist, nor for the helix effect.
- A slot is a hinge with a spring about the strong axis at the member's end.
- An element that ends beside its node hangs on it by a rigid link.
- A joint that may turn has two nodes at one place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.material import Material
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.export.element_laws import slot_hinges
from lamella.structure.loads import Loads
from lamella.structure.model.case_loads import STRAND_EXPANSION
from lamella.structure.model.model import Model

# m; an end that is nearer is on its node
ON_NODE = 1e-9
# kg/m3; with the mass of a cable it says the area that a program takes for it
CABLE_DENSITY = 7850.0


@dataclass(frozen=True)
class StraightSection:
    """A section with its material.

    Attributes
    ----------
    shape : "rectangle", "pipe" or "circle"
    size : tuple of float
        Height (upright) and width; diameter and wall; diameter, m.
    material : Material
    times : int
        Layers that share one member: stiffness and weight of the material are so many times those of the strip's.
    """

    shape: str
    size: tuple[float, ...]
    material: Material
    times: int = 1


@dataclass(frozen=True, eq=False)
class StraightModel:
    """Members on nodes.

    Attributes
    ----------
    points : (n, 3)
        m; first the nodes of the structure, of which the first are those of the network.
    members : (m, 2) int
        Nodes of elements: of lamellas, then of edge beams.
    names : tuple of str
        Of members: lamella, layer where there are several, number along it.
    upright : (m, 3)
        Unit vectors.
    sections : tuple of StraightSection
    section : (m,) int
    links : (l, 2) int
        Rigid links: node, and end beside it.
    hinges : (m, 2)
        Stiffness of the spring about the strong axis at either end, N m/rad; 0: no hinge.
    turning : (k, 2) int
        Members of both families at a joint that may turn about the first one's upright direction, and do not share a
        node.
    turning_stiffness : (k,)
        N m/rad; 0: free.
    held : (n, 6) bool
    springs : (n, 6)
        N/m and N m/rad.
    cables : (c, 2) int
    cable_section : tuple of StraightSection
        One a cable.
    cable_strain : (c,)
        By which it is cut too short.
    strains : (m, 3)
        As designed: stretch, curvature towards y (sideways, u = n x t) and towards z (upright), 1/m.
    """

    points: Floats
    members: Integers
    names: tuple[str, ...]
    upright: Floats
    sections: tuple[StraightSection, ...]
    section: Integers
    links: Integers
    hinges: Floats
    turning: Integers
    turning_stiffness: Floats
    held: Booleans
    springs: Floats
    cables: Integers
    cable_section: tuple[StraightSection, ...]
    cable_strain: Floats
    strains: Floats

    @property
    def lengths(self) -> Floats:
        """Of members, m, (m,)."""
        ends = self.points[self.members]
        return np.asarray(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))


@dataclass(frozen=True, eq=False)
class StraightLoads:
    """Loads of a case on a straight model.

    Attributes
    ----------
    forces : (n, 6)
        N and N m, global.
    lines : (m, 3)
        N/m of a member's length, global.
    warming : (m,)
        K.
    cable_warming : float
        Strain.
    motions : (n, 6)
        Of held nodes, m and rad.
    """

    forces: Floats
    lines: Floats
    warming: Floats
    cable_warming: float
    motions: Floats


def straight_model(model: Model) -> StraightModel:
    """Of a net's model as it was designed."""
    structure = model.structure
    poses, beams = structure.poses, structure.beams
    on = beams.attachment
    state = beams.at(poses)
    places, frames = on.ends(poses)
    loose = np.flatnonzero(~structure.held_joints)
    base = np.zeros(len(poses.angles), np.int64)
    base[on.joints[on.joints >= 0]] = on.nodes[on.joints >= 0]
    beyond = base.copy()
    beyond[loose] = len(poses.points) + np.arange(len(loose))
    points = np.concatenate((poses.points, poses.points[base[loose]]))
    bases = np.where(on.joints >= 0, np.append(beyond, -1)[on.joints], on.nodes)
    points, members = _beside(points, bases, places)
    points, cables = _beside(points, structure.cables.attachment.nodes, structure.cables.attachment.ends(poses)[0])
    hung = np.concatenate((bases, structure.cables.attachment.nodes)).ravel()
    own = np.column_stack((hung, np.concatenate((members, cables)).ravel()))
    links = np.unique(own[own[:, 0] != own[:, 1]], axis=0)
    upright = frames[..., 2].sum(1)
    upright /= np.linalg.norm(upright, axis=1)[:, None]
    held, springs = (np.zeros((len(points), NODE_UNKNOWNS), kind) for kind in (bool, float))
    held[: len(poses.points)] = structure.held
    springs[structure.node_springs.nodes] = structure.node_springs.stiffness
    sections, section = _sections(model)
    values = state.strains.values
    turning, stiffness = _turning(model, base, loose)
    span = np.linalg.norm(points[cables[:, 1]] - points[cables[:, 0]], axis=1)
    return StraightModel(
        points,
        members,
        _names(model),
        upright,
        sections,
        section,
        links,
        _hinges(model),
        turning,
        stiffness,
        held,
        springs,
        cables,
        _cable_sections(model),
        1 - structure.cables.length / span if len(cables) else span,
        np.column_stack((values[0], values[5], -values[4])),
    )


def straight_loads(model: Model, straight: StraightModel, loads: Loads) -> StraightLoads:
    """Loads of a case, at the load factor 1."""
    structure = model.structure
    count = len(structure.poses.points)
    forces, motions = np.zeros((2, len(straight.points), NODE_UNKNOWNS))
    forces[:count] = loads.forces_at(1.0)[: NODE_UNKNOWNS * count].reshape(-1, NODE_UNKNOWNS)
    motions[:count] = loads.motions[: NODE_UNKNOWNS * count].reshape(-1, NODE_UNKNOWNS)
    # the load of the element, which a straight member is shorter than
    shorter = (structure.beams.law.length / straight.lengths)[:, None]
    lines = (loads.constant_lines + loads.lines) * shorter
    expansion = np.array([one.material.expansion for one in straight.sections], float)[straight.section]
    warming = np.divide(loads.swelling, expansion, out=np.zeros_like(expansion), where=expansion > 0)
    return StraightLoads(forces, lines, warming, float(loads.cable_swelling), motions)


def _beside(points: Floats, bases: Integers, places: Floats) -> tuple[Floats, Integers]:
    """Points with one more for every place beside its base, (e, 2) bases and (e, 2, 3) places; numbers of the ends."""
    flat, there = bases.ravel(), places.reshape(-1, 3)
    key = np.column_stack((flat, np.rint((there - points[flat]) / ON_NODE).astype(np.int64)))
    off = np.flatnonzero(key[:, 1:].any(1))
    _, first, inverse = np.unique(key[off], axis=0, return_index=True, return_inverse=True)
    ends = flat.copy()
    ends[off] = len(points) + inverse.reshape(-1)
    return np.concatenate((points, there[off][first])), ends.reshape(bases.shape)


def _names(model: Model) -> tuple[str, ...]:
    """A1.1, A1.2, ...; with layers A1-1.1, ...; edge beams E.1, ..."""
    ids, lines, seen, names = model.lamellas.network.ids, model.lines, dict[str, int](), []
    for lamella, layer in zip(lines.lamella.tolist(), lines.layer.tolist(), strict=True):
        whole = ids[lamella] if layer < 0 else f"{ids[lamella]}-{layer + 1}"
        seen[whole] = seen.get(whole, 0) + 1
        names.append(f"{whole}.{seen[whole]}")
    return (*names, *(f"edge beam.{k + 1}" for k in range(len(model.rims.nodes))))


def _sections(model: Model) -> tuple[tuple[StraightSection, ...], Integers]:
    section = model.lamellas.section
    layers = section.layers if model.rules.layers == "combined" else 1
    strip = StraightSection("rectangle", (section.height, section.thickness), model.lamellas.material, layers)
    edges = []
    for one in model.rims.sections:
        if one.round:
            # of the area and the modulus of bending, the diameter and the wall
            inertia = one.section.bending_u / one.material.youngs_modulus
            outer = 2 * inertia / one.modulus_u
            inner = np.sqrt(max(outer**2 - 4 * one.area / np.pi, 0.0))
            edges.append(StraightSection("pipe", (outer, float(outer - inner) / 2), one.material))
        else:
            height = 6 * one.modulus_u / one.area
            edges.append(StraightSection("rectangle", (height, one.area / height), one.material))
    which = np.concatenate((np.zeros(len(model.lines.length), np.int64), model.rims.section + 1))
    return (strip, *edges), which


def _cable_sections(model: Model) -> tuple[StraightSection, ...]:
    cables, found = model.structure.cables, []
    for axial, mass in zip(cables.axial.tolist(), cables.mass.tolist(), strict=True):
        area = mass / CABLE_DENSITY
        young = float(f"{axial / area:.9g}")
        size = float(f"{2 * np.sqrt(area / np.pi):.9g}")
        strand = Material(CABLE_DENSITY, young, young / 2.6, 0.0, expansion=STRAND_EXPANSION)
        found.append(StraightSection("circle", (size,), strand))
    return tuple(found)


def _hinges(model: Model) -> Floats:
    """Springs at the ends of slotted elements, (m, 2): what slots take, shared by the ends that are at crossings."""
    more = slot_hinges(model.structure.beams)
    ends = np.zeros((len(more), 2))
    ends[: len(model.lines.length)] = model.lines.crossed
    share = more[:, None] * ends / np.maximum(ends.sum(1), 1)[:, None]
    return np.asarray(np.divide(1.0, share, out=np.zeros_like(share), where=share > 0))


def _turning(model: Model, base: Integers, loose: Integers) -> tuple[Integers, Floats]:
    """The first member on either side of every joint that may turn, and the springs' stiffness."""
    structure = model.structure
    on = structure.beams.attachment
    there = np.full(len(structure.poses.angles), -1)
    element, end = np.nonzero(on.joints >= 0)
    there[on.joints[element, end][::-1]] = element[::-1]
    here = np.full(len(structure.poses.points), -1)
    element, end = np.nonzero(on.joints < 0)
    here[on.nodes[element, end][::-1]] = element[::-1]
    stiffness = np.zeros(len(structure.poses.angles))
    stiffness[structure.joint_springs.joints] = structure.joint_springs.stiffness
    return np.column_stack((here[base[loose]], there[loose])), stiffness[loose]

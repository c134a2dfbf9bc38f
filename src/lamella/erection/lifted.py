"""A net, its joints locked, that hangs from a crane under its own weight."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import nnls

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.erection.rigid_motion import moved_onto
from lamella.hardware.rules import FILLING, STRAND_MODULUS
from lamella.structure.actions.load_case import GRAVITY
from lamella.structure.beam.fibre_stress import strip_stresses
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.cables import Cables, make_cables
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import Loads, no_loads
from lamella.structure.model.model import Model, line_weights
from lamella.structure.static import at_rest
from lamella.structure.structure import Structure

# of the weight: what a sling is tight with at the least in the pose that the search begins in
LEAST_TENSION = 1e-3


@dataclass(frozen=True, eq=False, repr=False)
class Lifted(Result):
    """A net that hangs.

    Attributes
    ----------
    nodes : (p,) int
        It is lifted at.
    weight : float
        N.
    deflection : float or None
        Largest distance of a node from where it was designed, after the best rigid motion, m; None where no
        equilibrium was found: it does not hold.
    von_mises : float or None
        Largest equivalent stress of a strip, Pa.
    slings : (p,)
        Their tensions, N.
    poses : Poses or None
        Turned about the vertical from the designed shape; the hook is the last node.
    """

    nodes: Integers
    weight: float
    deflection: float | None
    von_mises: float | None
    slings: Floats
    poses: Poses | None

    def _line(self) -> str:
        at = f"lifted at {len(self.nodes)} nodes"
        return f"{at}, does not hold" if self.deflection is None else f"{at}, bends by {self.deflection:.3g} m"


def lifted(
    model: Model,
    nodes: Integers,
    *,
    hook: float | None = None,
    diameter: float = 0.01,
    node_masses: Floats | None = None,
) -> Lifted:
    """The net in the crane.

    Slings go from the nodes to one hook above the centre of gravity, as long as they are in the designed shape. What
    nothing resists, turning about the vertical, is held at one shift of a node straight out from the hook: it carries
    nothing.

    Parameters
    ----------
    model : Model
        Joints locked, without supports; z up.
    nodes : (p,) int
        Two or more, not all at one place in plan.
    hook : float, optional
        Height of the hook over the highest of them, m; default: half of their largest distance.
    diameter : float
        Of the slings' strands, m.
    node_masses : (n,), optional
        Of what hangs on the network's nodes beside strips, edge beams and cables, kg.

    Raises
    ------
    InputError
        Fewer than two nodes.
    """
    points = model.structure.poses.points
    if len(nodes) < 2:
        raise InputError(f"{len(nodes)} lifting nodes", "a net is lifted at two or more", "nodes")
    forces, lines = _weights(model, node_masses)
    weight, centre = _resultant(model, forces, lines)
    apart = float(np.linalg.norm(points[nodes][:, None] - points[nodes], axis=2).max())
    height = apart / 2 if hook is None else hook
    top = np.array([centre[0], centre[1], points[nodes, 2].max() + height])
    structure = _hung(model, nodes, top, weight, centre, diameter)
    own = np.zeros(structure.poses.unknowns)
    own[: len(forces)] = forces
    loads: Loads = replace(no_loads(structure), constant_forces=own, constant_lines=lines)
    try:
        here = at_rest(structure, loads)
    except InputError:
        return Lifted(nodes, weight, None, None, np.zeros(len(nodes)), None)
    return _told(model, here, nodes, weight)


def _told(model: Model, here: Equilibrium, nodes: Integers, weight: float) -> Lifted:
    section = model.lamellas.section
    stresses = strip_stresses(
        here.state, model.lamellas.material, section.height, section.thickness, layers=section.layers
    )
    own = slice(0, 2 * len(model.lines.length))
    network = slice(0, model.nodes)
    off = moved_onto(here.poses.points[network], model.structure.poses.points[network])
    return Lifted(
        nodes=nodes,
        weight=weight,
        deflection=float(off.max()),
        von_mises=float(stresses.von_mises[own].max()),
        slings=here.whole.cables.tension[-len(nodes) :],
        poses=here.poses,
    )


def _weights(model: Model, node_masses: Floats | None) -> tuple[Floats, Floats]:
    """Forces of what hangs on nodes, (6 n,), and of elements, (m, 3), N/m."""
    structure = model.structure
    masses = np.zeros(len(structure.poses.points))
    if node_masses is not None:
        masses[: model.nodes] = node_masses
    cables = structure.cables
    np.add.at(masses, cables.attachment.nodes, (cables.mass * cables.length / 2)[:, None])
    forces = np.zeros((len(masses), NODE_UNKNOWNS))
    forces[:, 2] = -GRAVITY * masses
    return forces.ravel(), np.outer(line_weights(model), (0.0, 0.0, -GRAVITY))


def _resultant(model: Model, forces: Floats, lines: Floats) -> tuple[float, Floats]:
    """Weight, N, and centre of gravity."""
    structure = model.structure
    ends, _ = structure.beams.attachment.ends(structure.poses)
    on_elements = -lines[:, 2] * structure.beams.law.length
    on_nodes = -forces.reshape(-1, NODE_UNKNOWNS)[:, 2]
    weight = float(on_elements.sum() + on_nodes.sum())
    moment = on_elements @ ends.mean(1) + on_nodes @ structure.poses.points
    return weight, np.asarray(moment / weight)


def _hung(model: Model, nodes: Integers, top: Floats, weight: float, centre: Floats, diameter: float) -> Structure:
    """The structure with a hook, which is held, and slings that carry about what they have to."""
    structure = model.structure
    arms = (structure.poses.points[nodes] - top)[:, :2]
    far = int(np.round(np.linalg.norm(arms, axis=1), 9).argmax())
    poses = _turned(structure.poses, top, arms[far])
    centre = top * (1, 1, 0) + centre * (0, 0, 1)
    hook = len(poses.points)
    hung = replace(
        poses, points=np.concatenate((poses.points, top[None])), frames=np.concatenate((poses.frames, np.eye(3)[None]))
    )
    away = top - poses.points[nodes]
    along = away / np.linalg.norm(away, axis=1)[:, None]
    # forces and moments about the centre of gravity
    levers = np.cross(poses.points[nodes] - centre, along)
    balance = np.concatenate((along.T, levers.T / np.abs(levers).max(initial=1.0)))
    tension, _ = nnls(balance, np.concatenate(([0.0, 0.0, weight], np.zeros(3))))
    tension = np.maximum(tension, LEAST_TENSION * weight)
    ends = np.stack((nodes, np.full(len(nodes), hook)), 1)
    slings = make_cables(hung, ends, STRAND_MODULUS * FILLING * np.pi / 4 * diameter**2, prestress=tension)
    held = np.concatenate((structure.held, np.ones((1, NODE_UNKNOWNS), bool)))
    # the farthest node, straight below the x axis through the hook, stays there
    held[nodes[far], 1] = True
    return replace(structure, poses=hung, held=held, cables=_together(structure.cables, slings))


def _turned(poses: Poses, top: Floats, arm: Floats) -> Poses:
    """Poses turned about the vertical through the hook, so that an arm (2,) in plan is along x."""
    x, y = arm / np.linalg.norm(arm)
    turn = np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]])
    return replace(poses, points=(poses.points - top) @ turn.T + top, frames=turn @ poses.frames)


def _together(one: Cables, other: Cables) -> Cables:
    """Cables of two kinds, one after the other."""
    attachment = replace(
        one.attachment,
        **{
            name: np.concatenate((getattr(one.attachment, name), getattr(other.attachment, name)))
            for name in ("nodes", "turns", "offsets", "joints")
        },
    )
    along = {name: np.concatenate((getattr(one, name), getattr(other, name))) for name in ("length", "axial", "mass")}
    return Cables(attachment, **along)

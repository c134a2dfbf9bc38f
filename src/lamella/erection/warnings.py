"""What a user should know of a net's way from flat to designed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lamella.base.message import Message
from lamella.base.wording import counted
from lamella.erection.bracings import NONE
from lamella.erection.lift_cases import LiftCase, least_bracing
from lamella.erection.slot_room import largest_turn

if TYPE_CHECKING:
    from lamella.erection.cut import Cut
    from lamella.erection.erection import Erection
    from lamella.erection.way import Way

# deg: a joint that has closed to less than this from straight is folded up, layers and all
FOLDED_ANGLE = 15.0
# of the net's size: what springs back farther needs bracing
SPRINGY = 0.02
# ids that a message names
SEGMENTS_NAMED = 5


def erection_warnings(erection: Erection) -> Iterator[Message]:
    """Of the states alone."""
    flat, first = erection.flat, erection.states[0]
    ids, node = erection.model.lamellas.network.ids, erection.model.joint_nodes
    # angles are told without jumps: a joint that turns past straight has more than 180 or less than 0
    left = np.minimum(first.angles, 180 - first.angles)
    folded = int((left < FOLDED_ANGLE).sum())
    if folded:
        worst = int(left.argmin())
        yield Message(
            "folds_up",
            f"let go, the net folds up: the joint at node {node[worst]} goes to {first.angles[worst]:.1f} deg, and "
            f"{folded} of {len(node)} joints to less than {FOLDED_ANGLE:g} deg from straight; hold it on the floor, or "
            "divide it into segments",
        )
    if len(flat.overlaps):
        one, other = (ids[i] for i in flat.overlaps[0].tolist())
        yield Message(
            "flat_overlaps",
            f"laid flat, {len(flat.overlaps)} pairs of lamellas cross that are not joined, {one} and {other} for one: "
            "the net cannot be laid flat in one piece; divide it into segments",
        )
    if erection.held:
        yield Message(
            "flat_is_held",
            f"let go, the net folds up; it lies flat with the mean of its joints' angles held, by {erection.hold:.2f} "
            "N m on each joint: brace a cell on the floor",
        )
    if not flat.lies and erection.laid:
        network = erection.model.lamellas.network
        around = network.closed.any() or any(abs(p.a_cells) + abs(p.b_cells) > 0.5 for p in network.periods)
        why = "the net closes around, and has to be cut along a lamella" if around else "divide it into segments"
        shape = "a plane" if flat.planar else f"a sphere of radius {flat.radius:.3g} m"
        yield Message(
            "not_flat", f"let go, the net does not lie flat: nodes are up to {flat.off:.3g} m off {shape}; {why}"
        )
    if erection.each_joint:
        yield Message(
            "each_joint_turned",
            "one moment shared by all joints does not lead the net to its designed shape: the states have each joint "
            "turned to its own angle, in proportion",
        )
    if erection.stop is not None:
        stop = erection.stop
        yield Message(
            "driver_stops",
            f"on the way from the designed shape to flat the net meets a limit point at {100 * stop.share:.0f} % of "
            f"the way, in the step to state {stop.state}: node {stop.node} moves farthest, by {stop.distance:.3g} m; "
            "no equilibrium is found beyond, and the states up to there and the flat one are kept",
        )
    if erection.way is not None:
        yield from way_warnings(erection, erection.way)
    loose = [state for state in erection.states if not state.stable]
    if loose:
        yield Message(
            "way_unstable",
            f"{len(loose)} of {len(erection.states)} states are unstable with their joints held, at "
            f"{100 * loose[0].share:.0f} % of the way for one: the net snaps there",
        )


def way_warnings(erection: Erection, way: Way) -> Iterator[Message]:
    """Of what a device does."""
    of_it = "the driver" if way.kind == "angles" else f"the driver ({way.kind})"
    if way.stop is not None:
        stop = way.stop
        yield Message(
            "driver_stops",
            f"{of_it} meets a limit point after {100 * stop.share:.0f} % of the way, in the step to state "
            f"{stop.state + 1}: node {stop.node} moves farthest there, by {stop.distance:.3g} m, and no equilibrium is "
            "found beyond; the states up to there are kept",
        )
    if way.snaps:
        snap = way.snaps[0]
        yield Message(
            "driver_snaps",
            f"{of_it} passes {counted(len(way.snaps), 'limit point')}: in the step to {100 * snap.share:.0f} % of the "
            f"way (state {snap.state}) the net snaps, node {snap.node} farthest, by {snap.distance:.3g} m; hold it "
            "back there",
        )
    if way.start == "flat" and way.off_design > SPRINGY * erection.model.structure.size:
        yield Message(
            "off_design",
            f"at the end of its way the net is up to {way.off_design:.3g} m off its designed shape: {of_it} alone does "
            "not form it",
        )


def spring_back_warning(erection: Erection) -> Iterator[Message]:
    """Of a net that does not keep its shape, where nothing braces it."""
    if erection.spring_back > SPRINGY * erection.model.structure.size and not erection.braced:
        yield Message(
            "springs_back",
            f"with its joints locked and nothing else holding it the net springs back by {erection.spring_back:.3g} m: "
            "brace it before it is moved, by diagonals or edge beams",
        )


def cut_warning(cut: Cut | None) -> Iterator[Message]:
    """Of a net that overlaps when it is laid flat."""
    if cut is None:
        return
    parts = "what is left" if cut.parts == 1 else f"{cut.parts} parts"
    if cut.left == 0:
        what = f"{parts} then can be laid flat without overlap"
    elif cut.left is None:
        what = f"{parts} would not come to rest: divide it into smaller segments"
    else:
        what = f"{counted(cut.left, 'pair')} would overlap still: divide it into smaller segments"
    yield Message("flat_cut", f"cut along {cut.lamella}, midway between what overlaps, {what}")


def lifting_warnings(lifts: Mapping[str, Sequence[LiftCase]]) -> Iterator[Message]:
    """Of nets that have to be braced before they are lifted: a message a number of points.

    Parameters
    ----------
    lifts : mapping
        Cases by the id of the segment, "" for the whole net.
    """
    for points in dict.fromkeys(case.points for cases in lifts.values() for case in cases):
        needed = {
            segment: least_bracing(cases, points)
            for segment, cases in lifts.items()
            if any(case.points == points for case in cases)
        }
        soft = {segment: bracing for segment, bracing in needed.items() if bracing != NONE}
        if not soft:
            continue
        of_it = "the net" if "" in soft else f"{len(soft)} of {counted(len(needed), 'segment')}"
        ways = []
        for bracing in dict.fromkeys(soft.values()):
            ids = [segment for segment, one in soft.items() if one == bracing and segment]
            those = f" ({', '.join(ids[:SEGMENTS_NAMED])}{', ...' if len(ids) > SEGMENTS_NAMED else ''})" if ids else ""
            ways.append((_not_enough(lifts) if bracing is None else _named(bracing)) + those)
        yield Message(
            "lifting_needs_bracing",
            f"lifted at {points} points with joints locked alone {of_it} would not keep the shape; needed before: "
            + "; ".join(ways),
        )


def _not_enough(lifts: Mapping[str, Sequence[LiftCase]]) -> str:
    """Where nothing of the project holds a net: that it has nothing, or not enough."""
    if all(case.bracing == NONE for cases in lifts.values() for case in cases):
        return "bracing, of which the project has none: add [cables] or [edge_beam]"
    return "no bracing that the project has is enough"


def _named(bracing: str) -> str:
    return {"edge_beams": "edge beams", "both": "cables and edge beams"}.get(bracing, bracing)


def slot_warning(erection: Erection, slot_width: float) -> Iterator[Message]:
    """Of slots that are too narrow for a state; stacked lamellas have none.

    Parameters
    ----------
    erection : Erection
    slot_width : float
        m.
    """
    thickness = erection.model.lamellas.section.thickness
    needed = erection.slot_width_needed
    if needed is None or slot_width < thickness:
        return
    room = np.degrees(largest_turn(slot_width, thickness))
    for state, off in zip(erection.states, erection.turned, strict=True):
        tight = int((off > room).sum())
        if tight:
            worst = int(off.argmax())
            yield Message(
                "slots_too_narrow",
                f"slots {1e3 * slot_width:.3g} mm wide let a joint turn by {room:.3g} deg off square; at "
                f"{100 * state.share:.0f} % of the way {tight} of {len(off)} joints are beyond that, the one at node "
                f"{erection.model.joint_nodes[worst]} by {off[worst]:.3g} deg; "
                f"{1e3 * needed:.3g} mm would do for all states",
            )
            return

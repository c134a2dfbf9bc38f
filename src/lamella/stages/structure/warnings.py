"""What a run warns about a structure: overload, instability, slack cables, overstress, soft supports."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.message import Message
from lamella.stages.structure.output import StructureOutput
from lamella.structure.analysis.analyse import RESIDUAL, Analysis
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.named_mechanism import place_name

FAR_SHARE = 0.2
"""Of a structure's size: what moves farther has supports that hold little, or loads in another unit."""

ALL_HELD = 0.95
"""Share of the nodes that are supported, from which on supports are probably meant otherwise."""


def structure_warnings(out: StructureOutput) -> Iterator[Message]:
    """Of all cases, the worst one of a kind each."""
    analysis = out.analysis
    if analysis.free_body:
        yield Message(
            "structure_free",
            "no table [[support]] holds the net: it is let go with its middle node held, which resists nothing",
        )
    for case in analysis.cases:
        if not case.converged:
            yield Message(
                "overload",
                f"load case {case.name!r}: the structure carries {case.load_factor:.3g} of the load: {case.reason}"
                f"{_first_mode(case)}",
            )
        elif not case.stable:
            yield Message("structure_unstable", _unstable(case))
    yield from _supports(analysis)
    yield from _slack(analysis)
    if out.driven is not None and out.driven.reason:
        far = float(out.driven.curve.watched[-1])
        yield Message(
            "displacement_not_reached", f"node {out.driven.node} is moved by {far:.4g} m only: {out.driven.reason}"
        )
    worst = max(analysis.cases, key=lambda case: round(case.utilisation_max, 9))
    if worst.utilisation_max > 1:
        yield Message("structure_overstressed", _overstressed(worst))


def _unstable(case: CaseResult) -> str:
    ways = case.equilibrium.negative
    if case.name == RESIDUAL:
        return (
            f"let go, the net is unstable in {ways} ways: strips buckle under their own residual stress: thicker or "
            "lower strips, closer nodes, more layers"
        )
    return (
        f"load case {case.name!r}: the equilibrium is unstable in {ways} ways, the structure buckles before the load "
        f"is reached{_first_mode(case)}"
    )


def _first_mode(case: CaseResult) -> str:
    """Where it buckles first, by linear buckling about the last stable state."""
    if not len(case.buckling):
        return ""
    structure = case.equilibrium.structure
    shifts = case.modes[0][: 6 * len(structure.poses.points)].reshape(-1, 6)[:, :3]
    # ties by the order of nodes, whatever the last bits
    size = np.round(np.linalg.norm(shifts, axis=1), 9)
    node = int(size.argmax())
    where = f"{place_name(case.model, node)} at ({coordinates(structure.poses.points[node], 3)}) m"
    return f"; by linear buckling at {case.buckling[0]:.3g} of the load, first {where}"


def _supports(analysis: Analysis) -> Iterator[Message]:
    size = analysis.model.structure.size
    case = max(analysis.cases[1:], key=lambda case: round(case.deflection_max, 9), default=None)
    if case is not None and case.deflection_max > FAR_SHARE * size:
        yield Message(
            "structure_moves_far",
            f"load case {case.name!r}: a node moves by {case.deflection_max:.3g} m, the structure is {size:.3g} m "
            "large: its supports or springs hold little, or a load is in another unit (N, m)",
        )
    held = analysis.model.supports.supported
    if len(held) and held.mean() > ALL_HELD and not analysis.free_body:
        yield Message(
            "all_nodes_supported",
            f"{int(held.sum())} of {len(held)} nodes are supported: loads go straight into supports; look at ground, "
            "tolerance and radius of [[support]]",
        )


def _slack(analysis: Analysis) -> Iterator[Message]:
    slack = [case.slack for case in analysis.cases]
    worst = int(np.argmax(slack))
    if slack[worst]:
        case = analysis.cases[worst]
        loose = np.flatnonzero(~case.equilibrium.whole.cables.tight(case.equilibrium.whole.cables.force))
        one, other = case.equilibrium.structure.cables.attachment.nodes[loose[0]].tolist()
        yield Message(
            "cables_slack",
            f"load case {case.name!r}: {slack[worst]} of {len(case.cable_forces)} stretches of cable are slack and "
            f"carry nothing (from node {one} to {other}, ...): raise cables.prestress if they are meant to",
        )


def _overstressed(case: CaseResult) -> str:
    use, model = case.use.utilisation, case.model
    if case.edge_utilisation_max > use.max():
        return f"under load case {case.name!r} utilisation of the edge beam reaches {case.edge_utilisation_max:.2f}"
    element, end = np.unravel_index(np.round(use, 9).argmax(), use.shape)
    lines = model.lines
    points, _ = case.equilibrium.structure.beams.attachment.ends(model.structure.poses)
    point = coordinates(points[element, end], 3)
    lamella = model.lamellas.network.ids[lines.lamella[element]]
    return (
        f"under load case {case.name!r} utilisation reaches {use[element, end]:.2f} in lamella {lamella} at ({point}) "
        f"m, von Mises stress up to {case.von_mises_max / 1e6:.4g} MPa, of which residual {case.residual_share:.0%}"
    )

"""What a run warns about a structure: overload, instability, slack cables, overstress."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.message import Message
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.analysis.case_result import CaseResult


def structure_warnings(analysis: Analysis) -> Iterator[Message]:
    """Of all cases, the worst one of a kind each."""
    if analysis.free_body:
        yield Message(
            "structure_free",
            "no table [[support]] holds the net: it is let go with its middle node held, which resists nothing",
        )
    for case in analysis.cases:
        if not case.converged:
            yield Message(
                "overload",
                f"load case {case.name!r}: the structure carries {case.load_factor:.3g} of the load: {case.reason}",
            )
        elif not case.stable:
            yield Message(
                "structure_unstable",
                f"load case {case.name!r}: the equilibrium is unstable in {case.equilibrium.negative} ways, the "
                "structure buckles before the load is reached",
            )
    yield from _slack(analysis)
    worst = max(analysis.cases, key=lambda case: round(case.utilisation_max, 9))
    if worst.utilisation_max > 1:
        yield Message("structure_overstressed", _overstressed(worst))


def _slack(analysis: Analysis) -> Iterator[Message]:
    slack = [case.slack for case in analysis.cases]
    worst = int(np.argmax(slack))
    if slack[worst]:
        case = analysis.cases[worst]
        yield Message(
            "cables_slack",
            f"load case {case.name!r}: {slack[worst]} of {len(case.cable_forces)} stretches of cable are slack and "
            "carry nothing: raise cables.prestress if they are meant to",
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

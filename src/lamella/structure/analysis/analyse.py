"""Analyses of a net: what it does when it is let go, under load cases, and how it swings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.result import Result
from lamella.hardware.rules import CableRules
from lamella.structure.actions.load_case import LoadCase
from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.construction_order import put_up
from lamella.structure.analysis.named_mechanism import named_mechanism
from lamella.structure.buckling import linear_buckling
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import Loads, no_loads
from lamella.structure.loose_parts import refuse_loose_parts
from lamella.structure.model.bracing import brace
from lamella.structure.model.case_loads import case_loads
from lamella.structure.model.model import Model
from lamella.structure.static import at_rest, load_path, loaded
from lamella.structure.vibration import vibration

FURTHER_STEPS = 60
"""Load steps of a case beyond those that are asked for; what needs more gives way bit by bit."""

RESIDUAL = "residual"
"""Name of the state without loads."""


@dataclass(frozen=True, repr=False, eq=False)
class Analysis(Result):
    """A net as a structure.

    Attributes
    ----------
    model : Model
    cases : tuple of CaseResult
        The first is the residual state.
    stages : tuple of CaseResult
        The end of every stage of construction, by their names; none where all is in place from the first.
    swing_modes : (f, 6 n + k)
        Motions of the frequencies, of largest number 1.
    frequencies : (f,)
        Of the residual state, Hz.
    free_body : bool
        Whether nothing supports it, so that a node was held that it cannot drift.
    loads : tuple of LoadCase
        Of the cases but for the first one.
    node_masses : (n,) or None
        Of what hangs on the network's nodes, kg.
    """

    model: Model
    cases: tuple[CaseResult, ...]
    frequencies: Floats
    free_body: bool
    stages: tuple[CaseResult, ...] = ()
    swing_modes: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    loads: tuple[LoadCase, ...] = ()
    node_masses: Floats | None = None

    def _line(self) -> str:
        return ", ".join(f"{case.name} {case.utilisation_max:.2f}" for case in self.cases)

    @property
    def spring_back(self) -> float:
        """How far a node moves when the net is let go, m."""
        return self.cases[0].displacement_max


def free_body_supports(points: Floats) -> NodeSupports:
    """The node nearest to the middle held in all ways, which holds a body and resists nothing."""
    fixed = np.zeros((len(points), 6), bool)
    away = np.linalg.norm(points - points.mean(0), axis=1)
    # of nodes alike the first, whatever the last bits
    fixed[int(np.round(away / max(float(away.max()), np.finfo(float).tiny), 9).argmin())] = True
    return NodeSupports(fixed, np.zeros(fixed.shape))


def analyse(
    model: Model,
    cases: Sequence[LoadCase] = (),
    *,
    node_masses: Floats | None = None,
    cables_later: CableRules | None = None,
    construction: Sequence[str] = (),
    buckling: int = 3,
    frequencies: int = 3,
    steps: int = 1,
    progress: Progress = silent,
) -> Analysis:
    """The residual state, each load case on it, linear buckling about each, frequencies of the residual state.

    Parameters
    ----------
    model : Model
    cases : sequence of LoadCase
    node_masses : (n,), optional
        See `lamella.structure.model.case_loads.case_loads`.
    cables_later : CableRules, optional
        Cables that are put on once the net has been let go, with their prestress there, or in their stage of
        construction; the model has none then.
    construction : sequence of str
        Stages in the order of the site, see `lamella.structure.analysis.construction_order.put_up`; default: the
        designed shape is let go with all that is in the model.
    buckling, frequencies : int
        How many.
    steps : int
        Load steps to begin with.
    progress : callable

    Raises
    ------
    InputError
        Nothing supports what is loaded; a part moves freely; the residual state has no equilibrium.
    """
    supported = bool(model.supports.supported.any())
    if cases and not supported:
        raise InputError("there are loads and no supports", "hold nodes of the net", "supports")
    if not supported:
        model = _held_in_the_middle(model)
    with named_mechanism(model):
        refuse_loose_parts(model.structure)
        stages: tuple[CaseResult, ...] = ()
        if construction:
            ends, model = put_up(model, construction, cables_later, progress=progress)
            rest = ends[-1]
            stages = tuple(_end_of(stage, model, end) for stage, end in zip(construction, ends, strict=True))
        else:
            progress(Report.step("residual state"))
            rest = at_rest(model.structure, no_loads(model.structure))
            if cables_later is not None:
                rest, model = _braced(rest, model, cables_later)
        found = [CaseResult(RESIDUAL, model, rest, rest, "", np.zeros(0))]
        swings, modes = np.zeros(0), np.zeros((0, 0))
        if frequencies and rest.negative == 0:
            swinging = vibration(rest, frequencies)
            swings, modes = swinging.frequencies, swinging.modes
        for k, case in enumerate(cases):
            report = _reporter(progress, case.name, k / len(cases))
            report(0.0)
            loads = case_loads(model, case, node_masses)
            found.append(_case(model, case.name, rest, loads, buckling, steps, report))
    return Analysis(model, tuple(found), swings, not supported, stages, modes, tuple(cases), node_masses)


def _end_of(stage: str, model: Model, end: Equilibrium) -> CaseResult:
    """What is known at the end of a stage of construction."""
    return CaseResult(stage, replace(model, structure=end.structure), end, end, "", np.zeros(0))


def _held_in_the_middle(model: Model) -> Model:
    supports = free_body_supports(model.lamellas.network.node_points)
    held = model.structure.held.copy()
    held[: model.nodes] |= supports.fixed
    return replace(model, structure=replace(model.structure, held=held), supports=supports)


def _braced(rest: Equilibrium, model: Model, rules: CableRules) -> tuple[Equilibrium, Model]:
    """The residual state with cables that were put on in it."""
    lamellas = model.lamellas
    cables = brace(lamellas.network, rest.poses, rules, lamellas.section.height)
    structure = replace(rest.structure, cables=cables)
    own = Equilibrium(structure, no_loads(structure), 0.0, rest.poses, rest.negative, 0)
    # all the way from one load factor without loads to another, in shorter steps where they are needed
    last = loaded(replace(own, factor=-1.0), 0.0)
    return last, replace(model, structure=structure)


def _reporter(progress: Progress, name: str, share: float) -> Callable[[float], None]:
    """Tells how much of a case's load is on."""

    def report(factor: float) -> None:
        on = f", {factor:.3g} of the load" if factor else ""
        progress(Report.step(f"load case {name}{on}", share))

    return report


def _case(
    model: Model,
    name: str,
    rest: Equilibrium,
    loads: Loads,
    buckling: int,
    steps: int,
    report: Callable[[float], None],
) -> CaseResult:
    start = stable = last = replace(rest, loads=loads)
    reason, states = "", []
    try:
        for last in load_path(start, steps=steps):
            states.append(replace(last))
            if last.negative == 0:
                stable = last
            if last.factor != 1:
                report(last.factor)
                if len(states) >= steps + FURTHER_STEPS:
                    reason = f"{len(states)} load steps lead no farther than to the load factor {last.factor:.6g}"
                    break
    except InputError as error:
        reason = error.message
    factors, modes = np.zeros(0), np.zeros((0, 0))
    if buckling and stable.negative == 0:
        # nothing may be there that these loads would make buckle
        with suppress(InputError):
            found = linear_buckling(stable, buckling)
            factors, modes = found.factors, found.modes
    return CaseResult(name, model, last, rest, reason, factors, tuple(states[:-1]), modes)

"""Envelope, paths, stages of construction and compared variants as rows of tables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.compared_case import ComparedCase
from lamella.structure.analysis.driven import Driven
from lamella.structure.analysis.envelope import Envelope
from lamella.structure.analysis.failure import Failure
from lamella.structure.export.result_rows import MM, MPA, EndForces, Row, layer_number, texts
from lamella.structure.model.model import Model

FORCES = {"N_N": 0, "Mx_Nm": 3, "My_Nm": 4, "Mz_Nm": 5}
"""Section forces of the envelope, and their columns."""

ENVELOPE = (
    *("lamella", "layer", "element", "end", "at_m"),
    *(f"{name}_{what}" for name in FORCES for what in ("min", "min_case", "max", "max_case")),
    *("von_mises_MPa", "von_mises_case", "utilisation", "utilisation_case"),
)
GOVERNING = ("lamella", "N_min_N", "N_max_N", "utilisation", "case", "layer", "at_m")
PATHS = ("analysis", "case", "state", "load_factor", "shift_max_mm", "driven_mm", "utilisation", "unstable_ways")
FAILURE = ("case", "linear_buckling", "first_yield", "first_branch", "limit_point", "followed_to", "ended_by")
CONSTRUCTION = ("stage", "displacement_mm", "utilisation", "prop_force_max_N", "cable_force_max_N")
COMPARED = (
    *("variant", "case", "load_factor", "deflection_mm", "von_mises_MPa", "utilisation", "buckling_factor"),
    *("cable_force_max_N", "axial_share", "upright_bending_share", "deflection_ratio", "buckling_ratio", "remark"),
)


def envelope_of(cases: Sequence[CaseResult]) -> Envelope:
    """Of all cases."""
    return Envelope.of(cases, lambda case: EndForces.of(case).values)


def envelope_rows(model: Model, envelope: Envelope) -> Iterator[Row]:
    """Both ends of every element of the lamellas."""
    lines, ids, names = model.lines, model.lamellas.network.ids, envelope.names
    columns: list[list[str]] = []
    for column in FORCES.values():
        for extreme in (envelope.least, envelope.most):
            columns.append([row[0] for row in texts(extreme.values[..., column].reshape(-1, 1), 4)])
            columns.append([names[k] for k in extreme.cases[..., column].ravel()])
    for values, digits, unit in ((envelope.von_mises, 5, MPA), (envelope.utilisation, 6, 1.0)):
        columns.append([row[0] for row in texts(unit * values.values.reshape(-1, 1), digits)])
        columns.append([names[k] for k in values.cases.ravel()])
    for k, row in enumerate(zip(*columns, strict=True)):
        element, end = divmod(k, 2)
        name, layer = ids[int(lines.lamella[element])], layer_number(int(lines.layer[element]))
        yield (name, layer, element, end, f"{lines.arclengths[element, end]:.6f}", *row)


def governing_rows(model: Model, envelope: Envelope) -> Iterator[Row]:
    """Of every lamella the extremes, and where and by which case it is used most."""
    lines, ids = model.lines, model.lamellas.network.ids
    use = np.round(envelope.utilisation.values, 9)
    for k, name in enumerate(ids):
        own = np.flatnonzero(lines.lamella == k)
        if not len(own):
            continue
        axial = envelope.least.values[own, :, 0].min(), envelope.most.values[own, :, 0].max()
        row, end = np.unravel_index(use[own].argmax(), (len(own), 2))
        element = int(own[row])
        case = envelope.names[envelope.utilisation.cases[element, end]]
        low, high, used = texts(np.array([[*axial, use[element, end]]]), 5)[0]
        yield (
            *(name, low, high, used, case, layer_number(int(lines.layer[element]))),
            f"{lines.arclengths[element, end]:.6f}",
        )


def path_rows(failures: Iterable[Failure], driven: Driven | None) -> Iterator[Row]:
    """Every state of the paths."""
    named = [("load factor to failure", one.name, one.curve) for one in failures]
    if driven is not None:
        named.append((f"displacement of node {driven.node}", driven.name, driven.curve))
    for analysis, case, curve in named:
        columns = np.column_stack((curve.factors, MM * curve.shifts, MM * curve.watched, curve.utilisation))
        for state, (row, negative) in enumerate(zip(texts(columns, 6), curve.negative.tolist(), strict=True)):
            yield (analysis, case, state, *row, negative)


def failure_rows(failures: Iterable[Failure]) -> Iterator[Row]:
    """A row a case."""
    for one in failures:
        factors = (one.linear_factor, one.yield_factor, one.branch_factor, one.limit_factor, one.reached)
        yield (one.name, *(_number(factor) for factor in factors), one.reason)


def construction_rows(stages: Iterable[CaseResult]) -> Iterator[Row]:
    """A row a stage."""
    for stage in stages:
        props = prop_force_max(stage)
        cables = float(stage.cable_forces.max(initial=0.0))
        numbers = (MM * stage.displacement_max, stage.utilisation_max, props, cables)
        yield (stage.name, *(f"{value:.6g}" for value in numbers))


def prop_force_max(stage: CaseResult) -> float:
    """Of a node that is held and has no support, N."""
    count = stage.model.nodes
    reactions = stage.equilibrium.reactions[:count, :3][~stage.model.supports.supported]
    return float(np.linalg.norm(reactions, axis=1).max(initial=0.0))


def compared_rows(cases: Sequence[ComparedCase]) -> Iterator[Row]:
    """A row a variant and case; ratios to the first variant of the same case."""
    first: dict[str, ComparedCase] = {}
    for one in cases:
        base = first.setdefault(one.case, one)
        shares = (None, None) if one.shares is None else (one.shares.axial, one.shares.upright)
        yield (
            *(one.variant, one.case, _number(one.load_factor), _number(one.deflection_max, MM)),
            *(_number(one.von_mises_max, MPA), _number(one.utilisation_max), _number(one.buckling_factor)),
            *(_number(one.cable_force_max), *(_number(share) for share in shares)),
            _ratio(one.deflection_max, base.deflection_max),
            _ratio(one.buckling_factor, base.buckling_factor),
            one.reason,
        )


def _number(value: float | None, unit: float = 1.0) -> str:
    return "" if value is None else f"{unit * value:.6g}"


def _ratio(value: float | None, base: float | None) -> str:
    return f"{value / base:.4f}" if value is not None and base else ""

"""Sheets of SAF: load groups, cases, combinations, and what acts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.structure.actions.combinations import PERMANENT, SETTLEMENT, Combination
from lamella.structure.export.saf.columns import COMBINED
from lamella.structure.export.saf.model_sheets import MM, NOTHING, Row, cable, node, support
from lamella.structure.export.straight_model import StraightLoads, StraightModel

KILO = 1e3
RESIDUAL = "residual"
"""Load case of what strips were bent by and cables are prestressed with."""

_KINDS = {"snow": "Snow", "snow above 1000 m": "Snow", "wind": "Wind", "temperature": "Temperature"}
"""SAF's type of a load by the category of EN 1990."""

_WAYS = ("X", "Y", "Z")


@dataclass(frozen=True, eq=False)
class Case:
    """A load case with its category of EN 1990."""

    name: str
    category: str
    loads: StraightLoads

    @property
    def permanent(self) -> bool:
        """Whether it is there all the time."""
        return self.category in (PERMANENT, SETTLEMENT)

    @property
    def group(self) -> str:
        """Its load group: one for all permanent ones, one for each category of the others."""
        return PERMANENT if self.permanent else self.category


def group_rows(cases: Sequence[Case]) -> Iterator[Row]:
    """Permanent loads act together; of a category of variable ones any may."""
    yield (PERMANENT, "Permanent", "Together", NOTHING)
    for group in dict.fromkeys(case.group for case in cases if not case.permanent):
        kind = _KINDS.get(group, "Roofs" if group == "H" else "Domestic")
        yield (group, "Variable", "Exclusive" if kind != "Domestic" else "Standard", kind)


def case_rows(cases: Sequence[Case]) -> Iterator[Row]:
    """The residual state first."""
    about = "bending that strips have as designed, as temperature; prestress of cables; twist is not in it"
    yield (RESIDUAL, about, "Permanent", PERMANENT, "Prestress", NOTHING)
    for case in cases:
        if case.permanent:
            yield (case.name, case.category, "Permanent", case.group, "Others", NOTHING)
        else:
            kind = _KINDS.get(case.category, "Static")
            yield (case.name, case.category, "Variable", case.group, kind, "Short" if kind != "Static" else "Medium")


def combination_header(combinations: Sequence[Combination]) -> tuple[str, ...]:
    """Columns of the cases of the longest one, the residual state among them."""
    most = 1 + max((len(one.factors) for one in combinations), default=0)
    return tuple(f"{column} {k + 1}" for k in range(most) for column in COMBINED)


def combination_rows(combinations: Sequence[Combination]) -> Iterator[Row]:
    """All of them with the residual state, non-linear: large displacements and slack cables do not add up."""
    for one in combinations:
        parts: list[object] = [1.0, 1.0, RESIDUAL]
        for name, factor in one.factors.items():
            parts += [float(factor), 1.0, name]
        yield (one.name, NOTHING, "Not defined", NOTHING, "Nonlinear", *parts)


def force_rows(cases: Sequence[Case]) -> Iterator[Row]:
    """Forces on nodes."""
    number = 0
    for case in cases:
        forces = np.round(case.loads.forces[:, :3] / KILO, 9)
        for at, way in np.argwhere(forces).tolist():
            number += 1
            first = (
                f"F{number}",
                "Standard",
                _WAYS[way],
                "In node",
                node(at),
                NOTHING,
                float(forces[at, way]),
                NOTHING,
            )
            yield (*first, case.name, "Global", *(NOTHING,) * 5)


def moment_rows(cases: Sequence[Case]) -> Iterator[Row]:
    """Moments on nodes."""
    number = 0
    for case in cases:
        moments = np.round(case.loads.forces[:, 3:] / KILO, 9)
        for at, way in np.argwhere(moments).tolist():
            number += 1
            first = (f"PM{number}", "Standard", f"M{'xyz'[way]}", "In node", node(at), NOTHING, float(moments[at, way]))
            yield (*first, case.name, "Global", *(NOTHING,) * 5)


def line_rows(model: StraightModel, cases: Sequence[Case]) -> Iterator[Row]:
    """Even loads on members."""
    number = 0
    for case in cases:
        lines = np.round(case.loads.lines / KILO, 9)
        for at, way in np.argwhere(lines).tolist():
            number += 1
            first = (f"LF{number}", "Standard", "On beam", "Uniform", _WAYS[way], float(lines[at, way]))
            there = (model.names[at], case.name, "Global", "Length", "Relative", "From start", "Full")
            yield (*first, *there, 0.0, 1.0, 0.0, 0.0)


def thermal_rows(model: StraightModel, cases: Sequence[Case]) -> Iterator[Row]:
    """What strips were bent by, as temperature from face to face; prestress; changes of temperature."""
    yield from _residual(model)
    number = 0
    for case in cases:
        warmer = np.round(case.loads.warming, 6)
        for k in np.flatnonzero(warmer).tolist():
            number += 1
            yield _thermal(f"T{number}", (float(warmer[k]),), model.names[k], case.name)
        for k, section in enumerate(model.cable_section):
            if case.loads.cable_warming:
                number += 1
                change = case.loads.cable_warming / section.material.expansion
                yield _thermal(f"T{number}", (round(change, 6),), cable(k), case.name)


def _residual(model: StraightModel) -> Iterator[Row]:
    """Temperature that holds a member as it is bent: R, at y, is warmer than L by curvature x width / expansion."""
    number = 0
    for k, name in enumerate(model.names):
        section = model.sections[model.section[k]]
        if section.shape != "rectangle" or not section.material.expansion:
            continue
        stretch, sideways, up = model.strains[k].tolist()
        height, width = section.size
        mean, across, along = (
            value / section.material.expansion for value in (-stretch, sideways * width / 2, up * height / 2)
        )
        four = tuple(round(value, 6) for value in (mean - across, mean + across, mean + along, mean - along))
        if any(four):
            number += 1
            yield _thermal(f"R{number}", four, name, RESIDUAL)
    for k, section in enumerate(model.cable_section):
        number += 1
        change = -float(model.cable_strain[k]) / section.material.expansion
        yield _thermal(f"R{number}", (round(change, 6),), cable(k), RESIDUAL)


def _thermal(name: str, values: tuple[float, ...], member: str, case: str) -> Row:
    """One value is constant; four are left, right, top, bottom."""
    linear = len(values) == 4
    four = (NOTHING, *values) if linear else (values[0], *(NOTHING,) * 4)
    return (
        *(name, "On beam", "Linear" if linear else "Constant", *four, member, case),
        *("Relative", "From start", 0.0, 1.0),
    )


def settlement_rows(cases: Sequence[Case]) -> Iterator[Row]:
    """Motions of supports."""
    number = 0
    for case in cases:
        motions = np.round(case.loads.motions * MM, 9)
        for at, way in np.argwhere(motions).tolist():
            number += 1
            value = float(motions[at, way])
            shift = (value, NOTHING) if way < 3 else (NOTHING, value)
            direction = (*_WAYS, "Rx", "Ry", "Rz")[way]
            yield (f"D{number}", support(at), direction, *shift, case.name)

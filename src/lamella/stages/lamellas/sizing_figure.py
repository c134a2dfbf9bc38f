"""Figures of the largest measures that stay elastic."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella.stages.figure import ABSENT, NUMBER, TEXT, Figure, nullable, record
from lamella.stages.lamellas.output import LamellasOutput

Rows = Iterator[tuple[str, str, str]]

MEASURE = record(largest=nullable(NUMBER), lamella=nullable(TEXT))


def _sizing(out: LamellasOutput) -> Any:
    if out.sizing is None:
        return ABSENT
    told: dict[str, Any] = {"safety": out.sizing.safety}
    for name, values in out.sizing.measures().items():
        # equal ones but for rounding: the first lamella
        least = int(np.argmin(np.round(values, 9)))
        bounded = bool(np.isfinite(values[least]))
        told[name] = {
            "largest": float(values[least]) if bounded else None,
            "lamella": str(out.network.ids[least]) if bounded else None,
        }
    return told


def _sizing_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    for name in ("thickness", "height", "offset"):
        one = value[name]
        if one["largest"] is not None:
            label = f"Largest {name} at a safety of {value['safety']:g}"
            yield label, format(1e3 * one["largest"], ".3g"), f"mm, by lamella {one['lamella']}"


SIZING: Figure[LamellasOutput] = Figure(
    "sizing",
    "m",
    "where `[sizing]` is given, at its `safety`: `largest` `thickness`, `height` and `offset` with which all lamellas "
    "stay elastic, the other measures as they are, and the first `lamella` that would not; null where 16 times the "
    "present one does, 0 where a sixty-fourth does not",
    _sizing,
    record(safety=NUMBER, thickness=MEASURE, height=MEASURE, offset=MEASURE),
    always=False,
    rows=_sizing_rows,
)

"""A neutral table of what strips were bent and twisted by, for programs that take strain loads member by member."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.files.write.table import write_table
from lamella.structure.model.model import Model

HEADER = (
    *("element", "lamella", "layer", "from_node", "to_node", "x1_m", "y1_m", "z1_m", "x2_m", "y2_m", "z2_m"),
    *("nx", "ny", "nz", "length_m", "kg_per_m", "kn_per_m", "tg_per_m", "strain", "EA_N", "EI_strong_Nm2"),
    *("EI_weak_Nm2", "GJ_Nm2"),
)
"""kg, kn, tg and strain are those from the flat strip to the designed shape; n is the strip's upright direction."""


def write_imposed_curvatures(path: Path, model: Model, *, name: str, version: str, origin: Origin = NOWHERE) -> None:
    """Write curvatures, torsion and strain of all elements in the designed shape, measured from `origin`.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    write_table(path, HEADER, _rows(model, origin), name=name, version=version)


def _rows(model: Model, origin: Origin) -> Iterator[tuple[object, ...]]:
    structure, lines = model.structure, model.lines
    state = structure.beams.at(structure.poses)
    law, strains = structure.beams.law, state.strains.values
    points, frames = structure.beams.attachment.ends(structure.poses)
    upright = frames[:, :, :, 2].mean(1)
    upright /= np.linalg.norm(upright, axis=1)[:, None]
    stiffness = law.stiffness / law.length
    # strains turn about u by -kn, which the natural curvature is taken from
    numbers = np.column_stack(
        (points.reshape(-1, 6), upright, law.length, strains[5], -strains[4], strains[3], strains[0])
    )
    # edge beams, which come last, are bent before they are mounted
    count = len(lines.length)
    values = (np.round(numbers, 9) + 0.0).tolist()[:count]
    for k, (row, rigid) in enumerate(zip(values, stiffness.T.tolist()[:count], strict=True)):
        layer = int(lines.layer[k])
        yield (
            k,
            model.lamellas.network.ids[int(lines.lamella[k])],
            layer + 1 if layer >= 0 else "",
            *lines.nodes[k].tolist(),
            *(f"{value:.9g}" for value in row),
            *(f"{rigid[kind]:.9g}" for kind in (0, 4, 5, 3)),
        )

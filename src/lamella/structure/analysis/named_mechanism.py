"""Mechanisms of a model by where they are on the net."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.structure.mechanism import MechanismError
from lamella.structure.model.model import Model


@contextmanager
def named_mechanism(model: Model) -> Iterator[None]:
    """Say where on the net what moves freely is.

    Raises
    ------
    InputError
        In place of a `MechanismError`.
    """
    try:
        yield
    except MechanismError as error:
        if error.node is None:
            what = "the angle of a joint"
        else:
            point = coordinates(model.structure.poses.points[error.node], 3)
            what = f"{place_name(model, error.node)} at ({point}) m"
        raise InputError(
            f"a part of the structure moves freely: {what} {error.way} and nothing resists",
            "hold more of it, or in more directions",
            "supports",
        ) from None


def place_name(model: Model, node: int) -> str:
    """ "node 12" of the network, or the lamella of a node between."""
    if node < model.nodes:
        return f"node {node}"
    on = np.flatnonzero((model.lines.nodes == node).any(1))
    return f"lamella {model.lamellas.network.ids[model.lines.lamella[on[0]]]}" if len(on) else "the edge beam"

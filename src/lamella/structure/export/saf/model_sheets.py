"""Sheets of SAF: materials, sections, nodes, members, supports and what connects them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.export.straight_model import StraightModel, StraightSection

Row = tuple[object, ...]
NOTHING = None
"""An empty cell."""

MM, MEGA = 1e3, 1e6


def node(number: int) -> str:
    """Name of a node; the numbers of the network's are those of network.json."""
    return f"N{number}"


def support(number: int) -> str:
    """Name of a node's support."""
    return f"S{number}"


def cable(number: int) -> str:
    """Name of a cable."""
    return f"cable.{number + 1}"


def all_sections(model: StraightModel) -> tuple[tuple[StraightSection, ...], list[int]]:
    """Sections of members, then different ones of cables, and which of them each cable has."""
    found = list(model.sections)
    which = []
    for one in model.cable_section:
        if one not in found[len(model.sections) :]:
            found.append(one)
        which.append(len(model.sections) + found[len(model.sections) :].index(one))
    return tuple(found), which


def material_rows(model: StraightModel) -> Iterator[Row]:
    """One for every section."""
    for k, one in enumerate(all_sections(model)[0]):
        made, times = one.material, one.times
        kind = "Timber" if made.shear_strength is not None else "Aluminium" if made.youngs_modulus < 1e11 else "Steel"
        quality = f"{times} layers in one" if times > 1 else "as the project says"
        young, shear = times * made.youngs_modulus, times * made.shear_modulus
        poisson = min(max(young / (2 * shear) - 1, 0.0), 0.49)
        numbers = (times * made.density, young / MEGA, shear / MEGA, poisson, made.expansion)
        yield (f"M{k + 1}", kind, NOTHING, quality, *numbers, NOTHING)


def section_rows(model: StraightModel) -> Iterator[Row]:
    """Parametric ones."""
    names = {"rectangle": "Rectangle", "pipe": "Pipe", "circle": "Circle"}
    for k, one in enumerate(all_sections(model)[0]):
        size = "; ".join(f"{MM * value:.9g}" for value in one.size)
        # of one number a number
        shape: object = size if len(one.size) > 1 else float(size)
        yield (f"CS{k + 1}", f"M{k + 1}", "Parametric", names[one.shape], shape, *(NOTHING,) * 7)


def node_rows(model: StraightModel) -> Iterator[Row]:
    """All nodes."""
    for k, place in enumerate(_rounded(model.points).tolist()):
        yield (node(k), *place)


def member_rows(model: StraightModel) -> Iterator[Row]:
    """Elements, then cables, which take tension alone."""
    ends, upright = model.members.tolist(), _rounded(model.upright).tolist()
    lengths = _rounded(model.lengths).tolist()
    for k, name in enumerate(model.names):
        layer = name.rpartition(".")[0]
        yield _member(name, model.section[k], ends[k], lengths[k], upright[k], layer, "Standard")
    _, which = all_sections(model)
    span = model.points[model.cables[:, 1]] - model.points[model.cables[:, 0]]
    across = np.eye(3)[np.abs(np.round(span, 9)).argmin(1)]
    long = _rounded(np.linalg.norm(span, axis=1)).tolist()
    for k, pair in enumerate(model.cables.tolist()):
        yield _member(cable(k), which[k], pair, long[k], across[k].tolist(), "cables", "Tension only")


def _member(
    name: str, section: int, ends: list[int], length: float, upright: list[float], layer: str, behaviour: str
) -> Row:
    nodes = f"{node(ends[0])}; {node(ends[1])}"
    first = (name, "General", f"CS{section + 1}", nodes, "Line", length, "Line", "z by vector", 0.0)
    return (*first, *upright, "Centre", 0.0, 0.0, 0.0, 0.0, layer, behaviour)


def support_rows(model: StraightModel) -> Iterator[Row]:
    """Nodes that are held or on springs, along global axes."""
    for k in np.flatnonzero((model.held | (model.springs > 0)).any(1)).tolist():
        held, springs = model.held[k].tolist(), model.springs[k].tolist()
        ways = ["Rigid" if h else "Flexible" if s else "Free" for h, s in zip(held, springs, strict=True)]
        stiffness = [s / MEGA if way == "Flexible" else NOTHING for way, s in zip(ways, springs, strict=True)]
        yield (support(k), "Custom", "In node", node(k), *ways, *stiffness)


def hinge_rows(model: StraightModel) -> Iterator[Row]:
    """Springs about the strong axis where slots are."""
    for k, end in np.argwhere(model.hinges > 0).tolist():
        ways = ("Rigid", "Rigid", "Rigid", "Rigid", "Flexible", "Rigid")
        stiffness = (*(NOTHING,) * 4, float(model.hinges[k, end]) / MEGA, NOTHING)
        position = ("Begin", "End")[end]
        yield (f"H.{model.names[k]}.{position}", model.names[k], position, *ways, *stiffness)


def cross_rows(model: StraightModel) -> Iterator[Row]:
    """Joints that turn about their normal."""
    for k, ((one, other), stiffness) in enumerate(
        zip(model.turning.tolist(), model.turning_stiffness.tolist(), strict=True)
    ):
        turns = ("Flexible", stiffness / MEGA) if stiffness else ("Free", NOTHING)
        both = f"{model.names[one]}; {model.names[other]}"
        yield (f"RC{k + 1}", both, "Custom", *("Rigid",) * 5, *turns)


def link_rows(model: StraightModel) -> Iterator[Row]:
    """Rigid links to what lies beside a node."""
    for k, (one, other) in enumerate(model.links.tolist()):
        yield (f"RL{k + 1}", f"{node(one)}; {node(other)}", "None", *("Rigid",) * 6)


def _rounded(values: Floats) -> Floats:
    """Without digits that differ between processors."""
    return np.asarray(np.round(values, 9) + 0.0)

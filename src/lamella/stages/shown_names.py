"""Names of sliders and quantities, refused before anything is computed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from lamella.base.errors import InputError
from lamella.project.tables import Project
from lamella.stages import all_stages
from lamella.stages.stage import Stage

FAMILY = "family"
"""Colour of strips by their family."""


def check_slider(project: Project, name: str, wanted: Sequence[Stage[Any]]) -> None:
    """Refuse a slider that no stage has, or a stage that is not computed.

    Raises
    ------
    InputError
    """
    if not name:
        return
    kind = name.partition(" ")[0]
    stage = next((one for one in all_stages.STAGES if kind in one.sliders), None)
    if stage is None:
        known = ", ".join(slider for one in all_stages.STAGES for slider in one.sliders)
        raise InputError(f"there are no frames {name!r}", f"choose one of {known}", "--frames")
    if stage in wanted:
        return
    missing = stage.missing(project)
    remedy = missing.remedy if missing else f"compute it too: --until {stage.name}, or leave --until out"
    raise InputError(f"frames {name!r} come from the stage {stage.name}, which is not computed", remedy, "--frames")


def check_colour(colour: str, wanted: Sequence[Stage[Any]]) -> None:
    """Refuse a quantity that no computed stage has.

    Raises
    ------
    InputError
    """
    known = [key for stage in wanted for key in stage.quantities]
    if colour and colour not in (FAMILY, *known):
        remedy = f"choose one of {', '.join([FAMILY, *known])}"
        raise InputError(f"there is no quantity {colour!r}", remedy, "--colour")

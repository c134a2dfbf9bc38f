"""Which stages a computation has."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from typing import Any

from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.project.tables import Project
from lamella.stages import all_stages
from lamella.stages.stage import Missing, Stage


def wanted_stages(project: Project, until: str | None) -> tuple[tuple[Stage[Any], ...], tuple[Message, ...]]:
    """The stages up to one, with all they need; without one all that the project has.

    Parameters
    ----------
    project : Project
    until : str or None
        Name of the last stage.

    Returns
    -------
    tuple of Stage
        Each after those it needs.
    tuple of Message
        Why the run ends early, if it does.

    Raises
    ------
    InputError
        No such stage, or the project has none.
    """
    stages = all_stages.STAGES
    if until is None:
        return _possible(project, stages)
    check_name(until)
    names = _with_needs(until, stages)
    chosen = tuple(stage for stage in stages if stage.name in names)
    for stage in chosen:
        missing = stage.missing(project)
        if missing:
            text = f"stage {until!r} needs {missing.needs}: {missing.reason}"
            raise InputError(text, missing.remedy, missing.where)
    return chosen, ()


def check_name(until: str | None) -> None:
    """Refuse the name of a stage that does not exist.

    Raises
    ------
    InputError
    """
    names = [stage.name for stage in all_stages.STAGES]
    if until is None or until in names:
        return
    choice = f"choose one of {', '.join(names)}"
    near = get_close_matches(until, names, 1, 0.5)
    meant = f", did you mean {near[0]!r}?" if near else ""
    raise InputError(f"unknown stage {until[:40]!r}{meant}", choice, "--until")


def _possible(project: Project, stages: Sequence[Stage[Any]]) -> tuple[tuple[Stage[Any], ...], tuple[Message, ...]]:
    """All stages that a project has, with what is said of the first ones that it has not."""
    chosen: list[Stage[Any]] = []
    missing: list[Missing] = []
    for stage in stages:
        why = stage.missing(project)
        if why:
            if not why.unasked:
                missing.append(why)
        elif set(stage.needs) <= {one.name for one in chosen}:
            chosen.append(stage)
    last = chosen[-1].name
    messages = (Message(f"ends_with_{last}", f"the run ends with the {last}: {why.reason}") for why in missing)
    return tuple(chosen), tuple(messages)


def _with_needs(name: str, stages: Sequence[Stage[Any]]) -> set[str]:
    """A stage's name with those of all it needs, directly or not."""
    needs = {stage.name: stage.needs for stage in stages}
    found, new = set[str](), {name}
    while new:
        found |= new
        new = {need for one in new for need in needs[one]} - found
    return found

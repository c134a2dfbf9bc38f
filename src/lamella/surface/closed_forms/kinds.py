"""All closed-form surfaces by the name a project file gives them: those of the modules beside this one."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING

from lamella.base.arrays import Complexes
from lamella.surface import closed_forms
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface


def _closed_forms() -> Iterator[type[ClosedForm]]:
    """The classes with a kind of their own."""
    for module in iter_modules(closed_forms.__path__):
        if module.name == "kinds":
            continue
        for one in vars(import_module(f"{closed_forms.__name__}.{module.name}")).values():
            if isinstance(one, type) and issubclass(one, ClosedForm) and "kind" in vars(one):
                yield one


CLOSED_FORMS: dict[str, type[ClosedForm]] = {surface.kind: surface for surface in _closed_forms()}

if TYPE_CHECKING:

    def _answers(closed_form: ClosedForm) -> Surface[Complexes]:
        return closed_form

"""All closed-form surfaces by the name a project file gives them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lamella.base.arrays import Complexes
from lamella.surface.closed_forms.catenoid import Catenoid
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.cylinder import Cylinder
from lamella.surface.closed_forms.delaunay import Nodoid, Unduloid
from lamella.surface.closed_forms.enneper import Enneper
from lamella.surface.closed_forms.helicoid import Helicoid
from lamella.surface.closed_forms.scherk import Scherk
from lamella.surface.surface import Surface

CLOSED_FORMS: dict[str, type[ClosedForm]] = {
    surface.kind: surface for surface in (Unduloid, Nodoid, Catenoid, Cylinder, Helicoid, Enneper, Scherk)
}

if TYPE_CHECKING:

    def _answers(closed_form: ClosedForm) -> Surface[Complexes]:
        return closed_form

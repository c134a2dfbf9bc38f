"""All closed-form surfaces by the name a project file gives them."""

from __future__ import annotations

from lamella.surface.catenoid import Catenoid
from lamella.surface.closed_form import ClosedForm
from lamella.surface.cylinder import Cylinder
from lamella.surface.delaunay import Nodoid, Unduloid
from lamella.surface.enneper import Enneper
from lamella.surface.helicoid import Helicoid
from lamella.surface.scherk import Scherk

CLOSED_FORMS: dict[str, type[ClosedForm]] = {
    surface.kind: surface for surface in (Unduloid, Nodoid, Catenoid, Cylinder, Helicoid, Enneper, Scherk)
}

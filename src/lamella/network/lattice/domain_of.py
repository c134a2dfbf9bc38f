"""Which domain of the cell plane a closed-form surface has."""

from __future__ import annotations

from lamella.network.lattice.domain import Band, DiscDomain, Domain, RectangleDomain, ScherkDomain, StarDomain
from lamella.network.lattice.principal_domain import PrincipalRectangle, PrincipalScherk
from lamella.network.lattice.skew_band import SkewBand
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Disc, Rectangle, Ring, Square
from lamella.surface.closed_forms.revolution import SurfaceOfRevolution
from lamella.surface.closed_forms.scherk import Scherk


def domain_of(surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> Domain:
    """The domain of a closed-form surface for the curves of a pattern, l0 = `step` (sqrt(m))."""
    turned = pattern.kind == "principal"
    if pattern.normal_curvature not in (None, surface.mean_curvature):
        assert isinstance(surface, SurfaceOfRevolution)
        return SkewBand(surface, step, pattern)
    if isinstance(surface.outline, Ring):
        return Band(surface, step, pattern)
    if isinstance(surface.outline, Rectangle):
        return (PrincipalRectangle if turned else RectangleDomain)(surface, step, pattern)
    if isinstance(surface, Scherk):
        return (PrincipalScherk if turned else ScherkDomain)(surface, step, pattern)
    assert isinstance(surface.outline, Disc | Square)
    return (StarDomain if surface.hopf_order else DiscDomain)(surface, step, pattern)

"""A closed form over a simply connected piece of its parameter plane as lines are traced on it."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.charts.charts import ChartSample, RimPlaces
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Disc, Rectangle
from lamella.surface.closed_forms.scherk import Scherk, asymptotic_to_conformal
from lamella.surface.element.places import Places

# parts of the longest way across a closed form's parameters in a step, and samples along either parameter
STEP_PARTS, CHART_SAMPLES = 80, 60
# difference of parameters along the rim, of the size
DELTA = 1e-6


class PlaneCharts:
    """A closed form over a simply connected piece of its parameter plane.

    Parameters
    ----------
    surface : ClosedForm
        Helicoid, Enneper's or Scherk's surface.
    """

    def __init__(self, surface: ClosedForm) -> None:
        self.surface = surface
        places, _ = surface.places(CHART_SAMPLES, CHART_SAMPLES)
        self._middle = complex(places.real.min() + places.real.max(), places.imag.min() + places.imag.max()) / 2
        self._sides = float(np.ptp(places.real)), float(np.ptp(places.imag))
        self._size = max(self._sides)

    def evaluate(self, where: Places) -> ChartSample:
        zeta = _complex(where)
        at = self.surface.at(zeta)
        to_local = np.eye(2) / self.surface.metric(zeta)[:, None, None]
        return ChartSample(at.position, at.normal, at.e_u, at.e_v, at.mean_curvature, at.deviator, to_local)

    def measured(self, where: Places) -> tuple[Floats, Complexes]:
        sample = self.evaluate(where)
        return sample.mean, sample.deviator

    def uncertain(self, where: Places) -> Floats:
        return np.zeros(len(where))

    def reach(self, where: Places) -> Floats:
        return np.full(len(where), self._size / STEP_PARTS)

    def settle(self, where: Places) -> Places:
        return where

    def gap(self, where: Places) -> Floats:
        return self._gap(_complex(where))

    def _gap(self, zeta: Complexes) -> Floats:
        outline = self.surface.outline
        if isinstance(outline, Rectangle):
            off = zeta - outline.corner
            return np.asarray(
                np.minimum.reduce([off.real, outline.width - off.real, off.imag, outline.height - off.imag])
            )
        if isinstance(outline, Disc):
            return np.asarray(outline.radius - np.abs(zeta))
        assert isinstance(self.surface, Scherk)
        limit = 2 * self.surface.outline.half_side
        most = float(asymptotic_to_conformal(np.array([limit]))[0])
        q, p = (np.arcsinh(self.surface.hyperbolic(np.clip(x, -most, most))[1]) for x in (zeta.real, zeta.imag))
        beyond = np.maximum(np.abs(zeta.real) - most, 0) + np.maximum(np.abs(zeta.imag) - most, 0)
        return np.asarray(limit - np.abs(p) - np.abs(q) - beyond)

    def samples(self) -> tuple[Places, Floats]:
        # cells of a grid over the parameters, by their middles
        share = (np.arange(2 * CHART_SAMPLES) + 0.5) / (2 * CHART_SAMPLES) - 0.5
        x, y = (a.ravel() for a in np.meshgrid(*(side * share for side in self._sides), indexing="ij"))
        zeta = self._middle + x + 1j * y
        zeta = zeta[self._gap(zeta) > 0]
        return _places(zeta), self.surface.metric(zeta) ** 2 * self._sides[0] * self._sides[1] / (
            2 * CHART_SAMPLES
        ) ** 2

    def rim_places(self, where: Places) -> RimPlaces:
        # the outlines are convex about their middles, or as good as that (Scherk's)
        zeta = _complex(where)
        angle = np.angle(zeta - self._middle)
        ahead, behind = (self._on_rim(angle + sign * DELTA) for sign in (1, -1))
        tangent = self.surface.at(zeta).vector((ahead - behind) / np.abs(ahead - behind))
        return RimPlaces(np.zeros(len(zeta), np.int64), np.mod(angle + 1e-9, 2 * np.pi), tangent)

    def _on_rim(self, angle: Floats) -> Complexes:
        """Places of the rim at angles about the middle."""
        inside, outside = np.zeros(len(angle)), np.full(len(angle), self._size)
        for _ in range(60):
            middle = (inside + outside) / 2
            within = self._gap(self._middle + middle * np.exp(1j * angle)) > 0
            inside, outside = np.where(within, middle, inside), np.where(within, outside, middle)
        return np.asarray(self._middle + inside * np.exp(1j * angle))

    def rim_points(self, count: int) -> Places:
        return _places(self._on_rim(2 * np.pi * np.arange(count) / count))

    def hole(self, count: int) -> tuple[Places, float] | None:
        return None


def _complex(where: Places) -> Complexes:
    return np.asarray(where.local[:, 0] + 1j * where.local[:, 1])


def _places(zeta: Complexes) -> Places:
    return Places(np.zeros(len(zeta), np.int64), np.column_stack([zeta.real, zeta.imag]))

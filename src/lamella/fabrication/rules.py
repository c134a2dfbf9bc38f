"""The measures that every part of a structure shares, and which of them no part can be made with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.cutting.lanes import LENGTH_ROUNDING
from lamella.fabrication.flat import longest_fitting

__all__ = ["LARGEST_TURN", "LENGTH_ROUNDING", "Rules", "clear_hub", "edge_scale"]

# a flat ring closer to a full turn than this would leave its ends no room
LARGEST_TURN = 1.9 * np.pi


def clear_hub(rays: int, layers: int, offset: float, thickness: float) -> float:
    """Distance from a singular node at which the outer layers of neighbouring rays are clear of each other, m.

    Rays are 2 pi / `rays` apart; strips of half width w about them, a thickness of play included, part at
    w / tan(pi / rays).
    """
    half_width = 0.5 * (layers - 1) * offset + thickness
    return float(half_width / np.tan(np.pi / rays)) if rays > 2 else 0.0


def edge_scale(curvature: float, height: float) -> float:
    """Length along the shorter edge of a strip for each length along the centre line (at least 0.1)."""
    return max(1.0 - 0.5 * abs(curvature) * height, 0.1)


@dataclass(frozen=True)
class Rules:
    """Measures of every part, m, kg.

    Attributes
    ----------
    layers : int
        Parallel strips of a lamella.
    offset : float
        Distance of neighbouring layers, m.
    height, thickness : float
        Of a strip, m.
    curvature : float
        Of the developed centre line, 1/m.
    density : float
        kg/m3.
    end_distance : float
        Least distance from the last slot's axis to the strip's end, m.
    rim_overhang : float
        Least distance from the rim's node to the strip's end, m.
    hub_radius : float
        From a singular node to the strip's end, m.
    slot_width : float
        m.
    sheet : (float, float)
        Length and width, m.
    gap : float
        Between parts and to the sheet's edge, m.
    slot_play : float
        Of a slot's foot beyond the centre line, m.
    foot_radius : float
        Of the corners of a slot's foot, m.
    bow : float
        How far outlines of layers that are cut to their own curvature leave the others' at most, m.
    transport_length : float
        Longest part allowed, m.
    """

    layers: int
    offset: float
    height: float
    thickness: float
    curvature: float
    density: float
    end_distance: float
    rim_overhang: float
    hub_radius: float
    slot_width: float
    sheet: tuple[float, float]
    gap: float
    slot_play: float = 0.0
    foot_radius: float = 0.0
    bow: float = 0.0
    transport_length: float = np.inf

    @property
    def edge_scale(self) -> float:
        """Length along the shorter edge for each length along the centre line."""
        return edge_scale(self.curvature, self.height)

    @property
    def least_end_distance(self) -> float:
        """From the last slot to the end, m: one slot width is left between them."""
        return 1.5 * self.slot_width / self.edge_scale

    @property
    def longest_ring(self) -> float:
        """Length that turns through `LARGEST_TURN`, m."""
        return LARGEST_TURN / abs(self.curvature) if self.curvature else np.inf

    @property
    def longest_on_sheet(self) -> float:
        """Length of the longest strip that fits the sheet, m."""
        length, width = max(self.sheet) - 2 * self.gap, min(self.sheet) - 2 * self.gap
        return longest_fitting(length, width, self.height + 2 * self.bow, self.curvature, LARGEST_TURN)

    def check(self) -> None:
        """Raise an `InputError` for measures that no part can be made with."""
        least = (
            ("density", self.density, 0.0),
            ("gap", self.gap, 0.0),
            ("sheet", min(self.sheet), 2 * self.gap),
        )
        for name, value, bound in least:
            if not (np.isfinite(value) and value > bound):
                raise InputError(
                    f"{name} is {value:g}, it has to be more than {bound:g}",
                    f"write a {name} above {bound:g}",
                    name,
                )
        for name, value in (("hub_radius", self.hub_radius), ("rim_overhang", self.rim_overhang)):
            if not (np.isfinite(value) and value >= 0):
                raise InputError(f"{name} is {value:g} m, it cannot be less than 0", "give 0 or more", name)
        # twice the thickness, where the strip is high enough
        usual = min(2 * self.thickness, (self.thickness + self.height) / 2)
        if not (np.isfinite(self.slot_width) and self.slot_width >= self.thickness):
            raise InputError(
                f"slot_width is {self.slot_width:g} m, less than the thickness {self.thickness:g} m "
                "of the strip that goes in",
                f"write slot_width = {usual:g}",
                "slot_width",
            )
        if self.slot_width >= self.height:
            raise InputError(
                f"slot_width is {self.slot_width:g} m, not less than the strip's height {self.height:g} m",
                f"write slot_width = {usual:g}",
                "slot_width",
            )
        # a tighter circle's inner edge would be narrower than the slots and their distances
        if self.edge_scale <= 0.5 or abs(self.curvature) * self.slot_width >= self.edge_scale:
            bend = abs(self.curvature)
            # both limits, with slots of twice the thickness
            highest = 2 * (1 - max(0.5, 2 * bend * self.thickness)) / bend
            raise InputError(
                f"the lamellas' circle has a radius of {1 / abs(self.curvature):g} m, too little for a strip "
                f"{self.height:g} m high with slots {self.slot_width:g} m wide",
                f"write height = {rounded(0.99 * highest, up=False):g} or less, and leave slot_width out"
                if highest > 2 * self.thickness
                else f"write thickness = {rounded(0.1 / bend, up=False):g} or less",
                "height",
            )
        self._check_feet()
        nearest = self.least_end_distance
        if not (np.isfinite(self.end_distance) and self.end_distance >= nearest - LENGTH_ROUNDING):
            raise InputError(
                f"end_distance is {self.end_distance:g} m, which leaves less than one slot width "
                f"({self.slot_width:g} m) beyond the last slot",
                f"raise end_distance to {rounded(nearest, up=True):g} m or more",
                "end_distance",
            )

    def _check_feet(self) -> None:
        for name, value in (("slot_play", self.slot_play), ("foot_radius", self.foot_radius)):
            if not (np.isfinite(value) and value >= 0):
                raise InputError(f"{name} is {value:g} m, it cannot be less than 0", "give 0 or more", name)
        if self.slot_play > self.height / 4:
            raise InputError(
                f"slot_play is {self.slot_play:g} m, more than a quarter of the strip's height {self.height:g} m",
                f"write slot_play = {self.height / 4:g} or less",
                "slot_play",
            )
        # a strip in the middle of the slot reaches its foot between the corners
        largest = (self.slot_width - self.thickness) / 2
        if self.foot_radius > largest + LENGTH_ROUNDING:
            raise InputError(
                f"foot_radius is {self.foot_radius:g} m: corners of slots {self.slot_width:g} m wide rounded by more "
                f"than {largest:g} m would hold up the strip {self.thickness:g} m thick that goes in",
                f"write foot_radius = {rounded(largest, up=False):g} or less, or a larger slot_width",
                "foot_radius",
            )

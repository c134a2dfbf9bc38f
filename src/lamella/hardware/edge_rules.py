"""Measures of edge beams: cross sections, end plates, base plates, and which of them nothing can be made with."""

from __future__ import annotations

import re
from dataclasses import dataclass

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.hardware.rules import MM, JointRules
from lamella.hardware.shape import circle, rectangle
from lamella.strip.lamellas import Section

TUBE = re.compile(r"tube\s+(\d+(?:\.\d+)?)\s*x\s*(\d+(?:\.\d+)?)")
"""A round tube: diameter x wall, mm."""

END_EDGE = 1.5
"""Hole diameters from a hole's axis to the edge of an end plate, a packer or a layer; EN 1993-1-8 table 3.3 asks for
1.2."""

END_PITCH = 2.5
"""Hole diameters between the two screws of an end; EN 1993-1-8 table 3.3 asks for 2.2."""

FOLD_BEND = 1.0
"""Thicknesses of an end plate that its fold has for an inner radius."""


@dataclass(frozen=True, eq=False)
class BeamSection:
    """Cross section of an edge beam.

    Attributes
    ----------
    name : str
        "tube 60.3 x 3.2 mm".
    height : float
        Along the surface normal, m.
    reach : float
        From the axis to the face that end plates lie on, m.
    outline : (v, 3)
        x towards the surface, y along its normal, see `lamella.hardware.shape.Sweep`.
    holes : tuple of (w, 3)
    round : bool
        Whether it is a tube.
    """

    name: str
    height: float
    reach: float
    outline: Floats
    holes: tuple[Floats, ...]
    round: bool


@dataclass(frozen=True)
class EdgeBeamRules:
    """Measures of the edge beam of a boundary loop, m.

    Attributes
    ----------
    section : str or None
        "tube 60.3x3.2", mm.
    flat : (float, float) or None
        Width along the surface normal and thickness of a flat bar, instead.
    distance : float or None
        From the rim to the beam's axis, outwards; None: none, or where lamellas cross on the rim as much as their end
        plates need.
    segment : float
        Longest piece.
    end_gap : float
        Between a lamella's end and the end plate on the beam.
    end_plate : float
        Thickness of the end plates.
    end_plate_height : float or None
        Along the surface normal; None: that of shear blocks.
    end_plate_leg : float
        Of the leg on the beam, from the fold's corner.
    ground : float or None
        z of the ground; base plates are where the rim is as low. None: there are none.
    base_plate : float
        Side of a base plate.
    base_plate_thickness : float
    base_spacing : float
        Largest distance of base plates along the ground.
    anchor : float
        Thread of the four anchors of a base plate.
    material : str
    density : float
        Its own, kg/m3.
    """

    section: str | None = "tube 60.3x3.2"
    flat: tuple[float, float] | None = None
    distance: float | None = None
    segment: float = 6.0
    end_gap: float = 0.003
    end_plate: float = 0.005
    end_plate_height: float | None = None
    end_plate_leg: float = 0.04
    ground: float | None = None
    base_plate: float = 0.2
    base_plate_thickness: float = 0.012
    base_spacing: float = 1.0
    anchor: float = 0.012
    material: str = "1.4301"
    density: float = 7900.0

    @property
    def beam(self) -> BeamSection:
        """The cross section.

        Raises
        ------
        InputError
            It is none.
        """
        return _flat_bar(*self.flat) if self.flat is not None else _tube(self.section or "")

    def plate_height(self, section: Section, joints: JointRules) -> float:
        """Of an end plate along the surface normal, m."""
        return joints.block_height(section) if self.end_plate_height is None else self.end_plate_height

    def check(self, section: Section, joints: JointRules) -> None:
        """Raise an `InputError` for what cannot be made with strips of a section.

        Raises
        ------
        InputError
        """
        beam, height = self.beam, self.plate_height(section, joints)
        if section.level and beam.round:
            raise InputError(
                f"stacked lamellas end {MM * section.level:.4g} mm above and below the middle of the edge beam, where "
                f"a {beam.name} has no face",
                f"write flat = [{2 * section.level + height:.3g}, 0.01] instead of section",
                "section",
            )
        if 2 * section.level + height > beam.height + 1e-9:
            where = f", {MM * section.level:.4g} mm above and below its middle," if section.level else ""
            raise InputError(
                f"end plates {MM * height:.4g} mm high{where} do not lie on an edge beam ({beam.name}) that is "
                f"{MM * beam.height:.4g} mm high",
                f"choose a beam {2 * section.level + height:.3g} m high or more"
                + (f", or end_plate_height = {beam.height:g} or less" if not section.level else ""),
                "end_plate_height",
            )
        least = 2 * END_EDGE * joints.block_size.hole
        if height < least or height > section.height:
            raise InputError(
                f"end plates {MM * height:.4g} mm high: a hole of {MM * joints.block_size.hole:g} mm needs "
                f"{MM * least:.4g} mm, and the strips are {MM * section.height:.4g} mm high",
                f"write end_plate_height = {least:g} to {section.height:g}, or choose a smaller block_bolt",
                "end_plate_height",
            )
        clear = section.offset - section.thickness - 2 * joints.play
        if self.end_plate >= clear:
            raise InputError(
                f"an end plate {MM * self.end_plate:g} mm thick does not fit between layers that leave "
                f"{MM * clear:.4g} mm",
                f"write end_plate = {clear / 2:.3g} or less, or a larger offset",
                "end_plate",
            )
        fold = (FOLD_BEND + 1.0) * self.end_plate
        if self.end_plate_leg <= fold:
            raise InputError(
                f"end_plate_leg = {self.end_plate_leg:g} m leaves nothing beside the fold of a plate "
                f"{MM * self.end_plate:g} mm thick",
                f"write end_plate_leg = {2 * fold:.3g} or more",
                "end_plate_leg",
            )
        edge = 2 * 1.2 * 1.1 * self.anchor
        if self.ground is not None and self.base_plate <= 2 * edge:
            raise InputError(
                f"base_plate = {self.base_plate:g} m has no room for four anchors M{MM * self.anchor:g}",
                f"write base_plate = {4 * edge:.3g} or more",
                "base_plate",
            )


def _tube(text: str) -> BeamSection:
    match = TUBE.fullmatch(text.strip())
    if match is None:
        raise InputError(
            f'section = "{text}" is no tube', 'write section = "tube 60.3x3.2", diameter x wall in mm', "section"
        )
    diameter, wall = (float(number) / MM for number in match.groups())
    if not 0 < 2 * wall < diameter:
        raise InputError(
            f"a tube of {MM * diameter:g} mm with walls of {MM * wall:g} mm has no inside",
            f"write a wall below {MM * diameter / 2:g} mm",
            "section",
        )
    name = f"tube {MM * diameter:g} x {MM * wall:g} mm"
    return BeamSection(name, diameter, diameter / 2, circle(diameter), (circle(diameter - 2 * wall),), True)


def _flat_bar(width: float, thickness: float) -> BeamSection:
    if thickness >= width:
        raise InputError(
            f"flat = [{width:g}, {thickness:g}]: a flat bar stands along the surface normal, its width is the larger "
            "measure",
            f"write flat = [{thickness:g}, {width:g}]",
            "flat",
        )
    name = f"flat bar {MM * width:g} x {MM * thickness:g} mm"
    return BeamSection(name, width, thickness / 2, rectangle(thickness, width), (), False)

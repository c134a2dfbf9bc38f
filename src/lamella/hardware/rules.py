"""Measures of the hardware, and which of them nothing can be made with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.errors import InputError
from lamella.hardware.bolts import BoltSize, bolt_size
from lamella.strip.lamellas import Section

MM = 1e3

SEAT_PLAY = 1e-5
"""m; between a washer, a head or a nut and the highest place that was looked at below it."""

NUT_HOLE = 1.03
"""Hole of a nut as it is drawn, over the thread's diameter: polygons of circles do not run into each other."""

FIT = 1e-4
"""m; play of a tenon in its slot, on each side."""

LEAST_TENON = 0.008
"""m; shortest tenon that is welded."""

WEB = 0.003
"""m; least width of a plate between cut-outs."""

BLOCK_HEIGHT = 0.4
"""Of a strip's height that a shear block is high."""


FILLING = 0.57
"""Metal of a spiral strand over the circle around it, EN 12385-10 (1 x 19)."""

STRAND_MODULUS = 130e9
"""Pa; of stainless spiral strands, EN 1993-1-11 table 3.1."""


@dataclass(frozen=True)
class CableRules:
    """Measures of the cables.

    Attributes
    ----------
    every : int
        Every n-th line of diagonals has cables.
    diameter : float
        m.
    prestress : float
        Force in a cable, N.
    turnbuckle : float
        Length of the turnbuckle in each cable, m; 0: none.
    """

    every: int = 2
    diameter: float = 0.006
    prestress: float = 0.0
    turnbuckle: float = 0.2

    @property
    def stretch(self) -> float:
        """Elongation under the prestress."""
        return self.prestress / (STRAND_MODULUS * FILLING * np.pi / 4 * self.diameter**2)


@dataclass(frozen=True)
class JointRules:
    """Measures of joints and of what holds layers together, m.

    Attributes
    ----------
    washer : bool
        Whether nodes have star washers, keys and a bolt.
    washer_length : float or None
        Of a star washer from tip to tip; None: half a layer distance beyond the outer layers on each side.
    washer_thickness : float
        Of star washers and keys.
    bolt : float
        Thread of the bolt on a node's axis.
    play : float
        Least play between a key and the strips around it, on each side.
    block_spacing : float
        Largest distance of shear blocks along a lamella; 0: none.
    block_length : float
        Of a shear block along the lamella.
    block_bolt : float
        Thread of the bolts through blocks and hubs.
    hub : bool
        Whether singular nodes have hubs.
    hub_thickness : float
        Of a hub's plates.
    splice : bool
        Whether pieces of a lamella are joined by splice plates.
    splice_thickness : float or None
        Of a splice plate; None: twice a strip's.
    material : str
        Of plates, blocks and bolts.
    density : float
        Its own, kg/m3.
    block_material : str or None
        Of shear blocks, packers and spacers; None: the same.
    block_density : float
        Its own, kg/m3.
    """

    washer: bool = True
    washer_length: float | None = None
    washer_thickness: float = 0.004
    bolt: float = 0.008
    play: float = 0.0002
    block_spacing: float = 0.3
    block_length: float = 0.03
    block_bolt: float = 0.006
    hub: bool = True
    hub_thickness: float = 0.005
    splice: bool = True
    splice_thickness: float | None = None
    material: str = "1.4301"
    density: float = 7900.0
    block_material: str | None = None
    block_density: float = 7900.0

    @property
    def block(self) -> tuple[str, float]:
        """Material and density (kg/m3) of blocks, packers and spacers."""
        if self.block_material is None:
            return self.material, self.density
        return self.block_material, self.block_density

    @property
    def size(self) -> BoltSize:
        """The bolt on a node's axis."""
        return bolt_size(self.bolt, "bolt")

    @property
    def block_size(self) -> BoltSize:
        """The bolts through blocks and hubs."""
        return bolt_size(self.block_bolt, "block_bolt")

    def check(self, section: Section) -> None:
        """Raise an `InputError` for what cannot be made with strips of a section.

        Raises
        ------
        InputError
        """
        if section.layers % 2:
            layers = f"{section.layers} layer{'s' if section.layers > 1 else ''}"
            raise InputError(
                f"a joint has its bolt on the node's axis, where a middle one of {layers} would be",
                "write layers = 2 or 4, or leave joints out",
            )
        clear = section.offset - section.thickness
        if self.washer and self.size.hole + 2 * self.play >= clear:
            largest = MM * clear
            raise InputError(
                f"a bolt {self.size.name} with its hole of {MM * self.size.hole:g} mm does not fit between layers that "
                f"leave {largest:.4g} mm",
                f"choose a bolt below {clear:.3g} m or an offset above {self.size.hole + section.thickness:.3g} m",
                "bolt",
            )
        if not section.level and section.height <= 2 * self.washer_thickness:
            raise InputError(
                f"two keys {MM * self.washer_thickness:g} mm thick do not fit between the edges of a strip "
                f"{MM * section.height:g} mm high",
                f"write washer_thickness = {0.2 * section.height:.3g} or less",
                "washer_thickness",
            )
        if self.block_spacing and self.block_spacing <= self.block_length:
            raise InputError(
                f"block_spacing = {self.block_spacing:g} m is not more than block_length = {self.block_length:g} m",
                f"write block_spacing = {2 * self.block_length:g} or more, or 0 for no blocks",
                "block_spacing",
            )
        if self.block_spacing and self.block_size.hole * 2 >= min(self.block_length, section.height):
            raise InputError(
                f"a hole of {MM * self.block_size.hole:g} mm leaves too little of a block "
                f"{MM * self.block_length:g} mm long, in strips {MM * section.height:g} mm high",
                "choose a smaller block_bolt, or longer blocks",
                "block_bolt",
            )

    def star_length(self, section: Section, least_angle: float) -> float:
        """Of a star washer from tip to tip, m, for lamellas that cross at some angle (rad) or a larger one."""
        if self.washer_length is not None:
            return self.washer_length
        usual = (section.layers - 1) * section.offset + section.thickness + section.offset
        return max(usual, self.least_star_length(section, least_angle))

    def least_star_length(self, section: Section, least_angle: float) -> float:
        """Length with which a fifth of the arms of a star washer lies beside the strips' crossing, m."""
        return float(1.2 * self.star_width(section) / np.tan(least_angle / 2))

    def star_width(self, section: Section) -> float:
        """Of a star washer's arms: over the outer layers, and as much on each side as it is thick, m."""
        return (section.layers - 1) * section.offset + section.thickness + 2 * self.washer_thickness

    def plate_thickness(self, section: Section) -> float:
        """Of a splice plate, m."""
        return 2 * section.thickness if self.splice_thickness is None else self.splice_thickness

    def block_height(self, section: Section) -> float:
        """Of a shear block along the surface normal, m."""
        return BLOCK_HEIGHT * section.height

    def fin_begin(self, angle: float) -> float:
        """Where fins of a hub at an angle (rad) from each other begin, m: a millimetre farther out than they meet."""
        return float(self.hub_thickness / 2 / np.tan(min(angle, np.pi) / 2)) + 1e-3

    def least_hub_radius(self, angle: float) -> float:
        """Least distance from a singular node to the strips' ends with which a hub's star plates hold its fins, m.

        Parameters
        ----------
        angle : float
            Between neighbouring rays, rad.
        """
        return self.fin_begin(angle) + 2 * WEB + LEAST_TENON + 2 * FIT + self.hub_thickness / 2

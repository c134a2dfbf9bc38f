"""Standard fasteners: sizes of carriage bolts, screws and nuts, holes they pass through, lengths they are sold in.

Sources: carriage bolts with square neck DIN 603 (head, neck), hexagon screws ISO 4017, hexagon nuts with flange
EN 1661 (formerly DIN 6923), clearance holes ISO 273 "medium", lengths ISO 888.
"""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.errors import InputError

LENGTHS = (
    *(0.006, 0.008, 0.010, 0.012, 0.016, 0.020, 0.025, 0.030, 0.035, 0.040, 0.045, 0.050, 0.055, 0.060, 0.065, 0.070),
    *(0.080, 0.090, 0.100, 0.110, 0.120, 0.130, 0.140, 0.150, 0.160, 0.180, 0.200, 0.220, 0.240, 0.260, 0.280, 0.300),
    *(0.320, 0.340, 0.360, 0.380, 0.400, 0.420, 0.440, 0.460, 0.480, 0.500),
)
"""Nominal lengths of bolts, ISO 888, m."""

# m beyond a length that still counts as that length
LENGTH_GRAIN = 1e-6
# thread pitches of bolt that show beyond the nut
PITCHES_BEYOND = 2.0


@dataclass(frozen=True)
class BoltSize:
    """Measures of one thread, m.

    Attributes
    ----------
    diameter : float
        Of the thread.
    pitch : float
    hole : float
        Clearance hole, medium.
    neck : float
        Side of the carriage bolt's square neck.
    head, head_height : float
        Diameter and height of the carriage bolt's head.
    flats, hex_height : float
        Width across flats and height of the hexagon head.
    nut, nut_flange : float
        Height of the flange nut, diameter of its flange.
    """

    diameter: float
    pitch: float
    hole: float
    neck: float
    head: float
    head_height: float
    flats: float
    hex_height: float
    nut: float
    nut_flange: float

    @property
    def name(self) -> str:
        """ "M8"."""
        return f"M{1e3 * self.diameter:g}"

    def length(self, grip: float) -> float:
        """Shortest nominal length that holds a grip (m): nut and two pitches beyond it, m.

        Raises
        ------
        InputError
            No bolt is that long.
        """
        needed = grip + self.nut + PITCHES_BEYOND * self.pitch
        for length in LENGTHS:
            if length >= needed - LENGTH_GRAIN:
                return length
        raise InputError(
            f"a bolt through {1e3 * grip:.4g} mm has to be {1e3 * needed:.4g} mm long, the longest there is has "
            f"{1e3 * LENGTHS[-1]:g} mm",
            "make the strips less high",
            "bolt",
        )


SIZES: dict[float, BoltSize] = {
    size.diameter: size
    for size in (
        BoltSize(0.005, 0.0008, 0.0055, 0.00548, 0.01355, 0.0033, 0.008, 0.0035, 0.005, 0.0118),
        BoltSize(0.006, 0.0010, 0.0066, 0.00648, 0.01655, 0.00388, 0.010, 0.0040, 0.006, 0.0142),
        BoltSize(0.008, 0.00125, 0.0090, 0.00858, 0.02065, 0.00488, 0.013, 0.0053, 0.008, 0.0179),
        BoltSize(0.010, 0.0015, 0.0110, 0.01058, 0.02465, 0.00538, 0.016, 0.0064, 0.010, 0.0218),
        BoltSize(0.012, 0.00175, 0.0135, 0.0127, 0.03065, 0.00695, 0.018, 0.0075, 0.012, 0.0260),
        BoltSize(0.016, 0.0020, 0.0175, 0.0167, 0.03880, 0.00895, 0.024, 0.0100, 0.016, 0.0345),
    )
}
"""By thread diameter, m."""


def bolt_size(diameter: float, where: str = "bolt") -> BoltSize:
    """The size of a thread diameter, m.

    Raises
    ------
    InputError
        There is none.
    """
    for known, size in SIZES.items():
        if abs(known - diameter) <= LENGTH_GRAIN:
            return size
    raise InputError(
        f"{where} = {diameter:g} m: there is no such thread here",
        f"choose one of {', '.join(f'{known:g}' for known in SIZES)} m",
        where,
    )

"""Sheets of paper, their frame and title block, and the scales of drawings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SCALES = (1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0)
"""Denominators of usual scales (ISO 5455, and 1:25)."""
DECADE = (1.0, 2.0, 5.0)


@dataclass(frozen=True)
class Paper:
    """A sheet in landscape.

    Attributes
    ----------
    name : str
    width, height : float
        mm.
    """

    name: str
    width: float
    height: float

    # mm: from the edge to the frame, height of the title block, from the frame to drawings
    margin = 10.0
    title = 20.0
    inset = 6.0

    @property
    def room(self) -> tuple[float, float, float, float]:
        """Where drawings may be: left, bottom, right, top, mm."""
        edge = self.margin + self.inset
        return edge, self.margin + self.title + self.inset, self.width - edge, self.height - edge


PAPERS = {"A3": Paper("A3", 420.0, 297.0), "A1": Paper("A1", 841.0, 594.0)}


def standard_scale(size: tuple[float, float], room: tuple[float, float]) -> float:
    """Denominator of the largest usual scale in which a drawing fits.

    Parameters
    ----------
    size : (float, float)
        Of what is drawn, m.
    room : (float, float)
        On the paper, mm.

    Returns
    -------
    float
        One of `SCALES`; beyond these 1, 2, 5 times a power of ten, below 1 for enlargements.
    """
    least = max(1e3 * extent / space for extent, space in zip(size, room, strict=True))
    if least <= 0:
        return 1.0
    # rounding errors do not choose the next scale
    least *= 1 - 1e-9
    if SCALES[0] / 2 < least <= SCALES[-1]:
        return next(scale for scale in SCALES if scale >= least)
    decade = 10.0 ** np.floor(np.log10(least))
    return float(next(digit * decade for digit in (*DECADE, 10.0) if digit * decade >= least))


def scale_text(scale: float) -> str:
    """ "1:20", or "2:1" of an enlargement."""
    return f"1:{scale:g}" if scale >= 1 else f"{1 / scale:g}:1"

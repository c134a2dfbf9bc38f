"""A view: where points of the structure lie on a sheet, and lengths told there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.drawings.page import TEXT_EM, Dimension, Page, text_width
from lamella.drawings.terms import Terms

TICK = 1.2
"""mm: half of a tick at the end of a dimension line."""
WITNESS = 1.5
"""mm: how far a witness line goes beyond the dimension line."""
NUMBER_GAP = 0.8
"""mm: between a dimension line and its text."""


@dataclass(frozen=True, eq=False)
class View:
    """A parallel projection at a scale.

    Attributes
    ----------
    axes : (2, d)
        What points to the right and upwards on the paper; d = 2 for flat things.
    centre : (d,)
        Point that lies at `at`, m.
    at : (2,)
        mm on the paper.
    scale : float
        Denominator.
    """

    axes: Floats
    centre: Floats
    at: Floats
    scale: float

    @classmethod
    def flat(cls, centre: Floats, at: tuple[float, float], scale: float) -> View:
        """Of a drawing in a plane."""
        return cls(np.eye(2), np.asarray(centre, float), np.array(at), scale)

    @property
    def mm(self) -> float:
        """On the paper, for a metre."""
        return 1e3 / self.scale

    def place(self, points: Floats) -> Floats:
        """Points (..., d) on the paper, (..., 2), mm."""
        return np.asarray(self.at + self.mm * ((points - self.centre) @ self.axes.T))

    def dimension(self, page: Page, words: Terms, ends: Floats, away: float, *, text: str = "") -> None:
        """Tell the distance of two points, (2, d), with a line beside them.

        Parameters
        ----------
        page : Page
        words : Terms
        ends : (2, d)
            m.
        away : float
            From their line to the dimension line, mm, to the left of the way from the first to the second.
        text : str
            In front of the number.
        """
        first, second = self.place(np.asarray(ends, float))
        drawn = float(np.linalg.norm(second - first))
        if drawn == 0:
            return
        value = drawn / self.mm
        along = (second - first) / drawn
        left = np.array([-along[1], along[0]])
        begin, end = first + away * left, second + away * left
        reach = (away + np.copysign(WITNESS, away)) * left
        page.line([first, first + reach], "thin")
        page.line([second, second + reach], "thin")
        page.line([begin, end], "thin")
        tick = TICK * (along + left) / 2**0.5
        for point in (begin, end):
            page.line([point - tick, point + tick], "medium")
        _write(page, f"{text}{words.mm(value)}", begin, end, along)
        page.dimensions.append(Dimension(value, drawn, self.scale))


def _write(page: Page, text: str, begin: Floats, end: Floats, along: Floats) -> None:
    """The number over the dimension line's middle, or beyond its end where it is short."""
    angle = float(np.degrees(np.arctan2(along[1], along[0])))
    # readable from below and from the right
    turned = angle > 90.01 or angle <= -89.99
    if turned:
        angle, along, begin, end = angle - np.copysign(180.0, angle), -along, end, begin
    up = np.array([-along[1], along[0]])
    if text_width(text, TEXT_EM) + 2 > np.linalg.norm(end - begin):
        at, anchor = end + (TICK + NUMBER_GAP) * along + NUMBER_GAP * up, "start"
        page.line([end, end + (TICK + 2 * NUMBER_GAP + text_width(text, TEXT_EM)) * along], "thin")
    else:
        at, anchor = (begin + end) / 2 + NUMBER_GAP * up, "middle"
    width = text_width(text, TEXT_EM)
    begin = at - (width / 2 if anchor == "middle" else 0.0) * along
    # what a number stands on is covered
    page.shape([begin + np.outer([0, 1, 1, 0], width * along) + np.outer([0, 0, 1, 1], 0.75 * TEXT_EM * up)], 1.0)
    page.label(text, float(at[0]), float(at[1]), TEXT_EM, anchor=anchor, angle=round(angle, 6))

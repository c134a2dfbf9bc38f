"""Loops whose sliding parts are held: where form finding with sliding edges begins.

Where on its plane a sliding edge is drawn makes no difference to where its film has it in the end. So what is held is
not the edge as drawn, whose corners would leave rough elements behind, but a smooth one near it on the same plane: a
polynomial between its ends, or the first Fourier modes of a whole loop. On a wall an edge is held as it is drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats
from lamella.surface.form_finding.film import Loop, Slide
from lamella.surface.form_finding.free_boundary import within

# samples of a part; degree of the polynomials less 2; Fourier modes; samples of a loop for its length
SUPPORT_SAMPLES, SUPPORT_DEGREE, SUPPORT_MODES, LENGTH_SAMPLES = 200, 3, 3, 2000


@dataclass(frozen=True)
class FixedLoop:
    """A loop with nothing free to slide, see `fixed_loop`.

    Attributes
    ----------
    loop : Loop
        As drawn.
    length : float
        m.
    corners, smooth : (c,)
        See `lamella.surface.boundary.curve.Loop`; those inside a part that slides on a plane are gone.
    slides : tuple
        None.
    """

    loop: Loop
    length: float
    corners: Floats
    smooth: Booleans
    _parts: tuple[tuple[Slide, Complexes], ...]
    slides: Sequence[Slide] = ()

    @property
    def name(self) -> str:
        """Name in the project."""
        return self.loop.name

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""
        t = np.asarray(t, float) % 1
        points = self.loop.at(t)
        for slide, coefficients in self._parts:
            inside = within(t, slide.start, slide.end)
            share = ((t[inside] - slide.start) % 1) / (slide.end - slide.start)
            points[inside] = (_basis(share, slide) @ coefficients).real
        return points


def held(loops: tuple[Loop, ...], *, straight: bool = False) -> tuple[Loop, ...]:
    """The loops with nothing free to slide, see `fixed_loop`."""
    return tuple(fixed_loop(loop, straight=straight) if loop.slides else loop for loop in loops)


def fixed_loop(loop: Loop, *, straight: bool = False) -> FixedLoop:
    """A loop whose parts that slide on a plane are smooth curves there between the same ends.

    Near the parts as drawn, or `straight` where they do not go around.
    """
    parts = []
    kept = np.ones(len(loop.corners), bool)
    for slide in loop.slides:
        if slide.direction is not None:
            continue
        share = np.arange(SUPPORT_SAMPLES + 1) / SUPPORT_SAMPLES
        points = loop.at(slide.start + (slide.end - slide.start) * share)
        basis = _basis(share, slide)
        coefficients = np.zeros((basis.shape[1], 3), complex)
        if slide.end - slide.start < 1:
            # the ends first, the rest by least squares
            coefficients[:2] = points[[0, -1]]
        free = slice(2, None) if slide.end - slide.start < 1 else slice(None)
        rest = points - basis @ coefficients
        if not (straight and slide.end - slide.start < 1):
            coefficients[free] = np.linalg.lstsq(basis[:, free], rest.astype(complex), rcond=None)[0]
        parts.append((slide, coefficients))
        kept &= ~within(np.asarray(loop.corners), slide.start, slide.end)
    corners, smooth = np.asarray(loop.corners)[kept], np.asarray(loop.smooth)[kept]
    rough = FixedLoop(loop, loop.length, corners, smooth, tuple(parts))
    points = rough.at(np.arange(LENGTH_SAMPLES) / LENGTH_SAMPLES)
    length = float(np.linalg.norm(np.roll(points, -1, 0) - points, axis=1).sum())
    return FixedLoop(loop, length, corners, smooth, tuple(parts))


def _basis(share: Floats, slide: Slide) -> Complexes:
    """Functions (n, k) of the share of a part: its chord's ends and bubbles over it, or waves around a whole loop."""
    if slide.end - slide.start >= 1:
        return np.asarray(np.exp(2j * np.pi * share[:, None] * np.arange(-SUPPORT_MODES, SUPPORT_MODES + 1)))
    bubbles = (share * (1 - share))[:, None] * (2 * share[:, None] - 1) ** np.arange(SUPPORT_DEGREE)
    return np.column_stack([1 - share, share, bubbles]).astype(complex)

"""The piece of the lamella plane a closed-form surface covers, in cells.

In the lamella plane with coordinate chi = (1 + i) w = (u - v) + i (u + v) the A lamellas (u + v = const) are the
lines Im chi = const and the B lamellas (u - v = const) the lines Re chi = const. A domain divides by the step l0,
so that lamellas are lines through the whole numbers and nodes are the points of the integer lattice. In a principal net
chi is w itself (`lamella.network.pattern`), and all of this holds for principal lines.

A domain may have several *sheets*, each with a lattice of its own (the half planes around the rays of a
singular node); `Domain.canonical` names a lattice point alike on every sheet that sees it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.network.network import A, B, Period
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.closed_forms.outline import Disc, Rectangle, Ring
from lamella.surface.closed_forms.scherk import Scherk, asymptotic_to_conformal

# places along a loop start a little before 0, so that rounding does not send its first node to the end
LOOP_START = 1e-9
# cells; a lattice point this close to the rim counts as on it (docs/files.md)
RIM_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Lines:
    """Lamellas as straight pieces of the cell plane: base + t direction, start <= t <= end.

    Attributes
    ----------
    family : (m,) int
        `A` or `B`.
    sheet : (m,) int
    base, direction : (m,) complex
        Lattice point and unit step, so that nodes are at whole t.
    start, end : (m,)
        In cells.
    singular : (m,) bool
        Whether t = 0 is a singular node where the lamella starts.
    closed : (m,) bool
        Whether the end is the start again.
    """

    family: Integers
    sheet: Integers
    base: Complexes
    direction: Complexes
    start: Floats
    end: Floats
    singular: Booleans
    closed: Booleans

    @property
    def level(self) -> Integers:
        """The whole number of chi each line is at, (m,)."""
        return np.rint(self.base.real + self.base.imag).astype(np.int64)

    def every(self, pattern: Pattern) -> Lines:
        """Those a pattern keeps."""
        return self.take(self.level % np.array(pattern.every)[self.family] == 0)

    def take(self, keep: Booleans | Integers) -> Lines:
        """Some of the lines, by mask or by index."""
        return Lines(*(getattr(self, name)[keep] for name in self.__dataclass_fields__))


class Rim(NamedTuple):
    """Where points lie on the rim: distance from it (cells), loop number, place along the loop, direction.

    `place` grows along the loop and `tangent` (in parameters zeta) points that way, the surface to its left.
    """

    distance: Floats
    loop: Integers
    place: Floats
    tangent: Complexes


class Domain(ABC):
    """A region of the cell plane that every lamella line meets in one piece."""

    def __init__(self, surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> None:
        self.surface, self.step, self.pattern = surface, step, pattern

    @abstractmethod
    def lines(self) -> Lines:
        """All lamellas, A before B, each family in order."""

    @abstractmethod
    def rim(self, where: Complexes) -> Rim:
        """The nearest rim of places zeta."""

    @property
    def periods(self) -> tuple[Period, ...]:
        """Kept curves crossed on a loop around each hole."""
        return ()

    def canonical(self, sheet: Integers, point: Complexes) -> Integers:
        """Name of lattice points, (n, 3) int, the same from every sheet and turn."""
        return np.column_stack([sheet, np.rint(point.real), np.rint(point.imag)]).astype(np.int64)

    @abstractmethod
    def place(self, sheet: Integers, point: Complexes) -> Complexes:
        """Places zeta on the surface of points of the cell plane."""

    @abstractmethod
    def derivative(self, sheet: Integers, point: Complexes) -> Complexes:
        """d zeta / d cell at points of the cell plane (not at a singular node)."""

    def velocity(self, sheet: Integers, point: Complexes, direction: Complexes) -> Complexes:
        """Rate at which zeta changes along lines of given direction, a cell."""
        return self.derivative(sheet, point) * direction


class PlaneDomain(Domain):
    """A domain of one sheet on which zeta is an affine function of the cell plane.

    Attributes
    ----------
    origin : complex
        Lattice point 0 in the unshifted cell plane.
    """

    def __init__(self, surface: ClosedForm, step: float, origin: complex, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, pattern)
        self.origin = origin
        # chi is linear in zeta on these surfaces: zeta = slope * (cell + origin)
        self.slope = complex(surface.from_isothermic(np.array([step / pattern.factor]))[0])

    def place(self, sheet: Integers, point: Complexes) -> Complexes:
        return self.slope * (point + self.origin)

    def derivative(self, sheet: Integers, point: Complexes) -> Complexes:
        return np.full(len(point), self.slope)

    @abstractmethod
    def extent(self) -> tuple[Floats, Floats]:
        """Corners (or extreme points) of the domain in the cell plane: real parts, imaginary parts."""

    @abstractmethod
    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        """t where the lines base + t direction enter and leave."""

    def lines(self) -> Lines:
        real, imag = self.extent()
        pieces = []
        for family, across, base, direction in ((A, imag, 1j, 1 + 0j), (B, real, 1 + 0j, 1j)):
            low = int(np.ceil(across.min() - RIM_TOLERANCE))
            high = int(np.floor(across.max() + RIM_TOLERANCE))
            pieces.append(self._family(family, np.arange(low, high + 1), base, direction))
        return _join(pieces)

    def _family(self, family: int, constants: Integers, base: complex, direction: complex) -> Lines:
        bases = base * constants.astype(complex)
        start, end = self.chord(bases, direction)
        m = len(constants)
        never = np.zeros(m, bool)
        return Lines(np.full(m, family), np.zeros(m, np.int64), bases, np.full(m, direction), start, end, never, never)


def _join(pieces: list[Lines]) -> Lines:
    return Lines(*(np.concatenate([getattr(p, name) for p in pieces]) for name in Lines.__dataclass_fields__))


class Band(PlaneDomain):
    """A ring around an axis: a strip of the cell plane that repeats after a whole number of cells."""

    def __init__(self, surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, 0j, pattern)
        assert isinstance(surface.outline, Ring)
        self.outline = surface.outline
        self.turn = 2j * np.pi / self.slope
        self.period = complex(round(self.turn.real), round(self.turn.imag))

    @property
    def periods(self) -> tuple[Period, ...]:
        p, q = self.pattern.every
        # no -0 where principal lines run around the axis
        return (Period("axis", self.turn.imag / p + 0.0, self.turn.real / q + 0.0),)

    def extent(self) -> tuple[Floats, Floats]:
        # one turn's worth of lamellas of each family; every other one is a repetition
        around = (np.array([0.0, abs(p) - 1.0]) for p in (self.period.real, self.period.imag))
        ends = np.array([self.outline.start, self.outline.end]) / self.slope
        # principal lines that close around the axis do not repeat: there is one at each whole number along it
        real, imag = (turn if turn[1] > 0 else side for turn, side in zip(around, (ends.real, ends.imag), strict=True))
        return real, imag

    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        if self._closes(direction):
            return np.zeros(len(base)), np.full(len(base), abs(self.period))
        at_zero, rate = (self.slope * base).real, (self.slope * direction).real
        ends = np.stack([(self.outline.start - at_zero) / rate, (self.outline.end - at_zero) / rate])
        return ends.min(0), ends.max(0)

    def _closes(self, direction: complex) -> bool:
        """Whether lines of a direction run around the axis, back to where they began."""
        return (self.period * complex(direction).conjugate()).imag == 0

    def _family(self, family: int, constants: Integers, base: complex, direction: complex) -> Lines:
        lines = super()._family(family, constants, base, direction)
        return replace(lines, closed=np.full(len(constants), self._closes(direction)))

    def canonical(self, sheet: Integers, point: Complexes) -> Integers:
        if self.period.imag:
            turns = np.floor(np.rint(point.imag) / self.period.imag)
        else:
            turns = np.floor(np.rint(point.real) / self.period.real)
        return super().canonical(sheet, point - turns * self.period)

    def rim(self, where: Complexes) -> Rim:
        to_start, to_end = where.real - self.outline.start, self.outline.end - where.real
        at_end = to_end < to_start
        sense = np.where(at_end, 1.0, -1.0)
        return Rim(
            np.minimum(to_start, to_end) / abs(self.slope),
            at_end.astype(np.int64),
            np.mod(sense * where.imag + LOOP_START, 2 * np.pi),
            1j * sense,
        )


class RectangleDomain(PlaneDomain):
    """A rectangle with lamella directions as sides: whole cells across its narrow side, node or cell in its middle."""

    def __init__(self, surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, 0j, pattern)
        outline = surface.outline
        assert isinstance(outline, Rectangle)
        self.outline = outline
        sides = np.array([0, outline.width, outline.width + 1j * outline.height, 1j * outline.height])
        corners = (sides + outline.corner) / self.slope
        low = complex(corners.real.min(), corners.imag.min())
        high = complex(corners.real.max(), corners.imag.max())

        # the same in both directions, or the nodes were not those of a net with twice the cells
        self.origin = (low + high) / 2 + centred(surface.whole_length / step)
        self.low, self.high = low - self.origin, high - self.origin

    def extent(self) -> tuple[Floats, Floats]:
        return np.array([self.low.real, self.high.real]), np.array([self.low.imag, self.high.imag])

    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        real, imag = self.extent()
        low, high = real if direction == 1 else imag
        return np.full(len(base), low), np.full(len(base), high)

    def rim(self, where: Complexes) -> Rim:
        local = where - self.outline.corner
        w, h = self.outline.width, self.outline.height
        distance = np.stack([local.imag, w - local.real, h - local.imag, local.real])
        side = np.argmin(distance, axis=0)
        along = np.stack([local.real, w + local.imag, 2 * w + h - local.real, 2 * (w + h) - local.imag])
        pick = side, np.arange(len(where))
        return Rim(
            distance[pick] / abs(self.slope),
            np.zeros(len(where), np.int64),
            # a corner belongs to the side that starts there
            np.mod(along[pick] + RIM_TOLERANCE * abs(self.slope), 2 * (w + h)),
            np.array([1, 1j, -1, -1j])[side],
        )


def centred(cells: float) -> complex:
    """Lattice origin that puts a node in the middle for an even number of cells across, else a face."""
    return 0j if round(cells) % 2 == 0 else -(0.5 + 0.5j)


class ScherkDomain(PlaneDomain):
    """Scherk's square: a curved diamond |p| + |q| <= 2 gd^-1(extent)."""

    def __init__(self, surface: Scherk, step: float, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, centred(surface.whole_length / step), pattern)
        self.scherk = surface
        self.limit = 2 * surface.outline.half_side
        self.reach = float(asymptotic_to_conformal(np.array([self.limit]))[0])

    def _asymptotic(self, conformal: Floats) -> Floats:
        clipped = np.clip(conformal, -self.reach, self.reach)
        return np.arcsinh(self.scherk.hyperbolic(clipped)[1])

    def extent(self) -> tuple[Floats, Floats]:
        ends = np.array([-1, 1]) * self.reach / abs(self.slope)
        return ends - self.origin.real, ends - self.origin.imag

    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        zeta = self.place(np.zeros(len(base), np.int64), base)
        fixed = zeta.imag if direction == 1 else zeta.real
        half = asymptotic_to_conformal(np.maximum(self.limit - np.abs(self._asymptotic(fixed)), 0))
        half /= abs(self.slope)
        shift = self.origin.real if direction == 1 else self.origin.imag
        return -half - shift, half - shift

    def rim(self, where: Complexes) -> Rim:
        p, q = self._asymptotic(where.imag), self._asymptotic(where.real)
        # side directions in (q, p), going round counter-clockwise; a corner belongs to the side that starts there
        place = np.mod(np.angle(q + 1j * p) + LOOP_START, 2 * np.pi)
        along = np.array([-1 + 1j, -1 - 1j, 1 - 1j, 1 + 1j])[(place // (np.pi / 2)).astype(int) % 4]
        rate_q, rate_p = 1 / np.sqrt(np.cosh(q)), 1 / np.sqrt(np.cosh(p))
        distance = (self.limit - np.abs(p) - np.abs(q)) * np.minimum(rate_p, rate_q) / abs(self.slope)
        return Rim(distance, np.zeros(len(where), np.int64), place, along.real * rate_q + 1j * along.imag * rate_p)


class DiscDomain(PlaneDomain):
    """A disc around a regular point (Enneper's classical surface)."""

    def __init__(self, surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, centred(surface.whole_length / step), pattern)
        assert isinstance(surface.outline, Disc)
        self.radius = surface.outline.radius

    def extent(self) -> tuple[Floats, Floats]:
        ends = np.array([-1, 1]) * self.radius / abs(self.slope)
        return ends - self.origin.real, ends - self.origin.imag

    def chord(self, base: Complexes, direction: complex) -> tuple[Floats, Floats]:
        centre = base + self.origin
        fixed, shift = (centre.imag, centre.real) if direction == 1 else (centre.real, centre.imag)
        half = np.sqrt(np.maximum((self.radius / abs(self.slope)) ** 2 - fixed**2, 0))
        return -half - shift, half - shift

    def rim(self, where: Complexes) -> Rim:
        return Rim(
            (self.radius - np.abs(where)) / abs(self.slope),
            np.zeros(len(where), np.int64),
            np.mod(np.angle(where) + LOOP_START, 2 * np.pi),
            np.exp(1j * (np.angle(where) + np.pi / 2)),
        )


class StarDomain(Domain):
    """A disc around a zero of order m >= 1: 2 (m + 2) rays, one sheet (a half plane) around each.

    On sheet k the ray is the positive real axis; even rays are A, odd ones B. A lamella that is no ray crosses
    exactly one ray, at a right angle, and is a line of that ray's sheet.
    """

    def __init__(self, surface: ClosedForm, step: float, pattern: Pattern = LAMELLAS) -> None:
        super().__init__(surface, step, pattern)
        assert isinstance(surface.outline, Disc)
        self.radius = surface.outline.radius
        self.sheets = 2 * (surface.hopf_order + 2)
        self.exponent = 2 / (surface.hopf_order + 2)
        chi = pattern.factor * surface.isothermic(np.array([1 + 0j]))[0]
        self.unit, self.phase = abs(chi) / step, float(np.angle(chi))
        self.reach = self.unit * self.radius ** (1 / self.exponent)

    def lines(self) -> Lines:
        pieces: list[list[Lines]] = [[], []]
        constants: Complexes = np.arange(1, int(np.floor(self.reach + RIM_TOLERANCE)) + 1).astype(np.complex128)
        half = np.sqrt(np.maximum(self.reach**2 - constants.real**2, 0))
        m = len(constants)
        never, no = np.zeros(m, bool), np.zeros(1, bool)
        for k in range(self.sheets):
            ray, crossing = (A, B) if k % 2 == 0 else (B, A)
            one, unit = np.ones(1), np.ones(1, np.complex128)
            pieces[ray].append(
                Lines(np.full(1, ray), np.full(1, k), 0 * unit, unit, 0 * one, self.reach * one, one > 0, no)
            )
            pieces[crossing].append(
                Lines(np.full(m, crossing), np.full(m, k), constants, np.full(m, 1j), -half, half, never, never)
            )
        lines = _join(pieces[A] + pieces[B])
        # each family in order along the rim
        t = np.where(lines.singular, lines.end, lines.start)
        place = self.rim(self.place(lines.sheet, lines.base + t * lines.direction)).place
        return lines.take(np.lexsort((place, lines.family)))

    def canonical(self, sheet: Integers, point: Complexes) -> Integers:
        # below the ray a point belongs to the quadrant above the previous ray
        below = np.rint(point.imag) < 0
        names = super().canonical(np.where(below, sheet - 1, sheet) % self.sheets, np.where(below, 1j * point, point))
        names[np.rint(np.abs(point)) == 0, 0] = 0
        return names

    def place(self, sheet: Integers, point: Complexes) -> Complexes:
        angle = sheet * (np.pi / 2) + np.angle(point) - self.phase
        return np.asarray((np.abs(point) / self.unit) ** self.exponent * np.exp(1j * self.exponent * angle))

    def derivative(self, sheet: Integers, point: Complexes) -> Complexes:
        return self.exponent * self.place(sheet, point) / point

    def rim(self, where: Complexes) -> Rim:
        # d cell / d zeta on the rim
        rate = self.reach / (self.exponent * self.radius)
        return Rim(
            (self.radius - np.abs(where)) * rate,
            np.zeros(len(where), np.int64),
            np.mod(np.angle(where) + LOOP_START, 2 * np.pi),
            np.exp(1j * (np.angle(where) + np.pi / 2)),
        )

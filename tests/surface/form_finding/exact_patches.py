"""Pieces of surfaces in closed form over a rectangle or a disc of parameters: rims, curvatures, distances.

Formulas: DESIGN section 9 and do Carmo, Differential Geometry of Curves and Surfaces (1976), sections 3.3 and 3.5.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from itertools import pairwise

import numpy as np
from scipy.integrate import quad
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree
from scipy.special import ellipj, ellipkinc, elliprd, elliprf

TAU = 2 * np.pi


class ArcLength:
    """A closed curve f(s), s in [0, 1], with the fraction of its arc length as parameter; corners at some s."""

    slides = ()

    def __init__(self, f, corners=(), name="rim") -> None:
        self._f, self.name = f, name
        stops = [*corners, 1.0] if len(corners) else [0.0, 1.0]
        s = np.concatenate([np.linspace(a, b, 2001)[:-1] for a, b in pairwise(stops)] + [[1.0]])
        # inside the pieces, so that no chord spans a corner
        arcs = np.linalg.norm(np.diff(f(s - 1e-13 * (s == 1.0)), axis=0), axis=1)
        d = np.concatenate([[0.0], np.cumsum(arcs)])
        self.length = float(d[-1])
        d /= d[-1]
        at = np.searchsorted(s, stops)
        self.corners = d[at[:-1]] if len(corners) else np.array([])
        self.smooth = np.zeros(len(self.corners), bool)
        self._stops = d[at]
        self._inverse = [CubicSpline(d[a : b + 1], s[a : b + 1]) for a, b in pairwise(at)]

    def at(self, t):
        t = np.asarray(t, float) % 1
        piece = np.clip(np.searchsorted(self._stops, t, side="right") - 1, 0, len(self._inverse) - 1)
        s = np.choose(piece, [inverse(t) for inverse in self._inverse])
        return self._f(s)


def circle(s):
    """The unit circle in z = 0."""
    return np.column_stack([np.cos(TAU * s), np.sin(TAU * s), 0 * s])


def disc(rings: int):
    """Points, faces, loop and parameter of an irregular disc with vertices on the unit circle."""
    rng = np.random.default_rng(4)
    z, number = [np.zeros(1, complex)], [[0]]
    for ring in range(1, rings + 1):
        loose = 0.25 if ring < rings else 0.1
        angle = TAU * (np.arange(6 * ring) + rng.uniform(-loose, loose, 6 * ring)) / (6 * ring)
        radius = (ring + (rng.uniform(-loose, loose, 6 * ring) if ring < rings else 0)) / rings
        number.append(list(range(sum(map(len, z)), sum(map(len, z)) + 6 * ring)))
        z.append(radius * np.exp(1j * angle))
    faces = []
    for ring in range(1, rings + 1):
        inner, outer = number[ring - 1], number[ring]
        for sector in range(6):
            for k in range(ring):
                o = [outer[(sector * ring + k + step) % (6 * ring)] for step in (0, 1)]
                i = [inner[(sector * (ring - 1) + k + step) % max(6 * (ring - 1), 1)] for step in (0, 1)]
                faces.append([i[0], *o])
                if k < ring - 1:
                    faces.append([i[0], o[1], i[1]])
    points = np.concatenate(z)
    on_rim = np.isin(np.arange(len(points)), number[-1])
    parameter = np.where(on_rim, np.angle(points) / TAU % 1, np.nan)
    return np.column_stack([points.real, points.imag, 0 * points.real]), np.array(faces), on_rim, parameter


def ring(radius: float, height: float, name: str = "ring") -> ArcLength:
    return ArcLength(
        lambda s: np.column_stack([radius * np.cos(TAU * s), radius * np.sin(TAU * s), np.full(np.shape(s), height)]),
        name=name,
    )


class Exact(ABC):
    """A surface x(u, v) with unit normal x_u x x_v over |x_u x x_v|.

    `rectangle` is ((u0, v0), (u1, v1)); for a disc override `rim_parameters`.
    """

    rectangle = ((0.0, 0.0), (1.0, 1.0))
    mean_curvature = 0.0

    @abstractmethod
    def x(self, u, v): ...

    @abstractmethod
    def tangents(self, u, v): ...

    @abstractmethod
    def curvatures(self, u, v):
        """k1 and the unit direction that goes with it, and k2 <= k1."""

    def rim_parameters(self, s):
        """Around the rectangle, a quarter of s to a side."""
        (u0, v0), (u1, v1) = self.rectangle
        corners = np.array([[u0, v0], [u1, v0], [u1, v1], [u0, v1], [u0, v0]])
        t = np.clip(np.asarray(s, float), 0, 1) * 4
        side = np.minimum(t.astype(int), 3)
        return (corners[side] + (corners[side + 1] - corners[side]) * (t - side)[:, None]).T

    corners = (0.0, 0.25, 0.5, 0.75)

    def rim(self) -> ArcLength:
        return ArcLength(lambda s: self.x(*self.rim_parameters(s)), self.corners)

    def normal(self, u, v):
        n = np.cross(*self.tangents(u, v))
        return n / np.linalg.norm(n, axis=1)[:, None]

    def parameters(self, points):
        """Parameters of the closest points: Newton's method with first derivatives, which a small distance suits."""
        if not hasattr(self, "_tree"):
            (u0, v0), (u1, v1) = self.rectangle
            u, v = (a.ravel() for a in np.meshgrid(np.linspace(u0, u1, 200), np.linspace(v0, v1, 200)))
            self._grid, self._tree = np.stack([u, v]), cKDTree(self.x(u, v))
        u, v = self._grid[:, self._tree.query(points)[1]]
        for _ in range(30):
            a, b = self.tangents(u, v)
            off = points - self.x(u, v)
            e, f, g = (a * a).sum(1), (a * b).sum(1), (b * b).sum(1)
            p, q = (off * a).sum(1), (off * b).sum(1)
            du, dv = (g * p - f * q) / (e * g - f * f), (e * q - f * p) / (e * g - f * f)
            u, v = u + du, v + dv
            if max(np.abs(du).max(), np.abs(dv).max()) < 1e-13:
                break
        return u, v

    def distance(self, points):
        return np.linalg.norm(points - self.x(*self.parameters(points)), axis=1)


class CatenoidPatch(Exact):
    """rho = cosh v; K = -1 / cosh^4 v; the normal points away from the axis, so that k1 goes with the meridian."""

    rectangle = ((0.0, -1.0), (2.0, 1.0))

    def x(self, u, v):
        return np.column_stack([np.cosh(v) * np.cos(u), np.cosh(v) * np.sin(u), v])

    def tangents(self, u, v):
        zero = 0 * u
        return (
            np.column_stack([-np.cosh(v) * np.sin(u), np.cosh(v) * np.cos(u), zero]),
            np.column_stack([np.sinh(v) * np.cos(u), np.sinh(v) * np.sin(u), 1 + zero]),
        )

    def curvatures(self, u, v):
        k = 1 / np.cosh(v) ** 2
        return k, self.tangents(u, v)[1] / np.cosh(v)[:, None], -k


class HelicoidPatch(Exact):
    """(sinh u cos v, sinh u sin v, v): K = -1 / cosh^4 u, and the principal directions halve the angle of u and v."""

    rectangle = ((-0.6, 0.0), (1.0, 1.8))

    def x(self, u, v):
        return np.column_stack([np.sinh(u) * np.cos(v), np.sinh(u) * np.sin(v), v])

    def tangents(self, u, v):
        zero = 0 * u
        return (
            np.column_stack([np.cosh(u) * np.cos(v), np.cosh(u) * np.sin(v), zero]),
            np.column_stack([-np.sinh(u) * np.sin(v), np.sinh(u) * np.cos(v), 1 + zero]),
        )

    def curvatures(self, u, v):
        k = 1 / np.cosh(u) ** 2
        a, b = self.tangents(u, v)
        # x_uv . n = -1 with n = x_u x x_v / cosh^2 u, so that k1 goes with x_u - x_v
        return k, (a - b) / (np.sqrt(2) * np.cosh(u))[:, None], -k


class EnneperPatch(Exact):
    """x = Re(w - w^3 / 3), ...: the parameters' lines are the principal ones, K = -4 / (1 + u^2 + v^2)^4."""

    rectangle = ((-0.7, -0.5), (0.6, 0.8))

    def x(self, u, v):
        return np.column_stack([u - u**3 / 3 + u * v**2, -v + v**3 / 3 - v * u**2, u**2 - v**2])

    def tangents(self, u, v):
        return (
            np.column_stack([1 - u**2 + v**2, -2 * u * v, 2 * u]),
            np.column_stack([2 * u * v, -1 + v**2 - u**2, -2 * v]),
        )

    def curvatures(self, u, v):
        rho = 1 + u**2 + v**2
        # at 0 the normal is (0, 0, -1) and x_uu = (0, 0, 2): u goes with k2
        return 2 / rho**2, self.tangents(u, v)[1] / rho[:, None], -2 / rho**2


class SphereCap(Exact):
    """Radius 1 seen from inside, over a disc in the plane of the rim; umbilic everywhere."""

    corners = ()

    def __init__(self, height: float) -> None:
        """Height over the rim's radius 1: H = 2 h / (h^2 + 1)."""
        self.height = height
        self.mean_curvature = 2 * height / (height**2 + 1)
        self.radius = 1 / self.mean_curvature

    def rim_parameters(self, s):
        return np.cos(TAU * s), np.sin(TAU * s)

    def x(self, u, v):
        """A bowl hanging below its rim in the plane z = 0."""
        return np.column_stack([u, v, self.radius - self.height - np.sqrt(self.radius**2 - u**2 - v**2)])

    def tangents(self, u, v):
        z = np.sqrt(self.radius**2 - u**2 - v**2)
        one, zero = np.ones_like(u), np.zeros_like(u)
        return np.column_stack([one, zero, u / z]), np.column_stack([zero, one, v / z])

    def curvatures(self, u, v):
        raise NotImplementedError("umbilic")

    def distance(self, points):
        return np.abs(np.linalg.norm(points - [0, 0, self.radius - self.height], axis=1) - self.radius)


class UnduloidPatch(Exact):
    """Delaunay's surface from its neck (DESIGN section 9), isothermic: metric r^2 (dU^2 + dV^2), V the angle.

    u = V and v = -U: then the normal points towards the axis. k_parallel = H + T / r^2, k_meridian = H - T / r^2.
    """

    rectangle = ((0.0, -1.6), (1.5, 1.0))

    def __init__(self, neck: float = 0.5, bulge: float = 1.0) -> None:
        self.neck, self.bulge = neck, bulge
        self.mean_curvature = 1 / (neck + bulge)
        self.flux = neck * bulge * self.mean_curvature
        self._m = 1 - (neck / bulge) ** 2

    def _profile(self, u):
        """Radius and height at the parameter U; E by Carlson's form."""
        m = self._m
        x = self.bulge * self.mean_curvature * u
        _, _, dn, _ = ellipj(x, m)
        quarter = ellipkinc(np.pi / 2, m)
        _, _, _, am = ellipj(x + quarter, m)

        def e(phi):
            """Incomplete integral of the second kind for |phi - pi/2| <= pi / 2 + reflection at pi / 2."""
            turns = np.round(phi / np.pi)
            rest = phi - turns * np.pi
            s, c = np.sin(rest), np.cos(rest)
            part = s * elliprf(c**2, 1 - m * s**2, 1) - m / 3 * s**3 * elliprd(c**2, 1 - m * s**2, 1)
            half = elliprf(0, 1 - m, 1) - m / 3 * elliprd(0, 1 - m, 1)
            return part + 2 * turns * half

        return self.neck / dn, self.flux * u + self.bulge * (e(am) - e(np.array(np.pi / 2)))

    def x(self, u, v):
        r, z = self._profile(-v)
        return np.column_stack([r * np.cos(u), r * np.sin(u), z])

    def tangents(self, u, v):
        r, _ = self._profile(-v)
        rise = self.mean_curvature * r**2 + self.flux
        slope = np.sign(-v) * np.sqrt(np.maximum(r**2 - rise**2, 0))
        return (
            np.column_stack([-r * np.sin(u), r * np.cos(u), 0 * u]),
            -np.column_stack([slope * np.cos(u), slope * np.sin(u), rise]),
        )

    def curvatures(self, u, v):
        r, _ = self._profile(-v)
        bend = self.flux / r**2
        return self.mean_curvature + bend, self.tangents(u, v)[0] / r[:, None], self.mean_curvature - bend


def catenoid_neck(distance: float, *, thin: bool) -> float:
    """Neck radius of the catenoid between unit rings at a distance: cosh(d / 2c) = 1 / c, either root."""
    from scipy.optimize import brentq

    # with x = d / 2c: cosh x / x = 2 / d; the minimum of cosh x / x is at x tanh x = 1
    turn = brentq(lambda x: x * np.tanh(x) - 1, 0.5, 2, xtol=1e-15)
    low, high = (turn, 12.0) if thin else (1e-6, turn)
    x = brentq(lambda x: np.cosh(x) / x - 2 / distance, low, high, xtol=1e-15)
    return distance / (2 * x)


def area_of(patch: Exact) -> float:
    """Area over the rectangle, by adaptive quadrature."""
    (u0, v0), (u1, v1) = patch.rectangle

    def element(u, v):
        return float(np.linalg.norm(np.cross(*patch.tangents(np.array([u]), np.array([v])))))

    return quad(lambda v: quad(lambda u: element(u, v), u0, u1, epsabs=1e-12)[0], v0, v1, epsabs=1e-11)[0]

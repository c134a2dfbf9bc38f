"""Random boundaries: outer loops of four characters, with up to three holes near the surface, and a mean curvature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.surface.boundary import Loop, make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.splines import closed_spline

TAU = 2 * np.pi


@dataclass(frozen=True)
class RandomCase:
    """Loops, the outer one first, the mean curvature asked for (1/m), and what was drawn."""

    loops: tuple[Loop, ...]
    mean_curvature: float
    reported: str


def draw_case(seed: int) -> RandomCase:
    """Everything follows from the seed."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(["star", "waving", "free", "winding", "polygon"], p=[0.3, 0.25, 0.2, 0.1, 0.15]))
    scale, turn = 10 ** rng.uniform(-0.3, 1.2), _rotation(rng)
    shift = scale * rng.uniform(-3, 3, 3)
    corners = int(rng.integers(4, 9))
    rim, points = _outer(kind, rng, corners)

    def moved(points: np.ndarray) -> np.ndarray:
        return scale * points @ turn.T + shift

    made = lines if kind == "polygon" else closed_spline
    outer = make_loop("outer", lines(moved(points), closed=True) if made is lines else closed_spline(moved(points)))
    holes = []
    for number, (middle, normal, reach) in enumerate(_places(rng, rim, int(rng.choice([0, 0, 1, 1, 2, 3])))):
        middle = middle + reach * rng.uniform(-0.6, 0.6) * normal
        axis = normal + rng.normal(0, 0.3, 3)
        axis /= np.linalg.norm(axis)
        radius = reach * rng.uniform(0.15, 0.55)
        if rng.random() < 0.5:
            holes.append(make_loop(f"hole {number}", circle(moved(middle), scale * radius, turn @ axis)))
        else:
            side = np.cross(axis, rng.normal(size=3))
            side /= np.linalg.norm(side)
            angle = TAU * np.arange(12) / 12 * (-1 if rng.random() < 0.5 else 1)
            wave = 1 + rng.uniform(0, 0.2) * np.cos(3 * angle + rng.uniform(0, TAU))
            lift = rng.uniform(0, 0.3) * np.cos(2 * angle + rng.uniform(0, TAU))
            ring = wave[:, None] * (np.outer(np.cos(angle), side) + np.outer(np.sin(angle), np.cross(axis, side)))
            holes.append(
                make_loop(f"hole {number}", closed_spline(moved(middle + radius * (ring + np.outer(lift, axis)))))
            )
    curvature = 0.0
    if rng.random() < 0.6:
        fine = outer.at(np.arange(400) / 400)
        enclosed = np.linalg.norm(np.cross(fine - fine.mean(0), np.roll(fine, -1, 0) - fine.mean(0)).sum(0) / 2)
        # up to beyond the bound |H| <= length / (2 vector area)
        curvature = float(rng.uniform(-1.2, 1.2) * min(outer.length / (2 * enclosed), 2 * TAU / outer.length))
    reported = f"{kind}, {len(holes)} holes, length {outer.length:.3g} m, H {curvature:.3g} 1/m"
    return RandomCase((outer, *holes), curvature, reported)


def _rotation(rng: np.random.Generator) -> np.ndarray:
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def _outer(kind: str, rng: np.random.Generator, corners: int) -> tuple[np.ndarray, np.ndarray]:
    """A fine polygon (240, 3), and the points the loop is laid through."""
    count = corners if kind == "polygon" else int(rng.integers(16, 48))
    parameters = [TAU * np.arange(n) / n for n in (240, count)]
    k = np.arange(1, 5)
    phase, size = rng.uniform(0, TAU, (4, 3)), rng.normal(size=(4, 3))
    loose = rng.uniform(-0.3, 0.3, count) * TAU / count
    result = []
    for index, t in enumerate(parameters):
        if kind == "polygon" and index == 1:
            t = t + loose
        waves = [(size[:, c] / (k + 1) * np.cos(np.outer(t, k) + phase[:, c])).sum(1) for c in range(3)]
        if kind == "star":
            r, z = 1 + 0.35 * np.clip(waves[0], -2, 2), 0.35 * waves[1]
            points = np.column_stack([r * np.cos(t), r * np.sin(t), z])
        elif kind in ("waving", "polygon"):
            r, z = 1 + 0.2 * np.clip(waves[0], -2, 2), 0.9 * waves[1]
            points = np.column_stack([r * np.cos(t), r * np.sin(t), z])
        elif kind == "free":
            points = np.column_stack([np.cos(t), np.sin(t), 0 * t]) + 0.8 * np.column_stack(waves)
        else:
            # the rim of an Enneper-like disc beyond where it crosses itself in plan
            a = 0.25 + 0.3 * abs(np.tanh(size[0, 0]))
            points = np.column_stack(
                [np.cos(t) - a * np.cos(3 * t), -np.sin(t) - a * np.sin(3 * t), 0.9 * np.cos(2 * t)]
            )
            points[:, 2] += 0.1 * waves[2]
        result.append(points)
    return result[0], result[1]


def _places(rng: np.random.Generator, rim: np.ndarray, count: int) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """Middle, normal and reach of holes on the harmonic disc over the rim."""
    modes = np.fft.fft(rim, axis=0) / len(rim)
    k = np.arange(1, 24)
    chosen: list[tuple[np.ndarray, np.ndarray, float, complex]] = []
    for _ in range(60):
        if len(chosen) == count:
            break
        z = np.sqrt(rng.random()) * 0.65 * np.exp(1j * TAU * rng.random())
        room = min([1 - abs(z), *[abs(z - other[3]) / 2 for other in chosen]])
        if room < 0.22:
            continue
        middle = modes[0].real + 2 * ((z**k) @ modes[1:24]).real
        slope = 2 * ((k * z ** (k - 1)) @ modes[1:24])
        a, b = slope.real, -slope.imag
        normal = np.cross(a, b)
        area = np.linalg.norm(normal)
        if area < 1e-3:
            continue
        chosen.append((middle, normal / area, room * np.sqrt(area), z))
    return [place[:3] for place in chosen]

"""Random boundaries as a designer might sketch them: a waving outer curve, up to three rings over it, some pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.surface.boundary import Loop, make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.splines import closed_spline

TAU = 2 * np.pi
# where the rings stand over a disc of radius 1, by their number, and the largest radius that keeps them apart
PLACES = {
    1: ([0], 0.45),
    2: ([-0.45, 0.45], 0.3),
    3: ([0.5, 0.5 * np.exp(TAU / 3 * 1j), 0.5 * np.exp(-TAU / 3 * 1j)], 0.25),
}


@dataclass(frozen=True)
class Sketch:
    """Loops, the outer one first, the mean curvature (1/m), and the number of cells."""

    loops: tuple[Loop, ...]
    mean_curvature: float
    cells: int


def sketch(seed: int) -> Sketch:
    """Everything follows from the seed."""
    rng = np.random.default_rng(seed)
    radius = 10 ** rng.uniform(0.2, 1.3)
    k = np.arange(2, 5)
    wave, lift = (rng.normal(size=(2, 3)) * share / k for share in (0.12, 0.35))
    turns = TAU * np.arange(24) / 24
    harmonics = np.stack([np.cos(np.outer(turns, k)), np.sin(np.outer(turns, k))])

    def along(amplitudes: np.ndarray) -> np.ndarray:
        return np.einsum("ctk,ck->t", harmonics, amplitudes)

    stretch = rng.uniform(0.7, 1.0)
    reach = 1 + along(wave)
    outer = np.column_stack([reach * np.cos(turns), stretch * reach * np.sin(turns), along(lift)])
    loops = [make_loop("outer", closed_spline(radius * outer))]
    count = int(rng.choice([0, 0, 1, 1, 2, 3]))
    where, most = PLACES.get(count, ([], 0.0))
    for number, z in enumerate(where):
        z = z * np.exp(0.3j * rng.normal())
        middle = np.array([np.real(z), stretch * np.imag(z), rng.uniform(-0.35, 0.35)])
        normal = np.array([*rng.normal(0, 0.25, 2), 1.0])
        ring = circle(radius * middle, radius * stretch * most * rng.uniform(0.5, 0.9), normal / np.linalg.norm(normal))
        loops.append(make_loop(f"ring {number}", ring))
    pressure = rng.choice([0.0, rng.uniform(-0.6, 0.6)]) / radius
    return Sketch(tuple(loops), float(pressure), int(rng.integers(8, 31)))

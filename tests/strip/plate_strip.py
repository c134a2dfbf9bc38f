"""A bent and twisted strip as von Karman's plate in one dimension, solved anew: what `lamella.strip.plate` is judged
by.

All of the strain is kept, eps = e0 + tg^2 (z^2 + f^2) / 2 - kg f. On half the height, 0 <= z <= h/2, the deflection is
z^2 times polynomials of z (f is even and 0 on the centre line; its third derivative may jump there where nodes hold the
centre line), the energy per length a sum over Gauss points, and its minimum found by Newton's method from 0, with the
loads raised in steps.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev

# polynomials, Gauss points, steps of the loads, Newton steps of each
TERMS, POINTS, STEPS, NEWTON = 16, 48, 8, 30


class PlateStrip(NamedTuple):
    """Heights z (m) from the centre line up, membrane stress, and von Mises stress of the worse face, Pa, each (n,)."""

    z: np.ndarray
    stress: np.ndarray
    von_mises: np.ndarray
    deflection: np.ndarray


def plate_strip(h, t, kg, tg, *, held, youngs_modulus=200e9, nu=0.3):
    """Stresses of a strip h x t (m) with weak-axis curvature kg and twist tg (1/m)."""
    x, weight = np.polynomial.legendre.leggauss(POINTS)
    share, weight = (x + 1) / 2, weight / 2
    square = np.polynomial.Polynomial([0, 0, 1])
    basis = [square * Chebyshev.basis(n, domain=[0, 1]).convert(kind=np.polynomial.Polynomial) for n in range(TERMS)]
    value = np.array([b(share) for b in basis])
    bend = np.array([b.deriv(2)(share) for b in basis]) * 4 / h**2
    stiff = youngs_modulus * t**3 / (12 * (1 - nu**2))
    z = share * h / 2
    # the last unknown is e0, over a unit of its own
    unit = (max(tg, 1e-3) * h) ** 2 / 24
    unknown = np.zeros(TERMS + 1)

    def strain(p, kg, tg, value, z):
        f = p[:-1] @ value
        return f, p[-1] * unit + tg**2 * (z**2 + f**2) / 2 - kg * f

    for load in np.arange(1, STEPS + 1) / STEPS:
        k, g = kg * load, tg * load
        for _ in range(NEWTON):
            f, eps = strain(unknown, k, g, value, z)
            by = np.vstack([(g**2 * f - k) * value, np.full(POINTS, unit)])
            across = unknown[:-1] @ bend
            gradient = youngs_modulus * t * (by * weight) @ eps
            gradient[:-1] += stiff * (bend * weight) @ (nu * k + across)
            hessian = youngs_modulus * t * (by * weight) @ by.T
            hessian[:-1, :-1] += youngs_modulus * t * (value * weight * eps * g**2) @ value.T
            hessian[:-1, :-1] += stiff * (bend * weight) @ bend.T
            free = TERMS if held else TERMS + 1
            scale = 1 / np.sqrt(np.abs(np.diag(hessian)[:free]))
            system = hessian[:free, :free] * scale[:, None] * scale
            step = -scale * np.linalg.solve(system, scale * gradient[:free])
            unknown[:free] += step
            if np.abs(step @ gradient[:free]) < 1e-22 * youngs_modulus * t * unit**2:
                break
    fine = np.linspace(0, 1, 101)
    value = np.array([b(fine) for b in basis])
    across = unknown[:-1] @ np.array([b.deriv(2)(fine) for b in basis]) * 4 / h**2
    f, eps = strain(unknown, kg, tg, value, fine * h / 2)
    stress, shear = youngs_modulus * eps, youngs_modulus / (2 * (1 + nu)) * t * tg
    face = youngs_modulus * t / 2 / (1 - nu**2)
    along, sideways = face * (kg + nu * across), face * (across + nu * kg)
    mises = [
        np.sqrt((stress + s * along) ** 2 - (stress + s * along) * s * sideways + sideways**2 + 3 * shear**2)
        for s in (-1, 1)
    ]
    return PlateStrip(fine * h / 2, stress, np.maximum(*mises), f)

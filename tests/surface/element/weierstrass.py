"""Minimal surfaces from Weierstrass' formula on elements, with zeros of the deviator where they are wanted.

With f = 1, X = Re of the integral of ((1 - g^2) / 2, i (1 + g^2) / 2, g) dz, and the Hopf differential is -g' dz^2
(Dierkes, Hildebrandt and Sauvigny, Minimal Surfaces (2010), section 3.3).
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial

from lamella.surface.element.surface import ElementSurface
from surface.form_finding.films import disc_film, surface


def weierstrass(zeros, rings: int = 8, noise: float = 0.0, seed: int = 0, scale: float = 0.5) -> ElementSurface:
    """Elements of order 4 over the unit disc of z, g' being scale times the product of z - z_k; noise of nodes in m."""
    flat = disc_film(4, rings)
    z = flat.nodes[:, 0] + 1j * flat.nodes[:, 1]
    g = Polynomial(scale * Polynomial.fromroots(zeros).coef).integ()
    forms = (0.5 * (1 - g * g), 0.5j * (1 + g * g), g)
    nodes = np.stack([Polynomial(np.asarray(form.coef, complex)).integ()(z).real for form in forms], 1)
    inside = np.setdiff1d(np.arange(len(nodes)), flat.connectivity.rim_nodes)
    nodes[inside, 2] += noise * np.random.default_rng(seed).normal(size=len(inside))
    return surface(flat.at(nodes))

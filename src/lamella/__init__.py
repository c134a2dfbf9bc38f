"""Strained gridshells from straight or circular lamellas with congruent nodes.

Signs and names, the same everywhere (Schling, Kilian, Wang, Schikore, Pottmann: Design and
Construction of Curved Support Structures with Repetitive Parameters, AAG 2018, section 2; docs/sign-conventions.md):

unit tangent t, surface normal n, sideways u = n x t, and

    t' =  kg u + kn n        kg  geodesic curvature
    u' = -kg t + tg n        kn  normal curvature
    n' = -kn t - tg u        tg  geodesic torsion

Principal curvatures k1 >= k2 with unit directions (d1, d2, n) right-handed, H = (k1 + k2) / 2, K = k1 k2. A sphere has
H > 0 for its inward normal. Isothermic coordinates: du = mu <d1, .>, dv = mu <d2, .>, mu = (H^2 - K)^(1/4). Family A
are the lamellas with tg > 0, along u + v = const; family B those with tg < 0, along u - v = const.

Lengths are metres, angles degrees, stresses Pa.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from typing import Any

__version__ = "0.1.0"


@cache
def _homes() -> dict[str, str]:
    """Module of each public name, read from the type stub beside this file: each is written there once."""
    import ast
    from pathlib import Path

    stub = ast.parse(Path(__file__).with_suffix(".pyi").read_text("utf-8"))
    return {
        alias.asname or alias.name: node.module
        for node in stub.body
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }


def __getattr__(name: str) -> Any:
    # imported on first use: `lamella --help` must not wait for scipy
    if name == "__all__":
        return ["__version__", *_homes()]
    if name.startswith("__") or name not in _homes():
        raise AttributeError(f"module 'lamella' has no attribute {name!r}")
    value = getattr(import_module(_homes()[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return ["__version__", *_homes()]

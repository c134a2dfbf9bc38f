"""What guides a problem at its beginning and is gone at its end."""

from __future__ import annotations

import numpy as np

from lamella.projection.constraint import Constraint
from lamella.projection.constraints.fairness import fairness
from lamella.projection.constraints.fixed import Fixed
from lamella.projection.quad_mesh import QuadMesh

# weights of third differences and of staying where a vertex was. Together they are a low-pass filter: waves of
# L edges are damped where (2 pi / L)^3 FAIR > STAY, about 9 edges; shorter ones are noise, longer ones shape
FAIR, STAY = 0.3, 0.1
# per iteration; after eight they are dropped
FADE = 0.3


def guides(mesh: QuadMesh) -> tuple[Constraint, ...]:
    """Fairness and closeness to the start, both fading: they take noise away and leave the shape where it was."""
    stay = Fixed(
        name="start",
        index=np.arange(len(mesh.vertices)),
        points=mesh.vertices,
        edge=mesh.mean_edge,
        weight=STAY,
        fade=FADE,
        hard=False,
    )
    return (*fairness(mesh, 3, weight=FAIR, fade=FADE), stay)

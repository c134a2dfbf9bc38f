"""A grid of straight strips on a hyperbolic paraboloid, to compare with other programs."""

import numpy as np

from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import CrossSection
from lamella.structure.beam.poses import Poses
from lamella.structure.structure import Structure, make_structure

EDGE, YOUNG, SHEAR, HEIGHT, THICKNESS = 8.0, 210e9, 210e9 / 2.6, 0.1, 0.0015
TORSION = SHEAR * HEIGHT * THICKNESS**3 / 3 * (1 - 0.63 * THICKNESS / HEIGHT * (1 - (THICKNESS / HEIGHT) ** 4 / 12))
# strips that neither shear nor have a helix term
SECTION = CrossSection(
    YOUNG * HEIGHT * THICKNESS,
    np.inf,
    np.inf,
    TORSION,
    YOUNG * THICKNESS * HEIGHT**3 / 12,
    YOUNG * HEIGHT * THICKNESS**3 / 12,
)


def hypar(cells: int, per_cell: int) -> tuple[Structure, np.ndarray]:
    """Strips along the straight lines of z = x y / 8 over a square of 8 m, and the nodes of their inner crossings.

    Without stress as they stand, locked at their crossings and pinned along the edges.
    """
    steps = cells * per_cell
    along, across = np.arange(steps + 1), per_cell * np.arange(cells + 1)
    grid = np.stack(np.meshgrid(across, along, indexing="ij"), -1)
    keys = np.concatenate([grid[..., ::-1].reshape(-1, 2), grid.reshape(-1, 2)])
    unique, number = np.unique(keys, axis=0, return_inverse=True)
    x, y = (unique * EDGE / steps - EDGE / 2).T
    points = np.stack((x, y, x * y / EDGE), 1)
    normals = np.stack((-y / EDGE, -x / EDGE, np.ones_like(x)), 1)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    frames = []
    for slope, way in ((y, 0), (x, 1)):
        tangent = np.stack((np.full_like(x, way == 0), np.full_like(x, way == 1), slope / EDGE), 1)
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        frames.append(np.stack((tangent, np.cross(normals, tangent), normals), 2))
    ends, turns = [], []
    for family, numbers in enumerate(number.reshape(2, cells + 1, steps + 1)):
        pairs = np.stack((numbers[:, :-1].ravel(), numbers[:, 1:].ravel()), 1)
        ends.append(pairs)
        turns.append(np.swapaxes(frames[0][pairs], -1, -2) @ frames[family][pairs])
    nodes = np.concatenate(ends)
    lengths = np.linalg.norm(points[nodes[:, 1]] - points[nodes[:, 0]], axis=1)
    poses = Poses(points, frames[0], np.zeros(0))
    beams = make_beams(nodes, lengths, SECTION, turns=np.concatenate(turns))
    rim = ((unique == 0) | (unique == steps)).any(1)
    held = dict.fromkeys(np.flatnonzero(rim).tolist(), "x y z")
    structure = make_structure(poses, beams.unstrained(poses, np.ones(len(beams), bool)), held)
    return structure, np.flatnonzero((unique % per_cell == 0).all(1) & ~rim)

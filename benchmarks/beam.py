"""Beam structures: assembly beside factorisation, whole analyses beside their factorisations, growth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from bench import Limit, Row, Table, alone, clocked, exponent, factorisations, in_turns, memory_gb, show

import lamella
from lamella import find_material
from lamella.base.arrays import Floats
from lamella.network.network import BOUNDARY
from lamella.structure.actions.load_case import no_load
from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.analysis.size import structure_memory
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import flat_strip
from lamella.structure.beam.poses import Poses
from lamella.structure.buckling import linear_buckling
from lamella.structure.loads import make_loads
from lamella.structure.model.case_loads import case_loads
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from lamella.structure.static import at_rest, loaded
from lamella.structure.structure import Structure, make_structure

# of the square, m
EDGE = 8.0
PER_CELL = 4
STEPS = 5
# of dead load, N/m of strip
LOAD = 12.0
# of nets, in multiples of their weight
NET_LOAD = 3.0
TOLD = "told beforehand, GB"


def hypar(cells: int, per_cell: int = PER_CELL) -> Structure:
    """Strips 100 x 1.5 mm on the straight lines of z = x y / 8 over a square, pinned along its edges.

    Its straight lines are asymptotic lines: strips upright on them are straight, twisted and locked at their crossings.
    """
    size, steps, grid_step = EDGE, cells * per_cell, EDGE / (cells * per_cell)
    lines = []
    for family in (0, 1):
        along = np.linspace(-size / 2, size / 2, steps + 1)
        across = np.linspace(-size / 2, size / 2, cells + 1)
        grid = np.stack(np.meshgrid(across, along, indexing="ij"), -1)
        lines.append(grid[..., ::-1] if family == 0 else grid)
    plan = np.concatenate([line.reshape(-1, 2) for line in lines])
    # crossings come up in both families
    keys, number = np.unique(np.round((plan + size / 2) / grid_step).astype(int), axis=0, return_inverse=True)
    number = number.reshape(2, cells + 1, steps + 1)
    x, y = (keys * grid_step - size / 2).T
    points = np.stack((x, y, x * y / EDGE), 1)
    normals = np.stack((-y / EDGE, -x / EDGE, np.ones_like(x)), 1)
    own = frames_along(normals, (1 + 0 * x, 0 * x, y / EDGE))
    other = frames_along(normals, (0 * x, 1 + 0 * x, x / EDGE))
    nodes, turns = [], []
    for family, frames in enumerate((own, other)):
        ends = np.stack((number[family][:, :-1].ravel(), number[family][:, 1:].ravel()), 1)
        nodes.append(ends)
        turns.append(np.swapaxes(own[ends], -1, -2) @ frames[ends])
    ends = np.concatenate(nodes)
    lengths = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    beams = make_beams(ends, lengths, flat_strip(find_material("1.4301"), 0.1, 0.0015), turns=np.concatenate(turns))
    rim = np.flatnonzero((np.abs(np.stack((x, y))) > size / 2 - 1e-6).any(0))
    held = dict.fromkeys(rim.tolist(), "x y z")
    return make_structure(Poses(points, own, np.zeros(0)), beams, held)


def frames_along(normals: Floats, tangents: tuple[Floats, Floats, Floats]) -> Floats:
    """Frames t, u, n of nodes, (n, 3, 3)."""
    n = normals / np.linalg.norm(normals, axis=1)[:, None]
    t = np.stack(tangents, 1)
    t /= np.linalg.norm(t, axis=1)[:, None]
    return np.stack((t, np.cross(n, t), n), 2)


def analysed(cells: int) -> dict[str, float]:
    """Residual state and load steps: figures."""
    structure = hypar(cells)
    loads = make_loads(structure, lines=(0, 0, -LOAD))
    with factorisations() as inside:
        seconds, found = clocked(lambda: loaded(at_rest(structure, loads), steps=STEPS))
    return {
        "elements": len(structure.beams),
        "analysis, s": seconds,
        "factorisations": len(inside.seconds),
        "analysis / factorisations": seconds / inside.total,
        "largest deflection, mm": 1e3 * float(np.abs(found.displacements).max()),
        "memory, GB": memory_gb(),
    }


def assembly() -> Table:
    """One assembly against one factorisation of the same matrix."""
    structure = hypar(36)
    poses = structure.poses.moved(1e-4 * np.random.default_rng(0).standard_normal(structure.poses.unknowns))
    state = structure.beams.at(poses)
    entries = structure.entries(state.stiffness(state.stress))
    structure.pattern.factor(entries)

    def assemble() -> None:
        here = structure.beams.at(poses)
        structure.vector(here.forces())
        structure.entries(here.stiffness(here.stress))

    times = in_turns({"assembly": assemble, "factorisation": lambda: structure.pattern.factor(entries)}, 9)
    ratio = times["assembly"] / times["factorisation"]
    row: Row = {
        "elements": len(structure.beams),
        "unknowns": len(structure.free),
        "assembly, s": times["assembly"],
        "factorisation, s": times["factorisation"],
        "assembly / factorisation": ratio,
    }
    return Table(
        "Beams: assembly",
        "Forces and tangent stiffness of all elements, summed into the matrix; beside one factorisation of it, its "
        "pattern analysed before.",
        (row,),
        (Limit("assembly / factorisation at 10,000 elements", ratio, 1.0),),
    )


def net_analysed(spacing: float) -> dict[str, float]:
    """The strips of Enneper's surface, pinned along the rim: model, residual state, load steps, first buckling factor.

    Pairs 100 x 1.5 mm slotted at every crossing; what a run of the stage "structure" computes of one case.
    """
    network = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=spacing)
    lamellas = network.strips()
    fixed = np.zeros((len(network.node_points), 6), bool)
    fixed[network.node_kinds == BOUNDARY, :3] = True
    supports = NodeSupports(fixed, np.zeros(fixed.shape))
    case = replace(no_load("load", len(fixed)), self_weight=np.array([0.0, 0.0, -NET_LOAD]))
    before = memory_gb()
    modelling, model = clocked(lambda: make_model(lamellas, supports, ModelRules(elements=PER_CELL)))
    loads = case_loads(model, case)
    with factorisations() as inside:
        seconds, found = clocked(lambda: loaded(at_rest(model.structure, loads), steps=STEPS))
    steps, bare = len(inside.seconds), inside.total
    buckling, _ = clocked(lambda: linear_buckling(found, 1))
    return {
        "elements": len(model.structure.beams),
        "model, s": modelling,
        "analysis, s": seconds,
        "factorisations": steps,
        "analysis / factorisations": seconds / bare,
        "buckling, s": buckling,
        "largest deflection, mm": 1e3 * float(np.abs(found.displacements).max()),
        "memory, GB": memory_gb() - before,
        TOLD: structure_memory(len(model.structure.beams), 1),
    }


def net_table() -> Table:
    """Nets of strips, in processes of their own."""
    rows = [alone(net_analysed, spacing) for spacing in (0.238, 0.106, 0.0479)]
    growth = exponent(*((row["elements"], row["analysis, s"]) for row in (rows[0], rows[-1])))
    whole = rows[-1]["model, s"] + rows[-1]["analysis, s"] + rows[-1]["buckling, s"]
    return Table(
        "Beams: a net",
        f"Strips of a net on Enneper's surface, {PER_CELL} elements a cell edge: the model, the residual state and "
        f"{STEPS} load steps, beside their factorisations, and the first buckling factor.",
        tuple({name: int(v) if float(v).is_integer() else v for name, v in row.items()} for row in rows),
        (
            Limit("analysis / factorisations at 2,000 elements", rows[0]["analysis / factorisations"], 3.0),
            Limit("CPU seconds at 50,000 elements, with model and buckling", whole, 600.0),
            Limit("exponent of growth, 2,000 to 50,000 elements", growth, 1.4),
            Limit("memory at 50,000 elements over what is told", rows[-1]["memory, GB"] / rows[-1][TOLD], 1.0),
        ),
    )


def tables() -> Iterator[Table]:
    """Assembly, then analyses in processes of their own."""
    yield assembly()
    yield net_table()
    rows = [alone(analysed, cells) for cells in (16, 36, 79)]
    growth = exponent(*((row["elements"], row["analysis, s"]) for row in (rows[0], rows[-1])))
    yield Table(
        "Beams: analysis",
        f"Strips on a hyperbolic paraboloid, their residual state and {STEPS} load steps by Newton's method; all of it "
        "beside its factorisations, the first of which analyses the pattern.",
        tuple({name: int(v) if float(v).is_integer() else v for name, v in row.items()} for row in rows),
        (
            Limit("analysis / factorisations at 2,000 elements", rows[0]["analysis / factorisations"], 3.0),
            Limit("CPU seconds at 50,000 elements", rows[-1]["analysis, s"], 600.0),
            Limit("exponent of growth, 2,000 to 50,000 elements", growth, 1.4),
        ),
    )


if __name__ == "__main__":
    show(tables())

r"""Newton's method for one step along an equilibrium path.

Strips resist stretch ten million times as much as bending. A motion of Newton's first iteration is right to first order
only, and what it is wrong by stretches the strip: the stress of that stretch is nonsense, and as a geometric stiffness
it spoils the next iteration. So the geometric stiffness takes the stress that the linear iteration itself expects,
:math:`\sigma + C (\varepsilon + \delta\varepsilon)`, from the stress of the last equilibrium on; the residual is
always the true one (D. Magisano, L. Leonetti, G. Garcea, Computer Methods in Applied Mechanics and Engineering 313
(2017) 496: mixed integration points). Where it converges both are alike, so it converges quadratically, in four or five
iterations a step whatever the ratio of stiffnesses.

Load factor and motion are unknowns together. What else is asked for (the load factor itself, the shift of a node, the
length of the step) is one linear equation in an iteration, see `lamella.structure.controls`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.sparse import SingularError
from lamella.structure.beam.beams import BeamState
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.controls import Control
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import Loads
from lamella.structure.mechanism import refuse_mechanism
from lamella.structure.structure import Structure

# last motion of an iteration that counts as converged, over the structure's size and in radians: the error that is left
# is of its square
LAST_MOTION = 1e-8
# what rounding leaves to move of badly conditioned structures, where iterations no longer gain anything
ROUNDING_MOTION = 1e-6
# of a step; more are taken by what snaps through to another path, which is not what a step is for
MOST_ITERATIONS = 9
# rotation of a node in one iteration, rad: more says that the step was too long
ROTATION_MAX = 1.2
# growth of motions from one iteration to the next that says the same
GROWTH_MAX = 1e3


class StepError(ArithmeticError):
    """A step did not converge; a shorter one may."""


def step(start: Equilibrium, control: Control) -> Equilibrium:
    """The equilibrium that a control asks for, from one near it.

    Raises
    ------
    StepError
        Newton's method does not converge from there.
    InputError
        A part of the structure moves freely.
    """
    structure, loads = start.structure, start.loads
    free, pattern = structure.free, structure.pattern
    poses, factor, stress = start.poses, start.factor, start.whole.stress
    total, before = np.zeros(poses.unknowns), np.inf
    control.begin(start)
    for iteration in range(1, MOST_ITERATIONS + 1):
        trial = factor + control.ahead(iteration)
        state = loads.state(structure, trial, poses)
        blocks = state.stiffness(stress)
        residual = loads.forces_at(trial) - structure.vector(state.forces())
        pull = pull_of(structure, loads, state.beams)
        if loads.motions.any():
            by_motions = structure.multiplied(blocks, loads.motions)
            pull, residual = pull - by_motions, residual - (trial - factor) * by_motions
        try:
            factored = pattern.factor(structure.entries(blocks))
        except SingularError as error:
            refuse_mechanism(structure, blocks)
            raise StepError(str(error)) from None
        solved = factored.solve(np.stack((residual[free], pull[free]), 1))
        motion, along = np.zeros((2, poses.unknowns))
        motion[free], along[free] = solved.T
        motion += (trial - factor) * loads.motions
        along += loads.motions
        more = control.more(iteration, total, motion, along)
        motion, factor = motion + more * along, trial + more
        stress = state.expected(structure.gathered(motion))
        poses, total = poses.moved(motion), total + motion
        size = _size(motion, len(poses.points), structure.size)
        if not np.isfinite(size) or size > ROTATION_MAX or size > GROWTH_MAX * before:
            raise StepError(f"a motion of {size:.3g} in iteration {iteration}")
        if size < LAST_MOTION or (before < ROUNDING_MOTION and size > before / 2):
            return Equilibrium(structure, loads, float(factor), poses, factored.negative, iteration)
        before = size
    raise StepError(f"no convergence in {MOST_ITERATIONS} iterations")


def pull_of(structure: Structure, loads: Loads, state: BeamState) -> Floats:
    """Forces on the unknowns by one unit of load factor, but for motions and natural curvature, (6 n + k,)."""
    if not loads.lines.any():
        return loads.forces
    on_ends = replace(state.lines, loads=loads.lines).on_ends()
    return np.asarray(loads.forces + structure.vector(state.on_nodes(on_ends)))


def _size(motion: Floats, nodes: int, size: float) -> float:
    """Largest shift over the structure's size, or rotation, of a motion (6 n + k,)."""
    parts = motion[: NODE_UNKNOWNS * nodes].reshape(-1, NODE_UNKNOWNS)
    largest = [np.abs(parts[:, :3]).max() / size, np.abs(parts[:, 3:]).max()]
    return float(max(*largest, np.abs(motion[NODE_UNKNOWNS * nodes :]).max(initial=0.0)))

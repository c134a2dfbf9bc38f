r"""Buckling: of the state as it is, about a loaded state, and the critical load that both lead to.

About an equilibrium with the tangent stiffness K a further load factor mu adds the stress that it makes by the linear
motion, and its geometric stiffness G: :math:`(K + \mu G) \varphi = 0` (classical linear buckling). Motion before
buckling and the change of stiffness with it are left out, so it is the more right the nearer the state is to its
critical load; `critical_point` goes there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.structure.controls import LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.newton import StepError, step
from lamella.structure.tangent import Tangent

# of the way to the load that linear buckling expects, gone in one round
APPROACH_SHARE = 0.9
MOST_APPROACHES = 60
# of a structure's size: shifts that are less are those of one equilibrium
SAME_POSE = 1e-6


@dataclass(frozen=True, repr=False, eq=False)
class Buckling(Result):
    """Loads at which an equilibrium may branch or give way.

    Attributes
    ----------
    equilibrium : Equilibrium
        About which.
    factors : (c,)
        Load factors, ascending: that of the equilibrium and what is to be added.
    modes : (c, 6 n + k)
        Motions, of largest number 1.
    """

    equilibrium: Equilibrium
    factors: Floats
    modes: Floats

    def _line(self) -> str:
        return "load factors " + ", ".join(f"{factor:.6g}" for factor in self.factors)


def linear_buckling(equilibrium: Equilibrium, count: int = 1) -> Buckling:
    """Lowest critical load factors above that of an equilibrium, for the loads it has.

    Raises
    ------
    InputError
        The equilibrium is unstable; loads that change natural curvatures or lengths.
    """
    return _about(Tangent.of(equilibrium), count)


def _about(tangent: Tangent, count: int) -> Buckling:
    equilibrium = tangent.equilibrium
    loads, structure, state = equilibrium.loads, equilibrium.structure, equilibrium.whole
    if not loads.strain_free:
        raise InputError("loads change the natural shape of elements", "give forces or motions", "loads")
    stress = state.stress_rate(structure.gathered(tangent.motion()))
    lines = replace(state.beams.lines, loads=loads.lines)
    further = replace(state, beams=replace(state.beams, lines=lines))
    geometric = [-block for block in further.geometric_stiffness(stress)]
    ratios, modes = tangent.modes(geometric, count)
    return Buckling(equilibrium, equilibrium.factor + ratios, modes)


def critical_point(start: Equilibrium, tolerance: float = 1e-6) -> Buckling:
    """Lowest critical load on the path of stable equilibria, bifurcation or limit point.

    Linear buckling about states ever nearer to it. Where strips between nodes buckle gradually, as bent ones do, the
    path has no critical point and goes on. Towards a limit point what it expects to be left is too much by a
    factor, always by the same one near it: the load at which nothing is left is where the line through two states has
    its zero.

    Parameters
    ----------
    start : Equilibrium
        Stable.
    tolerance : float
        Of what is left, over the load factor.

    Raises
    ------
    InputError
        No critical load; the start is unstable.
    """
    tangent = Tangent.of(start)
    known: tuple[float, float] | None = None
    for _ in range(MOST_APPROACHES):
        found, here = _about(tangent, 1), tangent.equilibrium
        if not len(found.factors):
            raise InputError("no critical load for loads in this direction", "", "loads")
        left = expected = float(found.factors[0]) - here.factor
        if known is not None and known[1] > expected:
            left = min(left, expected * (here.factor - known[0]) / (known[1] - expected))
        if left <= tolerance * abs(here.factor + left):
            return replace(found, factors=np.array([here.factor + left]))
        known = (here.factor, expected)
        tangent = _nearer(tangent, left)
    raise InputError(f"no critical load within {MOST_APPROACHES} steps", "start nearer to it", "start")


def _nearer(tangent: Tangent, left: float) -> Tangent:
    """Of a stable equilibrium on the way to a critical load that is about `left` away."""
    here = tangent.equilibrium
    size = here.structure.size
    part = APPROACH_SHARE * left
    while part > np.finfo(float).eps * abs(here.factor + left):
        try:
            after = step(here, LoadControl(here.factor + part))
            # what snaps through lands on another path, which does not lead back
            back = step(after, LoadControl(here.factor))
            if np.abs(back.poses.points - here.poses.points).max() <= SAME_POSE * size:
                onward = Tangent.of(after)
                if onward.factor.negative == 0:
                    return onward
        except (StepError, InputError):
            pass
        part /= 2
    raise InputError(f"no stable equilibrium beyond the load factor {here.factor:.6g}", "", "start")

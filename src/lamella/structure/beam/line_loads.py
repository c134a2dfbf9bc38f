r"""Dead loads along beam elements.

With the cubic through the ends and their tangents t the potential of a load q per natural length is

.. math:: -q \cdot \left( \tfrac12 L_0 (x_a + x_b) + \tfrac1{12} L_0^2 (t_a - t_b) \right):

half of the load at each end and the fixed-end moments of a beam, which make the linear element exact at its nodes. It
is a potential, so its part of the tangent stiffness is symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.columns import add_unit, cross, dot, outer, symmetric


@dataclass(frozen=True)
class LineLoads:
    """Dead loads on m elements.

    Attributes
    ----------
    length : (m,)
        m.
    tangents : (2, 3, m)
        Of the ends.
    loads : (m, 3) or None
        N/m, global; None: no loads.
    """

    length: Floats
    tangents: Floats
    loads: Floats | None

    def on_ends(self) -> Floats:
        """Forces (N) and moments (N m) on the ends, (12, m)."""
        result = np.zeros((12, len(self.length)))
        if self.loads is not None:
            half = self.loads.T * (self.length / 2)
            result[:3] = result[6:9] = half
            for end, sign in ((0, 1.0), (1, -1.0)):
                result[6 * end + 3 : 6 * end + 6] = cross(self.tangents[end] * (sign * self.length / 6), half)
        return result

    def add_stiffness(self, blocks: Floats) -> None:
        """Add their part of the tangent stiffness to matrices (12, 12, m) of the ends."""
        if self.loads is None or not self.loads.any():
            return
        for end, sign in ((0, -1.0), (1, 1.0)):
            tangent, turn = self.tangents[end], slice(6 * end + 3, 6 * end + 6)
            load = self.loads.T * (sign * self.length**2 / 12)
            blocks[turn, turn] += symmetric(outer(load, tangent))
            add_unit(blocks[turn, turn], -dot(load, tangent))

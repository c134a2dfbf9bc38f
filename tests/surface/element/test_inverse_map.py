"""Places of given values, from element to element."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.element.connectivity import connect
from lamella.surface.element.inverse_map import find_places
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials


@pytest.mark.parametrize("off", [1e-5, 7e-4, 0.02])
def test_a_place_beyond_the_rim_and_beyond_the_edge_next_to_it(off) -> None:
    """Two triangles of a square: what lies beyond the rim next to their common vertex is found on either's polynomial.

    A crossing of lamellas on the rim may lie there, within the surface's error.
    """
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    connectivity = connect(np.array([[0, 1, 2], [1, 3, 2]]), 4, 3)
    nodes = connectivity.basis.nodes
    shares = np.column_stack([1 - nodes.sum(1), nodes])
    fields = Polynomials.through(connectivity.basis, shares @ corners[connectivity.faces])
    # beyond the rim x = 0 by more than beyond the common edge x + y = 1
    target = np.array([[-5 * off], [1 + 6 * off]])
    start = Places(np.array([0]), np.array([[0.0, 0.999]]))
    places, found = find_places(connectivity, fields.jet, start, target, lambda *_: None, beyond_rim=0.25)
    assert found.all()
    assert fields.values(places) == pytest.approx(target, abs=1e-12)

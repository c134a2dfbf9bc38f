"""Closing a net by rounding where the nearest whole numbers fold it."""

from __future__ import annotations

import re

import pytest

from lamella.base.errors import InputError
from lamella.network.elements.element_network import element_network
from lamella.surface.form_finding.find import find_film
from network.elements.random_boundaries import sketch
from network.elements.test_element_network import ruler


@pytest.mark.slow
@pytest.mark.parametrize("seed", [15, 51])
def test_the_number_of_cells_that_is_offered_rounds_the_net(seed: int) -> None:
    """Rounding moves umbilics by up to a cell or two: with enough cells between them nothing folds."""
    case = sketch(seed)
    found = find_film(case.loops, case.mean_curvature, tolerance=2e-2, most_nodes=12_000)
    surface = found.surface("form-found")
    with pytest.raises(InputError) as error:
        element_network(surface, cells=case.cells, closing="round", minimum_length=0.0)
    assert error.value.where == "closing"
    offered = re.match(r"write cells = (\d+)", error.value.remedy)
    assert offered
    cells = int(offered[1])
    assert cells > case.cells
    net = element_network(surface, cells=cells, closing="round", minimum_length=0.0)
    assert net.describe()["closed"]
    assert ruler(net.network)["family_sign_errors"] == 0

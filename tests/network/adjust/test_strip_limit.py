"""Boundaries adjusted until strips keep a limit of utilisation."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella import InputError, compute, parse_project
from lamella.network.adjust.adjustable_films import Films
from lamella.network.adjust.strip_limit import MostUsed
from lamella.network.elements.element_network import plan_net
from lamella.network.pattern import LAMELLAS
from lamella.project.tables import FormFoundTable
from lamella.stages.surface.boundary_of_tables import adjustable_film
from lamella.stages.surface.strip_limit import strip_limit
from lamella.surface.boundary.freedom import Freedom

RINGS: dict[str, Any] = {
    "surface": {
        "kind": "form-found",
        "tolerance": 2e-2,
        "boundary": [
            {"name": "rim", "circle": {"center": [0.0, 0.0, 0.0], "radius": 2.5}},
            {
                "name": "eye",
                "circle": {"center": [0.3, 0.0, 1.2], "radius": 1.0, "normal": [0.1, 0.0, 1.0]},
                "adjust": {"move": 0.5, "scale": 0.2, "tilt": 10.0},
            },
        ],
    },
    "network": {"cells": 12, "closing": "adjust", "limit": {"utilisation": 0.8}},
}


def test_rates_of_utilisation_are_those_of_films_found_anew() -> None:
    """At the places of the elements: what first order leaves falls with the square of the change."""
    project = parse_project(RINGS)
    limit = strip_limit(project)
    assert isinstance(project.surface, FormFoundTable)
    assert limit is not None
    films = Films(Freedom(adjustable_film(project.surface)), LAMELLAS)
    net = films.first(2e-2)
    network = plan_net(net.surface, cells=12, seams=False).traced(closing="round", minimum_length=0.5).network
    most = MostUsed.of(network, net.surface, limit)
    assert most.largest == most.use.max() == limit.on_net(network).max()
    moves, curvature_rates = films.moves(net)
    rates = most.rates(net.surface, moves, curvature_rates, limit)
    alone = most.alone(net.surface, limit)
    # the layer beside the centre line adds little here
    assert np.abs(alone / most.use - 1).max() < 0.2
    direction = np.random.default_rng(4).normal(size=films.freedom.count)
    direction /= np.linalg.norm(direction)
    left = []
    for share in (0.08, 0.04):
        # films move their nodes along the surface too: the places are where first order takes the points
        there = films.moved(net, share * direction).surface
        nodes = net.surface.nodes + share * np.einsum("p,pnc->nc", direction, moves)
        places, _ = there.closest(replace(net.surface, nodes=nodes).frames(most.places).position)
        found = replace(most, places=places).alone(there, limit) * (most.use / alone)
        left.append(np.abs(found - most.use - share * rates @ direction).max())
    assert left[0] < 0.2 * np.abs(0.08 * rates @ direction).max()
    assert left[1] < left[0] / 3


@pytest.mark.slow
def test_the_nearest_boundary_whose_strips_keep_a_limit() -> None:
    """Without a limit strips are used more; with it they keep it, the net closes, and the boundary moves further."""
    free = {**RINGS, "network": {"cells": 12, "closing": "adjust"}}
    before = compute(parse_project(free), until="lamellas").summary
    limit = 0.9 * before["lamellas"]["utilisation_max"]
    limited = {**RINGS, "network": {"cells": 12, "closing": "adjust", "limit": {"utilisation": limit}}}
    after = compute(parse_project(limited), until="lamellas").summary
    assert after["network"]["closed"]
    assert 0.95 * limit < after["lamellas"]["utilisation_max"] <= 1.002 * limit
    moved = [one["network"]["adjustment"]["moved_max"] for one in (before, after)]
    assert moved[1] > moved[0]


@pytest.mark.slow
def test_a_limit_that_is_out_of_reach() -> None:
    tight = {**RINGS, "network": {"cells": 12, "closing": "adjust", "limit": {"utilisation": 0.05}}}
    with pytest.raises(InputError) as refusal:
        compute(parse_project(tight), until="lamellas", folder=Path())
    assert refusal.value.where == "network.limit"
    assert "0.05" in refusal.value.message


@pytest.mark.parametrize(
    "table",
    [
        {"closing": "open", "limit": {"utilisation": 1.0}},
        {"limit": {"utilisation": 1.0}},
        {"kind": "principal", "closing": "adjust", "limit": {"utilisation": 1.0}},
        {"closing": "adjust", "limit": {"utilisation": 0.0}},
        {"closing": "adjust", "limit": {"utilization": 1.0}},
        {"closing": "adjust", "limit": 1.0},
    ],
)
def test_limits_that_are_refused(table: dict[str, Any]) -> None:
    with pytest.raises(InputError) as refusal:
        parse_project({**RINGS, "network": table})
    assert refusal.value.where.startswith("network.limit")
    assert refusal.value.remedy

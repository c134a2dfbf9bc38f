"""Nets in the crane: balance of slings and weight, stiff nets by statics alone, where they are lifted."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import lamella
from lamella import InputError, Section
from lamella.erection.bracings import NONE, Bracings
from lamella.erection.lift_cases import LiftRules, least_bracing, lift_cases
from lamella.erection.lifted import Lifted, lifted
from lamella.erection.lifting_points import BESSEL, lifting_points
from lamella.erection.warnings import lifting_warnings
from lamella.hardware.rules import CableRules
from lamella.structure.actions.load_case import GRAVITY
from lamella.structure.actions.node_supports import no_supports


@cache
def patch() -> lamella.Network:
    return lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.8)


def hung(thickness: float, count: int, hook: float | None = None, masses: np.ndarray | None = None) -> Lifted:
    net = patch()
    strips = net.strips(Section(0.1, thickness, layers=1))
    model = Bracings().model(strips, no_supports(len(net.node_points)), 1, NONE)
    nodes = lifting_points(np.arange(len(net.node_points)), net.node_points, net.node_points.mean(0), count)
    return lifted(model, nodes, hook=hook, node_masses=masses)


@pytest.mark.parametrize("count", [2, 3, 4])
def test_slings_carry_the_weight(count: int) -> None:
    """Forces of all slings together are the weight, whatever the net's shape has become, and go through one hook."""
    net = patch()
    masses = np.linspace(0, 1, len(net.node_points))
    made = hung(0.0015, count, masses=masses)
    strips = net.strips(Section(0.1, 0.0015, layers=1))
    mass = strips.material.density * 0.1 * 0.0015 * net.lengths.sum() + masses.sum()
    assert made.weight == pytest.approx(GRAVITY * mass, rel=1e-3)
    assert made.poses is not None
    away = made.poses.points[-1] - made.poses.points[made.nodes]
    pull = made.slings[:, None] * away / np.linalg.norm(away, axis=1)[:, None]
    np.testing.assert_allclose(pull.sum(0), [0, 0, made.weight], atol=1e-6 * made.weight)


def test_high_hooks() -> None:
    """Two slings carry W/2 each the higher the hook is: more by half the square of their slope, of second order."""
    more = [float((2 * hung(0.0015, 2, hook).slings / hung(0.0015, 2).weight - 1).max()) for hook in (40.0, 80.0)]
    assert more[0] / more[1] == pytest.approx(4, rel=0.02)
    assert 0 < more[1] < 1e-3


def test_lifting_points() -> None:
    """On a board of 4 x 2 m: Bessel's points of either axis, wherever it lies and however it is turned."""
    x, y = np.meshgrid(np.linspace(-2, 2, 81), np.linspace(-1, 1, 41), indexing="ij")
    board = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], 1)
    nodes = np.arange(len(board))
    for angle in (0.0, 0.4, 2.0):
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        points = board @ turn.T + [7, 8, 9]
        for count, goals in ((2, [[2, 0], [-2, 0]]), (4, [[2, 0], [-2, 0], [0, 1], [0, -1]])):
            found = board[lifting_points(nodes, points, np.array([7.0, 8, 9]), count), :2]
            away = np.linalg.norm(found[:, None] - BESSEL * np.array(goals), axis=2)
            assert away.min(0).max() < 0.04
    assert not len(lifting_points(nodes[:3], board[:3], np.zeros(3), 4))
    with pytest.raises(InputError) as caught:
        lifting_points(nodes, board, np.zeros(3), 5)
    assert caught.value.where == "count"


def test_cables_are_what_it_needs() -> None:
    strips = patch().strips(Section(0.1, 0.0015, layers=1))
    cases = lift_cases(strips, LiftRules((4,), limit=0.02), Bracings(cables=CableRules(every=1)), elements=1)
    alone, braced = cases
    assert (alone.bracing, braced.bracing) == ("none", "cables")
    assert braced.lifted.deflection < 0.5 * alone.lifted.deflection
    assert not alone.holds
    assert braced.holds
    assert least_bracing(cases, 4) == "cables"
    assert least_bracing(cases[:1], 4) is None
    assert "4 nodes" in repr(alone.lifted)
    # a project without any bracing is told what would be one
    (message,) = lifting_warnings({"": cases[:1]})
    assert "[cables]" in message
    assert "[edge_beam]" in message
    (message,) = lifting_warnings({"": cases})
    assert "[" not in message


def test_one_node_is_no_lift() -> None:
    model = Bracings().model(patch().strips(), no_supports(len(patch().node_points)), 1, NONE)
    with pytest.raises(InputError) as caught:
        lifted(model, np.array([3]))
    assert caught.value.where == "nodes"

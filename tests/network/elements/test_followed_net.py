"""Nets that follow their surface: the same as made from nothing; and made anew where what they keep does not hold."""

from __future__ import annotations

import pickle
from functools import lru_cache

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella.base.errors import InputError
from lamella.network.network import SEAM
from lamella.surface.form_finding.followed_film import FollowedFilm


def rim(height: float = 2.5, turn: float = 0.0) -> lamella.Loop:
    """A saddle-shaped ellipse whose film with a ring inside has two umbilics."""
    t = 2 * np.pi * np.arange(24) / 24
    shape = [6 * np.cos(t), 4.5 * np.sin(t), height - height * np.cos(2 * t + turn)]
    return lamella.spline(np.column_stack(shape))


OCULUS = lamella.circle((0, 0, 2.0), 1.3)


@lru_cache
def first_film() -> FollowedFilm:
    return lamella.follow([rim(), OCULUS], tolerance=3e-2)


@lru_cache
def first_net() -> lamella.FollowedNet:
    return lamella.follow_net(first_film().surface, cells=16)


def alike(one: lamella.Network, other: lamella.Network) -> float:
    """Largest distance of the nodes of two nets but for those on seams, m."""
    points = [net.node_points[net.node_kinds != SEAM] for net in (one, other)]
    assert len(points[0]) == len(points[1])
    return float(cKDTree(points[0]).query(points[1])[0].max())


def test_the_first_net_is_that_of_its_surface() -> None:
    net, wanted = first_net().network, lamella.net(first_film().surface, cells=16)
    assert net.allclose(wanted, 0.0)


def test_a_followed_net_is_that_of_its_surface() -> None:
    """Umbilics, lattice and nodes are those found from nothing on the same surface."""
    film = first_film().at([rim(2.47), OCULUS])
    net = first_net().at(film.surface)
    assert net.made_anew == ""
    wanted = lamella.net(film.surface, cells=16)
    assert net.network.step == pytest.approx(wanted.step, rel=1e-6)
    assert alike(net.network, wanted) < 1e-4
    assert np.median(cKDTree(wanted.node_points).query(net.network.node_points)[0]) < 1e-5
    for key in ("node_angle_deviation_max_deg", "normal_curvature_deviation_max", "isothermic_residual"):
        assert net.network.figures[key] == pytest.approx(wanted.figures[key], rel=0.05)


def test_no_change_moves_the_first_net() -> None:
    film, net = first_film(), first_net()
    draws = np.random.default_rng(5)
    for _ in range(6):
        height, turn = draws.normal(size=2) * [0.03, 0.01]
        film = film.at([rim(2.5 + height, turn), OCULUS])
        net = net.at(film.surface)
        assert net.made_anew == ""
    back = net.at(film.at([rim(), OCULUS]).surface)
    assert np.array_equal(back.coordinates.value, first_net().coordinates.value)
    assert np.array_equal(back.lines.points, first_net().lines.points)


def test_level_lines_lie_on_the_lamellas() -> None:
    """Every sample of the net's lamellas is on a line of its family, to the sag of the polylines."""
    net = first_net()
    lines, network = net.lines, net.network
    family = np.repeat(lines.families, np.diff(lines.offsets))
    for which in "AB":
        mine = np.flatnonzero(family[:-1] == which)
        mine = mine[~np.isin(mine + 1, lines.offsets)]
        begin, end = lines.points[mine], lines.points[mine + 1]
        # between the corners as well
        share = np.linspace(0, 1, 33)[:, None, None]
        along = (begin + share * (end - begin)).reshape(-1, 3)
        samples = network.sample_points[np.repeat(network.families == which, np.diff(network.sample_offsets))]
        assert cKDTree(along).query(samples)[0].max() < 0.05


def test_what_does_not_hold_is_made_anew() -> None:
    """Other elements; and a rim so low that the umbilics are elsewhere among the elements."""
    film = first_film()
    other = lamella.follow([rim(), OCULUS], tolerance=5e-2, order=3)
    net = first_net().at(other.surface)
    assert "other elements" in net.made_anew
    assert net.at(film.surface).made_anew == ""
    low = film.at([rim(1.6), lamella.circle((0, 0, 1.6), 1.3)])
    assert low.made_anew == ""
    moved = first_net().at(low.surface)
    assert "umbilic" in moved.made_anew
    assert len(moved.umbilics.orders) == len(low.surface.umbilics.orders)


def test_spacing_rounding_and_principal_lines() -> None:
    film = first_film()
    moved = film.at([rim(2.48), OCULUS])
    for request in ({"spacing": 1.2}, {"cells": 10, "closing": "round", "kind": "principal"}):
        net = lamella.follow_net(film.surface, **request)
        there = net.at(moved.surface)
        assert there.made_anew == ""
        if "spacing" in request:
            assert there.step == net.step
            assert np.median(there.network.cell_edges) == pytest.approx(1.2, rel=0.15)
        else:
            wanted = lamella.net(moved.surface, **request)
            assert alike(there.network, wanted) < 1e-4


def test_nets_without_umbilics_and_holes() -> None:
    """A catenoid's net closes on itself whatever its height; that of a saddle has no hole."""

    def rings(height: float) -> list[lamella.Loop]:
        return [lamella.circle((0, 0, z), 3.0) for z in (0.0, height)]

    film = lamella.follow(rings(2.5), tolerance=3e-2)
    net = lamella.follow_net(film.surface, cells=12)
    there = net.at(film.at(rings(2.6)).surface)
    assert there.made_anew == ""
    assert there.network.figures["closed"]
    wanted = lamella.net(there.surface, cells=12)
    assert alike(there.network, wanted) < 1e-6
    assert np.array_equal(there.network.node_kinds, wanted.node_kinds)


def test_pickles_prints_and_refuses() -> None:
    net = pickle.loads(pickle.dumps(first_net()))
    film = first_film().at([rim(2.49), OCULUS])
    there = net.at(film.surface)
    assert there.made_anew == ""
    assert np.array_equal(there.coordinates.value, first_net().at(film.surface).coordinates.value)
    assert "2 umbilics" in repr(net)
    assert "lines of" in repr(net.lines)
    with pytest.raises(InputError) as refused:
        lamella.follow_net(lamella.Catenoid(1.0, (-1.0, 1.0)))  # type: ignore[arg-type]
    assert refused.value.where == "surface"
    with pytest.raises(InputError) as both:
        lamella.follow_net(film.surface, cells=12, spacing=0.5)
    assert both.value.where == "spacing"

"""Scattered borders: found, smoothed to less scatter, and exact ones of whatever shape left alone."""

from functools import cache

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lamella.surface.boundary.scatter import smooth_scatter


def circle(a):
    return np.column_stack((np.cos(a), np.sin(a), 0 * a))


def saddle(a):
    return np.column_stack((12 * np.cos(a), 9 * np.sin(a), 2.5 - 2.5 * np.cos(2 * a)))


def clover(a):
    return (2 + np.cos(3 * a))[:, None] * circle(a) + np.column_stack((0 * a, 0 * a, 0.3 * np.sin(2 * a)))


def loop(form, count, seed, uneven=0.3):
    turn = 2 * np.pi * (np.arange(count) + uneven * np.random.default_rng(seed).uniform(-1, 1, count)) / count
    points = form(turn)
    return points, float(np.linalg.norm(np.diff(points, axis=0), axis=1).mean())


@cache
def finely(form):
    """The curve at 400,001 places, to be searched."""
    return cKDTree(form(np.linspace(0, 2 * np.pi, 400_001)))


def off(form, points):
    return float(np.sqrt((finely(form).query(points)[0] ** 2).mean()))


@pytest.mark.parametrize("form", [circle, saddle, clover])
@pytest.mark.parametrize("count", [6, 12, 24, 48, 240])
@pytest.mark.parametrize("seed", range(4))
def test_exact_loops_stay_as_they_are(form, count, seed):
    """Points on a smooth curve are moved by less than 0.2 % of their distance when scatter is looked for."""
    points, edge = loop(form, count, seed)
    smooth, _, move = smooth_scatter(points, np.zeros(count, bool))
    assert off(form, smooth) < 2e-3 * edge
    assert move < 2e-3 * edge


@pytest.mark.parametrize("form", [circle, saddle])
@pytest.mark.parametrize("part", [1e-3, 1e-2])
@pytest.mark.parametrize("count", [60, 120, 240])
def test_scatter_is_measured_and_reduced(form, part, count):
    points, edge = loop(form, count, 7, uneven=0.0)
    given = points + part * edge * np.random.default_rng(8).normal(size=points.shape)
    smooth, scatter, move = smooth_scatter(given, np.zeros(count, bool))
    # across the curve: two of the three coordinates
    assert scatter == pytest.approx(np.sqrt(2) * part * edge, rel=0.3)
    assert off(form, smooth) < 0.9 * off(form, given)
    assert move < 5 * scatter
    if form is circle:
        # a spline through them bends by their second differences over the square of the edge
        bend = [np.sqrt((np.diff(p[:, 2], 2) ** 2).mean()) for p in (given, smooth)]
        assert bend[1] < 0.3 * bend[0]


def test_corners_stay_and_straight_sides_become_straight():
    side = np.linspace(0, 1, 31)[:-1]
    sides = ((side, 0 * side), (1 + 0 * side, side), (1 - side, 1 + 0 * side), (0 * side, 1 - side))
    flat = np.concatenate([np.column_stack(pair) for pair in sides])
    points = np.column_stack((flat, np.zeros(len(flat))))
    corner = np.arange(len(points)) % 30 == 0
    given = points + 3e-4 * np.random.default_rng(3).normal(size=points.shape) * ~corner[:, None]
    smooth, scatter, _ = smooth_scatter(given, corner)
    assert (smooth[corner] == points[corner]).all()
    assert scatter == pytest.approx(4e-4, rel=0.5)
    assert np.abs(smooth[:, 2]).max() < 0.7 * np.abs(given[:, 2]).max()

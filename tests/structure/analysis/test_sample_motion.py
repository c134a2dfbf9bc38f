"""Samples of a net in a pose of its model: rigid motions, nodes, and the rate with which elements follow a curve."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from lamella.base.material import Material
from lamella.strip.lamellas import Section
from lamella.structure.analysis.sample_motion import SampleMotion
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import exponential
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from structure.model.nets import PATCH, pinned_rim
from structure.strips import STRIP, orders, strip

STEEL = Material(7850, 210e9, 81e9, 355e6)
SAMPLES = np.arange(len(PATCH.sample_points))


def model(**rules):
    section = Section(layers=1 if rules.get("layers") is None else 2)
    return make_model(PATCH.strips(section, STEEL), pinned_rim(PATCH), ModelRules(**({"elements": 2} | rules)))


@pytest.mark.parametrize("rules", [{}, {"joints": "hinged"}, {"layers": "each"}])
def test_rigid_motion(rules):
    motion = SampleMotion.of(shape := model(**rules), SAMPLES)
    poses = shape.structure.poses
    still, normals = motion.at(poses)
    assert np.abs(still - PATCH.sample_points).max() < 1e-12
    assert np.abs(normals - PATCH.sample_normals).max() < 1e-12
    turn = exponential(np.array([[0.5, -1.2, 2.0]]))[0]
    moved = replace(poses, points=poses.points @ turn.T + [3.0, 0, 1.0], frames=turn @ poses.frames)
    places, turned = motion.at(moved)
    assert np.abs(places - (PATCH.sample_points @ turn.T + [3.0, 0, 1.0])).max() < 1e-12
    assert np.abs(turned - PATCH.sample_normals @ turn.T).max() < 1e-12


def test_elements_follow_an_arc():
    """A straight strip bent and twisted to a helix, which is no stretch: fourth order, and exact at the elements' ends;
    the normals second order."""
    bend, twist = 0.8, 0.5
    turn = np.hypot(bend, twist)
    axis = np.array([twist, 0, bend]) / turn
    errors = []
    for elements in (2, 4, 8):
        line = strip(elements, 2.0, STRIP, {0: "all"})
        share = np.linspace(0, 1, 9)
        place = (np.arange(elements)[:, None] + share).ravel() * 2.0 / elements
        points = np.stack((place, 0 * place, 0 * place), 1)
        up = np.tile([0.0, 0, 1], (len(place), 1))
        of_element, lengths = np.repeat(np.arange(elements), 9), np.full(len(place), 2.0 / elements)
        model = SimpleNamespace(structure=line)
        motion = SampleMotion(model, points, up, of_element, np.tile(share, elements), lengths)

        def helix(s):
            frames = exponential(turn * s[:, None] * axis)
            along = axis[0] * axis
            across, side = np.array([1.0, 0, 0]) - along, np.cross(axis, [1.0, 0, 0])
            angle = turn * s[:, None]
            return along * s[:, None] + (np.sin(angle) * across + (1 - np.cos(angle)) * side) / turn, frames

        poses = Poses(*helix(np.linspace(0, 2.0, elements + 1)), np.zeros(0))
        (places, normals), (exact, frames) = motion.at(poses), helix(place)
        ends = np.isin(motion.share, (0, 1))
        assert np.abs(places - exact)[ends].max() < 1e-14
        errors.append((np.abs(places - exact).max(), np.abs(normals - frames[:, :, 2]).max()))
    by_place, by_normal = np.array(errors).T
    assert np.allclose(orders(by_place), 4, atol=0.2)
    assert np.allclose(orders(by_normal), 2, atol=0.2)


def test_values_between_ends():
    shape = model()
    motion = SampleMotion.of(shape, SAMPLES)
    own = np.repeat(np.arange(len(PATCH.ids)), np.diff(PATCH.sample_offsets))
    found = motion.values(shape.lines.arclengths + 10.0 * shape.lines.lamella[:, None])
    assert np.abs(found - (PATCH.sample_arclengths + 10.0 * own)).max() < 1e-12

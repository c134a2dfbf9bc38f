"""Edge beams in the model: sections, no stress as they stand, corners, rings against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

import lamella
from lamella.base.material import MATERIALS
from lamella.hardware.beam_axes import edge_beam_axes
from lamella.hardware.edge_rules import EdgeBeamRules
from lamella.hardware.make_hardware import half_joint_of
from lamella.hardware.rules import JointRules
from lamella.strip.lamellas import Section
from lamella.structure.actions.load_case import no_load
from lamella.structure.analysis.analyse import analyse
from lamella.structure.loads import no_loads
from lamella.structure.model.beam_sections import edge_section
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from structure.model.nets import PATCH, central_node, held_at, pushed

S355 = MATERIALS["S355"]


def with_beams(network, **measures):
    """The strips, and the model's edge beams along the first loops."""
    strips = network.strips(Section(), "S355")
    joints = JointRules()
    rules = dict.fromkeys(range(4), EdgeBeamRules(material="S355", **measures))
    return strips, edge_beam_axes(strips, rules, joints, half_joint_of(strips, joints))


def test_sections():
    """Round tubes and flat bars by their textbook formulas."""
    tube = edge_section(EdgeBeamRules(section="tube 60.3x3.2").beam, S355)
    # EN 10219-2, annex B: 60.3 x 3.2
    assert tube.area == pytest.approx(5.74e-4, rel=1e-3)
    assert tube.section.bending_u / S355.youngs_modulus == pytest.approx(23.5e-8, rel=2e-3)
    assert tube.modulus_u == pytest.approx(7.78e-6, rel=2e-3)
    assert tube.modulus_t == pytest.approx(15.6e-6, rel=3e-3)
    flat = edge_section(EdgeBeamRules(section=None, flat=(0.1, 0.01)).beam, S355)
    assert flat.area == pytest.approx(1e-3)
    assert flat.modulus_u == pytest.approx(0.01 * 0.1**2 / 6)
    assert flat.modulus_n == pytest.approx(0.1 * 0.01**2 / 6)
    # alpha h t^2 with alpha = 0.312 of ten to one (S. Timoshenko, Strength of Materials II)
    assert flat.modulus_t == pytest.approx(0.312 * 0.1 * 0.01**2, rel=5e-3)
    assert flat.section.helix == flat.section.gyration == 0


@pytest.mark.parametrize("measures", [{}, {"section": None, "flat": (0.1, 0.01)}])
def test_edge_beams_stand_without_stress_and_hold_the_net(measures):
    strips, axes = with_beams(PATCH, **measures)
    supports = held_at(PATCH, central_node(PATCH))
    model = make_model(strips, supports, ModelRules(elements=2), edge_beams=axes)
    first = len(model.lines.length)
    structure = model.structure
    designed = no_loads(structure).state(structure, 0.0, structure.poses)
    assert np.abs(designed.beams.strains.values[:, first:]).max() < 1e-12
    # all around, in one piece
    length = structure.beams.law.length[first:].sum()
    rim = sum(axis.piece.length for axis in axes.axes)
    assert length == pytest.approx(rim, rel=0.1)
    assert (np.bincount(model.rims.nodes.ravel())[np.unique(model.rims.nodes)] == 2).all()
    case = pushed(PATCH, (0, 0, 0.0), weight=1.0)
    found = analyse(model, [case], frequencies=0, buckling=1)
    bare = analyse(make_model(strips, supports, ModelRules(elements=2)), [case], frequencies=0, buckling=0)
    assert found.spring_back < 0.1 * bare.spring_back
    assert found.cases[1].edge_utilisation_max > found.cases[0].edge_utilisation_max > 0
    assert bare.cases[1].edge_utilisation_max == 0
    more = length * model.rims.sections[0].section.mass * 9.81
    assert bare.cases[1].load_total[2] - found.cases[1].load_total[2] == pytest.approx(more, rel=1e-6)
    weight, reaction = found.cases[1].load_total, found.cases[1].reaction_total
    assert np.abs(weight + reaction).max() < 1e-8 * np.abs(weight).max()


def test_corners_are_welded():
    """Scherk's saddle tower has four corners: the rim is one closed beam of four pieces."""
    network = lamella.net(lamella.Scherk(1.0, 1.2), cells=12)
    strips, axes = with_beams(network, distance=0.09)
    model = make_model(strips, held_at(network, 0), ModelRules(elements=2), edge_beams=axes)
    assert len(axes.axes) == 4
    nodes, times = np.unique(model.rims.nodes, return_counts=True)
    assert (times == 2).all()
    assert len(nodes) == len(model.rims.nodes)


def test_what_is_warm_all_over_is_not_stressed():
    """Both rims of a catenoid have tubes. Warmed they grow with the net as a whole: no beam takes anything."""
    network = lamella.net(lamella.Catenoid(2.5, (-1.0, 1.5)), cells=12)
    strips, axes = with_beams(network)
    model = make_model(strips, held_at(network, 0), ModelRules(elements=2, slots="whole"), edge_beams=axes)
    case = replace(no_load("warm", len(network.node_points)), temperature=20.0)
    rest, warm = analyse(model, [case], frequencies=0, buckling=0).cases
    assert warm.edge_utilisation_max == pytest.approx(rest.edge_utilisation_max, rel=1e-2)
    grown = warm.displacements - rest.displacements
    points = rest.equilibrium.poses.points[: model.nodes]
    exact = 20 * S355.expansion * (points - points[0])
    assert np.abs(grown - exact).max() < 0.05 * np.abs(exact).max()

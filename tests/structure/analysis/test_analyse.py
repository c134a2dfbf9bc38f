"""Analyses of a net: cases, balance, overload, cables put on later, and mechanisms by name."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from lamella import InputError
from lamella.base.material import Material
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Section
from lamella.structure.actions.load_case import no_load
from lamella.structure.analysis.analyse import analyse
from lamella.structure.analysis.strip_use import strip_use
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import straight_poses
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import no_loads
from lamella.structure.loose_parts import refuse_loose_parts
from lamella.structure.mechanism import MechanismError
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from lamella.structure.structure import make_structure
from structure.model.nets import PATCH, central_node, held_at, pinned_rim, pushed
from structure.strips import STRIP, orders

STEEL = Material(7850, 210e9, 81e9, 355e6)
COARSE = ModelRules(elements=2)


def model(supports=None, rules=COARSE, section=None, cables=None):
    section = Section(layers=1) if section is None else section
    return make_model(PATCH.strips(section, STEEL), supports or pinned_rim(PATCH), rules, cables=cables)


def test_cases_and_what_is_left_of_the_residual_state():
    case = replace(pushed(PATCH, (0, 0, -30.0), weight=1.0), name="snow")
    found = analyse(model(), [case], buckling=2, frequencies=2)
    rest, snow = found.cases
    assert (rest.name, snow.name, snow.converged, snow.stable, found.free_body) == (
        "residual",
        "snow",
        True,
        True,
        False,
    )
    assert np.abs(snow.load_total + snow.reaction_total).max() < 1e-9 * np.abs(snow.load_total).max()
    assert rest.load_factor == snow.load_factor == 1.0
    assert rest.residual_share == 1.0
    assert 0 < snow.residual_share < 1
    largest = np.unravel_index(snow.use.von_mises.argmax(), snow.use.von_mises.shape)
    assert snow.residual_share * snow.von_mises_max == pytest.approx(rest.use.von_mises[largest], rel=1e-12)
    by = np.linalg.norm(snow.displacements - rest.displacements, axis=1)
    assert snow.deflection_max == by.max()
    # buckling: the load at which it does is the same from two loads of one direction, to the order of their distance
    assert 1 < snow.buckling[0] <= snow.buckling[1]
    assert len(found.frequencies) == 2


def test_stresses_of_the_designed_shape_are_those_of_the_strips():
    """Before it is let go the net has the strips' own von Mises stress, as nearly as its elements are short."""
    own = PATCH.strips(Section(layers=1), STEEL).von_mises.max()
    errors = []
    for elements in (2, 4, 8, 16):
        shape = model(rules=ModelRules(elements=elements, slots="whole"))
        structure = shape.structure
        designed = Equilibrium(structure, no_loads(structure), 0.0, structure.poses, 0, 0)
        errors.append(strip_use(shape, designed).von_mises.max() / own - 1)
    assert abs(errors[-1]) < 5e-3
    assert abs(errors[-1]) < abs(errors[0]) / 4


def test_pairs_share_forces():
    """Two layers as one line carry twice the load with the same deflection and stress, but for the layers' places."""
    case = pushed(PATCH, (0, 0, -20.0))
    double = pushed(PATCH, (0, 0, -40.0))
    pair = Section(layers=2, offset=0.002, layer_curves="cut")
    one, two = analyse(model(), [case]).cases[1], analyse(model(section=pair), [double]).cases[1]
    assert two.deflection_max == pytest.approx(one.deflection_max, rel=1e-6)
    assert two.von_mises_max == pytest.approx(one.von_mises_max, rel=1e-6)
    assert two.buckling == pytest.approx(one.buckling, rel=1e-5)


def test_overload_is_told_by_the_load_factor_that_was_reached():
    case = pushed(PATCH, (0, 0, -2e6))
    _, over = analyse(model(), [case], frequencies=0).cases
    assert not over.converged
    assert 0 <= over.load_factor < 1
    assert f"{over.equilibrium.factor:.6g}" in over.reason
    assert np.isfinite([over.displacement_max, over.von_mises_max, over.utilisation_max, over.residual_share]).all()
    # linear buckling about the last stable state says about where
    assert 0 < over.buckling[0] < 1


def test_cables_put_on_later_have_their_prestress_there():
    rules = CableRules(every=2, diameter=0.006, prestress=400.0)
    later = analyse(model(), cables_later=rules, frequencies=0)
    at_once = analyse(model(cables=rules), frequencies=0)
    forces = later.cases[0].cable_forces
    # what cables pull on gives way, and takes force from them
    assert forces.min() > 0
    assert forces.max() < 2.2 * 400
    assert len(forces) == len(at_once.cases[0].cable_forces)
    assert later.cases[0].slack == 0
    assert later.spring_back > at_once.spring_back * 0.5


def test_a_net_without_supports_is_let_go_and_not_loaded():
    nothing = held_at(PATCH, [])
    free = analyse(model(nothing), frequencies=0)
    assert free.free_body
    held = analyse(model(held_at(PATCH, central_node(PATCH))), frequencies=0)
    assert free.spring_back == pytest.approx(held.spring_back, rel=1e-9)
    assert np.abs(free.cases[0].reaction_total).max() < 1e-5
    with pytest.raises(InputError) as refused:
        analyse(model(nothing), [pushed(PATCH, (0, 0, -1.0))])
    assert refused.value.where == "supports"


@pytest.mark.parametrize(
    ("nodes", "ways", "free"),
    [([0], slice(0, 3), "turns about"), ([0, 5, 20], slice(0, 2), "moves along z"), ([0, 5, 20], slice(2, 3), "moves")],
)
def test_mechanisms_are_named(nodes, ways, free):
    with pytest.raises(InputError) as refused:
        analyse(model(held_at(PATCH, nodes, ways)))
    assert refused.value.where == "supports"
    assert free in refused.value.message


def test_two_points_leave_one_rotation():
    """About the line between them, whatever its direction."""
    with pytest.raises(InputError) as refused:
        analyse(model(held_at(PATCH, [0, 40], slice(0, 3))))
    assert "turns about" in refused.value.message


def test_a_part_that_is_not_connected():
    """The second of two strips end to end without a common node."""
    poses = straight_poses(2.0, 3)
    structure = make_structure(poses, make_beams([[0, 1], [2, 3]], 2 / 3, STRIP), {0: "all", 3: "x y z rx"})
    with pytest.raises(MechanismError) as refused:
        refuse_loose_parts(structure)
    assert refused.value.node in (2, 3)
    refuse_loose_parts(make_structure(poses, make_beams([[0, 1], [2, 3]], 2 / 3, STRIP), {0: "all", 3: "all"}))


def test_settlement_moves_what_is_held():
    """Supports that all settle alike move the net with them and leave its stresses."""
    case = no_load("settled", len(PATCH.node_points))
    settlements = np.zeros_like(case.settlements)
    settlements[:, 2] = -0.05
    found = analyse(model(), [replace(case, settlements=settlements)])
    rest, settled = found.cases
    assert settled.displacements - rest.displacements == pytest.approx(
        np.broadcast_to([0, 0, -0.05], settled.displacements.shape), abs=1e-8
    )
    assert settled.von_mises_max == pytest.approx(rest.von_mises_max, rel=1e-6)


def test_temperature_moves_a_net_on_one_node_as_a_whole():
    """Held at one node it grows by alpha T in all directions about that node, and no stress changes."""
    supports = held_at(PATCH, central_node(PATCH))
    case = replace(no_load("warm", len(PATCH.node_points)), temperature=30.0)
    rest, warm = analyse(model(supports), [case], frequencies=0).cases
    points = rest.equilibrium.poses.points[: len(PATCH.node_points)]
    grown = warm.displacements - rest.displacements
    exact = STEEL.expansion * 30.0 * (points - points[central_node(PATCH)])
    assert grown == pytest.approx(exact, abs=2e-2 * np.abs(exact).max())
    assert warm.von_mises_max == pytest.approx(rest.von_mises_max, rel=1e-3)
    assert np.abs(warm.reaction_total).max() < 1e-5


def test_stresses_converge_under_load():
    """At the nodes, of 2, 4, 8 and 16 elements a cell: with the second order of elements that are twisted."""
    case = pushed(PATCH, (0, 0, -30.0))
    found = []
    for elements in (2, 4, 8, 16):
        shape = model(rules=ModelRules(elements=elements, slots="whole"))
        stress = analyse(shape, [case], buckling=0, frequencies=0).cases[1].use.von_mises
        found.append(stress[::elements, 0].copy())
    steps = [np.sqrt(np.mean((b - a) ** 2)) for a, b in pairwise(found)]
    assert orders(steps)[-1] > 1.6
    assert steps[1] < 3e-3 * found[-1].max()


def test_a_case_that_needs_too_many_steps_ends_with_what_it_has(monkeypatch):
    """The state that was reached is one of equilibrium, and its share of the load is told."""
    monkeypatch.setattr("lamella.structure.analysis.analyse.FURTHER_STEPS", 1)
    told = []
    _, case = analyse(model(), [pushed(PATCH, (0, 0, -30.0))], frequencies=0, steps=4, progress=told.append).cases
    assert case.converged
    monkeypatch.setattr("lamella.structure.analysis.analyse.FURTHER_STEPS", -2)
    _, case = analyse(model(), [pushed(PATCH, (0, 0, -30.0))], frequencies=0, steps=4, progress=told.append).cases
    assert (case.converged, case.load_factor) == (False, 0.5)
    assert np.abs(case.load_total + case.reaction_total).max() < 1e-9 * np.abs(case.load_total).max()
    assert any("0.5 of the load" in report.text for report in told)

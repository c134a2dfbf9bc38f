"""Nets laid flat and driven to their designed shape, by the beam model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import islice
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError, Section
from lamella.erection import erect as erect_module
from lamella.erection.cut import proposed_cut
from lamella.erection.erect import erect
from lamella.erection.erection import Erection
from lamella.erection.flat_shape import FlatShape
from lamella.erection.free_net import free_net
from lamella.erection.laid_flat import laid_flat
from lamella.erection.samples import sampled
from lamella.strip.stress import shortening
from lamella.structure.beam.beams import make_beams
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import no_loads
from lamella.structure.static import at_rest
from validation.measure_network import arc_length, derivatives

PATCH = lamella.Enneper(2, 0.6, 3.0)
STRIP = Section(0.1, 0.0015, layers=1)


@cache
def erected(elements: int = 2, states: int = 9, section: Section = STRIP) -> Erection:
    """A patch of Enneper's surface of 14 m2 in one layer, its strips 58 m long."""
    return erect(lamella.net(PATCH, spacing=0.45).strips(section), states=states, elements=elements)


def test_flat_state() -> None:
    """It lies in a plane without twist and strong-axis bending, and by symmetry the mean angle is 90 degrees."""
    made = erected()
    first = made.states[0]
    assert made.flat.height == 0.0
    assert made.flat.lies
    assert made.flat.planar
    assert not made.held
    assert not len(made.flat.overlaps)
    assert first.angles.mean() == pytest.approx(90, abs=1e-6)
    assert first.angles.min() + first.angles.max() == pytest.approx(180, abs=1e-6)
    assert max(first.torsion, first.strong_axis) < 1e-3
    # turned by half a turn it is the same
    points = made.flat.plane.project(first.poses.points[: made.model.nodes])
    distance = np.linalg.norm(points[:, None] + points[None], axis=2).min(1)
    assert distance.max() < 1e-6


def test_energy_on_the_way() -> None:
    """It never falls while the net is driven to its shape, and ends below that of locked joints."""
    made = erected()
    energy = [state.energy for state in made.states]
    assert np.all(np.diff(energy) > 0)
    assert energy[-1] < made.locked.energy
    assert not made.each_joint
    assert [state.share for state in made.states] == pytest.approx(np.linspace(0, 1, 9), abs=1e-9)
    assert all(state.stable for state in made.states)
    # compliant: strips are bent about their weak axis and twisted
    assert max(state.strong_axis for state in made.states) < 0.05 * made.states[-1].von_mises


@pytest.mark.slow
def test_work_of_the_driver() -> None:
    """On the planar part of the way the change of energy is the driver's work: Simpson's rule, 4th order."""
    gap = []
    for states in (17, 33):
        made = erected(1, states)
        flat = [state for state in made.states if state.height < 1e-9]
        count = (states - 1) // 2
        assert len(flat) > count
        force = np.array([state.driver for state in flat[: count + 1]])
        step = made.driver.span / (states - 1)
        work = step / 3 * (force[0] + 4 * force[1:-1:2].sum() + 2 * force[2:-1:2].sum() + force[-1])
        gap.append(abs(work - (flat[count].energy - flat[0].energy)) / flat[count].energy)
    assert gap[1] < 1e-6
    assert gap[0] / gap[1] > 10


def test_lengths_on_the_way() -> None:
    """Measured from the points of a state, lamellas are shorter by h^2 tg^2 / 24 where they are twisted, and no more.

    A strip's mean fibre keeps its length, so its centre line gets shorter (docs/theory.md).
    """
    made = erected(4)
    network = made.model.lamellas.network
    for state, twisted in ((made.states[0], False), (made.states[-1], True)):
        points, normals = sampled(made.model, state.poses)
        shorter = np.zeros((2, len(network.ids)))
        for number in range(len(network.ids)):
            span = slice(*network.sample_offsets[number : number + 2])
            s = arc_length(points[span])
            unit, _ = derivatives(points[span], s)
            turning, _ = derivatives(normals[span], s)
            tg = -(turning * np.cross(normals[span], unit)).sum(1)
            shorter[:, number] = network.lengths[number] - s[-1], np.trapezoid(shortening(STRIP.height, tg), s)
        if twisted:
            assert shorter[0].sum() == pytest.approx(shorter[1].sum(), rel=0.02)
            assert shorter[0].sum() > 1e-3
        else:
            assert np.abs(shorter[0] / network.lengths).max() < 1e-6
            assert np.ptp(points @ made.flat.plane.axes[2]) < 1e-9


@pytest.mark.slow
def test_spring_back_of_finer_elements() -> None:
    """Locked joints and nothing else: the net springs back by decimetres, found to the second order in the elements."""
    back = [erected(elements, 2).spring_back for elements in (2, 4, 8)]
    assert back[-1] == pytest.approx(0.391, abs=0.002)
    assert (back[0] - back[1]) / (back[1] - back[2]) == pytest.approx(4, rel=0.2)


def test_all_layers_together() -> None:
    """Layers that slip on one another: twice the energy and driver, the same shape and the same stresses."""
    one, two = erected(1, 5), erected(1, 5, replace(STRIP, layers=2))
    for a, b in zip(one.states, two.states, strict=True):
        assert b.energy == pytest.approx(2 * a.energy, rel=1e-6)
        assert b.driver == pytest.approx(2 * a.driver, rel=1e-6, abs=1e-6)
        np.testing.assert_allclose(b.angles, a.angles, atol=1e-5)
        for kind in ("bending", "torsion", "helix", "von_mises"):
            assert getattr(b, kind) == pytest.approx(getattr(a, kind), rel=1e-5, abs=1.0)


def test_moved_and_turned() -> None:
    """A net elsewhere in space is erected alike."""
    net = lamella.net(PATCH, spacing=0.45)
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    moved = replace(
        net,
        node_points=net.node_points @ turn.T + [40, -7, 3],
        node_normals=net.node_normals @ turn.T,
        sample_points=net.sample_points @ turn.T + [40, -7, 3],
        sample_normals=net.sample_normals @ turn.T,
        sample_tangents=net.sample_tangents @ turn.T,
    )
    here, there = erected(1, 3), erect(moved.strips(STRIP), states=3, elements=1)
    for a, b in zip(here.states, there.states, strict=True):
        assert b.energy == pytest.approx(a.energy, rel=1e-7)
        np.testing.assert_allclose(b.angles, a.angles, atol=1e-5)
    assert there.flat.size == pytest.approx(here.flat.size, rel=1e-6)


def test_arcs_lie_on_a_sphere() -> None:
    """Strips cut to the radius 1/H are free of strong-axis bending and twist on the sphere of that radius alone.

    They lie on it but for what they gain by a little twist: for 1 m of the net's size a few tenths of a millimetre.
    """
    loop = lamella.spline(
        [
            [3, 0, 0],
            [2, 2.4, 0.5],
            [0, 2.8, 0],
            [-2.2, 2, 0.4],
            [-3, 0, 0],
            [-2, -2, 0.5],
            [0, -2.8, 0],
            [2.2, -2.2, 0.3],
        ]
    )
    net = lamella.net(lamella.film([loop], mean_curvature=-0.12), spacing=0.84)
    made = erect(net.strips(Section(0.1, 0.001, layers=1)), states=2, elements=1)
    assert made.flat.lies
    assert not made.flat.planar
    assert made.flat.radius == pytest.approx(1 / 0.12, rel=3e-3)
    assert made.flat.off < 5e-4 * made.model.structure.size
    assert max(made.states[0].strong_axis, made.states[0].torsion) < 0.05 * made.states[0].bending


@pytest.mark.slow
def test_arcs_without_stiffness_about_their_weak_axis_lie_on_the_sphere() -> None:
    """What a net is off the sphere of radius 1/H, and that sphere's own radius, go to zero with that stiffness: half of
    it, half of them. Bent about the weak axis strips gain by a little twist, which the sphere has not."""
    loop = [
        [3, 0, 0],
        [2, 2.4, 0.5],
        [0, 2.8, 0],
        [-2.2, 2, 0.4],
        [-3, 0, 0],
        [-2, -2, 0.5],
        [0, -2.8, 0],
        [2.2, -2.2, 0.3],
    ]
    net = lamella.net(lamella.film([lamella.spline(loop)], mean_curvature=-0.12), spacing=0.84)
    model = free_net(net.strips(Section(0.1, 0.001, layers=1)), 2)
    off, larger = [], []
    for soft in (1.0, 0.5, 0.25):
        beams = model.structure.beams
        attachment, law = beams.attachment, beams.law
        kinds = tuple(replace(kind, bending_n=soft * kind.bending_n) for kind in beams.sections)
        softer = make_beams(
            attachment.nodes,
            law.length,
            kinds,
            section=beams.section,
            natural=law.natural,
            turns=attachment.turns,
            offsets=attachment.offsets,
            joints=attachment.joints,
        )
        free = replace(model.structure, beams=softer)
        locked = at_rest(replace(free, held_joints=np.ones_like(free.held_joints)), no_loads(free))
        flat = FlatShape.of(replace(model, structure=free), laid_flat(locked, free).poses)
        off.append(flat.off)
        larger.append(flat.radius - 1 / 0.12)
    assert [off[0] / off[1], off[1] / off[2]] == pytest.approx([2, 2], rel=0.1)
    assert [larger[0] / larger[1], larger[1] / larger[2]] == pytest.approx([2, 2], rel=0.1)


@pytest.mark.slow
def test_a_net_that_closes_around_is_named() -> None:
    made = erect(lamella.net(lamella.Catenoid(1.0, (-1.5, 1.5)), cells=6).strips(STRIP), states=3, elements=1)
    assert "not_flat" in {warning.key for warning in made.warnings}
    assert not made.flat.lies


@pytest.mark.slow
def test_states_of_a_net_that_its_driver_lets_go() -> None:
    """Every joint is turned to its own angle, in proportion, and the last state is the locked one."""
    net = lamella.net(lamella.Helicoid(3.0, 0.3, 2.0, 0.6), cells=8)
    made = erect(net.strips(STRIP), states=4, elements=1)
    assert made.each_joint
    assert "each_joint_turned" in {warning.key for warning in made.warnings}
    first, last = made.states[0], made.states[-1]
    for state in made.states:
        np.testing.assert_allclose(state.angles, first.angles + state.share * (last.angles - first.angles), atol=1e-6)
    assert last.energy == pytest.approx(made.locked.energy, rel=1e-9)


def test_fewer_than_two_states() -> None:
    with pytest.raises(InputError) as caught:
        erect(lamella.net(PATCH, spacing=0.6).strips(STRIP), states=1)
    assert caught.value.where == "states"


def test_a_state_prints_in_a_line() -> None:
    made = erected()
    assert "planar" in repr(made)
    assert "J" in repr(made.states[0])


def test_what_was_reached_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """A way that ends before: named with place and step, the states up to there and the flat one kept."""
    whole = erect_module.turned_states

    def ending(*given: Any) -> Iterator[Equilibrium]:
        yield from islice(whole(*given), 3)
        raise InputError("no equilibrium", "", "loads")

    monkeypatch.setattr(erect_module, "turned_states", ending)
    # as if the driver alone let the net go
    monkeypatch.setattr(erect_module, "LET_GO", -1.0)
    net = lamella.net(PATCH, spacing=0.9)
    made = erect(net.strips(STRIP), states=5, elements=1)
    assert made.stop is not None
    assert [state.share for state in made.states] == pytest.approx([0, 0.5, 0.75, 1], abs=1e-9)
    assert made.stop.share == pytest.approx(0.5)
    # numbered from the flat one on
    assert made.stop.state == 2
    assert 0 <= made.stop.node < len(net.node_points)
    (warning,) = [text for text in made.warnings if text.key == "driver_stops"]
    assert "50 %" in warning
    assert f"node {made.stop.node}" in warning


@pytest.mark.slow
def test_a_cut_is_proposed_where_a_flat_net_overlaps() -> None:
    """A net with a hexagonal node, 540 degrees of cells around it: cut, far fewer of its lamellas overlap."""
    net = lamella.net(lamella.Enneper(3, 1.2, 2.0), cells=8)
    section = Section(0.06, 0.001, layers=1)
    made = erect(net.strips(section), states=2, elements=1)
    assert len(made.flat.overlaps)
    assert "flat_overlaps" in {warning.key for warning in made.warnings}
    cut = proposed_cut(made, lambda part: part.strips(section))
    assert cut is not None
    assert cut.lamella in net.ids
    assert cut.parts >= 1
    assert cut.left is not None
    assert cut.left < 0.5 * len(made.flat.overlaps)
    # where nothing overlaps there is nothing to cut
    assert proposed_cut(erected(1, 3), lambda part: part.strips(STRIP)) is None

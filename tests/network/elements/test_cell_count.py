"""What `cells` and `spacing` mean on surfaces that are found: films with holes, umbilics beside them, tubes, discs."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from lamella import InputError
from lamella.network.elements.cell_count import CellCount, curves_ending
from lamella.network.elements.element_network import ElementNetwork, NetPlan, element_network, plan_net
from lamella.network.isothermic.holonomy import holonomies
from lamella.network.network import BOUNDARY
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.boundary import Loop, make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.find import find_film

TURN = 2 * np.pi * np.arange(16) / 16


def rim(points: np.ndarray) -> Loop:
    return make_loop("rim", closed_spline(points))


@cache
def surface(name: str) -> ElementSurface:
    """Films of one kind each; the number tells how many umbilics they have."""
    if name == "regular 2":
        # DESIGN section 4
        outer = np.stack([6 * np.cos(TURN), 4.5 * np.sin(TURN), 2.5 - 2.5 * np.cos(2 * TURN)], 1)
        loops = (rim(outer), make_loop("oculus", circle(np.array([0, 0, 2.0]), 1.3, np.array([0, 0, 1.0]))))
    elif name == "four 4":
        # fourfold symmetric: four umbilics on one ring, a quarter of the period apart
        fine = 2 * np.pi * np.arange(32) / 32
        outer = np.stack([5 * np.cos(fine), 5 * np.sin(fine), 0.9 * np.cos(4 * fine)], 1)
        loops = (rim(outer), make_loop("oculus", circle(np.array([0, 0, 1.4]), 1.2, np.array([0, 0, 1.0]))))
    elif name in ("turned 3", "turned 4"):
        # the oculus hangs where the film would pass anyway: umbilics beside it turn the directions against its rim
        outer = np.stack(
            [
                5.2 * np.cos(TURN) + 0.1 * np.cos(2 * TURN),
                4.1 * np.sin(TURN),
                1.7 - 1.7 * np.cos(2 * TURN) + 0.15 * np.sin(TURN),
            ],
            1,
        )
        height = 1.7 if name == "turned 3" else 2.0
        loops = (rim(outer), make_loop("oculus", circle(np.array([0.4, -0.2, height]), 1.0, np.array([0, 0, 1.0]))))
    elif name in ("tube 0", "tube 3"):
        wave, tilt = {"tube 0": (0.05, 0.0), "tube 3": (0.12, 0.0)}[name]
        west = np.stack([2 * np.cos(TURN), 1.9 * np.sin(TURN), wave * np.cos(2 * TURN + 1) + 0.2 * np.cos(TURN)], 1)
        reach = 1.7 * (1 + wave * np.cos(3 * TURN))
        east = np.stack([reach * np.cos(TURN), reach * np.sin(TURN), 1.5 + (tilt - wave) * np.cos(2 * TURN)], 1)
        loops = (make_loop("west", closed_spline(west)), make_loop("east", closed_spline(east)))
    elif name == "saddle 2":
        # fairly straight sides, corners up and down: two umbilics on one lamella diagonal
        outer = np.array(
            [[0, 0, 0], [2, 0, 0.35], [4, 0, 1.2], [4, 2, 0.35], [4, 4, 0], [2, 4, 0.35], [0, 4, 1.2], [0, 2, 0.35]]
        )
        loops = (rim(1.2 * outer),)
    else:
        outer = np.stack([3 * np.cos(TURN), 2.5 * np.sin(TURN), 0.6 * np.cos(2 * TURN) + 0.1 * np.cos(TURN)], 1)
        loops = (rim(outer),)
    return find_film(loops, 0.0, tolerance=2e-2).surface("form-found")


FILMS = ("regular 2", "four 4", "turned 3", "turned 4", "tube 0", "tube 3", "saddle 2", "disc 0")


def laid(name: str, **density: float) -> NetPlan:
    return plan_net(surface(name), **density)  # type: ignore[arg-type]


def median(net: ElementNetwork) -> float:
    return float(np.median(net.network.cell_edges))


def all_nodes(net: ElementNetwork) -> bool:
    reported = net.describe()
    return bool(reported["closed"]) and all(one["node"] for one in reported["umbilics"])


def check_spacing(name: str, share: int) -> None:
    assert len(surface(name).umbilics.orders) == int(name[-1])
    spacing = float(np.linalg.norm(np.ptp(surface(name).nodes, axis=0))) / share
    net = laid(name, spacing=spacing)
    made = net.traced(closing="open", minimum_length=0.5)
    closes = all_nodes(made) and len(made.umbilics.orders) > 1
    bound = 0.11 if closes else 0.5 / net.lattice.cells + 0.03
    assert abs(np.log(median(made) / spacing)) < bound
    assert net.lattice.estimated_nodes == pytest.approx(len(made.network.node_points), rel=0.1)


@pytest.mark.parametrize("name", ["turned 4", "tube 3", "saddle 2", "disc 0"])
def test_spacing_is_the_median_cell_edge(name: str) -> None:
    """Within half a lamella of the number around the hole, or across: its share is what a whole number costs.

    A net that closes, with its umbilics on nodes, may cost a tenth.
    """
    check_spacing(name, 22)


@pytest.mark.slow
@pytest.mark.parametrize("share", [18, 30, 50])
@pytest.mark.parametrize("name", FILMS)
def test_spacing_of_all_films(name: str, share: int) -> None:
    """The same on every kind of film, coarse to fine."""
    check_spacing(name, share)


@pytest.mark.parametrize("name", ["regular 2", "turned 3", "turned 4", "tube 0", "tube 3"])
@pytest.mark.few(3)
def test_cells_are_lamellas_that_end_on_the_first_hole(name: str) -> None:
    """Ends of one family on the hole's rim, in network.json: as many as `cells`, but for curves that graze the rim."""
    for cells in (12, 17):
        network = element_network(surface(name), cells=cells, minimum_length=0.0).network
        rim_nodes = surface(name).nodes[surface(name).connectivity.rim_nodes]
        far = [
            np.linalg.norm(
                network.node_points[:, None] - rim_nodes[surface(name).rim_loop == loop].reshape(-1, 3), axis=2
            )
            for loop in (0, 1)
        ]
        on_hole = (far[1].min(1) < far[0].min(1)) & (network.node_kinds == BOUNDARY)
        tips = network.stop_nodes[np.stack([network.stop_offsets[:-1], network.stop_offsets[1:] - 1], 1)]
        ends = [int(on_hole[tips[network.families == family]].sum()) for family in "AB"]
        assert max(ends) == pytest.approx(cells, abs=2)
        assert len(network.node_points) < 4 * cells**2


def test_the_period_counts_where_directions_follow_the_rim() -> None:
    """DESIGN section 4: 12 and 13 cells around the oculus are its period over l0, and nest."""
    for cells in (12, 13, 24):
        net = laid("regular 2", cells=cells)
        chi = net.around[0].shift * (1 + 1j)
        assert max(abs(chi.real), abs(chi.imag)) / net.lattice.step == pytest.approx(cells, abs=1e-9)


def test_curves_that_come_back_count() -> None:
    """Where umbilics turn the directions against the rim, the period is a small part of what ends on it, or none."""
    for name in ("turned 3", "turned 4"):
        net = laid(name, cells=24)
        count = CellCount.of(net.iso, net.around, LAMELLAS)
        assert count.length == max(curves_ending(net.iso, LAMELLAS, 1))
        assert count.net(LAMELLAS) < 0.3 * count.length
        assert count.length / net.lattice.step == pytest.approx(24, abs=0.5)
        # not 24 of what is left over of the period: tens of thousands of nodes
        assert net.lattice.estimated_nodes < 4_000


@pytest.mark.parametrize(("name", "multiple"), [("regular 2", 2), pytest.param("four 4", 4, marks=pytest.mark.slow)])
def test_spacing_puts_umbilics_on_nodes(name: str, multiple: int) -> None:
    """DESIGN sections 2 and 4: the umbilics are a half, or a quarter, of the period apart on one principal line."""
    edge = laid(name, cells=5 * multiple).lattice.edge
    for factor in (0.83, 0.91, 1.0):
        net = laid(name, spacing=edge * factor)
        assert net.lattice.cells % multiple == 0
        assert all_nodes(net.traced(closing="open", minimum_length=0.5))


@pytest.mark.parametrize(
    ("name", "cells"),
    [("regular 2", 13), ("saddle 2", 12), pytest.param("four 4", 18, marks=pytest.mark.slow)],
)
def test_a_number_of_cells_is_kept_and_a_better_density_named(name: str, cells: int) -> None:
    """What the warning names, followed to the letter, leaves nothing to warn of."""
    net = laid(name, cells=cells)
    assert net.lattice.cells == cells
    made = net.traced(closing="open", minimum_length=0.5)
    assert not all_nodes(made)
    assert net.lattice.better_closes
    key, value = net.lattice.advice.split(" closes")[0].split(" = ")
    assert any(net.lattice.advice in warning for warning in made.warnings())
    better = laid(name, **{key: int(value) if key == "cells" else float(value)})
    again = better.traced(closing="open", minimum_length=0.5)
    assert all_nodes(again)
    assert better.lattice.advice == ""
    assert not any("umbilics are no nodes" in warning or "meet itself" in warning for warning in again.warnings())


def test_spacing_needs_room_for_three_cells() -> None:
    """Of the surface, not of the hole's rim; the spacing that is named runs."""
    for name in ("turned 4", "saddle 2", "tube 0"):
        with pytest.raises(InputError) as refused:
            laid(name, spacing=50.0)
        assert refused.value.where == "spacing"
        named = float(refused.value.remedy.split(" at most ")[1].split(" m")[0])
        assert laid(name, spacing=named).traced(closing="open", minimum_length=0.5).network.node_points.size


def test_most_nodes_that_are_named_fit() -> None:
    """Both remedies against too many nodes, followed to the letter."""
    for name in ("turned 4", "tube 0"):
        with pytest.raises(InputError) as refused:
            laid(name, spacing=1e-3)
        least = float(refused.value.remedy.split(" at least ")[1].split(" m")[0])
        assert 400_000 < laid(name, spacing=least).lattice.estimated_nodes <= 520_000
        with pytest.raises(InputError) as refused:
            laid(name, cells=20_000)
        most = int(refused.value.remedy.split("at most ")[1].split(" cells")[0])
        assert 400_000 < laid(name, cells=most).lattice.estimated_nodes <= 520_000


def test_count_of_kept_curves() -> None:
    """Of every second curve the count is that of the whole lattice."""
    kept = Pattern("lamellas", (2, 2))
    whole = laid("regular 2", cells=24)
    assert plan_net(surface("regular 2"), cells=24, pattern=kept).lattice.step == whole.lattice.step
    count = CellCount.of(whole.iso, holonomies(whole.iso), kept)
    assert count.follows_period(kept)
    assert count.step(24, kept) == whole.lattice.step

"""The model of a net: a known patch, closed forms, symmetry, frame indifference, order of convergence."""

from dataclasses import replace

import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.network.network import BOUNDARY, SINGULAR
from lamella.strip.lamellas import Section, make_lamellas
from lamella.structure.actions.load_case import GRAVITY
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import CrossSection
from lamella.structure.beam.plate_action import root_share
from lamella.structure.beam.rotations import exponential
from lamella.structure.loads import make_loads, no_loads
from lamella.structure.model.case_loads import case_loads
from lamella.structure.model.curve_samples import CurveSamples
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from lamella.structure.model.slots import STRIP_LIKE_A_NOTCH, slotted
from lamella.structure.static import at_rest, equilibrium, loaded
from structure.model.nets import PATCH, central_node, held_at, pinned_rim, pushed
from structure.strips import orders, rod, strip

STEEL = lamella.Material(7850, 200e9, 200e9 / (2 * 1.2987), 355e6)
ONE = Section(layers=1)


def springs_back(network, section, rules, change=None) -> float:
    """How far a free body with locked joints moves when it is let go, its middle node held, m."""
    lamellas = network.strips(section, STEEL)
    model = make_model(lamellas, held_at(network, central_node(network)), rules)
    structure = model.structure if change is None else change(model)
    rest = at_rest(structure, no_loads(structure))
    assert rest.negative == 0
    return float(np.linalg.norm(rest.displacements, axis=1).max())


def softened(model):
    """100 x 1.5 mm without the helix term, and with a hundredth of its axial and shear stiffness."""
    b, t, young, shear = 0.1, 0.0015, 200e9, STEEL.shear_modulus
    area, torsion = b * t, b * t**3 / 3 * (1 - 0.63 * t / b)
    soft = CrossSection(
        young * area / 100,
        shear * area / 120,
        shear * area / 120,
        shear * torsion,
        young * t * b**3 / 12,
        young * b * t**3 / 12,
    )
    lines = model.lines
    beams = make_beams(lines.nodes, lines.length, soft, turns=lines.turns, offsets=lines.offsets, joints=lines.joints)
    return replace(model.structure, beams=beams)


def test_a_patch_springs_back():
    """A patch of 89 nodes and 5 m with joints locked at 90 degrees, let go: 0.36 m by another program of the same
    kinematics, with two elements a cell edge, the softened section and no helix term; ours has those too."""
    rules = ModelRules(elements=2, slots="whole")
    assert springs_back(PATCH, ONE, rules, softened) == pytest.approx(0.36, abs=0.005)
    # the elements hardly matter, the helix term does
    fine = [springs_back(PATCH, ONE, replace(rules, elements=n)) for n in (2, 4, 8)]
    assert fine[-1] == pytest.approx(0.392, abs=0.001)
    assert orders(np.diff(fine))[-1] > 1.8


def test_energy_of_the_designed_shape():
    """Of each element's mean curvatures: the integral of the strip's energy along all lamellas, second order."""
    network = lamella.net(lamella.Catenoid(2.5, (-1.0, 1.5)), cells=12)
    lamellas = network.strips(ONE, STEEL)
    kg, tg = network.sample_darboux.kg, network.sample_darboux.tg
    errors = []
    for elements in (1, 2, 4):
        model = make_model(lamellas, pinned_rim(network), ModelRules(elements=elements, slots="whole"))
        section = model.structure.beams.sections[0]
        stretch = section.gyration * tg**2 / 2
        share = root_share(section.plate_rate * kg**2).value
        across = (tg**2 + section.poisson * kg**2) * share
        density = section.axial * stretch**2 + section.torsion * tg**2 + section.bending_n * kg**2
        density = (density + section.helix * across**2) / 2
        step = np.diff(network.sample_arclengths)
        step[network.sample_offsets[1:-1] - 1] = 0.0
        exact = float(((density[1:] + density[:-1]) / 2 * step).sum())
        errors.append(at_start(model).energy / exact - 1)
    assert orders(errors).min() > 1.9
    assert abs(errors[-1]) < 1e-3


def at_start(model):
    structure = model.structure
    return no_loads(structure).state(structure, 0.0, structure.poses)


def test_curves_between_samples():
    """Points and frames of a catenoid's lamella between every second or fourth sample: of the fourth order in their
    distance, where other samples tell what is exact."""
    network = lamella.net(lamella.Catenoid(2.5, (-1.0, 1.5)), cells=12)
    curve = CurveSamples.of_centre_lines(network)
    arc = network.sample_arclengths[: network.sample_offsets[1]]
    some = np.arange(2, len(arc) - 4, 4)
    errors = []
    for skip in (4, 2):
        # with every second one, the samples halfway between
        places = some if skip == 4 else some - 1
        keep = np.arange(0, len(arc), skip)
        fewer = replace(
            network, ids=network.ids[:1], sample_offsets=np.array([0, len(keep)]), sample_arclengths=arc[keep]
        )
        names = ("points", "along", "bending", "normals", "turning")
        coarse = CurveSamples(fewer, *(getattr(curve, name)[keep] for name in names))
        points, frames = coarse.at(np.zeros(len(places), int), arc[places])
        t, n = network.sample_tangents[places], network.sample_normals[places]
        exact = np.stack((t, np.cross(n, t), n), 2)
        errors.append((np.abs(points - network.sample_points[places]).max(), np.abs(frames - exact).max()))
    assert np.log2(np.divide(*errors)).min() > 3.5


def test_a_moved_net_has_a_moved_answer():
    """Frame indifference of the whole model."""
    turn, shift = exponential(np.array([[0.7, -1.1, 0.4]]))[0], np.array([12.0, -7.0, 30.0])
    fields = ("node_points", "node_normals", "sample_points", "sample_normals", "sample_tangents")
    moved = {name: getattr(PATCH, name) @ turn.T for name in fields}
    for name in ("node_points", "sample_points"):
        moved[name] += shift
    found = []
    for network, axes in ((PATCH, np.eye(3)), (replace(PATCH, surface=None, **moved), turn)):
        model = make_model(make_lamellas(network, ONE, STEEL), pinned_rim(network), ModelRules(elements=2))
        loads = case_loads(model, pushed(network, axes @ (3.0, 5.0, -40.0)))
        there = loaded(replace(at_rest(model.structure, loads), loads=loads))
        found.append(there.displacements @ axes)
    assert np.abs(found[0] - found[1]).max() < 1e-9 * np.abs(found[0]).max() + 1e-12 * 30


def test_a_symmetric_structure_has_a_symmetric_answer():
    """Enneper's surface by half a turn about z."""
    model = make_model(PATCH.strips(ONE, STEEL), pinned_rim(PATCH), ModelRules(elements=2))
    loads = case_loads(model, pushed(PATCH, (0, 0, -30.0), weight=1.0))
    there = loaded(at_rest(model.structure, loads))
    turned = PATCH.node_points * [-1, -1, 1]
    partner = np.linalg.norm(turned[:, None] - PATCH.node_points, axis=2).argmin(1)
    shifts = there.displacements[: model.nodes]
    assert np.abs(shifts[partner] - shifts * [-1, -1, 1]).max() < 1e-7 * np.abs(shifts).max()


def test_reactions_balance_loads():
    network, rules = PATCH, ModelRules(elements=2)
    lamellas = network.strips(Section(), STEEL)
    supports = pinned_rim(network)
    springs = np.zeros_like(supports.springs)
    springs[central_node(network), :3] = 1e4
    model = make_model(lamellas, replace(supports, springs=springs), rules, cables=None)
    case = pushed(network, (3.0, -2.0, -20.0), weight=1.35)
    loads = case_loads(model, case)
    there = loaded(at_rest(model.structure, loads))
    mass = 2 * 7850 * 0.1 * 0.0015 * network.lengths.sum()
    whole = case.node_forces.sum(0) + mass * GRAVITY * case.self_weight
    assert there.reactions[:, :3].sum(0) == pytest.approx(-whole, rel=1e-9, abs=1e-9 * mass * GRAVITY)


@pytest.mark.parametrize("marks", ["relaxed", "arc-length"])
def test_deflection_converges(marks):
    """2 to 16 elements a cell: towards the second order of elements that are twisted, and near with a few."""
    lamellas = PATCH.strips(Section(layers=1, marks=marks), STEEL)
    found = []
    for elements in (2, 4, 8, 16):
        model = make_model(lamellas, pinned_rim(PATCH), ModelRules(elements=elements, slots="whole"))
        loads = case_loads(model, pushed(PATCH, (0, 0, -20.0), nodes=[central_node(PATCH)]))
        rest = at_rest(model.structure, loads)
        there = loaded(rest)
        found.append((there.displacements - rest.displacements)[central_node(PATCH), 2])
    exact = found[-1] + (found[-1] - found[-2]) / 3
    assert orders(np.diff(found))[-1] > 1.8
    assert found[1] == pytest.approx(exact, rel=0.08)


def test_hubs_are_rigid():
    """Rays of a singular node begin on the hub, and their beginnings keep their places on it."""
    network = lamella.net(lamella.Enneper(3, 0.7, 2.0), cells=6)
    (node,) = np.flatnonzero(network.node_kinds == SINGULAR)
    lamellas = network.strips(Section(layers=1), STEEL)
    model = make_model(lamellas, pinned_rim(network), ModelRules(elements=3, hub_radius=0.05))
    ends = (model.lines.nodes == node) & (np.linalg.norm(model.lines.offsets, axis=2) > 0)
    assert ends.sum() == 6
    chords = np.linalg.norm(model.lines.offsets[ends], axis=1)
    assert chords == pytest.approx(0.05, rel=0.02)
    rest = at_rest(model.structure, no_loads(model.structure))
    points, _ = model.structure.beams.attachment.ends(rest.poses)
    before, _ = model.structure.beams.attachment.ends(model.structure.poses)
    apart = [np.linalg.norm(p[ends][:, None] - p[ends], axis=2) for p in (points, before)]
    assert np.abs(apart[0] - apart[1]).max() < 1e-12
    assert np.abs(points - before).max() > 1e-4


def test_a_slot_turns_like_a_notch():
    """A cantilever with n slots under a moment about its strong axis: M / E I (L^2 / 2 + sum of 3.42 h (L - x))."""
    structure = strip(4, 2.0, rod(), {0: "all"})
    slots = np.array([0.0, 1.0, 1.0, 0.0])
    with_slot = replace(structure, beams=slotted(structure.beams, slots, 0.1, 0.003))
    loads = make_loads(structure, forces={4: (0, 0, 0, 0, 1.0, 0)})
    turn = [
        2 * np.arcsin(-s.poses.frames[-1, 2, 0] / 2)
        for s in (equilibrium(structure, loads), equilibrium(with_slot, loads))
    ]
    assert abs(STRIP_LIKE_A_NOTCH - 3.42) < 0.01
    assert turn[1] - turn[0] == pytest.approx(STRIP_LIKE_A_NOTCH * 0.1 / 2.5e4, rel=1e-6)
    # a force at the tip: the slot at the middle turns under half of the moment at the clamp
    pull = make_loads(structure, forces={4: (0, 0, -1.0, 0, 0, 0)})
    sag = [s.displacements[-1, 2] for s in (equilibrium(structure, pull), equilibrium(with_slot, pull))]
    more = STRIP_LIKE_A_NOTCH * 0.1 / 2.5e4
    assert sag[0] - sag[1] == pytest.approx(more * 1.0 * 1.0, rel=0.1)


def test_layers_with_blocks_are_stiffer():
    """A pair as two lines: nodes at blocks are shared, and blocks make it stiffer."""
    network, section = PATCH, Section(layer_lengths="own")
    lamellas = network.strips(section, STEEL)
    sags, counts = [], []
    for spacing in (0.0, 0.3):
        rules = ModelRules(elements=4, layers="each", block_spacing=spacing, slots="whole")
        model = make_model(lamellas, pinned_rim(network), rules)
        loads = case_loads(model, pushed(network, (0, 0, -20.0)))
        rest = at_rest(model.structure, loads)
        there = loaded(rest)
        sags.append(np.abs(there.displacements - rest.displacements).max())
        counts.append(len(model.structure.poses.points))
        # each layer is as long as its own curve: in the designed shape it is not stretched but for the helix term
        state = at_start(model).beams
        section_ = model.structure.beams.sections[0]
        tg = state.motion.local_theta[0] / model.structure.beams.law.length
        assert np.abs(state.strains.values[0] - section_.gyration * tg**2 / 2).max() < 1e-6
    edges = len(network.cell_edges)
    assert counts[0] == 89 + 2 * 3 * edges
    blocks = np.ceil(np.round(network.cell_edges / 0.3, 6)).sum()
    assert counts[0] - counts[1] == blocks
    assert sags[1] < 0.8 * sags[0]


@pytest.mark.parametrize(
    ("rules", "key"),
    [
        ({"elements": 0}, "elements"),
        ({"elements": 1000}, "elements"),
        ({"joints": "glued"}, "joints"),
        ({"joints": "springs"}, "joint_stiffness"),
        ({"layers": "some"}, "layers"),
        ({"slots": "none"}, "slots"),
        ({"hub_radius": -1.0}, "hub_radius"),
        ({"joint_gap": np.inf}, "joint_gap"),
    ],
)
def test_refused_rules(rules, key):
    with pytest.raises(InputError) as refused:
        ModelRules(**rules)
    assert refused.value.where == key


def test_joints_hold_as_they_are_told():
    """Under a load in the plane of a catenoid's net: hinged joints move more than springs, springs more than locks."""
    network = lamella.net(lamella.Catenoid(2.5, (-1.0, 1.5)), cells=12)
    lamellas = network.strips(ONE, STEEL)
    low = (network.node_kinds == BOUNDARY) & (network.node_points[:, 2] < 0)
    moved = []
    for rules in ({"joints": "hinged"}, {"joints": "springs", "joint_stiffness": 50.0}, {}):
        model = make_model(lamellas, held_at(network, low, slice(0, 3)), ModelRules(elements=2, **rules))
        loads = case_loads(model, pushed(network, (1.0, 0, 0)))
        rest = at_rest(model.structure, loads)
        moved.append(np.abs(loaded(rest).displacements - rest.displacements).max())
        assert len(model.joint_nodes) == (
            0 if not rules else (network.node_degrees()[0] * network.node_degrees()[1] > 0).sum()
        )
    assert moved[0] > moved[1] > moved[2] > 0


def test_stacked_lamellas_lie_beside_their_nodes():
    """On two levels strips hang on the nodes by half of what is between them, have no slots, and are cut to r - z."""
    network = lamella.net(lamella.Unduloid(0.8, 1.2, (0.0, 1.5)), cells=12)
    section = Section(height=0.06, thickness=0.004, layers=1, level=0.035)
    lamellas = network.strips(section, STEEL)
    model = make_model(lamellas, pinned_rim(network), ModelRules(elements=2))
    on_nodes = model.lines.nodes < model.nodes
    offsets = model.lines.offsets[on_nodes]
    below = (network.families == "A")[np.repeat(model.lines.lamella, 2).reshape(-1, 2)[on_nodes]]
    assert offsets == pytest.approx(np.outer(np.where(below, -0.035, 0.035), (0, 0, 1)), abs=1e-9)
    assert not model.lines.crossed.any()
    curvature = -model.structure.beams.law.natural[:, 1]
    z = np.where((network.families == "A")[model.lines.lamella], -0.035, 0.035)
    assert curvature == pytest.approx(1 / (1 / network.mean_curvature - z), rel=1e-12)
    loads = case_loads(model, pushed(network, (0, 0, -5.0), weight=1.0))
    there = loaded(at_rest(model.structure, loads))
    mass = 7850 * section.height * section.thickness * lamellas.network.lengths.sum()
    assert there.reactions[:, 2].sum() == pytest.approx(mass * GRAVITY + 5.0 * model.nodes, rel=1e-8)


@pytest.mark.parametrize("level", [0.02, 0.05])
def test_strips_on_two_levels_are_bent_on_edge_by_what_they_were_not_cut_to(level):
    """On a catenoid strips cut straight are bent about the strong axis by -z tg^2 / (1 + z^2 tg^2), A below the surface
    and B above it (`lamella.strip.levels`); those cut to their own outline are not."""
    network = lamella.net(lamella.Catenoid(1.0, (-0.5, 0.5)), cells=12)
    errors = []
    for elements in (2, 4):
        lamellas = network.strips(Section(height=0.05, layers=1, level=level), STEEL)
        model = make_model(lamellas, pinned_rim(network), ModelRules(elements=elements))
        structure, lines = model.structure, model.lines
        tg = lamellas.network.sample_darboux.tg
        middle = lines.arclengths.mean(1)[:, None]
        of = CurveSamples.of_centre_lines(lamellas.network)
        tg = of.integrated(lines.lamella[:, None], middle, tg)[:, 0]
        side = np.where(lamellas.network.families[lines.lamella] == "A", -level, level)
        # tg on the level is tg / (1 + z^2 tg^2) of that on the surface, and so tg^2 / w^2 is tg_z^2 w^2
        root = (1 - np.sqrt(1 - 4 * level**2 * tg**2)) / (2 * level**2 * np.abs(tg))
        expected = -side * root**2 / (1 + level**2 * root**2)
        strains = structure.beams.at(structure.poses).strains.values[4]
        errors.append(np.abs(-strains - expected).max() / np.abs(expected).max())
    assert errors[-1] < 0.02
    assert orders(errors)[0] > 1.8
    cut = network.strips(Section(height=0.05, layers=1, level=level, layer_curves="cut"), STEEL)
    structure = make_model(cut, pinned_rim(network), ModelRules(elements=2)).structure
    assert np.abs(structure.beams.at(structure.poses).strains.values[4]).max() < 1e-12


def test_layers_cut_to_their_own_outline_are_not_bent_on_edge():
    """Beside the centre line the normal curvature is another one by d tg'; strips cut straight are bent by that."""
    bent = {}
    for curves in ("offset", "cut"):
        lamellas = PATCH.strips(Section(layers=2, offset=0.03, layer_curves=curves), STEEL)
        structure = make_model(lamellas, pinned_rim(PATCH), ModelRules(elements=4, layers="each")).structure
        bent[curves] = np.abs(structure.beams.at(structure.poses).strains.values[4]).max()
    assert bent["cut"] < 1e-12
    assert bent["offset"] == pytest.approx(0.015 * np.abs(PATCH.sample_slopes).max(), rel=0.05)

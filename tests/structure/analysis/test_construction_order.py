"""Construction in stages: closed forms of two orders, and nets that are put up in different ones."""

from dataclasses import replace

import numpy as np
import pytest

from lamella import InputError
from lamella.base.material import Material
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Section
from lamella.structure.analysis.analyse import analyse
from lamella.structure.analysis.construction_order import BENT, CABLES, LOCKED, RELEASED, put_up
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses, straight_poses
from lamella.structure.cables import make_cables
from lamella.structure.construction import continued
from lamella.structure.export.further_rows import prop_force_max
from lamella.structure.loads import make_loads, no_loads
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from lamella.structure.static import at_rest, loaded
from lamella.structure.structure import make_structure
from structure.model.nets import PATCH, pinned_rim
from structure.strips import rod

STEEL = Material(7850, 210e9, 81e9, 355e6)
CABLE_RULES = CableRules(every=2, diameter=0.006, prestress=400.0)


def cantilever(held: dict[int, str]):
    """1 m, k = 3 E I / l^3 = 300 N/m at its end; above the end a fixed node for a cable of 2 m, 500 N/m."""
    beam = straight_poses(1.0, 4)
    points = np.concatenate((beam.points, [[1.0, 0.0, 2.0]]))
    poses = Poses(points, np.concatenate((beam.frames, np.eye(3)[None])), beam.angles)
    nodes = np.stack((np.arange(4), np.arange(1, 5)), 1)
    beams = make_beams(nodes, 0.25, rod(about_u=100.0))
    return make_structure(poses, beams, {0: "all", 5: "all"} | held)


def test_two_orders_of_prop_and_cable():
    """P on the propped end, then a cable, then the prop away: P / (k + c). The prop away first, then a cable with the
    force S: P / k - S / (k + c)."""
    stiffness, cable, load, force = 300.0, 500.0, 1e-2, 4e-3
    props, bare = cantilever({4: "x y z"}), cantilever({})
    propped = loaded(at_rest(props, make_loads(props, forces={4: (0, 0, -load, 0, 0, 0)})))

    def strung(poses, prestress):
        return make_cables(poses, [[4, 5]], 2.0 * cable, prestress=prestress)

    held = loaded(continued(propped, no_loads(props), cables=strung(propped.poses, 0.0)))
    first = loaded(continued(held, no_loads(bare), replace(bare, cables=held.structure.cables)))
    assert -first.displacements[4, 2] == pytest.approx(load / (stiffness + cable), rel=1e-6)
    free = loaded(continued(propped, no_loads(bare), bare))
    assert -free.displacements[4, 2] == pytest.approx(load / stiffness, rel=1e-6)
    last = loaded(continued(free, no_loads(bare), cables=strung(free.poses, force)))
    assert -last.displacements[4, 2] == pytest.approx(load / stiffness - force / (stiffness + cable), rel=1e-5)
    assert last.whole.cables.tension[0] == pytest.approx(force * stiffness / (stiffness + cable), rel=1e-5)
    # taken off again it is as it was
    none = make_cables(last.poses, np.zeros((0, 2)), [])
    off = loaded(continued(last, no_loads(bare), cables=none))
    assert np.abs(off.displacements - free.displacements).max() < 1e-12


def model(joints="locked"):
    return make_model(PATCH.strips(Section(layers=1), STEEL), pinned_rim(PATCH), ModelRules(elements=2, joints=joints))


def test_props_that_go_leave_the_residual_state():
    """What is elastic and locked from the first does not depend on its way."""
    locked = model()
    (bent, free), after = put_up(locked, (BENT, RELEASED))
    direct = analyse(locked, frequencies=0).cases[0]
    assert np.abs(free.poses.points - direct.equilibrium.poses.points).max() < 1e-9
    assert np.abs(bent.displacements[: after.nodes]).max() == 0
    assert np.abs(bent.reactions[:, :3].sum(0)).max() < 1e-6
    assert np.array_equal(after.structure.held, locked.structure.held)


def test_the_order_is_that_of_the_site():
    """Cables that come before the props go keep the shape; joints that are locked keep the angles that they have."""
    before, after = ((BENT, LOCKED, CABLES, RELEASED), (BENT, LOCKED, RELEASED, CABLES))
    found = {}
    for order in (before, after):
        found[order] = analyse(model("hinged"), cables_later=CABLE_RULES, construction=order, frequencies=0, buckling=0)
    early, late = found[before], found[after]
    assert [stage.name for stage in early.stages] == list(before)
    assert early.cases[0].displacement_max == early.stages[-1].displacement_max
    assert early.spring_back < 0.8 * late.spring_back
    # nodes are held in their places and turn a little: cables lose a part of their prestress
    at_cables = early.stages[2]
    lost = 1 - at_cables.cable_forces / (2 * CABLE_RULES.prestress)
    assert -1e-9 < lost.min() <= lost.max() < 0.25
    assert np.abs(at_cables.displacements).max() < 1e-12
    assert prop_force_max(at_cables) > 0
    assert prop_force_max(early.stages[-1]) == 0
    locked, last = early.stages[1], early.stages[-1]
    assert np.array_equal(locked.equilibrium.poses.angles, last.equilibrium.poses.angles)
    bent = early.stages[0].equilibrium.poses.angles
    assert np.array_equal(locked.equilibrium.poses.angles, bent)


@pytest.mark.parametrize(
    ("stages", "cables"),
    [
        ((LOCKED, RELEASED), None),
        ((), None),
        ((BENT, LOCKED, RELEASED), None),
        ((BENT, CABLES, RELEASED), None),
        ((BENT, "roof"), None),
    ],
)
def test_refusals(stages, cables):
    with pytest.raises(InputError) as refused:
        put_up(model(), stages, cables)
    assert refused.value.where == "stages"

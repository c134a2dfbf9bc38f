"""Scenes as bytes: every array comes back to what its type keeps of it, whatever the layer, wherever the drawing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lamella.view.scene.curves import Curves, Fact, Plot, Series
from lamella.view.scene.encode import TOLD_BEYOND, encode_scene
from lamella.view.scene.encoding import ALIGNMENT, Pack, array_of, unpacked
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import InstancesLayer, LinesLayer, MeshLayer, PointsLayer, StripsLayer
from lamella.view.scene.quantity import Quantity, magnitude, signed
from lamella.view.scene.scene import Labels, Mark, Remark, Scene, Shown, make_scene

DRAW = np.random.default_rng(3)
POINTS = DRAW.uniform(-3, 5, (40, 3))
NORMALS = POINTS / np.linalg.norm(POINTS, axis=1)[:, None]
FACES = DRAW.integers(0, 40, (30, 3))


def all_kinds(away: Any = (0.0, 0.0, 0.0)) -> list[Shown]:
    points = POINTS + np.asarray(away)
    values = DRAW.normal(size=40)
    twist = signed("twist", "Twist", "1/m", values)
    strips: dict[str, Any] = {"offsets": np.array([0, 25, 40]), "normals": NORMALS, "ids": ("A1", "A2")}
    layers: list[Shown] = [
        MeshLayer(name="m", label="M", positions=points, faces=FACES, normals=NORMALS, quantities=(twist,)),
        MeshLayer(name="s", label="S", positions=points, faces=FACES, like="t", samples=np.arange(40)),
        LinesLayer(name="l", label="L", positions=points, offsets=np.array([0, 10, 40]), width=2.5),
        PointsLayer(name="p", label="P", positions=points, ids=("a", "b"), owner=np.arange(40) % 2),
        InstancesLayer(
            name="i", label="I", positions=POINTS, faces=FACES, origins=points[:7], axes=np.tile(np.eye(3), (7, 1, 1))
        ),
        StripsLayer(
            name="t", label="T", positions=points, sides=np.array([-0.1, 0.1]), height=0.2, thickness=0.01, **strips
        ),
    ]
    steps = DRAW.normal(size=(4, 40, 3))
    moved = Motion("t", positions=points + steps, normals=np.tile(NORMALS, (4, 1, 1)))
    frames = Frames(
        "f", "F", np.linspace(0, 1, 4), "m", ("a", "b", "c", "d"), (moved, Motion("m", displacements=steps))
    )
    labels, mark = Labels("n", "Names", points[:3], ("x", "y\n", "z")), Mark("large", points[:2], ("A1",))
    plot = Plot("Curvature", "1/m", (Series("kn", "kn", values),), 4)
    curves = Curves(
        "c", "Lamella", ("A1", "A2"), np.array([0, 25, 40]), np.arange(40.0), np.array([0, 2, 4]), np.arange(4),
        np.array([0, 24, 0, 14]), (Fact("Length", "m", np.array([1.5, 2.5]), 3), Fact("Family", "", ("A", "B"))),
        (plot,),
    )  # fmt: skip
    return [*layers, frames, labels, mark, curves, Remark("all")]


@pytest.mark.parametrize("away", [(0.0, 0.0, 0.0), (4e5, 5e6, 100.0)])
def test_all_arrays_come_back(away: tuple[float, float, float]) -> None:
    scene = make_scene("x", all_kinds(away))
    header, body = unpacked(encode_scene(scene))
    centre = np.array(header["centre"])
    # float32 of the offset, and the rounding of coordinates of 5e6 in float64
    error = 8 * 2.0**-23 + 2e-9
    for layer, told in zip(scene.layers, header["layers"], strict=True):
        assert (told["kind"], told["name"], told["count"]) == (layer.kind, layer.name, layer.count)
        own = isinstance(layer, InstancesLayer)
        back = array_of(told["origins" if own else "positions"], body).reshape(-1, 3) + centre
        assert np.abs(back - layer.points).max() <= error
        if isinstance(layer, MeshLayer | InstancesLayer):
            np.testing.assert_array_equal(array_of(told["faces"], body).reshape(-1, 3), layer.faces)
        if isinstance(layer, LinesLayer | StripsLayer):
            np.testing.assert_array_equal(array_of(told["offsets"], body), layer.offsets)
        for quantity, one in zip(layer.quantities, told["quantities"], strict=True):
            off = np.abs(array_of(one["values"], body) - quantity.values)
            assert off.max() <= 0.51 * np.ptp(quantity.values) / 65534
    frames, told = scene.frames[0], header["frames"][0]
    for motion, one in zip(frames.motions, told["motions"], strict=True):
        key = "positions" if motion.positions is not None else "displacements"
        given = getattr(motion, key)
        back = array_of(one[key], body).reshape(given.shape) + (centre if key == "positions" else 0)
        assert np.abs(back - given).max() <= 0.51 * np.ptp(given - (centre if key == "positions" else 0)) / 65534 + 2e-9
    assert header["labels"][0]["texts"] == ["x", "y", "z"]
    assert header["remarks"] == ["all"]
    assert array_of(header["curves"][0]["facts"][0]["values"], body).tolist() == [1.5, 2.5]


def test_the_same_scene_gives_the_same_bytes() -> None:
    shown = all_kinds()
    assert encode_scene(make_scene("x", shown)) == encode_scene(make_scene("x", shown))


def test_equal_arrays_are_held_once_and_all_are_aligned() -> None:
    pack = Pack()
    first = pack.integers(np.array([1, 2, 3]))
    second = pack.float32(np.arange(5.0))
    assert pack.float32(np.arange(5.0)) == second
    assert (first["at"], second["at"]) == (0, ALIGNMENT)
    data = pack.whole({"a": first, "b": second})
    header, body = unpacked(data)
    assert len(body) == ALIGNMENT + 20
    assert (len(data) - len(body)) % ALIGNMENT == 0
    assert array_of(header["b"], body).tolist() == [0, 1, 2, 3, 4]


def test_what_is_not_known_stays_unknown_and_poles_do_not_spoil_the_rest() -> None:
    values = np.array([0.0, 0.5, 1.0, np.nan, 1e9])
    quantity = Quantity("q", "Q", "", "", values, 0.0, 1.0, 0.0, 1e9, ("#000000", "#ffffff"))
    layer = PointsLayer(name="p", label="P", positions=np.zeros((5, 3)), quantities=(quantity,))
    header, body = unpacked(encode_scene(Scene("x", (layer,))))
    back = array_of(header["layers"][0]["quantities"][0]["values"], body)
    assert np.isnan(back[3])
    assert back[4] == pytest.approx(1 + TOLD_BEYOND)
    assert np.abs(back[:3] - values[:3]).max() <= (1 + TOLD_BEYOND) / 65534
    assert header["layers"][0]["quantities"][0]["most"] == 1e9


def test_a_constant_and_nothing_at_all() -> None:
    pack = Pack()
    assert np.isnan(array_of(pack.quantised(np.full(3, np.nan)), b"")).all()
    assert array_of(pack.quantised(np.full(3, 2.5)), b"").tolist() == [2.5] * 3
    header, _ = unpacked(encode_scene(Scene("empty")))
    assert (header["layers"], header["low"]) == ([], [0, 0, 0])


def test_magnitudes_begin_at_0_and_signed_ones_are_0_in_the_middle() -> None:
    values = np.array([-1.0, 3.0])
    assert (magnitude("q", "Q", "", values).low, magnitude("q", "Q", "", values).high) == (0, 3)
    assert (signed("q", "Q", "", values).low, signed("q", "Q", "", values).high) == (-3, 3)

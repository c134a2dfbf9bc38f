"""Remedies followed to the letter: a project that is refused or warned of, the remedy applied, and it is accepted."""

from __future__ import annotations

import re
from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from lamella import Memory, compute, parse_project
from lamella.base.material import MATERIALS
from lamella.stages.check import check_project
from refusals import check_stated, keys, refused

Tables = dict[str, Any]
UNDULOID = {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-1.0, 1.0]}
CATENOID = {"kind": "catenoid", "neck_radius": 1.0, "height": [-1.0, 1.0]}
SCHERK = {"kind": "scherk", "extent": 1.2, "scale": 3.0}
NODOID = {"kind": "nodoid", "neck_radius": 3.0, "bulge_radius": 9.0}
RIM = [[0, 0, 0], [2, 0, 0.35], [4, 0, 1.2], [4, 2, 0.35], [4, 4, 0], [2, 4, 0.35], [0, 4, 1.2], [0, 2, 0.35]]
SADDLE = {"kind": "form-found", "tolerance": 2e-2, "boundary": [{"points": RIM}]}
ONE = {"layers": 1}
MEMORY = Memory()
"""Of surfaces that several cases have: found once."""


def numbers(text: str) -> list[float]:
    return [float(x) for x in re.findall(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?", text)]


def put(key: str, *picks: int) -> Callable[[Tables, str], Tables]:
    """Writing a number of the remedy under a key; several: a list of them."""

    def apply(tables: Tables, remedy: str) -> Tables:
        table, name = key.split(".")
        there = deepcopy(tables)
        found = [numbers(remedy)[k] for k in picks]
        value: Any = found if len(found) > 1 else found[0]
        if name == "cells":
            value = int(value)
        there.setdefault(table, {})[name] = value
        if name in ("cells", "spacing"):
            there[table].pop({"cells": "spacing", "spacing": "cells"}[name], None)
        return there

    return apply


def without(key: str) -> Callable[[Tables, str], Tables]:
    """Leaving a key out."""

    def apply(tables: Tables, remedy: str) -> Tables:
        table, name = key.split(".")
        there = deepcopy(tables)
        del there[table][name]
        return there

    return apply


def accepted(tables: Tables) -> None:
    check_project(parse_project(tables), memory=MEMORY)


REFUSED: list[tuple[str, Tables, str, list[Callable[[Tables, str], Tables]]]] = [
    (
        "wide spacing",
        {"surface": UNDULOID, "network": {"spacing": 9.0}},
        "network.spacing",
        [put("network.spacing", 0)],
    ),
    ("many cells", {"surface": UNDULOID, "network": {"cells": 3000}}, "network.cells", [put("network.cells", 0)]),
    (
        "narrow spacing",
        {"surface": CATENOID, "network": {"spacing": 1e-3}},
        "network.spacing",
        [put("network.spacing", 0)],
    ),
    (
        "wide spacing on a film",
        {"surface": SADDLE, "network": {"spacing": 4.0}},
        "network.spacing",
        [put("network.spacing", 0)],
    ),
    (
        "many cells on a film",
        {"surface": SADDLE, "network": {"cells": 4000}},
        "network.cells",
        [put("network.cells", 0)],
    ),
    (
        "all too short",
        {"surface": SCHERK, "network": {"minimum_length": 99.0}},
        "network.minimum_length",
        [put("network.minimum_length", 0)],
    ),
    (
        "all too short on a film",
        {"surface": SADDLE, "network": {"cells": 8, "minimum_length": 99.0}},
        "network.minimum_length",
        [put("network.minimum_length", 0)],
    ),
    (
        "cells of every third",
        {"surface": UNDULOID, "network": {"cells": 25, "every": 3}},
        "network.cells",
        [put("network.cells", 0), put("network.cells", 1)],
    ),
    (
        "curvature of lines",
        {"surface": CATENOID, "network": {"normal_curvature": 0.9}},
        "network.normal_curvature",
        [put("network.normal_curvature", 0), put("network.normal_curvature", 1)],
    ),
    (
        "curvature of lines from seeds",
        {"surface": SADDLE, "network": {"normal_curvature": 3.0}, "lamella": ONE},
        "network.normal_curvature",
        [put("network.normal_curvature", 0), put("network.normal_curvature", 1)],
    ),
    (
        "all too short from seeds",
        {"surface": SADDLE, "network": {"normal_curvature": 0.1, "cells": 6, "minimum_length": 99.0}, "lamella": ONE},
        "network.minimum_length",
        [put("network.minimum_length", 0)],
    ),
    (
        "higher than round",
        {"surface": UNDULOID | {"neck_radius": 0.2, "bulge_radius": 0.3, "height": [-0.1, 0.1]}}
        | {"lamella": ONE | {"height": 0.6}},
        "lamella.height",
        [put("lamella.height", 0)],
    ),
    (
        "slots wider than high",
        {"surface": UNDULOID, "lamella": ONE | {"height": 0.01, "thickness": 0.006}},
        "fabrication.slot_width",
        [put("fabrication.slot_width", 0)],
    ),
    (
        "ends too short",
        {"surface": UNDULOID, "lamella": ONE, "fabrication": {"end_distance": 1e-3}},
        "fabrication.end_distance",
        [put("fabrication.end_distance", 0)],
    ),
    (
        "beyond the fold",
        {"surface": NODOID | {"height": [-9.0, 9.0]}, "lamella": ONE},
        "surface.height",
        [put("surface.height", 0, 1)],
    ),
    (
        "too thin a neck",
        {"surface": UNDULOID | {"neck_radius": 1e-4}, "lamella": ONE | {"height": 0.001, "thickness": 1e-5}},
        "surface.neck_radius",
        [put("surface.neck_radius", 0)],
    ),
    (
        "next to infinity",
        {"surface": SCHERK | {"extent": 1.570796}, "network": {"cells": 5}, "lamella": ONE},
        "network.cells",
        [put("network.cells", 0), put("surface.extent", 1)],
    ),
    (
        "principal lines next to infinity",
        {"surface": SCHERK | {"extent": 1.570796}, "network": {"cells": 4, "kind": "principal"}},
        "network.cells",
        [put("network.cells", 0), put("surface.extent", 1)],
    ),
    (
        "slots",
        {"surface": UNDULOID, "lamella": ONE, "fabrication": {"slot_width": 1e-3}},
        "fabrication.slot_width",
        [without("fabrication.slot_width")],
    ),
]


# lines from seeds are traced twice
SLOW = ("curvature of lines from seeds", "all too short from seeds")


@pytest.mark.parametrize(
    ("tables", "key", "ways"),
    [pytest.param(*case[1:], id=case[0], marks=pytest.mark.slow if case[0] in SLOW else ()) for case in REFUSED],
)
@pytest.mark.few(9)
def test_what_is_refused(tables: Tables, key: str, ways: list[Callable[[Tables, str], Tables]]) -> None:
    """A remedy written into the project to the letter: the project is accepted."""
    with refused(key) as error:
        check_project(parse_project(tables), memory=MEMORY)
    for way in ways:
        accepted(way(tables, error.value.remedy))


def warning(tables: Tables, *keys: str) -> str:
    """The first warning of some keys; "" where there is none."""
    messages = compute(parse_project(tables), memory=MEMORY).summary["warnings"]
    return next((message for message in messages if message.key in keys), "")


def offered(text: str, before: str, after: str = "") -> float:
    """The last number of a text between a key and a unit: what a remedy says to write."""
    found = re.findall(rf"{before}\D{{0,4}}([\d.]*\d){after}", text)
    assert found, (before, after, text)
    return float(found[-1])


@pytest.mark.parametrize(
    "tables",
    [
        {"surface": UNDULOID, "lamella": ONE | {"thickness": 0.008}},
        {"surface": CATENOID | {"neck_radius": 0.9}, "lamella": ONE | {"height": 0.12, "marks": "relaxed"}},
        {"surface": SCHERK | {"extent": 1.3, "scale": 1.0}, "lamella": ONE | {"material": "C24", "thickness": 0.006}},
    ],
    ids=["thick", "twisted", "timber"],
)
def test_strips_that_are_overstressed(tables: Tables) -> None:
    """As thin, as low or of a material as strong as is said: no warning is left, and not needlessly far below 1."""
    ways = warning(tables, "overstressed").partition("): ")[2]
    project = parse_project(tables)
    changed: list[Tables] = []
    for measure in ("thickness", "height"):
        if found := re.search(rf"{measure} of ([\d.]+) mm", ways):
            value = float(found[1]) / 1000
            changed.append(tables | {"lamella": tables["lamella"] | {measure: value}})
    material = project.material()
    own = {
        "density": material.density,
        "youngs_modulus": material.youngs_modulus,
        "shear_modulus": material.shear_modulus,
        "strength": 1e6 * offered(ways.partition("shear")[0], "strength of", " MPa"),
    }
    if shear := re.search(r"shear strength of ([\d.]+) MPa", ways):
        own["shear_strength"] = 1e6 * float(shear[1])
    changed.append(tables | {"materials": {"own": own}, "lamella": tables["lamella"] | {"material": "own"}})
    assert len(changed) > 1
    for there in changed:
        results = compute(parse_project(there))
        assert 0.9 < results.summary["lamellas"]["utilisation_max"] <= 1
        assert "overstressed" not in keys(results.summary["warnings"])


@pytest.mark.parametrize(
    ("surface", "strip"),
    [
        (UNDULOID, {"thickness": 0.0137}),
        (CATENOID | {"neck_radius": 0.5}, {"height": 0.12, "thickness": 0.002}),
        (
            UNDULOID | {"neck_radius": 0.2, "bulge_radius": 0.3, "height": [-0.3, 0.3]},
            {"height": 0.2, "thickness": 0.006},
        ),
        (CATENOID | {"neck_radius": 0.2}, {"height": 0.12, "thickness": 0.002, "layers": 2}),
        pytest.param(SADDLE, {"thickness": 0.004, "material": "S235"}, marks=pytest.mark.slow),
        (SCHERK | {"extent": 1.3, "scale": 1.0}, {"thickness": 0.012, "material": "D40"}),
    ],
    ids=["material", "lower", "smaller", "layers", "film", "timber"],
)
def test_strips_for_which_no_known_material_is_strong_enough(surface: Tables, strip: Tables) -> None:
    """No strength above that of all materials is offered: the one named, with the section named, bears the strain."""
    tables = {"surface": surface, "network": {"cells": 16}, "lamella": ONE | strip}
    ways = warning(tables, "overstressed").partition("): ")[2]
    assert "MPa" not in ways
    name, rest = re.search(r"lamella.material = '([^']+)'(.*)", ways).groups()  # type: ignore[union-attr]
    assert name in MATERIALS
    changed: Tables = {"material": name}
    for measure in ("thickness", "height"):
        if found := re.search(rf"{measure} of ([\d.]+) mm", rest):
            changed[measure] = float(found[1]) / 1000
    if found := re.search(r"section of ([\d.]+) x ([\d.]+) mm", rest):
        changed |= {"height": float(found[1]) / 1000, "thickness": float(found[2]) / 1000}
    results = compute(parse_project(tables | {"lamella": tables["lamella"] | changed}), until="lamellas")
    assert (0.9 if len(changed) > 1 else 0) < results.summary["lamellas"]["utilisation_max"] <= 1


def test_cells_smaller_than_the_strip() -> None:
    tables = {"surface": UNDULOID, "network": {"cells": 120}, "lamella": ONE | {"height": 0.15, "thickness": 0.001}}
    small = "cells_narrow", "cells_small"
    reported = warning(tables, "cells_narrow")
    cells, height = int(offered(reported, "", " cells")), offered(reported, "", " mm") / 1000
    assert not warning(tables | {"network": {"cells": cells}}, *small)
    assert not warning(tables | {"lamella": tables["lamella"] | {"height": height}}, *small)


@pytest.mark.parametrize(
    "tables",
    [
        pytest.param(
            {"surface": {"kind": "enneper", "order": 3, "radius": 0.9, "scale": 3.0}, "network": {"cells": 19}},
            id="enneper",
        ),
        pytest.param({"surface": SADDLE, "network": {"cells": 16}}, id="film", marks=pytest.mark.slow),
    ],
)
def test_curves_that_end_just_behind_a_node(tables: Tables) -> None:
    """With as many cells, or a strip as low, as is named no cell edge is shorter than a tenth of the strip's height."""
    tables = tables | {"lamella": ONE | {"height": 0.05, "thickness": 0.001}}
    message = warning(tables, "cells_small")
    # of the three numbers of mm the limit and the least edge come first; half of the height and more is offered
    lengths = re.findall(r"([\d.]+) mm", message)
    least = float(lengths[1])
    height = float(lengths[-1]) if float(lengths[-1]) > 5 else 0.0
    assert bool(height) == (least > 2.5)
    if height:
        strip = tables["lamella"] | {"height": height / 1000}
        assert not warning(tables | {"lamella": strip}, "cells_small")
    assert not warning(tables | {"network": {"cells": int(offered(message, "", " cells"))}}, "cells_small")


@pytest.mark.slow
def test_faces_that_are_left_out() -> None:
    """Around an umbilic that is no node, next to the rim; with as many cells as are named none is left out."""
    t = 2 * np.pi * np.arange(12) / 12
    draw = np.random.default_rng(7)
    waves = zip((2, 3, 4), draw.uniform(0.2, 0.7, 3), draw.uniform(0, 6, 3), strict=True)
    z = sum(a * np.cos(k * t + b) for k, a, b in waves)
    points = np.stack([4 * np.cos(t), 3 * np.sin(t), z], axis=1).round(3)
    surface = {"kind": "form-found", "tolerance": 2e-2, "boundary": [{"points": points.tolist()}]}
    tables: Tables = {"surface": surface, "network": {"cells": 5}, "lamella": ONE}
    cells = int(offered(warning(tables, "faces_left_out"), "", " cells"))
    assert not warning(tables | {"network": {"cells": cells}}, "faces_left_out")


def arches() -> list[dict[str, Any]]:
    """Four arching sides that meet at about 60 degrees in plan and at more on the film."""
    corners = np.array([[0, 0, 0], [3.5, 0, 0], [3.5, 3.0, 0], [0, 3.0, 0]])
    rises = np.array([[0, -0.2, 1.1], [0.2, 0, -0.25], [0, 0.2, 1.1], [-0.2, 0, -0.25]])
    s = np.linspace(0, 1, 17)[:, None]
    sides = [(1 - s) * corners[k] + s * corners[(k + 1) % 4] + 4 * s * (1 - s) * rises[k] for k in range(4)]
    return [{"points": np.round(side, 5).tolist()} for side in sides]


BEAMS = {
    "points": [[0, 0, 0], [6, 0, 1.0], [6, 3, 0.2], [3, 3, -0.2], [3, 6.6, 1.2], [0, 6.6, 0.4]],
    "interpolation": "polyline",
}


PLAN = {"points": [[5, 0, 0], [1.5, 4.5, 0], [-4, 2.9, 0], [-4, -2.9, 0], [1.5, -4.7, 0]], "interpolation": "polyline"}


def at_corners(boundary: Tables, mean_curvature: float) -> Tables:
    surface = {"kind": "form-found", "tolerance": 1e-2, "mean_curvature": mean_curvature, "boundary": [boundary]}
    strip = ONE | {"height": 0.05, "thickness": 0.001}
    return {"surface": surface, "network": {"spacing": 0.3}, "lamella": strip}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("boundary", "mean_curvature"), [({"part": arches()}, 0.0), (PLAN, -0.12)], ids=["arches", "dome"]
)
def test_corners_that_concentrate_stress(boundary: Tables, mean_curvature: float) -> None:
    """Reported apart from the rest; the radius that is said brings the utilisation to what is said with it, below 1."""
    boundary = boundary | {"name": "edge"}
    sharp = compute(parse_project(at_corners(boundary, mean_curvature))).summary
    message = next(reported for reported in sharp["warnings"] if reported.key == "overstressed")
    found = re.search(r"corner_radius = ([\d.]+) m\b.*'edge'\D*([\d.]*\d)", message)
    assert found
    figures = sharp["lamellas"]
    there = [value or 0.0 for value in figures["utilisation_at_corners"]]
    assert figures["utilisation_max"] == max(there)
    assert figures["utilisation_away_from_corners"] < 0.5 * max(there)
    assert len(sharp["network"]["corners"]) == len(there)

    round_ = compute(parse_project(at_corners(boundary | {"corner_radius": float(found[1])}, mean_curvature))).summary
    assert round_["lamellas"]["utilisation_max"] <= 1
    # three digits, up
    assert round_["lamellas"]["utilisation_max"] == pytest.approx(float(found[2]), rel=1e-2)
    assert not round_["network"]["corners"]
    assert "overstressed" not in keys(round_["warnings"])


@pytest.mark.slow
def test_corners_whose_loop_has_no_room_for_a_radius_that_does() -> None:
    """Beside a side of 0.5 m fillets are too small: none is named."""
    beams = BEAMS | {
        "points": [*BEAMS["points"][:3], [3.5, 3, -0.2], [3.5, 3.5, -0.1], [3, 3.5, 0], *BEAMS["points"][4:]]
    }
    message = warning(at_corners(beams, 0.0), "overstressed")
    # the key is named, with the radius there is room for, and none is offered
    assert re.search(r"corner_radius\b\D*0\.\d+ m\b", message)
    assert "corner_radius =" not in message


@pytest.mark.parametrize(
    ("cells", "layers", "end_distance"),
    [(17, 1, 0.05), (25, 1, 0.05), (25, 1, 0.3), pytest.param(25, 2, 0.08, marks=pytest.mark.slow), (17, 2, 0.02)],
)
def test_strips_that_meet_beyond_the_rim(cells: int, layers: int, end_distance: float) -> None:
    """With ends as short as is said none meet, and with ends a little longer some do."""
    tables: Tables = {
        "surface": {"kind": "enneper", "order": 3, "radius": 0.9, "scale": 3.0},
        "network": {"cells": cells},
        "lamella": {"layers": layers, "height": 0.05, "thickness": 0.001},
        "fabrication": {"end_distance": end_distance},
    }
    message = warning(tables, "ends_meet")
    assert message
    if "end_distance = " not in message:
        # no end is short enough: the strips themselves, as wide as their layers, meet
        if cells == 17:
            assert not warning(tables | {"network": {"cells": int(offered(message, "", " cells"))}}, "ends_meet")
        else:
            # none of the numbers of cells that were tried does
            check_stated(message, [21, 29])
        shortest = {"end_distance": 0.0031, "rim_overhang": 0.0}
        assert warning(tables | {"fabrication": shortest}, "ends_meet")
        return
    end, overhang = offered(message, "end_distance = "), offered(message, "rim_overhang = ")
    assert not warning(tables | {"fabrication": {"end_distance": end, "rim_overhang": overhang}}, "ends_meet")
    longer = {"end_distance": 1.02 * end + 1e-3, "rim_overhang": 1.02 * overhang + 1e-3}
    assert warning(tables | {"fabrication": longer}, "ends_meet")

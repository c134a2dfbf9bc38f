"""Remedies followed to the letter: a project that is refused or warned of, the remedy applied, and it is accepted."""

from __future__ import annotations

import re
from collections.abc import Callable
from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from lamella import InputError, compute, parse_project
from lamella.base.material import MATERIALS
from lamella.stages.check import check_project

Tables = dict[str, Any]
UNDULOID = {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-1.0, 1.0]}
CATENOID = {"kind": "catenoid", "neck_radius": 1.0, "height": [-1.0, 1.0]}
SCHERK = {"kind": "scherk", "extent": 1.2, "scale": 3.0}
NODOID = {"kind": "nodoid", "neck_radius": 3.0, "bulge_radius": 9.0}
RIM = [[0, 0, 0], [2, 0, 0.35], [4, 0, 1.2], [4, 2, 0.35], [4, 4, 0], [2, 4, 0.35], [0, 4, 1.2], [0, 2, 0.35]]
SADDLE = {"kind": "form-found", "tolerance": 2e-2, "boundary": [{"points": RIM}]}
ONE = {"layers": 1}


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
        assert "leave" in remedy
        table, name = key.split(".")
        there = deepcopy(tables)
        del there[table][name]
        return there

    return apply


def accepted(tables: Tables) -> None:
    check_project(parse_project(tables))


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
def test_what_is_refused(tables: Tables, key: str, ways: list[Callable[[Tables, str], Tables]]) -> None:
    with pytest.raises(InputError) as refused:
        check_project(parse_project(tables))
    assert key in refused.value.where
    for way in ways:
        accepted(way(tables, refused.value.remedy))


def warned(tables: Tables, word: str) -> str:
    """The warning with a word; "" where there is none."""
    reported = compute(parse_project(tables)).summary["warnings"]
    return next((message for message in reported if word in message), "")


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
    message = warned(tables, "utilisation reaches")
    ways = message.partition("over 1): ")[2]
    assert ways.endswith("brings it to 1")
    project = parse_project(tables)
    changed: list[Tables] = []
    for measure in ("thickness", "height"):
        if found := re.search(rf"{measure} of ([\d.]+) mm", ways):
            value = float(found[1]) / 1000
            changed.append(tables | {"lamella": tables["lamella"] | {measure: value}})
    material = project.material()
    strength = re.search(r"strength of ([\d.]+) MPa", ways)
    assert strength
    own = {
        "density": material.density,
        "youngs_modulus": material.youngs_modulus,
        "shear_modulus": material.shear_modulus,
        "strength": 1e6 * float(strength[1]),
    }
    if shear := re.search(r"shear strength of ([\d.]+) MPa", ways):
        own["shear_strength"] = 1e6 * float(shear[1])
    changed.append(tables | {"materials": {"own": own}, "lamella": tables["lamella"] | {"material": "own"}})
    assert len(changed) > 1
    for there in changed:
        results = compute(parse_project(there))
        assert 0.9 < results.summary["lamellas"]["utilisation_max"] <= 1
        assert not any("utilisation reaches" in message for message in results.summary["warnings"])


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
    message = warned(tables, "utilisation reaches")
    ways = message.partition("over 1): ")[2]
    assert "a strength of" not in message
    name, rest = re.search(r"lamella.material = '([^']+)'(.*) brings it to 1", ways).groups()  # type: ignore[union-attr]
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
    reported = warned(tables, "cell edges")
    cells, height = re.search(r"at most (\d+) cells, or a strip up to ([\d.]+) mm", reported).groups()  # type: ignore[union-attr]
    assert not warned(tables | {"network": {"cells": int(cells)}}, "cell edges")
    assert not warned(tables | {"lamella": tables["lamella"] | {"height": float(height) / 1000}}, "cell edges")


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
    message = warned(tables, "shorter than a tenth of the strip's height")
    # half of the height and more is offered
    low = re.search(r"a strip up to ([\d.]+) mm high", message)
    down = re.search(r"down to ([\d.]+) mm", message)
    assert down
    assert bool(low) == (float(down[1]) > 2.5)
    if low:
        strip = tables["lamella"] | {"height": float(low[1]) / 1000}
        assert not warned(tables | {"lamella": strip}, "shorter than a tenth of the strip's height")
    other = re.search(r"with (\d+) cells there are none", message)
    assert other
    assert not warned(tables | {"network": {"cells": int(other[1])}}, "shorter than a tenth of the strip's height")


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
    other = re.search(r"with (\d+) cells there are none", warned(tables, "more than six corners"))
    assert other
    assert not warned(tables | {"network": {"cells": int(other[1])}}, "more than six corners")


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
    message = next(reported for reported in sharp["warnings"] if "utilisation reaches" in reported)
    found = re.search(r"corner_radius = ([\d.]+) m in the table of 'edge' brings it to ([\d.]+)", message)
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
    assert not any("utilisation reaches" in reported for reported in round_["warnings"])


@pytest.mark.slow
def test_corners_whose_loop_has_no_room_for_a_radius_that_does() -> None:
    """Beside a side of 0.5 m fillets are too small: none is named."""
    beams = BEAMS | {
        "points": [*BEAMS["points"][:3], [3.5, 3, -0.2], [3.5, 3.5, -0.1], [3, 3.5, 0], *BEAMS["points"][4:]]
    }
    message = next(
        reported
        for reported in compute(parse_project(at_corners(beams, 0.0))).summary["warnings"]
        if "utilisation" in reported
    )
    assert re.search(r"no corner_radius that was tried, up to the 0\.\d+ m its loop has room for", message)
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
    message = warned(tables, "beyond the rim")
    assert message
    if "write fabrication" not in message:
        # no end is short enough: the strips themselves, as wide as their layers, meet
        other = re.search(r"with (\d+) cells there are none; or move the rim", message)
        assert bool(other) == (cells == 17)
        if other:
            assert not warned(tables | {"network": {"cells": int(other[1])}}, "beyond the rim")
        else:
            assert "with 21 to 29 cells there are such too" in message
        shortest = {"end_distance": 0.0031, "rim_overhang": 0.0}
        assert warned(tables | {"fabrication": shortest}, "beyond the rim")
        return
    lengths = re.search(r"end_distance = ([\d.]+) and rim_overhang = ([\d.]+)", message)
    assert lengths
    end, overhang = map(float, lengths.groups())
    assert not warned(tables | {"fabrication": {"end_distance": end, "rim_overhang": overhang}}, "beyond the rim")
    longer = {"end_distance": 1.02 * end + 1e-3, "rim_overhang": 1.02 * overhang + 1e-3}
    assert warned(tables | {"fabrication": longer}, "beyond the rim")

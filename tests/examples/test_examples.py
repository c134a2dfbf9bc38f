"""Every example runs and has the one physical number its surface is known for."""

import json
import re
import tomllib
from functools import cache

import pytest

from conftest import EXAMPLES, run_of_example
from examples.kernels import same_text
from examples.known_numbers import NUMBERS
from lamella import parse_project, read_project
from lamella.fabrication.schedule import COLUMNS
from lamella.files.write.network_json import network_bytes
from lamella.project.tables import FURTHER_TABLES
from lamella.surface.closed_forms.closed_form import ClosedForm
from test_docs import DOCS, builder
from validation.measure_network import measure

# what examples warn of, in full: nothing else may be said
SPLIT = r"\d+ of \d+ lamellas were split midway between nodes into \d+ pieces: \d+ do not fit the sheet of [^;]*"
LEFT_OUT = r"\d+ lamellas? shorter than network.minimum_length (is|are) left out"
OTHERWISE = (
    r"(no density near this one closes it|(cells|spacing) = \S+ misses whole cells by \S+ only); closing = 'round' or "
    r"'adjust' may close it"
)
SEAMS = (
    r"the net does not meet itself along \d+ seams?: it misses whole cells by up to 0\.\d+ \(summary: "
    r"network\.joints\); " + OTHERWISE
)
MISSED = r"\d of \d umbilics are no nodes of the net \(at [-\d., e;]+ m\): lamellas pass around them; " + OTHERWISE
SMALL = r"\d+ cell edges? (is|are) shorter than a tenth of the strip's height \([^)]*\), down to .*"
BENT = (
    r"the normal curvature of the lamellas is off by up to \S+ 1/m, [23]\.\de-03 of the curvature scale "
    r"\(at 95 % of the samples by 1\.\de-03; limit 0\.002\): .*"
)
BEYOND = r"\d+ pairs? of strips \([^)]*\) meets? beyond the rim, where no slot is cut: .*"
WARNINGS = {
    "01_unduloid": [SPLIT],
    "04_helicoid": [SPLIT],
    "05_enneper": [SPLIT],
    "06_scherk": [SPLIT],
    "09_thin_neck": [
        r"the surface is unstable as a film .*: a soap film would leave it unless its volume .*; a stiff net need not"
    ],
    "11_cap": [r"the run ends with the surface: it is a piece of a sphere of radius .*, and has no net of lamellas"],
    "12_cushion": [SEAMS, MISSED, BEYOND, SPLIT],
    "14_three_columns": [SEAMS, MISSED, LEFT_OUT, BEYOND, SMALL],
    # small lamellas in its four corners
    "15_vault": [LEFT_OUT],
    # lamellas of both families meet on its arches
    "16_hall": [BEYOND, SPLIT],
    "17_gridshell": [LEFT_OUT, BEYOND, SMALL],
    # 1,617 vertices do not tell more
    "18_saddle_roof": [BENT, LEFT_OUT, SPLIT, BEYOND],
}
# three umbilics of the cushion and six of the canopy lie anywhere: their nets have seams
OPEN = {"12_cushion", "14_three_columns"}
# lines from even seeds: no joints, no right angles
ASKEW = {"18_saddle_roof"}


def test_every_example_has_its_number():
    assert {path.stem for path in EXAMPLES.glob("*.toml")} == set(NUMBERS)


# of seconds each: `make kernels` runs them too
LONG = ("14_three_columns", "16_hall", "17_gridshell", "18_saddle_roof", "21_vault_structure")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in NUMBERS]
)
def test_example(name):
    """Each example has the physical number that it stands for: a closed form, or a figure found on finer elements."""
    number, tolerance = NUMBERS[name]
    results = run_of_example(name)
    found, known = number(results)
    assert found == pytest.approx(known, rel=tolerance)
    figures = results.summary
    if results.network is None:
        assert figures["surface"]["mean_curvature_deviation"] <= figures["surface"]["tolerance"]
        assert sum(figures["seconds"].values()) < 60
        return
    assert figures["lamellas"]["utilisation_max"] < 1
    assert figures["network"]["closed"] == (name not in OPEN)
    if isinstance(results.surface, ClosedForm):
        return
    ruler = measure(json.loads(network_bytes(results.network, name=name, version="0")))
    assert ruler["family_sign_errors"] == 0
    assert ruler["node_angle_measured"] == ruler["regular_nodes"] > (200 if name < "19" else 80)
    assert ruler["normal_curvature_error_p95"] <= 1e-3 * ruler["curvature_scale"]
    if "node_angle" in figures["surface"]:
        off = abs(90 - figures["surface"]["node_angle"])
        assert ruler["node_angle_deviation_max_deg"] == pytest.approx(off, abs=0.05)
        assert figures["network"]["node_angle_deviation_max_deg"] <= 0.05
    elif name in ASKEW:
        reported = figures["network"]["node_angle_deviation_max_deg"]
        assert ruler["node_angle_deviation_max_deg"] == pytest.approx(reported, abs=0.1)
    elif name not in OPEN:
        assert ruler["node_angle_deviation_max_deg"] <= 0.1
        assert all(joint["closed"] for joint in figures["network"]["joints"])
        assert all(umbilic["node"] for umbilic in figures["network"]["umbilics"])


@pytest.mark.parametrize("name", NUMBERS)
def test_examples_warn_of_what_is_known_of_them_and_of_nothing_else(name):
    """Warnings of every example in full, by patterns: nothing else is said."""
    left = list(WARNINGS.get(name, []))
    for message in run_of_example(name).summary["warnings"]:
        matching = [pattern for pattern in left if re.fullmatch(pattern, message)]
        assert matching, message
        left.remove(matching[0])
    assert SEAMS not in left
    assert MISSED not in left


FREE = ("network", "lamella", "fabrication", "files", "joint", "cables", "edge_beam", "structure", "erection")


@pytest.mark.parametrize("name", NUMBERS)
def test_defaults_filled_in_read_back_the_same(name):
    given = read_project(EXAMPLES / f"{name}.toml")
    project = run_of_example(name).project
    full = tomllib.loads(project.to_toml())
    again = parse_project(full)
    assert again.to_toml() == project.to_toml()
    for table in ("surface", "network", "lamella"):
        assert getattr(again, table) == getattr(project, table)
    assert again.fabrication.slot_width == (given.fabrication.slot_width or 2 * given.lamella.thickness)
    # every key that can have a value has one, of tables that are there
    unset = {"spacing"} if project.network.spacing is None else {"cells"}
    unset |= {"normal_curvature"} if project.network.normal_curvature is None else set()
    for table, model in FURTHER_TABLES.items():
        there = getattr(project, table)
        # what the net, the strips or who writes files decide
        left = {key for key, value in there or () if value is None} if table in FREE else set()
        assert set(full.get(table, ())) == (set(model.model_fields) - unset - left if there else set())


@cache
def pages():
    return builder().pages({name: run_of_example(name) for name in sorted(NUMBERS)})


SCHEMAS = [f"schema/{name}.schema.json" for name in ("project", "network", "optimise")]


@pytest.mark.parametrize("path", ["project-file.md", "examples.md", *SCHEMAS])
def test_generated_text_is_up_to_date(path):
    stored = (DOCS / path).read_text(encoding="utf-8")
    # counts and words as they are, other figures within their last digit
    assert same_text(stored, pages()[path]), "run: make docs"


def test_every_key_of_summary_and_schedule_is_described():
    text = (DOCS / "files.md").read_text()
    for summary in (run_of_example(name).summary for name in NUMBERS):
        for stage, values in summary.items():
            keys = [f"{stage}.{key}" for key in values] if isinstance(values, dict) and stage != "seconds" else [stage]
            # a stage that has not been run is null
            for key in (key for key in keys if key != "schema" and summary.get(key, 0) is not None):
                assert f"`{key}`" in text, key
    for column in (column.name for column in COLUMNS):
        assert f"`{column}`" in text, column

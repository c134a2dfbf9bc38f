"""The tables [structure], [[support]], [[load]] and [[combination]]: what they refuse, by key, and their defaults."""

import json
import re
import tomllib

import pytest

from lamella import InputError, parse_project
from lamella.project.structure_analyses_tables import STAGES

SURFACE = '[surface]\nkind = "catenoid"\nneck_radius = 2.5\nheight = [-2.0, 3.0]\n'
SNOW = '[[load]]\nname = "snow"\nkind = "area"\nvalue = 500\nper = "plan"\n'
WEIGHT = '[[load]]\nname = "weight"\nkind = "self_weight"\n'


def project(text):
    return parse_project(tomllib.loads(SURFACE + text), source="p.toml", text=SURFACE + text)


@pytest.mark.parametrize(
    ("text", "key", "named"),
    [
        ("[[support]]\n", "support[0]", ["boundary", "ground", "near"]),
        ('[[support]]\nboundary = "rim"\nground = 0.0\n', "support[0].ground", ["boundary"]),
        ('[[support]]\nboundary = "rim"\nradius = 1.0\n', "support[0].radius", ["near"]),
        ("[[support]]\nnear = [0, 0, 0]\ntolerance = 1.0\n", "support[0].tolerance", ["ground"]),
        ('[[support]]\nboundary = "rim"\nfixed = []\n', "support[0].fixed", ["nothing is held"]),
        ('[[support]]\nboundary = "rim"\nfixed = "x"\n', "support[0].fixed", ["list"]),
        ('[[support]]\nboundary = "rim"\nfixed = ["q"]\n', "support[0].fixed[0]", ["'q'", "'rx'"]),
        ('[[support]]\nboundary = "rim"\nspring = {z = -1.0}\n', "support[0].spring.z", ["-1", "0.001"]),
        ('[[support]]\nboundary = "rim"\nfixed = ["z"]\nspring = {z = 1e6}\n', "support[0].spring.z", ["fixed"]),
        ('[[support]]\nboundry = "rim"\nfixed = ["z"]\n', "support[0].boundry", ["boundary"]),
        ("[support]\nground = 0.0\n", "support", ["[[support]]"]),
        (SNOW.replace("500", "0.5"), "load[0].value", ["0.5 N/m2", "100000 N/m2", "kN"]),
        (SNOW.replace("500", "5e5"), "load[0].value", ["500000 N/m2", "kN"]),
        (SNOW.replace("value = 500\n", ""), "load[0].value", ["missing"]),
        (SNOW + "direction = [0, 0, 0]\n", "load[0].direction", ["zero"]),
        (SNOW + 'direction = "down"\n', "load[0].direction", ["normal"]),
        (SNOW + 'direction = "normal"\n', "load[0].per", ["true"]),
        (SNOW + 'boundary = "rim"\n', "load[0].boundary", ["area"]),
        (SNOW + "psi = [0.2, 0.5, 0.0]\n", "load[0].psi", ["psi1"]),
        (SNOW + SNOW, "load[1].name", ["snow", "twice"]),
        (SNOW + '[[combination]]\nname = "snow"\nfactors = {snow = 1.5}\n', "combination[0].name", ["twice"]),
        (
            SNOW + '[[combination]]\nname = "u"\nfactors = {sno = 1.5}\n',
            "combination[0].factors.sno",
            ["'snow'", "sno"],
        ),
        (SNOW + '[[combination]]\nname = "u"\nfactors = {}\n', "combination[0].factors", ["factors"]),
        (SNOW + '[[combination]]\nname = "u"\nfactors = {snow = 1e9}\n', "combination[0].factors", ["100"]),
        (SNOW + '[structure]\ncombinations = "EN 1990 6.10"\n', "load[0].category", ["wind"]),
        (SNOW + '[structure]\nserviceability = "frequent"\n', "load[0].category", ["snow"]),
        (WEIGHT + 'category = "wind"\n', "load[0].category", ["permanent"]),
        ('[[load]]\nname = "x"\nkind = "line"\nvalue = 100\n', "load[0].boundary", ["missing"]),
        ('[[load]]\nname = "x"\nkind = "point"\nnear = [0, 0, 0]\n', "load[0].value", ["moment"]),
        ('[[load]]\nname = "x"\nkind = "settlement"\nvalue = 0.01\n', "load[0]", ["ground"]),
        ('[[load]]\nname = "x"\nkind = "settlement"\nvalue = 20\nground = 0\n', "load[0].value", ["1 m"]),
        ('[[load]]\nname = "x"\nkind = "temperature"\nvalue = 5000\n', "load[0].value", ["500 K"]),
        (SNOW + "[[load.region]]\ncoefficient = 0.8\n", "load[0].region[0]", ["facing"]),
        (SNOW + "[[load.region]]\ncoefficient = 0.8\nnear = [0, 0, 0]\n", "load[0].region[0].radius", ["near"]),
        (
            SNOW + "[[load.region]]\ncoefficient = 0.8\nlow = [0, 0, 0]\nhigh = [1, 0, 1]\n",
            "load[0].region[0].high",
            ["in y"],
        ),
        ('[structure]\njoints = "loose"\n', "structure.joints", ["stiffness"]),
        ("[structure]\njoints = {stiffness = -1}\n", "structure.joints", ["-1", "0.001"]),
        ("[structure]\njoints = {stifness = 1}\n", "structure.joints", ["stiffness"]),
        ("[structure]\nelements = 0\n", "structure.elements", ["1", "32"]),
        ("[structure]\nfixed = 3\n", "structure.fixed", ["[[support]]"]),
    ],
)
def test_what_is_refused_names_the_key_and_the_limit(text, key, named):
    with pytest.raises(InputError) as caught:
        project(text)
    told = str(caught.value)
    assert told.splitlines()[0].partition(": ")[2].startswith(f"{key}:"), told
    assert "\n  remedy: " in told
    for word in named:
        assert word in told


def test_an_unknown_key_of_a_support_is_not_one_of_boundaries():
    with pytest.raises(InputError) as caught:
        project('[[support]]\nboundary = "rim"\ncircle = 3\n')
    assert "surface.boundary" not in str(caught.value)


def test_supports_hold_all_shifts_where_nothing_else_is_said():
    given = project('[[support]]\nboundary = "rim"\n[[support]]\nground = 0\nspring = {z = 1e6}\n').support
    assert given[0].fixed == ("x", "y", "z")
    assert given[1].fixed is None
    assert given[1].spring.given() == {"z": 1e6}


def test_loads_ask_for_a_structure():
    assert project("").structure is None
    assert project(WEIGHT).structure.elements == 4


@pytest.mark.parametrize(
    "text",
    [
        SNOW + "[[load.region]]\ncoefficient = -0.5\nfacing = [1, 0, 0]\n",
        '[[load]]\nname = "p"\nkind = "area"\nvalue = -300\ndirection = "normal"\n',
        '[[load]]\nname = "t"\nkind = "temperature"\nvalue = -30\n',
        '[[load]]\nname = "s"\nkind = "settlement"\nvalue = 0.02\nnear = [1, 2, 3]\n',
        '[[load]]\nname = "m"\nkind = "point"\nmoment = [0, 0, 1e6]\nnear = [1, 2, 3]\n',
        WEIGHT + "direction = [1, 0, 0]\nvalue = 0.2\n" + '[[combination]]\nname = "quake"\nfactors = {weight = 1}\n',
        "[structure]\njoints = {stiffness = 30}\nfactors = {reduction = 0.9}\n[[support]]\nground = 0\n",
    ],
)
def test_what_is_written_back_reads_the_same(text):
    one = project(text)
    again = parse_project(tomllib.loads(one.to_toml()))
    assert again.to_toml() == one.to_toml()
    assert again == one


def test_loads_have_the_defaults_of_their_kind_alone():
    loads = project(WEIGHT + SNOW + '[[load]]\nname = "t"\nkind = "temperature"\nvalue = 20\n').load
    assert [(load.value, load.direction, load.per) for load in loads] == [
        (1.0, (0.0, 0.0, -1.0), None),
        (500.0, (0.0, 0.0, -1.0), "plan"),
        (20.0, None, None),
    ]


@pytest.mark.parametrize(
    ("more", "left"),
    [
        ("", {"cables on"}),
        ("[joint]\n[cables]\n", set()),
        ('joints = "hinged"\n', {"joints locked", "cables on"}),
    ],
)
@pytest.mark.parametrize("stages", ["[]", '["loads on", "bent"]', '["bent", "bent", "props away", "loads on"]'])
def test_the_order_that_is_offered_is_one_the_project_can_have(stages, more, left):
    text = "[structure]\nconstruction = {}\n" + more
    with pytest.raises(InputError) as refused:
        project(text.format(stages))
    assert refused.value.where.endswith("structure.construction")
    offered = re.search(r"\[.*\]", refused.value.remedy)[0]
    assert set(STAGES) - set(json.loads(offered)) == left
    assert project(text.format(offered)).structure.construction == tuple(json.loads(offered))

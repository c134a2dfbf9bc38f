"""Supports, loads and combinations of a project's tables on its net."""

import tomllib
from functools import cache

import numpy as np
import pytest

import lamella
from lamella.base.errors import InputError
from lamella.stages.actions_of_tables import actions_of, combinations_of, rims_of

CATENOID = '[surface]\nkind = "catenoid"\nneck_radius = 2.5\nheight = [-2.0, 3.0]\n[network]\ncells = 12\n'
FAR = (4e6, 5e6, 300.0)
RINGS = """
[surface]
kind = "form-found"
tolerance = 1e-2
[[surface.boundary]]
name = "foot"
circle = {{center = [{x}, {y}, {z}], radius = 2.1}}
[[surface.boundary]]
name = "eye"
circle = {{center = [{x}, {y}, {top}], radius = 1.8}}
[network]
cells = 12
"""


@cache
def computed(text):
    return lamella.compute(lamella.parse_project(tomllib.loads(text)), until="network")


def actions(text, tables=""):
    project = lamella.parse_project(tomllib.loads(text + tables))
    results = computed(text)
    return results.network, actions_of(project, results.network, results.surface)


def test_tables_become_supports_and_cases():
    network, found = actions(
        CATENOID,
        '[[support]]\nboundary = "lower"\n[[support]]\nboundary = "upper"\nfixed = ["z"]\nspring = {x = 1e5}\n'
        '[[load]]\nname = "weight"\nkind = "self_weight"\n'
        '[[load]]\nname = "west"\nkind = "area"\nvalue = 400\ndirection = "normal"\n'
        "[[load.region]]\ncoefficient = 0.5\nfacing = [1, 0, 0]\n",
    )
    low, high = np.isclose(network.node_points[:, 2], -2), np.isclose(network.node_points[:, 2], 3)
    assert low.any()
    assert high.any()
    assert (found.supports.fixed[:, 0] == low).all()
    assert (found.supports.fixed[:, 2] == (low | high)).all()
    assert (found.supports.springs[:, 0] == np.where(high, 1e5, 0)).all()
    assert [case.name for case in found.loads] == ["weight", "west"]
    # outside all regions a load with regions is nothing
    loaded = found.loads[1].node_forces.any(1)
    assert (loaded == (network.node_normals[:, 0] > 0)).all()


@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), FAR])
def test_named_curves_and_places_of_drawings_far_away(origin):
    x, y, z = origin
    text = RINGS.format(x=x, y=y, z=z, top=z + 1.2)
    network, found = actions(
        text,
        f'[[support]]\nground = {z}\n[[load]]\nname = "p"\nkind = "point"\nvalue = 100\n'
        f"near = [{x + 1.8}, {y}, {z + 1.2}]\n"
        '[[load]]\nname = "rail"\nkind = "line"\nvalue = 10\nboundary = "eye"\n'
        f'[[load]]\nname = "b"\nkind = "area"\nvalue = 100\n[[load.region]]\ncoefficient = 1\n'
        f"low = [{x - 9}, {y - 9}, {z + 0.5}]\nhigh = [{x + 9}, {y + 9}, {z + 9}]\n",
    )
    points = network.node_points
    foot = np.abs(np.hypot(*points[:, :2].T) - 2.1) < 1e-6
    eye = np.abs(np.hypot(*points[:, :2].T) - 1.8) < 1e-6
    assert foot.sum() > 8
    assert (found.supports.fixed[:, 2] == foot).all()
    push, rail, box = found.loads
    (node,) = np.flatnonzero(push.node_forces.any(1))
    assert np.linalg.norm(points[node] - (1.8, 0, points[eye, 2].mean())) < 0.5
    assert (rail.node_forces.any(1) == eye).all()
    assert (box.node_forces.any(1) == (points[:, 2] >= points[foot, 2].mean() + 0.5)).all()


def test_rims_have_the_names_of_the_curves():
    results = computed(RINGS.format(x=0.0, y=0.0, z=0.0, top=1.2))
    assert rims_of(results.project, results.network, results.surface).names == ("foot", "eye")


@pytest.mark.parametrize(
    ("tables", "where"),
    [
        ('[[support]]\nboundary = "lower"\n[[support]]\nground = -9\n', "support[1].ground"),
        ('[[support]]\nboundary = "left"\n', "support[0].boundary"),
        (
            '[[support]]\nboundary = "lower"\nfixed = ["x", "y"]\n'
            '[[load]]\nname = "x"\nkind = "settlement"\nvalue = 0.01\nboundary = "lower"\n',
            "load[0].direction",
        ),
        ('[[load]]\nname = "x"\nkind = "line"\nvalue = 100\nboundary = "side"\n', "load[0].boundary"),
        (
            '[[load]]\nname = "x"\nkind = "area"\nvalue = 100\n'
            "[[load.region]]\ncoefficient = 1\nnear = [0, 0, 90]\nradius = 1\n",
            "load[0].region[0]",
        ),
    ],
)
def test_what_acts_on_nothing_is_refused_by_its_key(tables, where):
    with pytest.raises(InputError) as caught:
        actions(CATENOID, tables)
    assert caught.value.where == where


def test_combinations_are_those_listed_and_those_of_en_1990():
    loads = (
        '[[load]]\nname = "g"\nkind = "self_weight"\n'
        '[[load]]\nname = "s"\nkind = "area"\nvalue = 500\ncategory = "snow"\n'
        '[[combination]]\nname = "6.10 1"\nfactors = {g = 1.0}\n'
    )
    plain = combinations_of(lamella.parse_project(tomllib.loads(CATENOID + loads)))
    assert [(one.name, one.formula) for one in plain] == [("6.10 1", "1 g")]
    asked = (
        '[structure]\ncombinations = "EN 1990 6.10"\nserviceability = "characteristic"\nfactors = {variable = 1.4}\n'
    )
    made = combinations_of(lamella.parse_project(tomllib.loads(CATENOID + asked + loads)))
    by_name = {one.name: one.formula for one in made}
    # a listed one takes the place of the generated one of its name
    assert by_name["6.10 1"] == "1 g"
    assert by_name["6.10 2"] == "1 g + 1.4 s"
    assert by_name["characteristic 1"] == "1 g + 1 s"
    assert len(by_name) == len(made)

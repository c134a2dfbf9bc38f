"""model.ifc: checked by its library's validator, read back, each part once; refused where the library is missing."""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import lamella
from lamella import InputError, compute, parse_project, write
from lamella.files.write.drawn_layer import Body, DrawnLayer

PROJECT = {
    "surface": {"kind": "catenoid", "neck_radius": 0.8, "height": [-0.3, 0.4]},
    "network": {"cells": 6},
    "joint": {"block_spacing": 0.3},
    "files": {"ifc": True},
}
WITHOUT = "ifcopenshell is not installed: pip install lamella[ifc]"


def test_without_its_library_it_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ifcopenshell", None)
    with pytest.raises(InputError) as refused:
        compute(parse_project(PROJECT))
    assert refused.value.where == "files.ifc"
    assert "ifcopenshell" in str(refused.value)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[lamella.Results, Path]:
    pytest.importorskip("ifcopenshell", reason=WITHOUT)
    results = compute(parse_project(PROJECT))
    folder = tmp_path_factory.mktemp("ifc") / "run"
    write(results, folder)
    return results, folder / "model.ifc"


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_the_validator_finds_nothing(written: tuple[lamella.Results, Path]) -> None:
    import ifcopenshell
    import ifcopenshell.validate

    log = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(ifcopenshell.open(str(written[1])), log, express_rules=True)
    assert log.statements == []


def test_every_part_is_there_once_with_its_properties(written: tuple[lamella.Results, Path]) -> None:
    import ifcopenshell
    import ifcopenshell.util.element as element_of

    results, path = written
    file = ifcopenshell.open(str(path))
    made = results.outputs["fabrication"]
    expected = Counter({part.id: part.quantity for part in made.parts.parts})
    expected.update({item.id: item.quantity for item in made.hardware})
    elements = file.by_type("IfcElement")
    assert Counter(one.Tag for one in elements) == expected
    classes = {item.id: item.kind for item in made.hardware}
    for one in elements:
        kind = classes.get(one.Tag)
        if kind is None:
            assert one.is_a("IfcMember")
        elif kind in ("washer", "key"):
            assert one.is_a("IfcPlate")
        elif kind in ("bolt", "nut", "screw"):
            assert one.is_a("IfcMechanicalFastener")
        properties = element_of.get_psets(one)["Lamella_Part"]
        assert properties["mass_kg"] > 0
        assert element_of.get_material(one).Name == properties["material"]
    mass = sum(element_of.get_psets(one)["Lamella_Part"]["mass_kg"] for one in elements)
    assert mass == pytest.approx(made.parts.mass + made.hardware.mass, rel=1e-4)


def test_the_same_bytes_twice() -> None:
    pytest.importorskip("ifcopenshell", reason=WITHOUT)
    from lamella.files.write.ifc import ifc_bytes

    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    layers = [DrawnLayer("solids A", bodies=(Body("A1", corners, faces, {"material": "x", "mass_kg": "1"}),))]
    assert ifc_bytes(layers, name="n", version="1") == ifc_bytes(layers, name="n", version="1")
    assert ifc_bytes([], name="", version="1")

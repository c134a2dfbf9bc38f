"""The workbook of the Structural Analysis Format, read back with openpyxl against the columns that its documentation
(version 2.2.0, github.com/StructuralAnalysisFormat/StructuralAnalysisFormat-Doc) requires."""

from __future__ import annotations

from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pytest

import lamella
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Section
from lamella.structure.actions.combinations import Combination
from lamella.structure.analysis.analyse import Analysis, analyse
from lamella.structure.export.saf.workbook import write_saf
from lamella.structure.export.straight_model import straight_model
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from structure.model.nets import pinned_rim, pushed

# sheet: what has to be filled in every row
REQUIRED = {
    "StructuralMaterial": "Name; Type; Quality",
    "StructuralCrossSection": "Name; Material; Cross-section type; Shape; Parameters [mm]",
    "StructuralPointConnection": "Name; Coordinate X [m]; Coordinate Y [m]; Coordinate Z [m]",
    "StructuralCurveMember": "Name; Cross section; Nodes; Segments; LCS; LCS Rotation [deg]; Coordinate X [m]; "
    "Coordinate Y [m]; Coordinate Z [m]; System line; Analysis Y Eccentricity of Beg Node [mm]; Analysis Z "
    "Eccentricity of Beg Node [mm]; Analysis Y Eccentricity of End Node [mm]; Analysis Z Eccentricity of End Node "
    "[mm]; Behaviour in analysis",
    "StructuralPointSupport": "Name; Boundary condition; Node; ux; uy; uz; fix; fiy; fiz",
    "RelConnectsStructuralMember": "Name; Member; Position; ux; uy; uz; fix; fiy; fiz; Stiffness Fiy [MNm/rad]",
    "RelConnectsRigidCross": "Name; 1D Members; u1; u2; u; fi1; fi2; fi",
    "RelConnectsRigidLink": "Name; Nodes; Hinge position; ux; uy; uz; fix; fiy; fiz",
    "StructuralLoadGroup": "Name; Load group type; Relation",
    "StructuralLoadCase": "Name; Action type; Load group; Load type",
    "StructuralLoadCombination": "Name; Category; Load factor 1; Multiplier 1; Load case name 1",
    "StructuralPointAction": "Name; Direction; Force action; Reference node; Value [kN]; Load case; Coordinate system",
    "StructuralCurveAction": "Name; Force action; Distribution; Direction; Value 1 [kN/m]; Member; Load case; "
    "Coordinate system; Location; Coordinate definition; Origin; Extent; Start point [m]; End point [m]; Eccentricity "
    "ey [mm]; Eccentricity ez [mm]",
    "StructuralCurveActionThermal": "Name; Force action; Variation; Member; Load case; Coordinate definition; Origin; "
    "Start point [m]; End point [m]",
}
STEEL = lamella.Material(7850, 200e9, 77e9, 355e6)


def analysis(**rules: Any) -> Analysis:
    """24 nodes on Enneper's surface, pairs of 50 x 1.5 mm, pinned along the rim."""
    network = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.9)
    section = Section(height=0.05)
    rules = {"elements": 1, "slot_width": 0.003} | rules
    model = make_model(
        network.strips(section, STEEL), pinned_rim(network), ModelRules(**rules), cables=CableRules(prestress=300.0)
    )
    return analyse(model, [pushed(network, (0, 3.0, -20.0), 1.0)], buckling=0, frequencies=0)


def write(path: Path, found: Analysis) -> dict[str, list[dict[str, Any]]]:
    """Rows by sheet."""
    combinations = [Combination("uls", {"pushed": 1.5})]
    write_saf(path, found, {"pushed": "snow"}, combinations, name="patch", version="1")
    book = openpyxl.load_workbook(path)
    return {sheet.title: list(_rows(sheet)) for sheet in book if sheet.title not in ("Project", "Model")}


def _rows(sheet: Any) -> Iterator[dict[str, Any]]:
    rows = sheet.iter_rows(values_only=True)
    header = next(rows)
    for row in rows:
        yield {key: value for key, value in zip(header, row, strict=True) if value is not None}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Analysis, Path, dict[str, list[dict[str, Any]]]]:
    found = analysis(layers="each", block_spacing=0.5, joints="springs", joint_stiffness=50.0)
    path = tmp_path_factory.mktemp("saf") / "saf.xlsx"
    return found, path, write(path, found)


def test_required_columns_are_filled_and_names_refer_to_what_is_there(made: Any) -> None:
    _, path, sheets = made
    for title, wanted in REQUIRED.items():
        for row in sheets[title]:
            missing = set(wanted.split("; ")) - set(row)
            assert not missing, (title, missing)
        names = [row["Name"] for row in sheets[title]]
        assert len(set(names)) == len(names) > 0
    known = {title: {row["Name"] for row in rows} for title, rows in sheets.items()}
    for title, column, target in (
        ("StructuralCrossSection", "Material", "StructuralMaterial"),
        ("StructuralCurveMember", "Cross section", "StructuralCrossSection"),
        ("StructuralCurveMember", "Nodes", "StructuralPointConnection"),
        ("StructuralPointSupport", "Node", "StructuralPointConnection"),
        ("RelConnectsStructuralMember", "Member", "StructuralCurveMember"),
        ("RelConnectsRigidCross", "1D Members", "StructuralCurveMember"),
        ("RelConnectsRigidLink", "Nodes", "StructuralPointConnection"),
        ("StructuralLoadCase", "Load group", "StructuralLoadGroup"),
        ("StructuralLoadCombination", "Load case name 2", "StructuralLoadCase"),
        ("StructuralPointAction", "Reference node", "StructuralPointConnection"),
        ("StructuralCurveAction", "Member", "StructuralCurveMember"),
        ("StructuralCurveActionThermal", "Member", "StructuralCurveMember"),
    ):
        for row in sheets[title]:
            assert set(str(row[column]).split("; ")) <= known[target], (title, row)
    model = dict(openpyxl.load_workbook(path)["Model"].iter_rows(values_only=True))
    assert model["SAF Version"] == "2.2.0"
    assert "twist" in model["Description"]


def test_the_whole_load_arrives(made: Any) -> None:
    found, _, sheets = made
    points = {
        row["Name"]: np.array([row[f"Coordinate {way} [m]"] for way in "XYZ"])
        for row in sheets["StructuralPointConnection"]
    }
    lengths = {}
    for row in sheets["StructuralCurveMember"]:
        one, other = (points[name] for name in row["Nodes"].split("; "))
        lengths[row["Name"]] = np.linalg.norm(other - one)
    total = np.zeros(3)
    for row in sheets["StructuralPointAction"]:
        total["XYZ".index(row["Direction"])] += row["Value [kN]"]
    for row in sheets["StructuralCurveAction"]:
        total["XYZ".index(row["Direction"])] += row["Value 1 [kN/m]"] * lengths[row["Member"]]
    assert 1e3 * total == pytest.approx(found.cases[1].load_total, rel=1e-6, abs=1e-6)


def test_members_hang_together(made: Any) -> None:
    """By members, rigid links and crosses every node is reached from the first one: none is there for nothing."""
    found, _, sheets = made
    nodes = {row["Name"] for row in sheets["StructuralPointConnection"]}
    members = {row["Name"]: row["Nodes"].split("; ") for row in sheets["StructuralCurveMember"]}
    pairs = [*members.values(), *(row["Nodes"].split("; ") for row in sheets["RelConnectsRigidLink"])]
    for row in sheets["RelConnectsRigidCross"]:
        one, other = (members[name] for name in row["1D Members"].split("; "))
        pairs.append([one[0], other[0]])
    assert len(sheets["RelConnectsRigidCross"]) == len(found.model.joint_nodes) > 0
    assert sheets["RelConnectsRigidCross"][0]["Stiffness fi [MNm/rad]"] == pytest.approx(50e-6)
    there = {"N0"}
    while len(there) < (more := len(there | {end for pair in pairs if there & set(pair) for end in pair})):
        there |= {end for pair in pairs if there & set(pair) for end in pair}
        assert more == len(there)
    assert there == nodes
    behaviour = {row["Behaviour in analysis"] for row in sheets["StructuralCurveMember"] if "cable" in row["Name"]}
    assert behaviour == {"Tension only"}


def test_temperature_of_the_residual_case_has_the_moments_of_the_strips(made: Any) -> None:
    """A held member that is warmer by dT on its right face (y) has the moment E I alpha dT / b. Cables are pairs."""
    found, _, sheets = made
    structure = found.model.structure
    state = structure.beams.at(structure.poses)
    straight = straight_model(found.model)
    moments = dict(zip(straight.names, state.strains.values[5], strict=True))
    stretch = dict(zip(straight.names, state.strains.values[0], strict=True))
    rows = [row for row in sheets["StructuralCurveActionThermal"] if row["Load case"] == "residual"]
    linear = [row for row in rows if row["Variation"] == "Linear"]
    assert len(linear) == len(found.model.lines.length)
    for row in linear:
        warmer = row["TempR [°C]"] - row["TempL [°C]"]
        assert STEEL.expansion * warmer / 0.0015 == pytest.approx(moments[row["Member"]], abs=1e-6)
        assert row["TempR [°C]"] + row["TempL [°C]"] == pytest.approx(row["TempT [°C]"] + row["TempB [°C]"], abs=1e-5)
        mean = (row["TempR [°C]"] + row["TempL [°C]"]) / 2
        assert -STEEL.expansion * mean == pytest.approx(stretch[row["Member"]], abs=1e-9)
    tension = {row["Member"]: row["deltaT [°C]"] for row in rows if row["Variation"] == "Constant"}
    forces = [-16e-6 * tension[f"cable.{k + 1}"] * axial for k, axial in enumerate(structure.cables.axial)]
    assert forces == pytest.approx([2 * 300.0] * len(forces), rel=1e-3)


def test_layers_in_one_line_share_a_stiffer_material(tmp_path: Path) -> None:
    found = analysis()
    sheets = write(tmp_path / "saf.xlsx", found)
    strip, section = sheets["StructuralMaterial"][0], sheets["StructuralCrossSection"][0]
    height, width = (float(value) / 1e3 for value in section["Parameters [mm]"].split("; "))
    law = found.model.structure.beams.sections[0]
    young = strip["E modulus [MPa]"] * 1e6
    assert young * height * width == pytest.approx(law.axial)
    assert young * width * height**3 / 12 == pytest.approx(law.bending_u)
    assert young * height * width**3 / 12 == pytest.approx(law.bending_n)
    assert strip["Unit mass [kg/m3]"] * height * width == pytest.approx(law.mass)
    assert "RelConnectsRigidCross" not in sheets
    # a slot at every crossing: a hinge at each element's end there
    assert len(sheets["RelConnectsStructuralMember"]) == found.model.lines.crossed.sum()


def test_two_runs_write_the_same_bytes(made: Any, tmp_path: Path) -> None:
    found, path, _ = made
    write(tmp_path / "again.xlsx", found)
    assert sha256((tmp_path / "again.xlsx").read_bytes()).digest() == sha256(path.read_bytes()).digest()

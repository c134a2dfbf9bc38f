"""Tables of results: balance of the forces they tell, stresses, places, and the files."""

import csv
from dataclasses import replace
from functools import cache

import numpy as np
import openpyxl
import pytest

import lamella
from lamella.hardware.rules import CableRules
from lamella.strip.lamellas import Section
from lamella.structure.analysis.analyse import analyse
from lamella.structure.export import result_rows as rows
from lamella.structure.export.imposed_curvatures import HEADER, write_imposed_curvatures
from lamella.structure.export.result_tables import CSV_TABLES, write_result_book, write_result_table
from lamella.structure.model.model import make_model
from lamella.structure.model.rules import ModelRules
from structure.model.nets import pinned_rim, pushed

STEEL = lamella.Material(7850, 210e9, 81e9, 355e6)
SIGNED = {"name": "patch", "version": "1"}


@cache
def analysed():
    """24 nodes under 20 N each and under their weight, with cables."""
    network = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.9)
    section = Section(height=0.05, layers=1)
    rules = ModelRules(elements=2, slots="whole")
    cables = CableRules(1, 0.006, 500.0, 0.2)
    model = make_model(network.strips(section, STEEL), pinned_rim(network), rules, cables=cables)
    push = replace(pushed(network, (5.0, 0, -20.0)), name="push")
    weight = replace(pushed(network, (0, 0, 0.0), weight=1.0), name="weight")
    return analyse(model, [push, weight], buckling=0, frequencies=0)


def table(header, of):
    """Columns by name, of a table's rows."""
    return dict(zip(header, np.array([[str(value) for value in row] for row in of]).T, strict=True))


def test_forces_at_element_ends_balance_those_of_the_nodes_between():
    """Between the network's nodes nothing acts: what one element's end says the next one's says too."""
    push = analysed().cases[1]
    lines = push.model.lines
    forces = rows.EndForces.of(push).values
    inner = np.flatnonzero(lines.nodes[:-1, 1] == lines.nodes[1:, 0])
    inner = inner[lines.nodes[inner, 1] >= push.model.nodes]
    assert len(inner) > 20
    assert forces[inner, 1] == pytest.approx(forces[inner + 1, 0], abs=1e-6 * np.abs(forces).max())


def test_forces_at_supports_are_those_of_the_lamellas_that_end_there():
    case = analysed().cases[1]
    model, state = case.model, case.equilibrium.state
    lines = model.lines
    found = np.zeros((len(model.structure.poses.points), 3))
    forces = rows.EndForces.of(case).values[:, :, :3]
    _, frames = model.structure.beams.attachment.ends(case.equilibrium.poses)
    assert state.motion.frame.shape[-1] == len(lines.nodes)
    for end, sign in ((0, -1.0), (1, 1.0)):
        np.add.at(found, lines.nodes[:, end], sign * np.einsum("mij,mj->mi", frames[:, end], forces[:, end]))
    cables = case.equilibrium.whole.cables
    for end, sign in ((0, -1.0), (1, 1.0)):
        np.add.at(found, cables.cables.attachment.nodes[:, end], sign * (cables.tension * cables.direction).T)
    applied = np.zeros_like(found)
    applied[: model.nodes] = (5.0, 0.0, -20.0)
    # what holds the ends at a node is what acts there
    on = table(rows.SUPPORTS, rows.support_rows(case))
    for k, node in enumerate(on["node"].astype(int)):
        told = [float(on[key][k]) for key in ("Fx_N", "Fy_N", "Fz_N")]
        assert found[node] - applied[node] == pytest.approx(told, abs=1e-3)
    total = np.sum([on[key].astype(float) for key in ("Fx_N", "Fy_N", "Fz_N")], axis=1)
    assert total == pytest.approx(-applied.sum(0), abs=1e-2)


def test_element_rows_tell_the_stresses_that_are_used():
    case = analysed().cases[2]
    found = table(rows.ELEMENTS, rows.element_rows(case))
    assert len(found["case"]) == 2 * len(case.model.structure.beams)
    assert set(found["lamella"]) == set(case.model.lamellas.network.ids)
    stress = found["von_mises_MPa"].astype(float)
    assert stress.max() == pytest.approx(case.von_mises_max / 1e6, rel=1e-6)
    # weak-axis bending is the difference of both faces, and their mean what is left in the middle
    left, right = (found[f"{side}_face_MPa"].astype(float) for side in ("left", "right"))
    assert np.abs(left - right) / 2 == pytest.approx(found["weak_bending_MPa"].astype(float), abs=2e-5)
    middle = found["axial_MPa"].astype(float) + found["helix_centre_MPa"].astype(float)
    assert (left + right) / 2 == pytest.approx(middle, abs=2e-5)
    # the mean normal stress is the axial force over the area
    assert found["N_N"].astype(float) / (0.05 * 0.0015) / 1e6 == pytest.approx(
        found["axial_MPa"].astype(float), abs=0.02 * np.abs(found["axial_MPa"].astype(float)).max()
    )


def test_a_pulled_face_is_the_outer_one():
    """Where a strip turns left (kg > 0) its right face is the outer, stretched one."""
    case = analysed().cases[0]
    kg = case.model.structure.beams.at(case.equilibrium.poses).motion.local_theta[2]
    found = table(rows.ELEMENTS, rows.element_rows(case))
    turn = (found["right_face_MPa"].astype(float) - found["left_face_MPa"].astype(float)).reshape(-1, 2).mean(1)
    strongly = np.abs(kg) > 0.3 * np.abs(kg).max()
    assert (np.sign(turn[strongly]) == np.sign(kg[strongly])).all()


def test_most_stressed_places_are_the_largest_of_all_cases_once_each():
    cases = analysed().cases
    found = table(rows.STRESSED, rows.stressed_rows(cases))
    use = found["utilisation"].astype(float)
    assert len(use) == rows.PLACES
    assert (np.diff(use) <= 0).all()
    assert use[0] == pytest.approx(max(case.utilisation_max for case in cases), abs=1e-6)
    assert len(set(zip(found["lamella"], found["at_m"], strict=True))) == rows.PLACES
    network = cases[0].model.lamellas.network
    assert set(found["lamella"]) <= set(network.ids)
    top = max(cases, key=lambda case: case.utilisation_max)
    assert found["case"][0] == top.name


def test_lamella_rows_are_the_extremes_of_their_elements():
    case = analysed().cases[1]
    elements, found = table(rows.ELEMENTS, rows.element_rows(case)), table(rows.LAMELLAS, rows.lamella_rows(case))
    for k, name in enumerate(found["lamella"]):
        own = elements["lamella"] == name
        axial = elements["N_N"][own].astype(float)
        assert float(found["N_min_N"][k]) == pytest.approx(axial.min(), abs=1e-3)
        assert float(found["N_max_N"][k]) == pytest.approx(axial.max(), abs=1e-3)
        assert float(found["utilisation_max"][k]) == pytest.approx(
            elements["utilisation"][own].astype(float).max(), abs=1e-5
        )


@pytest.mark.parametrize("name", CSV_TABLES)
def test_csv_tables_have_their_header_and_a_row_for_each(tmp_path, name):
    cases = analysed().cases
    write_result_table(tmp_path / "a.csv", name, cases, **SIGNED)
    write_result_table(tmp_path / "b.csv", name, cases, **SIGNED)
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    lines = list(csv.reader((tmp_path / "a.csv").read_text("utf-8").splitlines()[1:]))
    assert tuple(lines[0]) == CSV_TABLES[name][0]
    model = cases[0].model
    each = {
        "nodes": model.nodes,
        "elements": 2 * len(model.structure.beams),
        "supports": int(model.supports.supported.sum()),
        "cables": len(model.structure.cables),
    }
    assert len(lines) - 1 == len(cases) * each[name]
    assert each[name] > 0
    assert {row[0] for row in lines[1:]} == {"residual", "push", "weight"}


def test_the_workbook_opens_elsewhere_and_has_the_same_bytes(tmp_path):
    for name in ("a.xlsx", "b.xlsx"):
        write_result_book(tmp_path / name, analysed().cases, **SIGNED)
    assert (tmp_path / "a.xlsx").read_bytes() == (tmp_path / "b.xlsx").read_bytes()
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    assert book.sheetnames == ["cases", "most stressed", "lamellas", "supports", "cables"]
    page = list(book["cases"].iter_rows(values_only=True))
    assert [row[0] for row in page[1:]] == ["residual", "push", "weight"]
    assert page[2][7] == pytest.approx(analysed().cases[1].utilisation_max, rel=1e-5)


def test_imposed_curvatures_are_those_of_the_designed_shape(tmp_path):
    model = analysed().model
    write_imposed_curvatures(tmp_path / "x.csv", model, **SIGNED)
    lines = list(csv.reader((tmp_path / "x.csv").read_text("utf-8").splitlines()[1:]))
    found = table(HEADER, lines[1:])
    network = model.lamellas.network
    at = np.asarray(model.lines.arclengths).mean(1)
    for k in range(0, len(at), 7):
        own = slice(*network.sample_offsets[model.lines.lamella[k] : model.lines.lamella[k] + 2])
        for key, values in (("kg_per_m", network.sample_darboux.kg), ("tg_per_m", network.sample_darboux.tg)):
            exact = np.interp(at[k], network.sample_arclengths[own], values[own])
            assert float(found[key][k]) == pytest.approx(exact, abs=0.02)
    # straight strips on a minimal surface: none about the strong axis, but for the elements' length
    assert np.abs(found["kn_per_m"].astype(float)).max() < 0.02
    assert found["EA_N"].astype(float) == pytest.approx(210e9 * 0.05 * 0.0015)

"""The study of examples/studies/vault_study.toml."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

import lamella
from conftest import EXAMPLES

STUDIES = EXAMPLES / "studies"


@pytest.mark.slow
def test_the_lightest_vault_is_the_same_from_three_starts(tmp_path: Path) -> None:
    """As low as allowed and so thick that its buckling factor is the limit: mass is proportional to height times
    thickness, and under snow the vault's strips buckle between their nodes."""
    values = tomllib.loads((STUDIES / "vault_study.toml").read_text())
    found = []
    for number, start in enumerate(([0.08, 0.003], [0.05, 0.0058], [0.14, 0.0025])):
        values["optimise"] = {"start": start, "evaluations": 150}
        study = lamella.study(values, folder=STUDIES, out=tmp_path / str(number), jobs=1)
        best = study.columns["id"].index(study.best[0])
        found.append([study.columns[key][best] for key in ("lamella.height", "lamella.thickness", "fabrication.mass")])
        # what the search began with
        assert study.columns["fabrication.mass"][best] < study.columns["fabrication.mass"][0]
    for height, thickness, mass in found:
        assert height == pytest.approx(0.04, rel=1e-6)
        assert thickness == pytest.approx(found[0][1], rel=1e-4)
        assert mass == pytest.approx(found[0][2], rel=1e-4)
    assert found[0][2] == pytest.approx(235.6, rel=2e-3)


@pytest.mark.parametrize("name", [path.name for path in sorted(STUDIES.glob("*_study.toml"))])
def test_studies_of_the_examples_are_read(name: str) -> None:
    from lamella.studies.tables import read_study

    study = read_study(STUDIES / name)
    assert (STUDIES / study.project).is_file()

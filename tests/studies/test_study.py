"""Studies with workers: tables, folders, what is kept, what is refused, what is searched."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import lamella
from lamella.studies.table import Table
from lamella.studies.variant import DONE, REFUSED

pytest.importorskip("distributed", reason="Dask is not installed")

# sockets and threads of Dask are closed after the test
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning")

CATENOID = '[surface]\nkind = "catenoid"\nneck_radius = 1.2\nheight = [0.0, 2.0]\n[network]\ncells = 12\n'
GRID: dict[str, Any] = {
    "project": "roof.toml",
    "until": "lamellas",
    "variable": [
        {"key": "surface.neck_radius", "values": [1.0, 2.0, -1.0]},
        {"key": "lamella.height", "values": [0.05, 0.1]},
    ],
    "objective": [{"figure": "lamellas.utilisation_max"}, {"figure": "surface.area", "goal": "max"}],
    "constraint": [{"figure": "lamellas.utilisation_max", "at_most": 10.0}],
    "headroom": [{"name": "door", "at": [2.2, 0.0], "ground": 0.1}],
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "roof.toml").write_text(CATENOID)
    return tmp_path


def _rows(out: Path) -> list[dict[str, str]]:
    with (out / "table.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_grid_is_computed_once_and_its_folder_is_whole(folder: Path) -> None:
    """Areas and torsions of catenoids in closed form; refused ones with their reasons; a second call computes none."""
    out = folder / "study"
    study = lamella.study(GRID, folder=folder, out=out, jobs=2)
    assert study.computed == 6
    rows = _rows(out)
    assert [row["status"] for row in rows] == 4 * [DONE] + 2 * [REFUSED]
    for row in rows[:4]:
        c, h = float(row["surface.neck_radius"]), 2.0
        assert float(row["surface.area"]) == pytest.approx(np.pi * c * (h + c / 2 * np.sinh(2 * h / c)), rel=1e-9)
        assert float(row["lamellas.geodesic_torsion_max"]) == pytest.approx(1 / c, rel=1e-9)
        if c == 2.0:
            # z = c arcosh(r / c), off by the sag of the mesh
            assert float(row["headroom.door"]) == pytest.approx(2 * np.arccosh(1.1) - 0.1, abs=0.03)
        files = sorted(path.name for path in (out / "variants" / row["id"]).iterdir())
        assert files == ["project.toml", "summary.json", "variant.json", "view.js"]
    assert all("surface.neck_radius" in row["reason"] and "-1" in row["reason"] for row in rows[4:])
    # the flattest catenoid with the lower strip is best in both
    assert [row["id"] for row in rows if row["best"] == "true"] == list(study.best)
    assert "0002" in study.best
    project = lamella.read_project(study.project("0002"))
    assert project.lamella.height == 0.05
    summary = json.loads((out / "variants" / "0002" / "summary.json").read_bytes())
    assert summary["surface"]["area"] == pytest.approx(float(rows[2]["surface.area"]), rel=1e-11)
    page = (out / "study.html").read_text()
    assert "http" not in re.sub(r"http://www\.w3\.org/\S+", "", page)
    assert (
        json.loads(page.partition('application/json">')[2].partition("</script>")[0])["names"]
        == study.columns["id"][:4]
    )
    table = (out / "table.csv").read_bytes()
    # nothing is missing: no workers are begun, and the same table comes of what is there
    again = lamella.study(GRID, folder=folder, out=out, jobs=1)
    assert again.computed == 0
    assert (out / "table.csv").read_bytes() == table
    # other values: what is there for them is not theirs; an edited project makes all anew
    assert not _kept(folder, GRID | {"until": "network"}, out)
    (folder / "roof.toml").write_text(CATENOID.replace("2.0]", "2.1]"))
    assert not _kept(folder, GRID, out)


def _kept(folder: Path, study: dict[str, Any], out: Path) -> bool:
    """Whether the first variant of a study is there already."""
    from lamella.studies.sampling import sampled
    from lamella.studies.study import _Work
    from lamella.studies.tables import parse_study

    work = _Work(parse_study(study), folder, out, print)
    return work.store.kept("0000", sampled(work.table)[0]) is not None


def test_a_folder_that_no_study_wrote_is_left_alone(folder: Path) -> None:
    out = folder / "thesis"
    out.mkdir()
    (out / "chapter.txt").write_text("years of work")
    with pytest.raises(lamella.InputError, match=r"chapter\.txt"):
        lamella.study(GRID, folder=folder, out=out)
    assert [path.name for path in out.iterdir()] == ["chapter.txt"]


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"project": "other.toml"}, "other.toml"),
        ({"until": "roof"}, "until: "),
        ({"variable": [{"key": "lamella.hight", "range": [0.1, 0.2]}]}, "lamella.hight"),
        ({"variable": [{"key": "surface.boundary.0.name", "values": ["a"]}]}, "surface.boundary"),
        ({"variable": [{"key": "network.cells", "range": [10.5, 14.5]}]}, "whole = true"),
        ({"variable": [{"loop": "rim", "freedom": "move", "range": [0.1, 0.2]}]}, "variable[0].loop"),
    ],
)
def test_what_no_variant_could_have_is_refused_before_any_work(change: dict[str, Any], key: str, folder: Path) -> None:
    with pytest.raises(lamella.InputError) as refusal:
        lamella.study(GRID | change, folder=folder, out=folder / "study")
    assert key in str(refusal.value)
    assert refusal.value.remedy
    assert not (folder / "study").exists()


@pytest.mark.slow
def test_a_figure_that_is_none_is_named_with_the_nearest(folder: Path) -> None:
    with pytest.raises(lamella.InputError) as refusal:
        lamella.study(
            GRID | {"objective": [{"figure": "lamellas.utilization_max"}]}, folder=folder, out=folder / "s", jobs=1
        )
    assert refusal.value.where == "objective[0].figure"
    assert "lamellas.utilisation_max" in refusal.value.message


@pytest.mark.slow
def test_the_catenoid_of_least_twist_of_given_area(folder: Path) -> None:
    """Between its neck and a ring at least 1.5 m above, of 22 m2 at most: tg is 1/c at the neck, the area grows with h.

    So h = 1.5 and c the largest root of pi c (h + c/2 sinh 2h/c) = 22.
    """
    (folder / "roof.toml").write_text(CATENOID.replace("2.0]", "1.8]"))
    study = {
        "project": "roof.toml",
        "until": "lamellas",
        "variable": [
            {"key": "surface.neck_radius", "range": [1.0, 3.0]},
            {"key": "surface.height.1", "range": [1.5, 3.0]},
        ],
        "objective": [{"figure": "lamellas.geodesic_torsion_max"}],
        "constraint": [{"figure": "surface.area", "at_most": 22.0}],
        "optimise": {},
    }
    found = lamella.study(study, folder=folder, out=folder / "study", jobs=2)
    c = brentq(lambda c: np.pi * c * (1.5 + c / 2 * np.sinh(3.0 / c)) - 22.0, 1.5, 3.0)
    best = found.columns["id"].index(found.best[0])
    assert found.columns["surface.neck_radius"][best] == pytest.approx(c, abs=1e-4)
    assert found.columns["surface.height.1"][best] == pytest.approx(1.5, abs=1e-4)


@pytest.mark.slow
def test_workers_that_die_change_nothing(folder: Path) -> None:
    """Ten times a worker is killed during a study of films: the table is that of an undisturbed one, on one worker."""
    film = (
        '[[surface.boundary]]\nname = "rim"\ncircle = {center = [0.0, 0.0, 0.0], radius = 2.0}\n'
        '[[surface.boundary]]\nname = "eye"\ncircle = {center = [0.0, 0.0, 1.0], radius = 1.0}\n'
    )
    (folder / "roof.toml").write_text(f'[surface]\nkind = "form-found"\n{film}[network]\ncells = 12\n')
    (folder / "study.toml").write_text(
        'project = "roof.toml"\nuntil = "network"\n[sampler]\ncount = 10\n'
        '[[variable]]\nkey = "surface.boundary.eye.circle.radius"\nrange = [0.2, 1.6]\n'
        '[[variable]]\nloop = "eye"\nfreedom = "move"\nvalues = [-0.2, 0.1]\n'
    )
    command = [sys.executable, "-m", "lamella", "study", "study.toml", "--quiet"]
    subprocess.run([*command, "--jobs", "1", "--out", "one"], cwd=folder, check=True)
    process = subprocess.Popen([*command, "--jobs", "2", "--out", "two"], cwd=folder)
    killed, stop = 0, threading.Event()

    def kill() -> None:
        nonlocal killed
        while not stop.wait(1.5) and killed < 10:
            workers = [pid for pid in _descendants(process.pid) if "spawn_main" in _command_line(pid)]
            # a cluster that has not begun cannot lose anybody
            if workers and list((folder / "two").glob("variants/0*")):
                with suppress(ProcessLookupError):
                    os.kill(workers[killed % len(workers)], signal.SIGKILL)
                    killed += 1

    killer = threading.Thread(target=kill)
    killer.start()
    try:
        assert process.wait(timeout=600) == 0
    finally:
        stop.set()
        killer.join()
        process.kill()
    assert killed > 0
    assert (folder / "two" / "table.csv").read_bytes() == (folder / "one" / "table.csv").read_bytes()
    statuses = {row["status"] for row in _rows(folder / "two")}
    assert statuses == {DONE, REFUSED}


def _descendants(pid: int) -> list[int]:
    import psutil

    try:
        return [child.pid for child in psutil.Process(pid).children(recursive=True)]
    except psutil.NoSuchProcess:
        return []


def _command_line(pid: int) -> str:
    import psutil

    try:
        return " ".join(psutil.Process(pid).cmdline())
    except psutil.NoSuchProcess:
        return ""


@pytest.mark.slow
def test_an_interrupted_study_goes_on(folder: Path) -> None:
    (folder / "study.toml").write_text(
        'project = "roof.toml"\nuntil = "lamellas"\n[sampler]\ncount = 300\n'
        '[[variable]]\nkey = "surface.neck_radius"\nrange = [1.0, 2.0]\n'
    )
    command = [sys.executable, "-m", "lamella", "study", "study.toml", "--jobs", "1", "--out", "out"]
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline and len(list((folder / "out").glob("variants/0*"))) < 5:
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert b"Traceback" not in out + err
    done = len(list((folder / "out").glob("variants/0*")))
    assert 5 <= done < 300
    result = lamella.study(folder / "study.toml", out=folder / "out", jobs=1)
    assert result.computed == 300 - done
    assert len(result.columns["id"]) == 300


def test_a_table_without_objectives_has_no_best() -> None:
    from lamella.studies.tables import parse_study

    study = parse_study({"project": "p.toml", "variable": [{"key": "lamella.height", "values": [0.1]}]})
    assert Table(study, ()).csv() == b"id,lamella.height,status,feasible,best,reason\n"

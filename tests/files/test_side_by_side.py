"""Tasks on two cores: each is done once, the first error ends all of them, and files are the same bytes."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import pytest

from lamella import compute, parse_project
from lamella.base.errors import InputError
from lamella.files import side_by_side
from lamella.files.side_by_side import run_side_by_side
from lamella.stages import write as stages_write

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")


@pytest.fixture(autouse=True)
def two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever threads the test runner has."""
    monkeypatch.setattr(side_by_side, "_can_fork", lambda: True)


def test_each_task_is_done_once_by_one_of_two_processes(tmp_path: Path) -> None:
    def task(number: int) -> None:
        with (tmp_path / str(number)).open("x") as file:
            file.write(str(os.getpid()))
        time.sleep(0.02)

    begun: list[int] = []
    seconds = run_side_by_side([lambda n=n: task(n) for n in range(12)], begun.append)  # type: ignore[misc]
    assert sorted(begun) == list(range(12))
    assert seconds > 0
    owners = [(tmp_path / str(n)).read_text() for n in range(12)]
    assert len(set(owners)) == 2
    # the first ones here, the last ones there
    assert owners == sorted(owners, key=lambda owner: owner != str(os.getpid()))


@pytest.mark.parametrize("failing", [0, 5], ids=["here", "there"])
def test_the_first_error_ends_all_tasks(tmp_path: Path, failing: int) -> None:
    def task(number: int) -> None:
        if number == failing:
            raise InputError("disk", "another one", f"task {number}")
        time.sleep(0.2)
        (tmp_path / str(number)).touch()

    with pytest.raises(InputError) as error:
        run_side_by_side([lambda n=n: task(n) for n in range(6)], lambda number: None)  # type: ignore[misc]
    assert (error.value.where, error.value.remedy) == (f"task {failing}", "another one")
    done = len(list(tmp_path.iterdir()))
    time.sleep(0.3)
    assert len(list(tmp_path.iterdir())) == done < 5


def test_a_process_ended_from_outside_is_an_error() -> None:
    def task() -> None:
        if os.getpid() != parent:
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(0.05)

    parent = os.getpid()
    with pytest.raises(RuntimeError):
        run_side_by_side([task] * 4, lambda number: None)


def test_a_cancelled_run_leaves_nothing(tmp_path: Path) -> None:
    class CancelledError(Exception):
        pass

    def cancel(number: int) -> None:
        if number == 1:
            raise CancelledError

    def task(path: Path) -> None:
        time.sleep(0.1)
        path.touch()

    with pytest.raises(CancelledError):
        run_side_by_side([lambda n=n: task(tmp_path / str(n)) for n in range(8)], cancel)  # type: ignore[misc]
    done = len(list(tmp_path.iterdir()))
    time.sleep(0.2)
    assert len(list(tmp_path.iterdir())) == done < 8


def test_files_of_two_processes_are_those_of_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    surface = {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}
    results = compute(parse_project({"name": "x", "surface": surface, "network": {"cells": 12}}))
    written = []
    for least in (10**9, 0):
        monkeypatch.setattr(stages_write, "SAMPLES_WRITTEN_ALONE", least)
        folder = tmp_path / str(least)
        folder.mkdir()
        assert (stages_write.write_files(results, folder) > 0) == (least == 0)
        files = sorted(path for path in folder.rglob("*") if path.is_file())
        written.append({str(path.relative_to(folder)): path.read_bytes() for path in files})
    assert {"network.json", "model.3dm", "report.html", "fabrication/sheets.dxf"} < set(written[0])
    assert written[0] == written[1]

"""Folders of runs where the system locks no folders, and renames or removes nothing that is open: as Windows does."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from lamella.base.errors import InputError
from lamella.files import folder as folders
from lamella.files import lock, own
from lamella.files.folder import check_target, staged_folder
from lamella.files.own import MARK, foreign_entries, run_files, write_summary

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks for open files in /proc")


def fill(stage: Path) -> None:
    (stage / "a.txt").write_text("a")
    write_summary(stage, {"schema": own.SCHEMA})


@pytest.fixture(autouse=True)
def _windows(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (lock, folders):
        monkeypatch.setattr(module, "on_windows", lambda: True)
    monkeypatch.setattr(folders, "exchange", lambda one, other: False)

    def refusing(does: Callable[..., Any]) -> Callable[..., Any]:
        def call(path: Any, *others: Any, **more: Any) -> Any:
            inside = str(path) + os.sep
            for number in os.listdir("/proc/self/fd"):
                name = f"/proc/self/fd/{number}"
                open_one = os.readlink(name) if os.path.islink(name) else ""
                if open_one == str(path) or open_one.startswith(inside):
                    raise PermissionError(13, "is open", str(path))
            return does(path, *others, **more)

        return call

    for name in ("rename", "unlink", "rmdir"):
        monkeypatch.setattr(os, name, refusing(getattr(os, name)))


def test_runs_one_after_the_other(tmp_path: Path) -> None:
    for _ in range(2):
        with staged_folder(tmp_path / "out") as stage:
            fill(stage)
        assert [path.name for path in tmp_path.iterdir()] == ["out"]
        assert run_files(tmp_path / "out") is not None


def test_a_run_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def run() -> None:
        with staged_folder(tmp_path / "out") as stage:
            fill(stage)
            raise ValueError("stop")

    with pytest.raises(ValueError, match="stop"):
        run()
    assert list(tmp_path.iterdir()) == []


def test_a_living_runs_folder_stays_and_a_dead_ones_goes(tmp_path: Path) -> None:
    stage, held = folders._make_stage(tmp_path / "out", [])
    fill(stage)
    with staged_folder(tmp_path / "out") as other:
        fill(other)
    assert (stage / "a.txt").exists()
    # the run dies, and the system closes its files
    lock.unlock_folder(held)
    assert list(stage.glob(MARK + "*"))
    with staged_folder(tmp_path / "out") as other:
        fill(other)
    assert not stage.exists()
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_target_that_is_open_elsewhere_stays_and_the_result_is_kept_beside(tmp_path: Path) -> None:
    with staged_folder(tmp_path / "out") as stage:
        fill(stage)
    with (
        (tmp_path / "out" / "a.txt").open(),
        pytest.raises(InputError) as refusal,
        staged_folder(tmp_path / "out") as stage,
    ):
        fill(stage)
    assert str(tmp_path / "out-2") in refusal.value.message
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out-2"]
    assert run_files(tmp_path / "out-2") is not None
    assert run_files(tmp_path / "out") is not None


def test_a_file_that_is_open_for_a_moment_is_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Scanners look into files just written."""
    seen: list[Any] = []

    def passes(seconds: float) -> None:
        if seen:
            seen.pop().close()

    monkeypatch.setattr(folders.time, "sleep", passes)
    with staged_folder(tmp_path / "out") as stage:
        fill(stage)
        seen.append((stage / "a.txt").open())
    assert not seen
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_junction_in_a_runs_folder_is_the_users(tmp_path: Path) -> None:
    class Junction:
        """What a folder that leads to another one looks like: no link, and a folder."""

        name = "fabrication"

        def is_symlink(self) -> bool:
            return False

        def stat(self, *, follow_symlinks: bool) -> SimpleNamespace:
            return SimpleNamespace(st_reparse_tag=own.JUNCTION)

    assert own._is_link(Junction())  # type: ignore[arg-type]


def test_a_file_that_cannot_be_read_is_not_called_edited(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with staged_folder(tmp_path / "out") as stage:
        fill(stage)
    monkeypatch.setattr(own, "_hash", lambda path: "")
    assert foreign_entries(tmp_path / "out", run_files(tmp_path / "out")) == ["a.txt (cannot be read)"]
    with pytest.raises(InputError, match="cannot be read"):
        check_target(tmp_path / "out")

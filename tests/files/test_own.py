"""A run replaces what a run wrote, and nothing else."""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from lamella.base.errors import InputError
from lamella.files.folder import check_target, staged_folder
from lamella.files.own import foreign_entries, remove_run, run_files, write_summary


def a_run(target: Path, mark: str = "old") -> None:
    (target / "fabrication").mkdir(parents=True)
    (target / "fabrication" / "A.dxf").write_text(mark)
    (target / "project.toml").write_text(f'name = "{mark}"')
    write_summary(target, {"schema": "lamella/summary/1", "name": mark, "seconds": {"surface": 0.5}})


def everything(root: Path) -> dict[str, str]:
    """All names below a folder with content or where they lead."""
    found = {}
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root).as_posix()
        found[name] = os.readlink(path) if path.is_symlink() else path.read_text() if path.is_file() else "/"
    return found


def foreign_summary(out: Path) -> str:
    """As tools that measure the coverage of tests write it."""
    out.mkdir()
    (out / "summary.json").write_text('{"total": {"lines": {"pct": 81.2}}}')
    return "summary.json"


def foreign_summary_and_thesis(out: Path) -> str:
    foreign_summary(out)
    (out / "thesis.tex").write_text("mine")
    return "thesis.tex"


def summary_that_is_no_object(out: Path) -> str:
    out.mkdir()
    (out / "summary.json").write_text("[]")
    return "summary.json"


def an_older_version(out: Path) -> str:
    out.mkdir()
    (out / "summary.json").write_text('{"schema": "lamella/summary/1", "name": "x", "warnings": []}')
    return "older version"


def edited_project(out: Path) -> str:
    a_run(out)
    (out / "project.toml").write_text('name = "mine"')
    return "project.toml (edited)"


def edited_drawing(out: Path) -> str:
    a_run(out)
    (out / "fabrication" / "A.dxf").write_text("mine")
    return "fabrication/A.dxf (edited)"


def edited_summary(out: Path) -> str:
    a_run(out)
    content = json.loads((out / "summary.json").read_text())
    (out / "summary.json").write_text(json.dumps(content | {"name": "mine"}))
    return "was edited"


def notes_beside(out: Path) -> str:
    a_run(out)
    (out / "fabrication" / "notes.txt").write_text("mine")
    return "fabrication/notes.txt"


def hidden_file(out: Path) -> str:
    a_run(out)
    (out / ".notes").write_text("mine")
    return ".notes"


def folder_beside(out: Path) -> str:
    a_run(out)
    (out / "photos").mkdir()
    return "photos/"


def link_inside(out: Path) -> str:
    a_run(out)
    (out.parent / "thesis.txt").write_text("mine")
    (out / "thesis.txt").symlink_to(out.parent / "thesis.txt")
    return "thesis.txt (a link)"


def link_to_nowhere_inside(out: Path) -> str:
    a_run(out)
    (out / "later").symlink_to(out.parent / "nowhere")
    return "later (a link)"


def file_replaced_by_a_link(out: Path) -> str:
    a_run(out)
    (out / "project.toml").rename(out.parent / "mine.toml")
    (out / "project.toml").symlink_to(out.parent / "mine.toml")
    return "project.toml (a link)"


def folder_replaced_by_a_link(out: Path) -> str:
    a_run(out)
    (out / "fabrication").rename(out.parent / "drawings")
    (out / "fabrication").symlink_to(out.parent / "drawings")
    return "fabrication (a link)"


def another_case(out: Path) -> str:
    a_run(out)
    (out / "Project.toml").write_text("mine")
    return "Project.toml"


USERS = [
    foreign_summary,
    foreign_summary_and_thesis,
    summary_that_is_no_object,
    an_older_version,
    edited_project,
    edited_drawing,
    edited_summary,
    notes_beside,
    hidden_file,
    folder_beside,
    link_inside,
    link_to_nowhere_inside,
    file_replaced_by_a_link,
    folder_replaced_by_a_link,
    another_case,
]


@pytest.mark.parametrize("make", USERS, ids=lambda make: make.__name__)
def test_a_folder_with_anything_of_the_users_is_refused(tmp_path: Path, make: Callable[[Path], str]) -> None:
    named = make(tmp_path / "out")
    before = everything(tmp_path)
    with pytest.raises(InputError) as refusal:
        check_target(tmp_path / "out")
    assert named in refusal.value.message
    assert "--out" in refusal.value.remedy
    with pytest.raises(InputError), staged_folder(tmp_path / "out"):
        pytest.fail("the run began")
    assert everything(tmp_path) == before


def untouched(out: Path) -> None:
    a_run(out)


def files_gone(out: Path) -> None:
    a_run(out)
    (out / "project.toml").unlink()
    (out / "fabrication" / "A.dxf").unlink()


def other_seconds(out: Path) -> None:
    a_run(out)
    content = json.loads((out / "summary.json").read_text())
    (out / "summary.json").write_text(json.dumps(content | {"seconds": {"surface": 9.5}}))


def shown_by_a_file_manager(out: Path) -> None:
    a_run(out)
    (out / ".DS_Store").write_bytes(b"\0")
    (out / "fabrication" / "Thumbs.db").write_bytes(b"\0")


@pytest.mark.parametrize("make", [untouched, files_gone, other_seconds, shown_by_a_file_manager])
def test_a_folder_of_a_run_is_replaced(tmp_path: Path, make: Callable[[Path], None]) -> None:
    make(tmp_path / "out")
    with staged_folder(tmp_path / "out") as stage:
        a_run(stage, "new")
    assert (tmp_path / "out" / "project.toml").read_text() == 'name = "new"'
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_the_list_has_all_files_but_itself_and_the_seal_leaves_times_out(tmp_path: Path) -> None:
    seals = []
    for seconds in (1.0, 2.0):
        folder = tmp_path / str(seconds)
        (folder / "deep").mkdir(parents=True)
        (folder / "deep" / "a").write_bytes(b"abc")
        write_summary(folder, {"name": "x", "seconds": seconds})
        content = json.loads((folder / "summary.json").read_text())
        assert content["files"] == {"deep/a": hashlib.sha256(b"abc").hexdigest()}
        assert content["seconds"] == seconds
        seals.append(content["seal"])
    assert seals[0] == seals[1]


@pytest.mark.parametrize(
    "name", ["../thesis.txt", "/thesis.txt", "a/../../thesis.txt", "..\\thesis.txt", "c:thesis.txt", ""]
)
def test_a_list_that_leads_out_of_its_folder_is_none(tmp_path: Path, name: str) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (tmp_path / "thesis.txt").write_text("mine")
    digest = hashlib.sha256(b"mine").hexdigest()
    covered = json.dumps({"files": {name: digest}}, separators=(",", ":")).encode()
    sealed = {"files": {name: digest}, "seal": hashlib.sha256(covered).hexdigest()}
    (out / "summary.json").write_text(json.dumps(sealed))
    assert run_files(out) is None
    good = {"files": {"model.obj": digest}}
    seal = hashlib.sha256(json.dumps(good, separators=(",", ":")).encode()).hexdigest()
    (out / "summary.json").write_text(json.dumps({**good, "seal": seal}))
    assert run_files(out) == good["files"]


def test_removal_stops_at_what_is_no_runs(tmp_path: Path) -> None:
    a_run(tmp_path / "out")
    files = run_files(tmp_path / "out")
    assert files is not None
    (tmp_path / "out" / "fabrication" / "late.txt").write_text("mine")
    assert not remove_run(tmp_path / "out", files)
    # and what is left can still be told to be a run's with something beside
    assert run_files(tmp_path / "out") == files
    assert foreign_entries(tmp_path / "out", files) == ["fabrication/late.txt"]
    (tmp_path / "out" / "fabrication" / "late.txt").unlink()
    assert remove_run(tmp_path / "out", files)
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="no pipes in folders there")
def test_a_pipe_is_not_opened(tmp_path: Path) -> None:
    a_run(tmp_path / "out")
    (tmp_path / "out" / "project.toml").unlink()
    os.mkfifo(tmp_path / "out" / "project.toml")
    with pytest.raises(InputError, match=r"project\.toml"):
        check_target(tmp_path / "out")


def test_another_case_of_one_folder_is_that_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As on file systems that do not tell case apart: both names lead to one folder, listed under one of them."""
    (tmp_path / "Out").mkdir()
    (tmp_path / "out").symlink_to(tmp_path / "Out")
    monkeypatch.setattr(Path, "resolve", lambda self, strict=False: self)
    listed = os.listdir
    monkeypatch.setattr(os, "listdir", lambda path: [name for name in listed(path) if name != "out"])
    assert check_target(tmp_path / "out") == tmp_path / "Out"

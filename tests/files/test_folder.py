"""The output folder appears whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lamella.base.errors import InputError
from lamella.files import folder
from lamella.files.exchange import exchange
from lamella.files.folder import check_target, staged_folder
from lamella.files.own import MARK, write_summary
from lamella.files.whole import write_whole

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals and limits")

RUN = """
import os, resource, signal, sys, time
from pathlib import Path
from lamella.files.folder import staged_folder
from lamella.files.own import write_summary
from lamella.files.whole import write_whole
target, mark = Path(sys.argv[1]), sys.argv[2]
def fill(stage):
    for k in range(30):
        write_whole(stage / f"{k}.txt", mark.encode())
    write_summary(stage, {"name": mark})
"""


TWO_STEPS = "import lamella.files.folder as f; f.exchange = lambda one, other: False\n"


def child(code: str, target: Path, mark: str) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    return subprocess.Popen(
        [sys.executable, "-c", RUN + code, str(target), mark],
        env=environment,
        stdout=subprocess.PIPE,
        text=True,
    )


def earlier_run(target: Path) -> None:
    (target / "deep").mkdir(parents=True)
    (target / "deep" / "file").write_text("old")
    write_summary(target, {"name": "old"})


def is_earlier_run(target: Path) -> bool:
    names = sorted(str(path.relative_to(target)) for path in target.rglob("*"))
    return names == ["deep", "deep/file", "summary.json"] and (target / "deep" / "file").read_text() == "old"


def fill(stage: Path) -> None:
    (stage / "model").write_text("new")
    write_summary(stage, {"name": "new"})


def is_new_run(target: Path) -> bool:
    names = sorted(path.name for path in target.iterdir())
    return names == ["model", "summary.json"] and (target / "model").read_text() == "new"


def name_of(target: Path) -> str:
    return str(json.loads((target / "summary.json").read_text())["name"])


def refuse_exchange(one: Path, other: Path) -> bool:
    return False


@pytest.fixture(params=[exchange, refuse_exchange], ids=["atomic", "two-steps"])
def _either_way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(folder, "exchange", request.param)


@pytest.mark.usefixtures("_either_way")
@pytest.mark.parametrize("before", ["missing", "empty", "earlier run", "missing parents"])
def test_a_complete_run_takes_the_place(tmp_path: Path, before: str) -> None:
    target = tmp_path / "out" if before != "missing parents" else tmp_path / "a" / "b" / "out"
    if before == "empty":
        target.mkdir()
    elif before == "earlier run":
        earlier_run(target)
    with staged_folder(target) as stage:
        assert stage.parent == target.parent
        assert stage.name.startswith(".out.")
        assert [path.name for path in stage.iterdir()] == [MARK + stage.name[-12:]]
        fill(stage)
        assert not (target / "model").exists()
    assert is_new_run(target)
    assert list(target.parent.iterdir()) == [target]


@pytest.mark.skipif(sys.platform != "linux", reason="the test machine's system")
def test_this_system_exchanges_folders(tmp_path: Path) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    one.mkdir()
    (other / "inside").mkdir(parents=True)
    assert exchange(one, other)
    assert (one / "inside").is_dir()
    assert list(other.iterdir()) == []
    shutil.rmtree(other)
    with pytest.raises(FileNotFoundError):
        exchange(one, other)


@pytest.mark.parametrize("error", [ValueError, OSError, KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("before", ["missing", "earlier run", "missing parents"])
def test_a_failed_run_leaves_everything_as_it_was(tmp_path: Path, error: type[BaseException], before: str) -> None:
    target = tmp_path / "a" / "b" / "out"
    if before != "missing parents":
        target.parent.mkdir(parents=True)
    if before == "earlier run":
        earlier_run(target)

    def run() -> None:
        with staged_folder(target) as stage:
            fill(stage)
            raise error

    with pytest.raises(error):
        run()
    assert (tmp_path / "a").exists() == (before != "missing parents")
    if before == "earlier run":
        assert is_earlier_run(target)
        assert list(target.parent.iterdir()) == [target]
    elif before == "missing":
        assert list(target.parent.iterdir()) == []


def test_a_failed_swap_in_two_steps_gives_the_old_folder_its_place_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "out"
    earlier_run(target)
    monkeypatch.setattr(folder, "exchange", refuse_exchange)
    rename: Callable[[Path, Path], None] = os.rename
    calls = []

    def failing(source: Path, destination: Path) -> None:
        calls.append((source, destination))
        if len(calls) == 3:  # the place is taken; set aside; now into the place
            raise PermissionError("not now")
        rename(source, destination)

    monkeypatch.setattr(os, "rename", failing)

    def run() -> None:
        with staged_folder(target) as stage:
            fill(stage)

    with pytest.raises(InputError, match="not now") as refusal:
        run()
    assert len(calls) == 5  # back, and the complete folder beside it
    assert is_earlier_run(target)
    assert sorted(tmp_path.iterdir()) == [target, tmp_path / "out-2"]
    assert is_new_run(tmp_path / "out-2")
    assert str(tmp_path / "out-2") in refusal.value.message


def thesis(target: Path) -> None:
    target.mkdir(exist_ok=True)
    (target / "thesis.txt").write_text("mine")


def edit(target: Path) -> None:
    (target / "deep" / "file").write_text("mine")


@pytest.mark.usefixtures("_either_way")
@pytest.mark.parametrize(("before", "change"), [(False, thesis), (True, thesis), (True, edit)])
def test_what_comes_into_the_target_meanwhile_stays_and_the_result_is_kept_beside(
    tmp_path: Path, before: bool, change: Callable[[Path], None]
) -> None:
    target = tmp_path / "out"
    (tmp_path / "out-2").write_text("a name that is taken")
    if before:
        earlier_run(target)

    def run() -> None:
        with staged_folder(target) as stage:
            fill(stage)
            change(target)

    with pytest.raises(InputError, match="came while the run worked") as refusal:
        run()
    assert "mine" in [path.read_text() for path in target.rglob("*") if path.is_file()]
    assert (target / "deep").exists() == before
    assert is_new_run(tmp_path / "out-3")
    assert str(tmp_path / "out-3") in refusal.value.message
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out", "out-2", "out-3"]


def test_what_comes_at_the_last_moment_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "out"
    earlier_run(target)

    def late(one: Path, other: Path) -> bool:
        if not (target / "thesis.txt").exists() and not (one / "thesis.txt").exists():
            thesis(target)
        return exchange(one, other)

    monkeypatch.setattr(folder, "exchange", late)
    with pytest.raises(InputError, match=r"thesis\.txt"), staged_folder(target) as stage:
        fill(stage)
    assert (target / "thesis.txt").read_text() == "mine"
    assert (target / "deep" / "file").read_text() == "old"
    assert is_new_run(tmp_path / "out-2")


def file_in_place(root: Path) -> Path:
    (root / "out").write_text("a file")
    return root / "out"


def foreign_folder(root: Path) -> Path:
    (root / "out").mkdir()
    (root / "out" / "thesis.txt").write_text("mine")
    return root / "out"


def file_above(root: Path) -> Path:
    (root / "a").write_text("a file")
    return root / "a" / "b" / "out"


def link_to_file(root: Path) -> Path:
    (root / "file").write_text("a file")
    (root / "out").symlink_to(root / "file")
    return root / "out"


def dangling_link(root: Path) -> Path:
    (root / "out").symlink_to(root / "nowhere")
    return root / "out"


def below_dangling_link(root: Path) -> Path:
    return dangling_link(root) / "deeper"


def circle_of_links(root: Path) -> Path:
    (root / "out").symlink_to(root / "other")
    (root / "other").symlink_to(root / "out")
    return root / "out"


def too_long(root: Path) -> Path:
    return root / ("x" * 300)


def root_of_the_disk(root: Path) -> Path:
    return Path(root.anchor)


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (file_in_place, "is a file"),
        (foreign_folder, r"no earlier run's: it holds thesis\.txt"),
        (dangling_link, "leads to nothing"),
        (below_dangling_link, "leads to nothing"),
        (file_above, "is a file"),
        (link_to_file, "is a file"),
        (circle_of_links, "out"),
        (too_long, "too long"),
        (root_of_the_disk, "root of a disk"),
    ],
)
def test_a_target_that_cannot_be_replaced_is_refused_with_a_remedy(
    tmp_path: Path, target: Callable[[Path], Path], message: str
) -> None:
    place = target(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError, match=message) as refusal:
        check_target(place)
    assert "--out" in refusal.value.remedy
    with pytest.raises(InputError, match=message), staged_folder(place):
        pytest.fail("the run began")
    assert sorted(tmp_path.rglob("*")) == before


@pytest.fixture
def foreign_user_folder() -> Iterator[Path]:
    """A folder without the right to write; root works as another user meanwhile."""
    root = Path(tempfile.mkdtemp())
    root.chmod(0o555)
    is_root = os.geteuid() == 0
    if is_root:
        os.seteuid(65534)
    yield root
    if is_root:
        os.seteuid(0)
    root.chmod(0o755)
    shutil.rmtree(root)


@POSIX
def test_a_parent_without_the_right_to_write_is_refused(foreign_user_folder: Path) -> None:
    with pytest.raises(InputError, match="no right to write"):
        check_target(foreign_user_folder / "a" / "out")


def test_check_target_writes_nothing_and_follows_links(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert check_target(tmp_path / "link" / "a" / "out") == (tmp_path / "real" / "a" / "out").resolve()
    assert list((tmp_path / "real").iterdir()) == []


def test_a_link_as_target_keeps_pointing_at_the_new_folder(tmp_path: Path) -> None:
    earlier_run(tmp_path / "real")
    (tmp_path / "link").symlink_to(tmp_path / "real")
    with staged_folder(tmp_path / "link") as stage:
        fill(stage)
    assert (tmp_path / "link").is_symlink()
    assert is_new_run(tmp_path / "real")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["link", "real"]


@POSIX
def test_a_killed_run_leaves_the_old_folder_and_the_next_run_clears_up(tmp_path: Path) -> None:
    target = tmp_path / "out"
    earlier_run(target)
    killed = child(
        "with staged_folder(target) as stage:\n    fill(stage)\n    print('filled', flush=True)\n    time.sleep(60)\n",
        target,
        "killed",
    )
    assert killed.stdout is not None
    assert killed.stdout.readline() == "filled\n"
    working = [path for path in tmp_path.iterdir() if path != target]
    assert len(working) == 1

    with staged_folder(target) as stage:  # a living run's folder is not touched
        fill(stage)
    assert name_of(working[0]) == "killed"
    shutil.rmtree(target)
    earlier_run(target)

    killed.send_signal(signal.SIGKILL)
    killed.wait()
    killed.stdout.close()
    assert is_earlier_run(target)
    assert working[0].is_dir()
    with staged_folder(target) as stage:
        assert not working[0].exists()
        fill(stage)
    assert is_new_run(target)
    assert list(tmp_path.iterdir()) == [target]


def test_an_output_set_aside_by_a_killed_run_gets_its_place_back(tmp_path: Path) -> None:
    target = tmp_path / "out"
    earlier_run(tmp_path / ".out.lamella-old-0123456789ab")

    def run() -> None:
        with staged_folder(target):
            raise ValueError("stop")

    with pytest.raises(ValueError, match="stop"):
        run()
    assert is_earlier_run(target)
    assert list(tmp_path.iterdir()) == [target]


def test_hidden_folders_of_others_are_not_cleared(tmp_path: Path) -> None:
    names = [".out", ".out.lamella", ".outer.lamella-new-0123456789ab", ".git", ".out.lamella-new-mine"]
    names += [f".out.lamella-{role}-{number}" for role in ("new", "old") for number in ("0123456789ab", "a" * 12)]
    # a run's own list does not cover what comes beside it
    earlier_run(tmp_path / names[-2] / "inner")
    earlier_run(tmp_path / names[-1])
    for name in names:
        (tmp_path / name).mkdir(exist_ok=True)
        (tmp_path / name / "thesis.txt").write_text("mine")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / ".out.lamella-new-bbbbbbbbbbbb").symlink_to(tmp_path / "elsewhere")
    earlier_run(tmp_path / "out")
    with staged_folder(tmp_path / "out") as stage:
        fill(stage)
    assert all((tmp_path / name / "thesis.txt").read_text() == "mine" for name in names)
    assert (tmp_path / ".out.lamella-new-bbbbbbbbbbbb").is_symlink()
    assert is_new_run(tmp_path / "out")


@POSIX
def test_a_write_size_limit_raises_and_leaves_the_old_folder(tmp_path: Path) -> None:
    target = tmp_path / "out"
    earlier_run(target)
    run = child(
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "try:\n"
        "    with staged_folder(target) as stage:\n"
        "        fill(stage)\n"
        "        write_whole(stage / 'large', bytes(1001))\n"
        "except OSError as error:\n"
        "    print('OSError', error.errno)\n",
        target,
        "limited",
    )
    printed, _ = run.communicate(timeout=30)
    assert printed.startswith("OSError")
    assert is_earlier_run(target)
    assert list(tmp_path.iterdir()) == [target]


KILLED_AT_EACH_STEP = """
kept = target.parent / "thesis.txt"
steps = {"os.rename", "os.remove", "os.rmdir", "os.mkdir", "open", "ctypes.call_function", "os.scandir", "os.listdir"}
def run(mark):
    with staged_folder(target) as stage:
        (stage / "deep").mkdir()
        write_whole(stage / "deep" / "file", mark.encode())
        write_summary(stage, {"name": mark})
def content():
    return (target / "deep" / "file").read_text() if target.exists() else "missing"
seen, step = [], 0
run("old")
while True:
    step += 1
    child = os.fork()
    if not child:
        left = [step]
        def count(event, arguments):
            left[0] -= event in steps
            if left[0] == 0 and event in steps:
                os.kill(os.getpid(), signal.SIGKILL)
        sys.addaudithook(count)
        run("new")
        os._exit(0)
    if os.waitpid(child, 0)[1] == 0:
        break
    seen.append(content())
    assert kept.read_text() == "mine"
    run("old")
    assert sorted(path.name for path in target.parent.iterdir()) == ["out", "thesis.txt"], step
    assert content() == "old"
print(step, *sorted(set(seen)))
"""


@POSIX
@pytest.mark.parametrize(("way", "left"), [("", "new old"), (TWO_STEPS, "missing new old")])
def test_a_kill_at_any_step_loses_nothing_and_is_cleared_up(tmp_path: Path, way: str, left: str) -> None:
    target = tmp_path / "out"
    (tmp_path / "thesis.txt").write_text("mine")
    killed = child(way + KILLED_AT_EACH_STEP, target, "")
    printed, _ = killed.communicate(timeout=120)
    steps, _, contents = printed.strip().partition(" ")
    # where it is missing for a moment, the next run gives it its place back first
    assert contents == left
    assert int(steps) > 20


def test_a_folder_swapped_for_one_with_its_number_is_looked_at_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The number of a folder just deleted is soon another one's: what was read of both is nobody's edit."""
    target = tmp_path / "out"
    earlier_run(target)
    look = folder.foreign_entries
    looked: list[Path] = []

    def swapped_once(place: Path, files: dict[str, str] | None) -> list[str]:
        looked.append(place)
        if len(looked) > 1:
            return look(place, files)
        target.rename(tmp_path / "gone")
        time.sleep(0.05)
        target.mkdir()
        fill(target)
        return ["model (edited)"]

    monkeypatch.setattr(folder, "foreign_entries", swapped_once)
    monkeypatch.setattr(os.path, "samestat", lambda one, other: True)
    assert folder.check_target(target) == target
    assert len(looked) == 2
    assert is_new_run(target)


@POSIX
@pytest.mark.parametrize("way", ["", TWO_STEPS])
def test_runs_at_once_leave_one_whole_folder(tmp_path: Path, way: str) -> None:
    target = tmp_path / "a" / "out"
    loop = way + ("for _ in range(25):\n    with staged_folder(target) as stage:\n        fill(stage)\nprint('done')\n")
    runs = [child(loop, target, mark) for mark in ("one", "two", "three")]
    assert [run.communicate(timeout=60)[0] for run in runs] == ["done\n"] * 3
    contents = {path.read_text() for path in target.glob("*.txt")}
    assert contents == {name_of(target)}
    assert len(list(target.iterdir())) == 31
    assert list(target.parent.iterdir()) == [target]


def test_write_whole_replaces_only_when_complete(tmp_path: Path) -> None:
    path = tmp_path / "file"
    write_whole(path, b"one")
    assert path.read_bytes() == b"one"

    def full() -> Iterator[bytes]:
        yield b"t"
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space left"):
        write_whole(path, full())
    assert path.read_bytes() == b"one"
    assert list(tmp_path.iterdir()) == [path]

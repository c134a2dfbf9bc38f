"""The output folder appears whole or not at all."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from lamella.errors import InputError
from lamella.files import folder
from lamella.files.exchange import exchange
from lamella.files.folder import check_target, staged_folder
from lamella.files.whole import write_whole

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals and limits")

RUN = """
import os, resource, signal, sys, time
from pathlib import Path
from lamella.files.folder import staged_folder
from lamella.files.whole import write_whole
target, mark = Path(sys.argv[1]), sys.argv[2]
def fill(stage):
    for k in range(30):
        write_whole(stage / f"{k}.txt", mark.encode())
    write_whole(stage / "summary.json", mark.encode())
"""


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
    (target / "summary.json").write_text("old")
    (target / "deep" / "file").write_text("old")


def is_earlier_run(target: Path) -> bool:
    names = sorted(str(path.relative_to(target)) for path in target.rglob("*"))
    return names == ["deep", "deep/file", "summary.json"] and (target / "deep" / "file").read_text() == "old"


def fill(stage: Path) -> None:
    (stage / "summary.json").write_text("new")
    (stage / "model").write_text("new")


def is_new_run(target: Path) -> bool:
    return {path.name: path.read_text() for path in target.iterdir()} == {
        "summary.json": "new",
        "model": "new",
    }


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
        assert list(stage.iterdir()) == []
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

    with pytest.raises(PermissionError):
        run()
    assert len(calls) == 4
    assert is_earlier_run(target)
    assert list(tmp_path.iterdir()) == [target]


def test_a_target_that_fills_up_meanwhile_is_refused_at_the_end(tmp_path: Path) -> None:
    target = tmp_path / "out"

    def run() -> None:
        with staged_folder(target) as stage:
            fill(stage)
            target.mkdir()
            (target / "thesis.txt").write_text("mine")

    with pytest.raises(InputError, match=r"holds no summary\.json"):
        run()
    assert [path.name for path in target.iterdir()] == ["thesis.txt"]
    assert list(tmp_path.iterdir()) == [target]


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
        (foreign_folder, r"holds no summary\.json"),
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
    assert (working[0] / "summary.json").read_text() == "killed"
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
    others = [tmp_path / name for name in (".out", ".out.lamella", ".outer.lamella-new-0123456789ab", ".git")]
    for other in others:
        other.mkdir()
    with staged_folder(tmp_path / "out") as stage:
        fill(stage)
    assert sorted(tmp_path.iterdir()) == sorted([*others, tmp_path / "out"])


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


@POSIX
@pytest.mark.parametrize("way", ["", "import lamella.files.folder as f; f.exchange = lambda one, other: False\n"])
def test_runs_at_once_leave_one_whole_folder(tmp_path: Path, way: str) -> None:
    target = tmp_path / "a" / "out"
    loop = way + ("for _ in range(25):\n    with staged_folder(target) as stage:\n        fill(stage)\nprint('done')\n")
    runs = [child(loop, target, mark) for mark in ("one", "two", "three")]
    assert [run.communicate(timeout=60)[0] for run in runs] == ["done\n"] * 3
    contents = {path.read_text() for path in target.iterdir()}
    assert len(contents) == 1
    assert len(list(target.iterdir())) == 31
    assert list(target.parent.iterdir()) == [target]


def test_write_whole_replaces_only_when_complete(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "file"
    write_whole(path, b"one")
    assert path.read_bytes() == b"one"

    def full(self: Path, content: bytes) -> int:
        with self.open("wb") as stream:
            stream.write(content[:1])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left"):
        write_whole(path, b"two")
    assert path.read_bytes() == b"one"
    assert list(tmp_path.iterdir()) == [path]

"""Runs that do not come to their end: full disks, kills, readers that go early."""

from __future__ import annotations

import errno
import os
import re
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from command.command_line import FILES, contents, lamella
from lamella.command.main import main


@pytest.fixture
def earlier(here: Path) -> dict[str, bytes]:
    """An earlier run's folder out/p."""
    assert main(["run", "p.toml", "--until", "network", "--quiet"]) == 0
    return contents(here / "out")


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX limits")
@pytest.mark.parametrize("most", [0, 1_000, 60_000, 200_000])
@pytest.mark.few(2)
def test_a_full_disk_leaves_the_earlier_run_whole(here: Path, earlier: dict[str, bytes], most: int) -> None:
    """Whichever file it is that does not fit: exit 2, and every file of the earlier run as it was."""
    process = lamella("run", "p.toml", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
    out, err = process.communicate(timeout=60)
    assert process.returncode == 2, err
    told = err[err.index("lamella: ") :]
    assert os.strerror(errno.EFBIG) in told
    assert "\n  remedy: " in told
    assert "Traceback" not in err
    assert out == ""
    assert contents(here / "out") == earlier
    assert [p.name for p in (here / "out").iterdir()] == ["p"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX limits")
def test_a_full_disk_leaves_nothing_where_nothing_was(here: Path) -> None:
    process = lamella("run", "p.toml", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (9_000, 9_000)))
    process.communicate(timeout=60)
    assert process.returncode == 2
    assert sorted(p.name for p in here.iterdir()) == ["p.toml"]


# a run to which something happens as network.json, complete, gets its name
RUN = """
import signal, sys, time

def at_network(event, arguments):
    if event == "os.rename" and str(arguments[1]).endswith("network.json"):
        {happens}

# a suite in the background of a shell has it ignored, and its processes inherit that
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.addaudithook(at_network)
from lamella.command.main import main
sys.exit(main(["run", "p.toml", "--quiet"]))
"""


def run_until(here: Path, happens: str) -> subprocess.Popen[str]:
    """A run as a process, and what happens to it half-way."""
    code = RUN.format(happens=happens)
    return subprocess.Popen([sys.executable, "-c", code], cwd=here, stderr=subprocess.PIPE, text=True)


def kill_half_way(here: Path, number: signal.Signals) -> tuple[int, str]:
    """Kill a run once it has begun to write; it stops there, so that the moment is always the same."""
    process = run_until(here, "print('half-way', file=sys.stderr, flush=True); time.sleep(60)")
    assert process.stderr
    assert process.stderr.readline() == "half-way\n"
    assert len(list((here / "out").iterdir())) == 2  # the earlier run and the one in the making
    process.send_signal(number)
    _, err = process.communicate(timeout=30)
    return process.returncode, err


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize(("name", "code"), [("SIGTERM", 143), ("SIGINT", 130)])
def test_a_polite_kill_cleans_up(here: Path, earlier: dict[str, bytes], name: str, code: int) -> None:
    returned, err = kill_half_way(here, signal.Signals[name])
    assert returned == code
    assert "Traceback" not in err
    if name == "SIGINT":
        # one line, as every message begins
        assert re.fullmatch(r"lamella: .+\n", err)
    assert contents(here / "out") == earlier
    assert [p.name for p in (here / "out").iterdir()] == ["p"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_what_a_hard_kill_leaves_is_cleaned_by_the_next_run(here: Path, earlier: dict[str, bytes]) -> None:
    assert kill_half_way(here, signal.SIGKILL)[0] == -signal.SIGKILL
    assert contents(here / "out" / "p") == {name.removeprefix("p/"): data for name, data in earlier.items()}
    assert len(list((here / "out").iterdir())) == 2
    assert main(["run", "p.toml", "--until", "surface", "--quiet"]) == 0
    assert [p.name for p in (here / "out").iterdir()] == ["p"]
    assert set(contents(here / "out" / "p")) == FILES["surface"]


def test_too_little_memory_is_a_message(here: Path) -> None:
    process = run_until(here, "raise MemoryError")
    _, err = process.communicate(timeout=60)
    assert process.returncode == 2
    assert re.fullmatch(r"lamella: .*memory.*\n  remedy: .+\n", err)
    assert sorted(p.name for p in here.iterdir()) == ["p.toml"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX pipes")
@pytest.mark.parametrize("arguments", [["schema", "project"], ["examples"], ["new", "unduloid", "--out", "-"]])
def test_a_reader_that_goes_early(arguments: list[str]) -> None:
    read, write = os.pipe()
    os.close(read)
    process = subprocess.Popen(
        [sys.executable, "-m", "lamella", *arguments], stdout=write, stderr=subprocess.PIPE, text=True
    )
    os.close(write)
    _, err = process.communicate(timeout=30)
    assert process.returncode == 1
    assert err == ""


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX pipes")
def test_a_reader_of_the_progress_that_goes_early(here: Path, earlier: dict[str, bytes]) -> None:
    read, write = os.pipe()
    os.close(read)
    process = subprocess.Popen([sys.executable, "-m", "lamella", "run", "p.toml"], stdout=write, stderr=write)
    os.close(write)
    assert process.wait(30) == 1
    assert contents(here / "out") == earlier
    assert [p.name for p in (here / "out").iterdir()] == ["p"]

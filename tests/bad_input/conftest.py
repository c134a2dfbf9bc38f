"""Running a project that has to be refused."""

from __future__ import annotations

import hashlib
import re
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from lamella.command.main import main
from lamella.files.own import write_summary
from messages import text_faults
from refusals import check_stated


def fingerprint(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.fixture
def refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Run a project that has to be refused over an earlier run's folder; returns the message.

    What it has to state are numbers and names as of `refusals.check_stated`; a key that comes first is the message's.
    """
    monkeypatch.chdir(tmp_path)
    earlier = tmp_path / "out" / "p"
    earlier.mkdir(parents=True)
    write_summary(earlier, {"name": "an earlier run"})
    before = fingerprint(tmp_path)

    def refused(project: str | bytes, *stated: str | float, at: str = "", lines: int = 2) -> str:
        content = project if isinstance(project, bytes) else project.encode()
        (tmp_path / "p.toml").write_bytes(content)
        start = time.perf_counter()
        code = main(["run", "p.toml"])
        seconds = time.perf_counter() - start
        told = capsys.readouterr()
        errors = told.err[told.err.index("lamella: ") :]
        assert code == 2, told.err
        assert seconds < 60
        assert re.match(f"lamella: {at or 'p.toml(:[0-9]+)?'}: ", errors), errors
        place = re.match(r"lamella: p.toml:(\d+): ([a-z_.]+): ", errors)
        if place and not at:
            # the line is that of the key, or of its table
            line, leaf = content.splitlines()[int(place[1]) - 1].decode(), place[2].rpartition(".")[2]
            assert leaf in line or f"{leaf} = " not in content.decode(), errors
        assert "Traceback" not in told.err
        assert told.out == ""
        numbers = [one for one in stated if not isinstance(one, str)]
        check_stated(errors, numbers, [one for one in stated if isinstance(one, str)])
        if stated and isinstance(stated[0], str) and re.fullmatch(r"\w+(\.[\w-]+)+", stated[0]):
            assert f": {stated[0]}: " in errors, errors
        assert errors.count("remedy: ") >= 1, errors
        assert not text_faults(errors), (text_faults(errors), errors)
        assert errors.count("\n") <= lines, errors
        assert max(map(len, errors.splitlines())) <= 300, errors
        (tmp_path / "p.toml").unlink()
        assert fingerprint(tmp_path) == before
        assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["p"]
        return errors

    return refused

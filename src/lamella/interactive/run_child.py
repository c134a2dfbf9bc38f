"""`lamella run` as a process of its own: it can be ended at any time, and the page stays quick beside it."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

LINES_MAX = 400


class RunChild:
    """A run of the saved project into the folder `out/<stem>` beside it.

    Parameters
    ----------
    file : Path
    told : callable
        Is called, from another thread, when there is something new to tell.
    """

    def __init__(self, file: Path, told: Callable[[], None]) -> None:
        self.out = file.parent / "out" / file.stem
        self._told, self._lines, self._ended = told, [f"lamella run {file.name}"], False
        self._cancelled = False
        self._process = subprocess.Popen(
            [sys.executable, "-m", "lamella", "run", file.name, "--out", f"out/{file.stem}"],
            cwd=file.parent,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self._lines = [*self._lines, line.rstrip()][-LINES_MAX:]
            self._told()
        self._process.wait()
        self._process.stdout.close()
        self._ended = True
        self._told()

    @property
    def is_running(self) -> bool:
        """Whether it has not ended."""
        return not self._ended

    def cancel(self) -> None:
        """End it; nothing half-written stays."""
        self._cancelled = True
        if self._process.poll() is None:
            self._process.terminate()

    def close(self) -> None:
        """End it and wait for that."""
        self.cancel()
        self._reader.join(20)
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()

    def record(self) -> dict[str, Any]:
        """For the page: lines, whether it runs, whether it is done and whether it was ended."""
        done = self._ended and self._process.returncode == 0
        return {
            "running": not self._ended,
            "done": done,
            "cancelled": self._cancelled,
            "lines": self._lines,
            "report": f"out/{self.out.name}/report.html" if done else None,
        }

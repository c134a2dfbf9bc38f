"""What a command costs before it computes anything: whole processes, beside the imports they cannot do without."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from bench import Limit, Table, in_turns, show

EXAMPLES = Path(__file__).parents[1] / "examples"
TIMES = 10
# numpy, elliptic functions, and the reader of project files
BARE = "import of numpy, scipy.special and pydantic"
CHECK = "`lamella check` of an unduloid"
COMMANDS: dict[str, tuple[str, ...]] = {
    BARE: ("-c", "import numpy, scipy.special, pydantic"),
    "`import lamella`": ("-c", "import lamella"),
    "`lamella --help`": ("-m", "lamella", "--help"),
    "`lamella schema project`": ("-m", "lamella", "schema", "project"),
    "`lamella schema summary`": ("-m", "lamella", "schema", "summary"),
    "`lamella new unduloid`": ("-m", "lamella", "new", "unduloid", "--out", "-"),
    CHECK: ("-m", "lamella", "check", str(EXAMPLES / "01_unduloid.toml")),
}


def _run(arguments: tuple[str, ...]) -> None:
    subprocess.run(
        [sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60
    )


def tables() -> Iterator[Table]:
    """A row a command."""
    works: dict[str, Callable[[], None]] = {name: partial(_run, arguments) for name, arguments in COMMANDS.items()}
    seconds = in_turns(works, TIMES)
    yield Table(
        "Start of commands",
        f"CPU seconds of whole processes, Python's own start included: medians of {TIMES} in turns. A check of a "
        "closed form computes its net, strips and parts.",
        tuple(
            {"process": name, "CPU s": value, "/ bare imports": value / seconds[BARE]}
            for name, value in seconds.items()
        ),
        (Limit(f"CPU s of {CHECK}", seconds[CHECK], 0.8),),
    )


if __name__ == "__main__":
    show(tables())

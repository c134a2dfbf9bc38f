"""Work on bytes of a stranger in a process of its own, which is ended when it takes too long or too much memory.

A library in another language may run for minutes on a damaged file, deaf to signals, or bring the whole process down.
In a process of its own it can do neither to the program. The process begins anew (it is no copy of the calling one),
so that it works alike on all systems, in threads, notebooks and scripts without a guarded main part.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass

# finds the same modules as the calling process, whatever has put them on its path
_BEGIN = (
    "import json, sys; sys.path[:] = json.loads(sys.argv[1]); "
    "from importlib import import_module; import_module(sys.argv[2]).main(sys.argv[3:])"
)
WALL_PER_CPU = 4
"""Seconds on the clock allowed for one of computing: the machine may be busy, and some systems count no computing."""


@dataclass(frozen=True)
class Limits:
    """What a process may take.

    Attributes
    ----------
    seconds : int
        Of computing, where the system counts them (not on Windows); `WALL_PER_CPU` times as many on the clock.
    memory : int
        Address space, bytes, where the system limits it (Linux).
    """

    seconds: int
    memory: int


class TookTooLong(Exception):
    """The process was ended at its limit of time."""


class BrokeDown(Exception):
    """The process ended without a result: damaged input, or more memory than its limit."""


def has_processes() -> bool:
    """Whether this program can start itself: not where it is frozen into an application or has no interpreter."""
    return bool(sys.executable) and not getattr(sys, "frozen", False) and sys.platform not in ("emscripten", "wasi")


def run_bounded(module: str, arguments: list[str], data: bytes, limits: Limits) -> bytes:
    """Call a module's ``main(arguments)`` in a process of its own.

    Parameters
    ----------
    module : str
        Full name; its `main` takes `data` from standard input and writes bytes to standard output.
    arguments : list of str
        For `main`; the limits are put in front of them.
    data : bytes
    limits : Limits

    Returns
    -------
    bytes
        What it has written.

    Raises
    ------
    TookTooLong, BrokeDown
    """
    limited = [str(limits.seconds), str(limits.memory), *arguments]
    # -I: neither variables of the environment nor the folder the user works in change what is imported
    command = [sys.executable, "-I", "-c", _BEGIN, json.dumps([str(place) for place in sys.path]), module, *limited]
    hidden = 0
    if sys.platform == "win32":
        hidden = subprocess.CREATE_NO_WINDOW
    try:
        done = subprocess.run(
            command,
            input=data,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=limits.seconds * WALL_PER_CPU,
            # threads of linear algebra take address space and are not needed
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            creationflags=hidden,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise TookTooLong from None
    if sys.platform != "win32":
        import signal

        # SIGKILL is what follows where SIGXCPU is ignored
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            raise TookTooLong
    if done.returncode:
        raise BrokeDown
    return done.stdout


def limit_this_process(limits: Limits) -> None:
    """Set the limits that the system enforces, for the calling process and for good."""
    if sys.platform == "win32":
        return
    import contextlib
    import resource
    import signal

    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    for kind, most in ((resource.RLIMIT_CPU, limits.seconds), (resource.RLIMIT_AS, limits.memory)):
        _, hard = resource.getrlimit(kind)
        own = most if hard == resource.RLIM_INFINITY else min(most, hard)
        # macOS refuses a limit of address space
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(kind, (own, hard))
    # no file of a crash is left behind
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def limits_for(size: int, seconds: float, seconds_per_megabyte: float, memory: int, memory_per_byte: int) -> Limits:
    """Limits that grow with the size of the data, bytes."""
    return Limits(int(seconds + seconds_per_megabyte * size / 1e6), memory + memory_per_byte * size)

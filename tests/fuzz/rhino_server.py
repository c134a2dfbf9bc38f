"""The process that reads .3dm files, forked from one that has imported everything: a few milliseconds a file."""

from __future__ import annotations

import os
import select
import signal
import struct
import sys
import time
from typing import BinaryIO

from lamella.files.read.bounded import Limits, limit_this_process
from lamella.files.read.rhino_child import packed_model

REQUEST = struct.Struct("<ddQIQ")
"""Seconds of computing, seconds on the clock, bytes of memory, kind, bytes of data."""
ANSWER = struct.Struct("<idQQ")
"""Exit code of the process, its seconds of computing and bytes of memory, bytes of data."""


def serve(given: BinaryIO, wanted: BinaryIO) -> None:
    """Answer each `REQUEST` and its data by an `ANSWER` and its data."""
    while head := given.read(REQUEST.size):
        seconds, clock, memory, kind, length = REQUEST.unpack(head)
        data = given.read(length)
        begin, end = os.pipe()
        child = os.fork()
        if not child:
            os.close(begin)
            _read(data, "curves" if kind else "meshes", seconds, memory, end)
        os.close(end)
        packed = _all_of(begin, time.monotonic() + clock)
        if packed is None:
            os.kill(child, signal.SIGALRM)
        _, status, used = os.wait4(child, 0)
        packed = packed or b""
        code = os.waitstatus_to_exitcode(status)
        wanted.write(ANSWER.pack(code, used.ru_utime + used.ru_stime, used.ru_maxrss * 1024, len(packed)) + packed)
        wanted.flush()


def _read(data: bytes, wanted: str, seconds: float, memory: int, end: int) -> None:
    """Read in this process, which ends then."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    limit_this_process(Limits(int(seconds) + 1, memory))
    # a limit of less than a second: by their default actions these signals end a process that is deaf to handlers
    for number in (signal.SIGPROF, signal.SIGALRM):
        signal.signal(number, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    packed = packed_model(data, wanted)
    with os.fdopen(end, "wb") as pipe:
        pipe.write(packed)
    os._exit(0)


def _all_of(pipe: int, until: float) -> bytes | None:
    """What comes through a pipe until it is closed; None where it is still open at that time."""
    parts = []
    try:
        while select.select([pipe], [], [], max(until - time.monotonic(), 0))[0]:
            part = os.read(pipe, 1 << 20)
            if not part:
                return b"".join(parts)
            parts.append(part)
    finally:
        os.close(pipe)
    return None


if __name__ == "__main__":
    answers = os.fdopen(os.dup(1), "wb")
    serve(sys.stdin.buffer, answers)

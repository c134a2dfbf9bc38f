"""The process that reads .3dm files, forked from one that has imported everything: a few milliseconds a file."""

from __future__ import annotations

import os
import struct
import sys
from typing import BinaryIO

from lamella.files.bounded import Limits, limit_this_process
from lamella.files.rhino_child import packed_model


def serve(given: BinaryIO, wanted: BinaryIO) -> None:
    """Answer requests (seconds, memory, kind, data) with (status of the process, data)."""
    while head := given.read(24):
        seconds, memory, kind, length = struct.unpack("<IQIQ", head)
        data = given.read(length)
        begin, end = os.pipe()
        child = os.fork()
        if not child:
            os.close(begin)
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            limit_this_process(Limits(seconds, memory))
            packed = packed_model(data, "curves" if kind else "meshes")
            with os.fdopen(end, "wb") as pipe:
                pipe.write(packed)
            os._exit(0)
        os.close(end)
        with os.fdopen(begin, "rb") as pipe:
            packed = pipe.read()
        _, status = os.waitpid(child, 0)
        wanted.write(struct.pack("<iQ", os.waitstatus_to_exitcode(status), len(packed)) + packed)
        wanted.flush()


if __name__ == "__main__":
    answers = os.fdopen(os.dup(1), "wb")
    serve(sys.stdin.buffer, answers)

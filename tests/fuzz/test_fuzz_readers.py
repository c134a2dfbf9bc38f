"""Damaged files of every format: read, or refused with a message; never another error, a hang or all the memory.

`LAMELLA_FUZZ` sets the number of files a reader (10,000 have been run), `LAMELLA_FUZZ_SEED` the draw.
"""

from __future__ import annotations

import contextlib
import os
import random
import signal
import subprocess
import sys
import time
import traceback
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import FrameType

import pytest

from lamella.base.errors import InputError
from lamella.files.quad_mesh_files import read_quad_mesh
from lamella.files.read import rhino_model
from lamella.files.read.bounded import BrokeDown, Limits, TookTooLong
from lamella.files.read.mesh import READERS as MESHES
from lamella.files.read.mesh import read_mesh
from lamella.project.read import parse_project, read_project
from lamella.project.tables import SURFACE_TABLES, FormFoundTable, MeshTable
from lamella.stages.check import check_project
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.from_mesh.clean import clean

from . import seed_files
from .mutants import mutant
from .rhino_server import ANSWER, REQUEST

if sys.platform == "win32":
    pytest.skip("limits of computing and memory are POSIX", allow_module_level=True)

import resource

COUNT = int(os.environ.get("LAMELLA_FUZZ", "150"))
SEED = int(os.environ.get("LAMELLA_FUZZ_SEED", "1"))
MOST_SECONDS = 20
MOST_MEMORY = 2**30
RHINO_SECONDS, RHINO_CLOCK = 0.5, 60.0
"""Limits for .3dm files here, of computing and on the clock: a good one takes milliseconds. One in fifteen damaged ones
runs in the library without end, which the program gives `lamella.files.read.rhino_model.SECONDS`."""


def read_loops(path: Path) -> None:
    table = {"kind": "form-found", "boundary": [{"file": path.name}]}
    project = parse_project({"surface": table})
    assert isinstance(project.surface, FormFoundTable)
    boundary_loops(project.surface, path.parent)


def read_surface(path: Path) -> None:
    clean(read_mesh(path, None if path.suffix == ".3dm" else "m"))


def read_quads(path: Path) -> None:
    read_quad_mesh(path)


def read_project_file(path: Path) -> None:
    project = read_project(path)
    if not isinstance(project.surface, FormFoundTable | MeshTable):
        check_project(project, folder=path.parent)


@dataclass(frozen=True)
class Reader:
    suffix: str
    seeds: Callable[[], tuple[bytes, ...]]
    read: Callable[[Path], None]
    text: bool = True


READERS = {
    "curves-dxf": Reader(".dxf", seed_files.dxf, read_loops),
    "curves-3dm": Reader(".3dm", seed_files.rhino_curves, read_loops, text=False),
    "curves-json": Reader(".json", seed_files.curve_json, read_loops),
    "mesh-obj": Reader(".obj", seed_files.obj, read_surface),
    "mesh-ply": Reader(".ply", seed_files.ply, read_surface),
    "mesh-stl": Reader(".stl", seed_files.stl, read_surface),
    "mesh-3dm": Reader(".3dm", seed_files.rhino_meshes, read_surface, text=False),
    "quads-obj": Reader(".obj", seed_files.obj, read_quads),
    "quads-ply": Reader(".ply", seed_files.ply, read_quads),
    "quads-json": Reader(".json", seed_files.compas_json, read_quads),
    "project": Reader(".toml", seed_files.projects, read_project_file),
}

if ".off" in MESHES:
    READERS["mesh-off"] = Reader(".off", seed_files.off, read_surface)


class RhinoServer:
    """Stands for `lamella.files.read.bounded.run_bounded`: the same limits, a quicker start."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", "fuzz.rhino_server"]
        tests = str(Path(__file__).parents[1])
        path = os.pathsep.join([tests, *filter(None, sys.path)])
        environment = {**os.environ, "PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1"}
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
        self.ended = self.waiting = self.broken = 0
        self.seconds, self.memory = 0.0, 0

    def __call__(self, module: str, arguments: list[str], data: bytes, limits: Limits) -> bytes:
        assert self.process.stdin
        assert self.process.stdout
        self.process.stdin.write(
            REQUEST.pack(RHINO_SECONDS, RHINO_CLOCK, limits.memory, arguments == ["curves"], len(data)) + data
        )
        self.process.stdin.flush()
        code, seconds, memory, length = ANSWER.unpack(self.process.stdout.read(ANSWER.size))
        packed = self.process.stdout.read(length)
        self.seconds, self.memory = max(self.seconds, seconds), max(self.memory, memory)
        if code in (-signal.SIGPROF, -signal.SIGXCPU, -signal.SIGKILL, -signal.SIGALRM):
            self.ended += code != -signal.SIGALRM
            self.waiting += code == -signal.SIGALRM
            raise TookTooLong
        if code:
            self.broken += 1
            raise BrokeDown
        return packed


@pytest.fixture
def rhino(monkeypatch: pytest.MonkeyPatch) -> Iterator[RhinoServer]:
    server = RhinoServer()
    monkeypatch.setattr(rhino_model, "run_bounded", server)
    yield server
    assert server.process.stdin
    assert server.process.stdout
    server.process.stdin.close()
    server.process.wait(30)
    server.process.stdout.close()


class TakesTooLong(BaseException):
    """So that no handler of exceptions mistakes it for damage."""


def too_long(number: int, frame: FrameType | None) -> None:
    raise TakesTooLong


@pytest.fixture
def _limited() -> Iterator[None]:
    """At most `MOST_MEMORY` more address space than now, and an alarm after `MOST_SECONDS` of computing."""
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    if sys.platform == "linux":
        now = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
        resource.setrlimit(resource.RLIMIT_AS, (now + MOST_MEMORY, hard))
    before = signal.signal(signal.SIGPROF, too_long)
    yield
    signal.signal(signal.SIGPROF, before)
    resource.setrlimit(resource.RLIMIT_AS, (soft, hard))


@pytest.mark.slow
@pytest.mark.usefixtures("_limited")
@pytest.mark.parametrize("name", READERS)
def test_damaged_files_are_read_or_refused(name: str, tmp_path: Path, rhino: RhinoServer) -> None:
    reader = READERS[name]
    draw = random.Random(SEED * 1000 + zlib.crc32(name.encode()))
    path = tmp_path / f"damaged{reader.suffix}"
    seeds = list(reader.seeds())
    whole = 0
    for seed in seeds:
        path.write_bytes(seed)
        # some hold several curves, or name files that are not here
        with contextlib.suppress(InputError):
            reader.read(path)
            whole += 1
    assert 2 * whole > len(seeds)
    begin = time.monotonic()
    good, longest, failures = 0, 0.0, []
    for number in range(COUNT):
        data = mutant(draw, seeds, reader.text)
        path.write_bytes(data)
        start = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, MOST_SECONDS)
        try:
            reader.read(path)
            good += 1
        except InputError:
            pass
        except (Exception, TakesTooLong) as error:
            where = traceback.extract_tb(error.__traceback__)[-1]
            kind = f"{type(error).__name__}: {str(error)[:80]} at {Path(where.filename).name}:{where.lineno}"
            failures.append(f"{number}: {kind}")
            (tmp_path / f"failure-{number}{reader.suffix}").write_bytes(data)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
        longest = max(longest, time.process_time() - start)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(
        f"{name}: {COUNT} files, {good} read (exit 0), {COUNT - good - len(failures)} refused (exit 2), "
        f"{len(failures)} failures, longest {longest:.2f} s, process {peak:.2f} GB, "
        f"{time.monotonic() - begin:.0f} s on the clock"
    )
    if reader.suffix == ".3dm":
        print(
            f"  in the library: {rhino.ended} ended at {RHINO_SECONDS} s, {rhino.waiting} at {RHINO_CLOCK} s on the "
            f"clock, {rhino.broken} broken down, longest {rhino.seconds:.2f} s, most {rhino.memory / 2**30:.2f} GB"
        )
    assert rhino.memory < MOST_MEMORY
    assert not failures, "\n".join([f"{len(failures)} of {COUNT}", *failures[:40]])
    assert longest < MOST_SECONDS


def test_every_kind_of_surface_and_file_is_damaged() -> None:
    from lamella.files.quad_mesh_files import FORMATS
    from lamella.project.boundary_tables import CURVE_FILES

    covered = {name.split("-")[0]: set[str]() for name in READERS}
    for name, reader in READERS.items():
        covered[name.split("-")[0]].add(reader.suffix)
    assert covered["curves"] == set(CURVE_FILES)
    assert covered["mesh"] >= set(MESHES)
    # .3dm is the same reader as for surfaces
    assert covered["quads"] | {".3dm"} == set(FORMATS)
    assert len(seed_files.projects()) > len(SURFACE_TABLES)

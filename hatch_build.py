"""Builds the compiled kernel of the remesher with the package, where there is a C compiler: it is whole without one.

Run by the build tool; `python hatch_build.py` builds the library in its place in the sources.
"""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import zlib
from pathlib import Path
from shutil import which
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

FOLDER = Path("src/lamella/surface/remesh")
# the names are those of lamella.surface.remesh.kernel
SOURCE, LIBRARY = FOLDER / "kernel.c", FOLDER / ("libkernel.dll" if sys.platform == "win32" else "libkernel.so")


def commands(source: Path, library: Path) -> list[list[str]]:
    """Ways to build the library, the first whose compiler is there to be taken.

    A product and a sum have to be rounded one after the other, or the meshes differ from those made by numpy.
    """
    known = f"LAMELLA_SOURCE={zlib.crc32(source.read_bytes())}"
    wanted = [os.environ.get("CC"), sysconfig.get_config_var("CC"), "cc", "gcc", "clang"]
    flags = ["-O2", "-std=c99", "-ffp-contract=off", "-fPIC", "-shared", f"-D{known}"]
    found = [[*compiler.split(), *flags, str(source), "-lm", "-o", str(library)] for compiler in wanted if compiler]
    if sys.platform == "win32":
        found.insert(0, ["cl", "/nologo", "/O2", "/fp:precise", "/LD", f"/D{known}", str(source), f"/Fe{library}"])
    return [command for command in found if which(command[0])]


def build(root: Path, library: Path | None = None) -> str:
    """Build the library, by default in its place in the sources; returns why it was not built, or nothing."""
    source, library = root / SOURCE, library or root / LIBRARY
    library.unlink(missing_ok=True)
    reason = "there is no C compiler"
    for command in commands(source, library):
        done = subprocess.run(command, capture_output=True, text=True, cwd=library.parent)
        if done.returncode == 0:
            return ""
        reason = f"{command[0]} failed: {(done.stderr or done.stdout).strip()}"
    return reason


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """What the build tool calls."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the library, and make the wheel one of this platform where that worked."""
        reason = build(Path(self.root))
        if reason:
            self.app.display_warning(f"without the compiled kernel, films take about twice as long: {reason}")
            return
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
        build_data["artifacts"].append(LIBRARY.as_posix())


if __name__ == "__main__":
    sys.exit(build(Path(__file__).parent.resolve()) or None)

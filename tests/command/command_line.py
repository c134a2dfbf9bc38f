"""The program as a process of its own, and what it leaves in a folder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

UNDULOID = """name = "x"
[surface]
kind = "unduloid"
neck_radius = 1.6
bulge_radius = 2.8
height = [-1.0, 1.0]
[network]
cells = 8
"""
# DESIGN section 7
FILES = {
    "surface": {"summary.json", "project.toml", "surface.obj", "surface.ply", "report.html"},
    "network": {"network.json", "network.obj", "nodes.csv", "model.3dm"},
    "lamellas": {"lamellas.json"},
    "fabrication": {
        "fabrication/A.dxf",
        "fabrication/B.dxf",
        "fabrication/sheets.dxf",
        "fabrication/schedule.csv",
        "fabrication/parts.xlsx",
    },
}


def lamella(*arguments: str, **more: object) -> subprocess.Popen[str]:
    return subprocess.Popen(  # type: ignore[call-overload,no-any-return]
        [sys.executable, "-m", "lamella", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        **more,
    )


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}

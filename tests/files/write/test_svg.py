"""SVG drawings against the DXF ones: the same paths in true size, layer by layer."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import ezdxf
import numpy as np
import pytest

import lamella
from lamella.base.arrays import Floats
from lamella.fabrication.contours import CutOptions
from lamella.fabrication.drawing import drawn_sheets, write_drawings
from lamella.files.write.dxf_text import BlockWriter, Placed
from lamella.files.write.svg import write_svg

SVG = "{http://www.w3.org/2000/svg}"
COMMAND = re.compile(r"([MLAZ])([^MLAZ]*)")


def path_points(data: str) -> Floats:
    """Points (n, 3) of a path: x, y downwards, and the bulge to the next point."""
    points: list[list[float]] = []
    for command, text in COMMAND.findall(data):
        values = [float(value) for value in text.split()]
        if command in "ML":
            points.append([*values, 0.0])
        elif command == "A":
            radius, _, _, large, sweep, x, y = values
            before = np.array(points[-1][:2])
            half = np.linalg.norm(before - (x, y)) / 2
            angle = 2 * np.arcsin(min(half / radius, 1.0))
            angle = 2 * np.pi - angle if large else angle
            points[-1][2] = np.tan(angle / 4) * (-1 if sweep else 1)
            points.append([x, y, 0.0])
    if np.allclose(points[0][:2], points[-1][:2]) and len(points) > 1:
        points.pop()
    return np.array(points)


def svg_paths(path: Path) -> dict[str, list[tuple[str, str, Floats]]]:
    root = ET.parse(path).getroot()
    width, height = (float(root.get(key, "").removesuffix("mm")) for key in ("width", "height"))
    assert root.get("viewBox") == f"0 0 {root.get('width', '')[:-2]} {root.get('height', '')[:-2]}"
    assert min(width, height) > 0
    return {
        group.get("id", ""): [
            (one.get("data-part", ""), one.get("data-copy", ""), path_points(one.get("d", "")))
            for one in group.iter(f"{SVG}path")
        ]
        for group in root.iter(f"{SVG}g")
    }


def dxf_paths(path: Path) -> dict[str, list[tuple[str, str, Floats]]]:
    found: dict[str, list[tuple[str, str, Floats]]] = {}
    for one in ezdxf.readfile(path).modelspace():
        if one.dxftype() == "LINE":
            points = np.array([[end.x, end.y, 0.0] for end in (one.dxf.start, one.dxf.end)])
        else:
            points = np.array([(x, y, bulge) for x, y, _, _, bulge in one.get_points()])
        tags = one.get_xdata("LAMELLA") if one.has_xdata("LAMELLA") else None
        part, copy = (tags[0].value, str(tags[1].value)) if tags else ("", "")
        found.setdefault(one.dxf.layer, []).append((part, copy, points))
    return found


@pytest.mark.parametrize("options", [CutOptions(), CutOptions(kerf=0.0003, lead_in=0.004, tabs=2)])
def test_svg_has_the_same_paths_as_dxf(options: CutOptions, tmp_path: Path) -> None:
    """With kerf, lead-ins and tabs too, of parts in rows and on their sheets."""
    net = lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=6)
    parts = net.strips().parts(foot_radius=0.0005)
    nesting = parts.nest()
    write_drawings(tmp_path, parts, nesting, options, name="n", version="1")
    for name, placed in drawn_sheets(parts, nesting, "", options).items():
        write_svg(tmp_path / f"{name}.svg", placed, name="n & <m>", version="1", further=options.layers)
        drawn, cut = svg_paths(tmp_path / f"{name}.svg"), dxf_paths(tmp_path / f"{name}.dxf")
        assert drawn.keys() == cut.keys()
        assert ("LEAD" in drawn) == bool(options.lead_in)
        shifts = []
        for layer, paths in cut.items():
            assert len(drawn[layer]) == len(paths)
            for (part, copy, there), (own, number, here) in zip(paths, drawn[layer], strict=True):
                assert (part, copy) == (own, number)
                assert here.shape == there.shape
                shifts.append(here[:, :2] * (1, -1) - there[:, :2])
                # an arc of 2.6 m over a few mm: its radius is told to a thousandth of a micrometre
                assert here[:, 2] == pytest.approx(there[:, 2], abs=2e-5)
        moved = np.concatenate(shifts)
        # one shift for all of a drawing
        assert np.ptp(moved, axis=0) == pytest.approx(0.0, abs=3e-6)


def test_more_than_half_a_circle_and_both_senses(tmp_path: Path) -> None:
    writer = BlockWriter("")
    bulges = [0.3, -0.3, 1.0, 2.5, -2.5, 0.0]
    points = np.column_stack([np.cos(np.arange(6.0)), np.sin(np.arange(6.0)), bulges]) * (100, 100, 1)
    writer.polyline("CUT", points, closed=True, tag="x")
    write_svg(tmp_path / "x.svg", [Placed(writer.block(), 3.0, 4.0, turned=True)], name="", version="1")
    ((_, _, found),) = svg_paths(tmp_path / "x.svg")["CUT"]
    assert found[:, 2] == pytest.approx(points[:, 2], abs=1e-4)
    moved = found[:, :2] * (1, -1) + points[:, :2]
    assert np.ptp(moved, axis=0) == pytest.approx(0.0, abs=3e-6)


def test_an_empty_drawing(tmp_path: Path) -> None:
    write_svg(tmp_path / "x.svg", [], name="", version="1")
    assert svg_paths(tmp_path / "x.svg") == {}

"""Sheets of segments, and of lamellas on two levels: each once, with what the lists have."""

from __future__ import annotations

import numpy as np
import pytest

from lamella import compute, parse_project
from lamella.drawings.built import Built
from lamella.drawings.joint_detail import joint_pages
from lamella.drawings.page import Label
from lamella.drawings.paper import PAPERS
from lamella.drawings.segment_sheets import facing, part_line, segment_pages
from lamella.drawings.strip_sheets import strip_pages
from lamella.drawings.terms import terms

EN = terms("en")
SURFACE = {"kind": "catenoid", "neck_radius": 1.2, "height": [-0.5, 0.7]}


def built(**tables: dict) -> Built:
    results = compute(parse_project({"surface": SURFACE, "network": {"cells": 8}} | tables))
    made = results.outputs["fabrication"]
    kind = results.project.joint.kind
    segments = made.segments if made.segments.segments else None
    return Built(results.network, results.lamellas, made.parts, made.hardware, "n", "1", "m", kind, segments)


def labels(page: object) -> list[str]:
    return [one.text for one in page.content if isinstance(one, Label)]  # type: ignore[attr-defined]


def test_every_segment_has_its_sheet() -> None:
    shown = built(joint={"block_spacing": 0}, segments={"size": 2.0})
    assert shown.segments is not None
    pages = list(segment_pages(shown, PAPERS["A3"], EN))
    assert [page.title for page in pages] == [EN("segment", id=one.id) for one in shown.segments.segments]
    assert len(pages) > 1
    for page, segment in zip(pages, shown.segments.segments, strict=True):
        told = labels(page)
        assert EN("mass", value=EN.number(segment.mass, 1)) in told
        words = " ".join(told)
        for index in segment.parts.tolist():
            assert shown.parts.parts[index].label in words
        # the extents that are told are those of what is drawn, along the mean normal
        axes = facing(shown.network.node_normals[segment.nodes])
        lines = [part_line(shown, shown.parts.parts[k]) for k in segment.parts.tolist()]
        flat = np.concatenate([*lines, shown.network.node_points[segment.nodes]]) @ axes.T
        assert [one.value for one in page.dimensions] == pytest.approx(np.ptp(flat, axis=0), abs=1e-9)


def test_a_part_runs_along_its_lamella() -> None:
    shown = built(joint={"block_spacing": 0}, segments={"size": 2.0})
    split = [part for part in shown.parts.parts if "." in part.id]
    assert split
    for part in split[:6]:
        line = part_line(shown, part)
        length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        # ends that reach beyond the first or the last node are not drawn
        assert length == pytest.approx(part.length, abs=0.15)


@pytest.mark.parametrize("mean", [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.3, -0.4, 0.5]])
def test_a_view_faces_the_mean_normal(mean: list[float]) -> None:
    unit = np.array(mean) / np.linalg.norm(mean)
    axes = facing(np.tile(unit, (3, 1)))
    assert np.cross(*axes) == pytest.approx(unit)
    assert axes[0, 2] == pytest.approx(0.0)
    assert axes[1, 2] >= -1e-12
    assert facing(np.array([unit, -unit])) == pytest.approx(np.eye(3)[:2])


def test_lamellas_on_two_levels_have_their_nodes_in_the_tables() -> None:
    shown = built(joint={"kind": "stacked", "block_spacing": 0}, lamella={"thickness": 0.004, "height": 0.05})
    (page,) = joint_pages(shown, PAPERS["A3"], EN)
    heights = [one.value for one in page.dimensions]
    assert min(abs(value - 0.05) for value in heights) < 1e-9
    told = [text for page in strip_pages(shown, PAPERS["A3"], EN) for text in labels(page)]
    parts = shown.parts.parts
    assert not any(len(part.slots) for part in parts)
    for station in parts[0].nodes - parts[0].start:
        if 0 <= station <= parts[0].length:
            assert EN.mm(float(station)) in told

"""One self-contained HTML file that shows a surface, its network and its lamellas in any browser, offline."""

from __future__ import annotations

import base64
import hashlib
import html
import re
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import orjson

from lamella.base.arrays import Floats, Integers
from lamella.base.wording import one_line
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.network.network import NODE_KINDS, REGULAR, Network
from lamella.strip.lamellas import Lamellas
from lamella.surface.mesh import SurfaceMesh
from lamella.view.built_payload import built_payload
from lamella.view.encoding import direction16, float32, integers, quantised
from lamella.view.scene.quantity import Quantity
from lamella.view.scene.surface_quantities import surface_quantities

Spec = dict[str, Any]

SAMPLE_LIMIT = 100_000
"""Centre line samples in a report; at 50 bytes each this keeps a large net's file at a few MB."""

STOP_LIMIT = 60_000
"""Nodes on lamellas, counted on each of them, in a report."""

VERTEX_LIMIT = 30_000
"""Surface vertices in a report."""

CORNER_LIMIT = 24
"""Corners of the boundary in a report's table."""

CORNER_COLUMNS = ("Place, m", "Angle, °", "Node angle off, °", "Utilisation")

PASCAL_TO_MEGAPASCAL = 1e-6


@dataclass(frozen=True)
class ReportData:
    """What a report shows.

    Attributes
    ----------
    name : str
        The project's name.
    version : str
        The program's version.
    kind : str
        Kind of surface, "unduloid".
    figures : tuple of (section, label, value, unit)
        Key figures, already formatted; sections appear in the order of their first figure.
    corners : tuple of (place, angle, node angle, utilisation)
        Corners of the boundary, already formatted, in the order of the summary; none: no table.
    warnings : tuple of str
        Shown above everything else.
    surface : SurfaceMesh
    mean_curvature : float
        H0, which the surface should have everywhere, 1/m.
    network : Network or None
        None after the stage "surface". Without lamellas its curvatures are still shown.
    lamellas : Lamellas or None
        None after the stages "surface" and "network".
    material : str
        Name of the lamellas' material, shown with their section.
    built : tuple of DrawnLayer
        What is built, with solids; none before the stage "fabrication".
    """

    name: str
    version: str
    kind: str
    figures: tuple[tuple[str, str, str, str], ...]
    corners: tuple[tuple[str, str, str, str], ...]
    warnings: tuple[str, ...]
    surface: SurfaceMesh
    mean_curvature: float
    network: Network | None
    lamellas: Lamellas | None
    material: str
    built: tuple[DrawnLayer, ...] = ()


def write_report(path: Path, data: ReportData) -> None:
    """Write the report to `path`.

    Parameters
    ----------
    path : Path
        The file, replaced if it exists.
    data : ReportData
        What to show.
    """
    path.write_bytes(report_html(data).encode())


def report_html(data: ReportData) -> str:
    """Return the report as the text of one HTML file.

    Parameters
    ----------
    data : ReportData
        What to show.

    Returns
    -------
    str
        HTML that asks for nothing outside itself; the same for the same data.
    """
    payload, notes = _payload(data)
    three, script = _asset("three.min.js"), _asset("report.js")
    return _filled(
        _asset("report.html"),
        {
            "policy": _policy(three, script),
            "name": html.escape(one_line(data.name)),
            "version": html.escape(data.version),
            "subtitle": html.escape(one_line(_subtitle(data))),
            "warnings": _warnings_html(data.warnings),
            "figures": _figures_html(data.figures) + _corners_html(data.corners),
            "notes": "".join(f'<p class="note">{html.escape(note)}</p>' for note in notes),
            "css": _asset("report.css"),
            "data": _json_for_html(payload),
            "three": three,
            "script": script,
        },
    )


def _asset(name: str) -> str:
    return files("lamella.view").joinpath("assets", name).read_text(encoding="utf-8")


def _filled(template: str, values: dict[str, str]) -> str:
    # One pass, so that a project named "{{css}}" stays just a name.
    return re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], template)


def _policy(*scripts: str) -> str:
    """Content security policy: these scripts by their hashes, no other, and no request to anywhere."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'" for script in scripts
    )
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def _subtitle(data: ReportData) -> str:
    parts = [data.kind]
    if data.lamellas is not None:
        section = data.lamellas.section
        text = f"lamellas {section.height * 1e3:.6g} × {section.thickness * 1e3:.6g} mm"
        if section.layers > 1:
            text += f", {section.layers} layers {section.offset * 1e3:.6g} mm apart"
        parts += [text, data.material]
    return " · ".join(part for part in parts if part)


def _warnings_html(warnings: tuple[str, ...]) -> str:
    if not warnings:
        return ""
    title = "Warning" if len(warnings) == 1 else f"{len(warnings)} warnings"
    items = "".join(f"<li>{html.escape(one_line(warning))}</li>" for warning in warnings)
    return f'<section class="warnings" aria-label="Warnings"><h2>{title}</h2><ul>{items}</ul></section>'


def _figures_html(figures: tuple[tuple[str, str, str, str], ...]) -> str:
    sections: dict[str, list[str]] = {}
    for section, label, value, unit in figures:
        suffix = f" <span>{html.escape(unit)}</span>" if unit else ""
        # "3.4e-15" would break at its sign, yet a long text has to break somewhere.
        kind = "short" if len(value) + len(unit) < 24 else "long"
        sections.setdefault(section, []).append(
            f'<tr><th scope="row">{html.escape(label)}</th><td class="{kind}">{html.escape(value)}{suffix}</td></tr>'
        )
    return "\n".join(
        f"<table><caption>{html.escape(section)}</caption><tbody>{''.join(rows)}</tbody></table>"
        for section, rows in sections.items()
    )


def _corners_html(corners: tuple[tuple[str, str, str, str], ...]) -> str:
    """A table with a row a corner, and how many more the summary has."""
    if not corners:
        return ""
    head = "".join(f'<th scope="col">{html.escape(column)}</th>' for column in CORNER_COLUMNS)
    rows = "".join(
        f'<tr><th scope="row">{html.escape(corner[0])}</th>'
        + "".join(f'<td class="short">{html.escape(value)}</td>' for value in corner[1:])
        + "</tr>"
        for corner in corners[:CORNER_LIMIT]
    )
    left = len(corners) - CORNER_LIMIT
    if left > 0:
        rows += f'<tr><th colspan="{len(CORNER_COLUMNS)}">{left:,} more: summary.json, network.corners</th></tr>'
    caption = "<caption>Corners of the boundary</caption>"
    body = f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody>"
    return f'\n<table class="columns">{caption}{body}</table>'


def _json_for_html(payload: Spec) -> str:
    # "<" is all that can end a script element or open a comment in it.
    return orjson.dumps(payload).decode().replace("<", "\\u003c")


def _payload(data: ReportData) -> tuple[Spec, list[str]]:
    """Return what report.js reads, and remarks on what was left out of it."""
    notes: list[str] = []
    clouds = [data.surface.points]
    if data.network is not None:
        clouds += [data.network.sample_points, data.network.node_points]
    centre = _centre(clouds)
    payload: Spec = {
        "schema": "lamella/report/1",
        "name": one_line(data.name),
        "centre": centre.tolist(),
        "surface": _surface_payload(data, centre, notes),
        "network": None,
        "lamellas": None,
        "built": None,
    }
    if data.network is not None:
        stops = _kept_stops(data.network, STOP_LIMIT)
        kept = _kept_samples(data.network, stops, SAMPLE_LIMIT)
        total = len(data.network.sample_points)
        if len(kept) < total:
            every = len(stops) == len(data.network.stop_nodes)
            nodes = "every node" if every else "one node in " + str(_stop_stride(data.network, STOP_LIMIT))
            notes.append(f"Drawn and plotted with {len(kept):,} of {total:,} centre line samples, {nodes} among them.")
        payload["network"] = _network_payload(data.network, centre, kept, stops)
        if data.lamellas is not None:
            payload["lamellas"] = _lamellas_payload(data.network, data.lamellas, kept)
            payload["built"], left_out = built_payload(data.built, data.network, kept, centre)
            notes += left_out
    return payload, notes


def _centre(clouds: list[Floats]) -> Floats:
    filled = [cloud for cloud in clouds if len(cloud)]
    if not filled:
        return np.zeros(3)
    low = np.min([cloud.min(axis=0) for cloud in filled], axis=0)
    high = np.max([cloud.max(axis=0) for cloud in filled], axis=0)
    return np.asarray((low + high) / 2, dtype=np.float64)


def _surface_payload(data: ReportData, centre: Floats, notes: list[str]) -> Spec:
    surface = data.surface
    quantities = surface_quantities(surface, data.mean_curvature)
    triangles = np.concatenate([surface.faces[:, [0, 1, 2]], surface.faces[:, [0, 2, 3]]])
    kept, labels = _clusters(surface.points, VERTEX_LIMIT)
    if len(kept) < len(surface.points):
        notes.append(
            f"Surface drawn with {len(kept):,} of {len(surface.points):,} vertices; the other files hold all of them."
        )
        triangles = labels[triangles]
    return {
        "points": float32(surface.points[kept] - centre),
        "normals": direction16(surface.normals[kept]),
        "triangles": integers(_distinct_triangles(triangles, len(kept))),
        "colourings": [_colouring(quantity, kept) for quantity in quantities.values()],
        # without strips to look at, the surface is what there is to see
        "first": "plain" if data.network is not None or quantities["K"].is_constant else "K",
    }


def _colouring(quantity: Quantity, kept: Integers) -> Spec:
    """A quantity as report.js reads it: values at the kept vertices, no farther out than the colours reach."""
    if quantity.is_constant:
        values = np.full(len(kept), quantity.low)
    else:
        values = quantity.values[kept]
        values = np.where(np.isfinite(values), np.clip(values, quantity.low, quantity.high), np.nan)
    return {
        "key": quantity.key,
        "label": quantity.label,
        "unit": quantity.unit,
        "remark": quantity.remark,
        "low": quantity.low,
        "high": quantity.high,
        "least": quantity.least,
        "most": quantity.most,
        "stops": list(quantity.stops),
        "values": quantised(values),
    }


def _clusters(points: Floats, limit: int) -> tuple[Integers, Integers]:
    """Return one vertex for each occupied cell of a cubic grid, and each vertex's place among those."""
    if len(points) <= limit:
        identity = np.arange(len(points))
        return identity, identity
    low, span = points.min(axis=0), float(np.ptp(points, axis=0).max())
    size = span / np.sqrt(limit)
    while True:
        cells = np.floor((points - low) / size).astype(np.int64)
        side = int(cells.max()) + 1
        keys = (cells[:, 0] * side + cells[:, 1]) * side + cells[:, 2]
        _, first, labels = np.unique(keys, return_index=True, return_inverse=True)
        if len(first) <= limit:
            return first, labels
        size *= max(1.02, np.sqrt(len(first) / limit))


def _distinct_triangles(triangles: Integers, count: int) -> Integers:
    """Drop triangles without area and repeated ones; the winding stays."""
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    if not len(triangles):
        return triangles
    turn = np.argmin(triangles, axis=1)[:, None]
    turned = np.take_along_axis(triangles, (turn + np.arange(3)) % 3, axis=1)
    _, first = np.unique((turned[:, 0] * count + turned[:, 1]) * count + turned[:, 2], return_index=True)
    return np.asarray(turned[np.sort(first)], dtype=np.int64)


def _stop_stride(network: Network, limit: int) -> int:
    return max(-(-len(network.stop_nodes) // limit), 1)


def _kept_stops(network: Network, limit: int) -> Integers:
    """Return indices of all stops, or of every so many in each lamella with its ends."""
    offsets = network.stop_offsets
    within = np.arange(offsets[-1]) - np.repeat(offsets[:-1], np.diff(offsets))
    keep = within % _stop_stride(network, limit) == 0
    keep[offsets[1:] - 1] = True
    return np.flatnonzero(keep)


def _kept_samples(network: Network, stops: Integers, limit: int) -> Integers:
    """Return indices of all samples, or of every so many in each lamella with its ends and some stops."""
    offsets = network.sample_offsets
    total = int(offsets[-1])
    if total <= limit:
        return np.arange(total)
    stride = -(-total // max(limit - len(stops), 1))
    within = np.arange(total) - np.repeat(offsets[:-1], np.diff(offsets))
    keep = within % stride == 0
    keep[_stop_indices(network)[stops]] = True
    keep[offsets[1:] - 1] = True
    return np.flatnonzero(keep)


def _stop_indices(network: Network) -> Integers:
    """Return the sample of each stop, counted over all lamellas."""
    starts = np.repeat(network.sample_offsets[:-1], np.diff(network.stop_offsets))
    return np.asarray(starts + network.stop_samples, dtype=np.int64)


def _network_payload(network: Network, centre: Floats, kept: Integers, stops: Integers) -> Spec:
    offsets = np.searchsorted(kept, network.sample_offsets)
    samples = np.searchsorted(kept, _stop_indices(network)[stops])
    stop_offsets = np.searchsorted(stops, network.stop_offsets)
    # nodes that are drawn: those of kept stops, and the few of other kinds
    drawn = network.node_kinds != REGULAR
    drawn[network.stop_nodes[stops]] = True
    return {
        "ids": list(network.ids),
        "families": "".join(network.families.tolist()),
        "lengths": float32(network.lengths if len(network.ids) else np.zeros(0)),
        "offsets": integers(offsets),
        "points": float32(network.sample_points[kept] - centre),
        "normals": direction16(network.sample_normals[kept]),
        "arclengths": float32(network.sample_arclengths[kept]),
        "normalCurvature": quantised(network.sample_darboux.kn[kept]),
        "geodesicCurvature": quantised(network.sample_darboux.kg[kept]),
        "geodesicTorsion": quantised(network.sample_darboux.tg[kept]),
        "nodeCounts": integers(np.diff(network.stop_offsets)),
        "stopOffsets": integers(stop_offsets),
        "stopNodes": integers(network.stop_nodes[stops]),
        "stopSamples": integers(samples - np.repeat(offsets[:-1], np.diff(stop_offsets))),
        "nodePoints": float32(network.node_points[drawn] - centre),
        "nodeKinds": integers(network.node_kinds[drawn]),
        "kindCounts": integers(np.bincount(network.node_kinds, minlength=len(NODE_KINDS))),
    }


def _lamellas_payload(network: Network, strips: Lamellas, kept: Integers) -> Spec:
    stresses = {
        "bending": strips.bending,
        "torsion": strips.torsion,
        "helixEdge": strips.helix_edge,
        "helixCentre": strips.helix_centre,
        "restraint": strips.restraint,
        "layer": strips.layer,
        "vonMises": strips.von_mises,
    }
    return {
        "height": strips.section.height,
        "developedLengths": float32(strips.developed_lengths),
        "utilisation": quantised(strips.utilisation[kept]),
        "planarity": quantised(_planarity(network, strips, kept)),
        **{key: quantised(stress[kept] * PASCAL_TO_MEGAPASCAL) for key, stress in stresses.items()},
    }


def _planarity(network: Network, strips: Lamellas, kept: Integers) -> Floats:
    """Return the worst score between a kept sample and the next; an end takes its neighbour's."""
    if not len(kept):
        return np.zeros(0)
    worst = np.maximum.reduceat(strips.planarity, kept)
    ends = np.searchsorted(kept, network.sample_offsets[1:] - 1)
    worst[ends] = worst[ends - 1]
    return np.asarray(worst, dtype=np.float64)

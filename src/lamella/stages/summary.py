"""summary.json: the figures of a run, computed from the surface itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella.base.material import Material
from lamella.base.wording import loop_names, one_line
from lamella.fabrication.part import Parts
from lamella.fabrication.sheet import Nesting
from lamella.network.network import BOUNDARY, SINGULAR, Network
from lamella.network.written_lines import angle_figures
from lamella.strip.lamellas import Lamellas
from lamella.strip.planarity import planarity_score
from lamella.strip.unroll import development_deviation
from lamella.surface.element.rim import element_rims
from lamella.surface.element.surface import ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.project.tables import BoundaryTable


def cleaned(value: Any) -> Any:
    """A table of figures with all its texts on one line each, without control characters: names come from files."""
    if isinstance(value, str):
        return one_line(value)
    if isinstance(value, dict):
        return {key: cleaned(item) for key, item in value.items()}
    return [cleaned(item) for item in value] if isinstance(value, list | tuple) else value


def surface_summary(surface: Surface[Any], mesh: SurfaceMesh) -> dict[str, Any]:
    """The surface's figures, with those it has to tell itself; its stability where that is one of them."""
    size = np.ptp(mesh.points, axis=0)
    measured = surface.measured_mean_curvature(surface.check_places())
    return {
        "kind": surface.kind,
        "mean_curvature": surface.mean_curvature,
        "mean_curvature_deviation_max": float(np.abs(measured - surface.mean_curvature).max()),
        "area": surface.area(),
        "size": size.tolist(),
        "k1_max": float(mesh.k1.max()),
        "k2_min": float(mesh.k2.min()),
        "stability": None,
    } | surface.describe()


def loop_summary(surface: Surface[Any], boundary: Sequence[BoundaryTable]) -> dict[str, Any]:
    """The boundary loops of a surface of elements: name, length (m), and whether they are held.

    Parameters
    ----------
    surface : Surface
    boundary : sequence of BoundaryTable
        Those of the project; none for a surface from a mesh, whose borders are held.
    """
    if not isinstance(surface, ElementSurface):
        return {}
    rims = element_rims(surface.connectivity, surface.nodes, surface.rim_loop)
    names = [table.name for table in boundary] or loop_names(len(rims))
    held = [_held(table) for table in boundary] or ["held"] * len(rims)
    return {
        "loops": [
            {"name": name, "length": rim.length, "held": how} for name, rim, how in zip(names, rims, held, strict=True)
        ]
    }


def _held(table: BoundaryTable) -> str:
    """How a loop is held, in words."""
    slides = [part.slide for part in table.part or ()] or [table.slide]
    ways = {"along a direction" if slide.direction else "on a plane" for slide in slides if slide is not None}
    if not ways:
        return "held"
    free, how = sum(slide is not None for slide in slides), " and ".join(sorted(ways))
    if free == len(slides):
        return f"slides {how}"
    return f"{free} of {len(slides)} parts {'slides' if free == 1 else 'slide'} {how}, the others are held"


def network_summary(network: Network, requested: str) -> dict[str, Any]:
    """The network's figures."""
    wanted = network.normal_curvature
    edges = network.cell_edges
    a, b = network.node_degrees()
    rays = a + b
    periods = [p._asdict() for p in network.periods]
    return {
        "nodes": len(network.node_points),
        "lamellas": len(network.ids),
        "lamellas_left_out": network.left_out,
        "faces": len(network.face_offsets) - 1,
        "kind": network.pattern.kind,
        "every": list(network.pattern.every),
        "requested": requested,
        "cells": network.cells,
        "step": network.step,
        "singular_nodes": [
            {"point": network.node_points[i].tolist(), "order": int(rays[i]) // 2 - 2, "rays": int(rays[i])}
            for i in np.flatnonzero(network.node_kinds == SINGULAR).tolist()
        ],
        **angle_figures(network.node_angles[None]),
        "normal_curvature": wanted,
        "normal_curvature_deviation_max": float(np.abs(network.sample_darboux.kn - wanted).max()),
        "cell_edge_min": float(edges.min()),
        "cell_edge_median": float(np.median(edges)),
        "cell_edge_max": float(edges.max()),
        "periods": periods,
        "closed": all(abs(c - round(c)) <= 1e-3 for p in network.periods for c in (p.a_cells, p.b_cells)),
    } | (principal_summary(network) if network.pattern.kind == "principal" else {})


def principal_summary(network: Network) -> dict[str, Any]:
    """What a principal net is judged by: its panels, and how its normal curvature varies. kn is H nowhere."""
    kn, family = network.sample_darboux.kn, np.repeat(network.families, np.diff(network.sample_offsets))
    curvatures = {f: [float(kn[family == f].min()), float(kn[family == f].max())] for f in "AB" if (family == f).any()}
    start = network.face_offsets[:-1][np.diff(network.face_offsets) == 4]
    panels = network.face_nodes[start[:, None] + np.arange(4)]
    score = planarity_score(*network.node_points[panels].transpose(1, 0, 2))
    rim = (network.node_kinds[panels] == BOUNDARY).any(1)
    inner = score[~rim]
    return {
        "normal_curvature": None,
        "normal_curvature_deviation_max": None,
        "principal_curvatures": curvatures,
        "geodesic_torsion_max": float(np.abs(network.sample_darboux.tg).max()),
        "panels": len(start),
        "panel_planarity": {
            "median": float(np.median(inner)) if len(inner) else None,
            "max": float(inner.max()) if len(inner) else None,
            "rim_max": float(score[rim].max()) if rim.any() else None,
        },
    }


def lamella_summary(network: Network, lamellas: Lamellas, name: str, material: Material) -> dict[str, Any]:
    """The lamellas' figures, with the section and the material (by name) they rest on."""
    quads = np.ones(len(lamellas.planarity), bool)
    quads[network.sample_offsets[1:] - 1] = False
    deviation = development_deviation(
        network.sample_points, network.sample_normals, network.sample_offsets, network.normal_curvature
    )
    apart = np.diff(lamellas.layers.distances, axis=0)[:, lamellas.layers.followed]
    return {
        "total_length": float(network.lengths.sum()),
        "section": asdict(lamellas.section),
        "material": {"name": name} | asdict(material),
        "geodesic_curvature_max": float(np.abs(network.sample_darboux.kg).max()),
        "geodesic_torsion_max": float(np.abs(network.sample_darboux.tg).max()),
        "planarity_score": {
            "twisted": {
                "median": float(np.median(lamellas.planarity[quads])),
                "max": float(lamellas.planarity[quads].max()),
            },
            "developable": None,
        },
        "development_deviation_max": float(deviation.max()),
        "stress_bending_max": float(lamellas.bending.max()),
        "stress_torsion_max": float(lamellas.torsion.max()),
        "stress_helix_max": float(lamellas.helix_edge.max()),
        "stress_restraint_max": float(lamellas.restraint.max()),
        "stress_layer_max": float(lamellas.layer.max()),
        "von_mises_max": float(lamellas.von_mises.max()),
        "utilisation_max": float(lamellas.utilisation.max()),
        "utilisation_net_section_max": float(lamellas.net_utilisation.max(initial=0.0)),
        "layer_distances": [float(apart.min()), float(apart.max())] if apart.size else [],
    }


def fabrication_summary(parts: Parts, nesting: Nesting, surface_area: float) -> dict[str, Any]:
    """The parts' figures; mass in kg, surface weight in kg per m2 of surface."""
    return {
        "mass": parts.mass,
        "surface_weight": parts.mass / surface_area,
        "parts": parts.pieces,
        "sheets": nesting.sheet_count,
        "bow_max": max((part.bow for part in parts.parts), default=0.0),
        "sheet_use": sum(part.quantity * part.area for part in parts.parts)
        / float(np.prod(nesting.sizes, axis=1).sum()),
    }

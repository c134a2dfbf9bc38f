"""The files of a run, stage by stage (docs/files.md)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from lamella import __version__
from lamella.base.drawing_origin import Origin
from lamella.base.progress import Progress, Report
from lamella.base.wording import one_line
from lamella.fabrication import write_drawings, write_schedule
from lamella.files.whole import write_whole
from lamella.files.write.curves_3dm import write_curves_3dm
from lamella.files.write.lamellas_json import write_lamellas
from lamella.files.write.meshes import write_network_obj, write_surface_obj, write_surface_ply
from lamella.files.write.model_3dm import model_bytes
from lamella.files.write.network_json import write_network
from lamella.files.write.nodes_csv import write_nodes_csv
from lamella.files.write.rhino_file import Frame
from lamella.files.write.surface_3dm import write_surface_3dm
from lamella.network.network import Network
from lamella.project.read import moved
from lamella.stages.boundary_of_tables import boundary_loops, drawing_unit
from lamella.surface.element.surface import ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.view.report import ReportData, write_report

if TYPE_CHECKING:
    from lamella.stages.pipeline import Results

Drawn = TypeVar("Drawn", SurfaceMesh, Network)

COARSE_MESH_POINTS = 7_500
"""Vertices below which the report's mesh of a surface of curved elements is made anew, with `REPORT_SAG`."""

REPORT_SAG = 2.5e-4
"""A quarter of what the files' mesh has, over the diagonal of the bounding box: four times the vertices."""


def write_files(results: Results, folder: Path, *, progress: Progress) -> None:
    """Write all files but summary.json into an existing folder.

    Parameters
    ----------
    results : Results
    folder : Path
    progress : callable
        Is told each file's name.
    """
    project, lamellas = results.project, results.lamellas
    frame = Frame(project.files.unit, results.origin)
    mesh, network = (
        in_drawing(results.mesh, results.origin),
        results.network and in_drawing(results.network, results.origin),
    )
    signed: Any = {"name": project.name, "version": __version__}

    def put(file: str, write: Callable[..., object], *content: Any, **more: Any) -> None:
        progress(Report.step(file))
        write(folder / file, *content, **more)

    heading = f"# {one_line(project.name)}, all defaults filled in by lamella {__version__}\n"
    put("project.toml", write_whole, (heading + moved(project, results.folder, folder).to_toml()).encode())
    if results.adjusted:
        reported = f"# {one_line(project.name)}, with the boundary as lamella {__version__} has adjusted it\n"
        own = project.model_copy(update={"surface": results.adjusted.table})
        put("adjusted.toml", write_whole, (reported + moved(own, results.folder, folder).to_toml()).encode())
        unit = drawing_unit(results.adjusted.table, results.folder)
        if unit:
            loops = boundary_loops(results.adjusted.table, results.folder)
            put("adjusted.3dm", write_curves_3dm, loops, Frame(unit, results.origin), **signed)
    put("surface.obj", write_surface_obj, mesh, **signed)
    put("surface.ply", write_surface_ply, mesh, **signed)
    if isinstance(results.surface, ElementSurface):
        put("surface.3dm", write_surface_3dm, results.surface, frame, **signed)
    if network:
        put("network.json", write_network, network, **signed)
        put("network.obj", write_network_obj, network, **signed)
        put("nodes.csv", write_nodes_csv, network, **signed)
        content: Any = {"surface": results.mesh, "network": results.network, "lamellas": lamellas, "frame": frame}
        # rhino3dm's own Write says nothing of a full disk
        put("model.3dm", lambda path: write_whole(path, model_bytes(**content, **signed)))
    if network and lamellas:
        put("lamellas.json", write_lamellas, network, lamellas, **signed)
    if network and lamellas and results.parts and results.nesting:
        (folder / "fabrication").mkdir()
        progress(Report.step("fabrication/A.dxf, B.dxf, sheets.dxf"))
        write_drawings(folder / "fabrication", results.parts, results.nesting, **signed)
        put("fabrication/schedule.csv", write_schedule, results.parts, results.nesting, network, lamellas, **signed)
    put("report.html", write_report, report_data(results))


def in_drawing(points: Drawn, origin: Origin) -> Drawn:
    """A mesh or a network in the drawing's coordinates."""
    if not any(origin):
        return points
    own = ("node_points", "sample_points") if isinstance(points, Network) else ("points",)
    return replace(points, **{key: getattr(points, key) + np.array(origin) for key in own})


def report_data(results: Results) -> ReportData:
    """What the report shows of a run."""
    return ReportData(
        name=results.project.name,
        version=__version__,
        kind=results.surface.kind,
        figures=tuple(_figures(results.summary)),
        corners=tuple(_corners(results.summary)),
        warnings=tuple(results.summary["warnings"]),
        surface=_report_mesh(results),
        mean_curvature=results.surface.mean_curvature,
        network=results.network,
        lamellas=results.lamellas,
        material=results.project.lamella.material,
    )


def _report_mesh(results: Results) -> SurfaceMesh:
    """The mesh of the report: finer than the files' where that is coarse, so that curved rims look curved."""
    if isinstance(results.surface, ElementSurface) and len(results.mesh.points) < COARSE_MESH_POINTS:
        return results.surface.mesh(REPORT_SAG)
    return results.mesh


def _figures(summary: dict[str, Any]) -> list[tuple[str, str, str, str]]:
    """Key figures of the summary as (section, label, value, unit)."""
    figures: list[tuple[str, str, str, str]] = []

    def add(section: str, label: str, value: float, unit: str = "", scale: float = 1.0, form: str = ".4g") -> None:
        figures.append((section, label, format(value * scale if scale != 1 else value, form), unit))

    s, n, m, f = (summary[stage] for stage in ("surface", "network", "lamellas", "fabrication"))
    if "mean_curvature_range" in s:
        low, high = s["mean_curvature_range"]
        add("Surface", "Mean curvature, its mean H0", s["mean_curvature"], "1/m")
        figures.append(("Surface", "Mean curvature, from and to", f"{low:.4g} … {high:.4g}", "1/m"))
    else:
        add("Surface", "Mean curvature H0", s["mean_curvature"], "1/m")
        add("Surface", "|H − H0|, at check places", s["mean_curvature_deviation_max"], "1/m", form=".2g")
    add("Surface", "Area", s["area"], "m²")
    figures.append(("Surface", "Size", " × ".join(f"{x:.3g}" for x in s["size"]), "m"))
    add("Surface", "Largest k1", s["k1_max"], "1/m")
    add("Surface", "Smallest k2", s["k2_min"], "1/m")
    if "volume" in s:
        add("Surface", "Volume, with lids over the loops", s["volume"], "m³")
    if "origin" in s:
        figures.append(("Surface", "Measured from, in the drawing", ", ".join(f"{x:.10g}" for x in s["origin"]), "m"))
    if s["stability"]:
        figures.append(("Surface", "Stability", str(s["stability"]), ""))
    if "jacobi_eigenvalue" in s:
        add("Surface", "Lowest Jacobi eigenvalue", s["jacobi_eigenvalue"], "1/m²", form=".3g")
    if "distance_max" in s:
        add("Surface", "Off the mesh's vertices, largest", s["distance_max"], "mm", 1e3, ".3g")
        add("Surface", "Off the mesh's vertices, typical", s["distance_rms"], "mm", 1e3, ".3g")
    if "elements" in s:
        figures.append(("Surface", "Curved triangles", f"{s['elements']:,} of order {s['order']}", ""))
    for loop in s.get("loops", ()):
        figures.append(("Boundary", loop["name"], f"{loop['length']:.4g} m, {loop['held']}", ""))
    if n:
        add("Network", "Lamellas", n["lamellas"], form=",")
        add("Network", "Nodes", n["nodes"], form=",")
        add("Network", "Singular nodes", len(n["singular_nodes"]), form="d")
        add("Network", "Cells around or across", n["cells"], form="d")
        add("Network", "Cell edge, smallest", n["cell_edge_min"], "m")
        add("Network", "Cell edge, median", n["cell_edge_median"], "m")
        add("Network", "Cell edge, largest", n["cell_edge_max"], "m")
        if "adjustment" in n:
            add("Network", "Boundary adjusted by, at most", n["adjustment"]["moved_max"], "mm", 1e3, ".3g")
        if n.get("unreal_area_share"):
            add("Network", "Surface without such directions", n["unreal_area_share"], "%", 100, ".3g")
        if n["normal_curvature"] in (None, s["mean_curvature"]):
            add("Network", "Node angle off 90°, largest", n["node_angle_deviation_max_deg"], "°", form=".2g")
        else:
            add("Network", "Node angle, smallest", n["node_angle_min_deg"], "°")
            add("Network", "Node angle, largest", n["node_angle_max_deg"], "°")
            if "node_angle_mean_deg" in n:
                add("Network", "Node angle, mean", n["node_angle_mean_deg"], "°")
            add("Network", "Normal curvature of all lamellas", n["normal_curvature"], "1/m")
        if n["kind"] == "lamellas":
            of = "H" if n["normal_curvature"] == s["mean_curvature"] else "it"
            off = n["normal_curvature_deviation_max"]
            add("Network", f"Normal curvature off {of}, largest", off, "1/m", form=".2g")
        else:
            add("Network", "Panels with four corners", n["panels"], form=",")
            for key, label in (
                ("median", "inside, median"),
                ("max", "inside, worst"),
                ("rim_max", "at the rim, worst"),
            ):
                if n["panel_planarity"][key] is not None:
                    add("Network", f"Panel planarity {label}", n["panel_planarity"][key], form=".2g")
    if m:
        add("Lamellas", "Length, one layer", m["total_length"], "m")
        add("Lamellas", "Geodesic curvature, largest", m["geodesic_curvature_max"], "1/m")
        add("Lamellas", "Geodesic torsion, largest", m["geodesic_torsion_max"], "1/m")
        add("Lamellas", "Planarity score, median", m["planarity_score"]["twisted"]["median"], form=".2g")
        add("Lamellas", "Planarity score, largest", m["planarity_score"]["twisted"]["max"], form=".2g")
        add("Lamellas", "Off the straight or round development", m["development_deviation_max"], "mm", 1e3, ".2g")
        for key, label in (
            ("stress_bending_max", "Bending stress, largest"),
            ("stress_torsion_max", "Torsion stress, largest"),
            ("stress_helix_max", "Helix stress, largest"),
            ("stress_restraint_max", "Restraint stress, largest"),
            ("stress_layer_max", "Strong-axis stress of layers, largest"),
            ("von_mises_max", "Von Mises stress, largest"),
        ):
            add("Lamellas", label, m[key], "MPa", 1e-6)
        add("Lamellas", "Utilisation, largest", m["utilisation_max"], form=".2f")
        add("Lamellas", "Utilisation at slots, largest", m["utilisation_net_section_max"], form=".2f")
        if m["layer_distances"]:
            low, high = (f"{1e3 * x:.3g}" for x in m["layer_distances"])
            figures.append(("Lamellas", "Layers apart", low if low == high else f"{low} … {high}", "mm"))
    if f:
        add("Fabrication", "Parts", f["parts"], form=",")
        add("Fabrication", "Sheets", f["sheets"], form="d")
        if f["bow_max"]:
            add("Fabrication", "Cut outlines bowed by, at most", f["bow_max"], "mm", 1e3, ".2g")
        add("Fabrication", "Mass", f["mass"], "kg")
        add("Fabrication", "Mass per area of surface", f["surface_weight"], "kg/m²")
    return figures


def _corners(summary: dict[str, Any]) -> list[tuple[str, str, str, str]]:
    """Place, angle between the sides, worst node angle and utilisation next to each corner of the boundary."""
    rows = (summary["network"] or {}).get("corners", [])
    stress = (summary["lamellas"] or {}).get("utilisation_at_corners", [None] * len(rows))

    decimals = int(np.clip(1 - np.floor(np.log10(max(summary["surface"]["size"]))), 0, 3))

    def reported(value: float | None, form: str) -> str:
        # nothing of the net is there
        return "–" if value is None else format(value, form)

    return [
        (
            ", ".join(f"{x:.{decimals}f}" for x in row["point"]),
            f"{row['angle_deg']:.1f}",
            reported(row["node_angle_deviation_max_deg"], ".2g"),
            reported(use, ".2f"),
        )
        for row, use in zip(rows, stress, strict=True)
    ]

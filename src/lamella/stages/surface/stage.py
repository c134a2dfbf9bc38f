"""The stage "surface": found, adjusted, read from a mesh or known in closed form."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress, Report
from lamella.base.wording import one_line
from lamella.project.read import moved
from lamella.project.tables import FormFoundTable, Project
from lamella.stages.drawn import in_drawing
from lamella.stages.figure import require_declared
from lamella.stages.keys import with_keys
from lamella.stages.pattern_of_table import pattern_of
from lamella.stages.stage import File, Stage, Upstream
from lamella.stages.surface.figures import FIGURES, REPORT
from lamella.stages.surface.output import SurfaceOutput
from lamella.stages.surface.surface_of_table import make_surface
from lamella.stages.surface.warnings import size_warnings, surface_file_warnings
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.stages.surface.adjusted_table import AdjustedTable
    from lamella.view.scene.scene import Shown


class SurfaceStage(Stage[SurfaceOutput]):
    """See `lamella.stages.stage.Stage`."""

    name = "surface"
    quantities = ("deviation", "K", "ratio", "k1", "k2")
    writes = (
        ("surface.obj, surface.ply", "the surface as a mesh"),
        (
            "surface.3dm",
            "of surfaces of curved triangles, where they are small or `files.surface_3dm` is true: the surface itself "
            "as NURBS patches",
        ),
        ("adjusted.toml", "where the boundary was adjusted: the project with that boundary"),
        ("adjusted.3dm", "where curves of such a boundary are from a file"),
    )
    figures = FIGURES
    report = ("Surface", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return (*_decided_by(project, wanted), "files.mesh_tolerance")

    def warned_by(self, project: Project) -> tuple[str, ...]:
        return ("lamella.height", "files.surface_3dm")

    def heading(self, up: Upstream) -> str:
        return up.project.surface.kind

    def run(self, up: Upstream, progress: Progress) -> SurfaceOutput:
        project = up.project
        key = up.content(_decided_by(project, up.wanted))
        surface, adjusted = up.remembered("surface without its mesh", key, lambda: _found(up, progress))
        progress(Report.detail("sampling the surface for files and pictures"))
        out = SurfaceOutput(project, surface, surface.mesh(project.files.mesh_tolerance), adjusted, key)
        require_declared(FIGURES, out.described)
        return out

    def result(self, figures: Mapping[str, Any], out: SurfaceOutput) -> str:
        return f"area {figures['area']:.4g} m2, H = {out.surface.mean_curvature:.6g} 1/m"

    def warnings(self, out: SurfaceOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        yield from (with_keys(warning, "surface.tolerance =", "surface.radius =") for warning in out.surface.warnings())
        yield from size_warnings(out.mesh, up.project.lamella.height)
        yield from surface_file_warnings(out.surface, up.project.files.surface_3dm)

    def files(self, out: SurfaceOutput, up: Upstream) -> Iterator[File]:
        from lamella.files.write.meshes import write_surface_obj, write_surface_ply

        project, origin = up.project, drawing_origin(out.surface)
        signed: Any = {"name": project.name, "version": __version__}
        mesh = in_drawing(out.mesh, origin)
        if out.adjusted:
            yield from _adjusted_files(out.adjusted, up)
        yield File("surface.obj", lambda path: write_surface_obj(path, mesh, **signed))
        yield File("surface.ply", lambda path: write_surface_ply(path, mesh, **signed))
        surface = out.surface
        if isinstance(surface, ClosedForm):
            return
        # heavy, and closed forms do without
        from lamella.surface.element.surface import ElementSurface

        if isinstance(surface, ElementSurface):
            from lamella.files.write.rhino_file import Frame
            from lamella.files.write.surface_3dm import write_surface_3dm
            from lamella.files.write.surface_patches import is_written

            frame = Frame(project.files.unit, origin)
            if is_written(surface, project.files.surface_3dm):
                yield File("surface.3dm", lambda path: write_surface_3dm(path, surface, frame, **signed))

    def scene(self, out: SurfaceOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.surface.scene import surface_scene

        yield from surface_scene(out, alone="network" not in up.outputs)


def _adjusts(project: Project, wanted: tuple[str, ...]) -> bool:
    """Whether the boundary is adjusted: for a net that is made."""
    return project.network.closing == "adjust" and project.surface.kind == "form-found" and "network" in wanted


def _decided_by(project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
    """What decides the surface, without its mesh."""
    if not _adjusts(project, wanted):
        return ("surface",) if project.network.angle == 90 else ("surface", "network.angle")
    limited = ("lamella", "joint", "materials") if project.network.limit is not None else ()
    return ("surface", "network", *limited)


def _found(up: Upstream, progress: Progress) -> tuple[Surface[Any], AdjustedTable | None]:
    """The surface, with its boundary adjusted where the project wants that."""
    project, table = up.project, up.project.surface
    if not _adjusts(project, up.wanted):
        return make_surface(project, up.folder, progress, up.memory), None
    from lamella.stages.surface.adjusted_table import adjust_table
    from lamella.stages.surface.strip_limit import strip_limit

    assert isinstance(table, FormFoundTable)
    adjusted = adjust_table(
        table,
        up.folder,
        cells=project.network.cells,
        spacing=project.network.spacing,
        pattern=pattern_of(project.network),
        limit=strip_limit(project),
        progress=progress,
    )
    return adjusted.surface, adjusted


def _adjusted_files(adjusted: AdjustedTable, up: Upstream) -> Iterator[File]:
    """The project with the boundary as it was adjusted, and the curves of that boundary that came from files."""
    from lamella.files.whole import write_whole
    from lamella.stages.surface.boundary_of_tables import boundary_loops, drawing_unit

    name = one_line(up.project.name)
    heading = f"# {name}, with the boundary as lamella {__version__} has adjusted it\n"
    own = up.project.model_copy(update={"surface": adjusted.table})
    yield File(
        "adjusted.toml",
        lambda path: write_whole(path, (heading + moved(own, up.folder, path.parent).to_toml()).encode()),
    )
    unit = drawing_unit(adjusted.table, up.folder)
    if unit:
        from lamella.files.write.curves_3dm import write_curves_3dm
        from lamella.files.write.rhino_file import Frame

        loops = boundary_loops(adjusted.table, up.folder)
        frame = Frame(unit, drawing_origin(adjusted.surface))
        signed: Any = {"name": up.project.name, "version": __version__}
        yield File("adjusted.3dm", lambda path: write_curves_3dm(path, loops, frame, **signed))

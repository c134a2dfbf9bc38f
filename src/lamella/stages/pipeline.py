"""The stages in order: compute, then write a folder that appears whole or not at all."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import partial
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import Origin, drawing_origin, reported_from, with_drawn_points
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, in_stage, silent
from lamella.base.result import Result, Shown
from lamella.base.wording import counted
from lamella.fabrication import Nesting, Parts, make_parts, nest
from lamella.fabrication.defaults import default_end_distance, default_hub_radius, default_slot_width
from lamella.fabrication.rules import Rules, clear_hub
from lamella.files.own import SCHEMA
from lamella.network.lattice.density import Density, choose_density
from lamella.network.lattice.trace import trace_closed_form
from lamella.network.network import Network
from lamella.network.streamlines.applicability import check_traced, is_traced
from lamella.project.read import located, read_project
from lamella.project.tables import FormFoundTable, Project
from lamella.stages import summary
from lamella.stages import warnings as cautions
from lamella.stages.clock import Clock
from lamella.stages.keys import keys, with_keys
from lamella.stages.other_cells import OtherCells
from lamella.stages.pattern_of_table import pattern_of, refuse_lines
from lamella.stages.surface_of_table import make_surface
from lamella.stages.unit_first import unit_first
from lamella.strip.lamellas import Lamellas, Section, make_lamellas
from lamella.strip.layer_curves import check_layer_curves
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface
from lamella.surface.umbilic import umbilic_reason

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from lamella.network.elements.element_network import ElementNetwork
    from lamella.network.streamlines.streamline_network import TracedNetwork
    from lamella.stages.adjusted_table import AdjustedTable

STAGES = ("surface", "network", "lamellas", "fabrication", "structure")
LAST_STAGE = "fabrication"


@dataclass(frozen=True, eq=False, repr=False)
class Results(Result):
    """Everything a run has computed; what was not asked for is None.

    Points are measured from `origin`, those of files and of the summary from the drawing's own.

    Attributes
    ----------
    project : Project
        With all defaults filled in.
    surface : Surface
    mesh : SurfaceMesh
        The surface sampled for files and pictures.
    network : Network or None
    lamellas : Lamellas or None
    parts : Parts or None
    nesting : Nesting or None
    summary : dict
        The content of summary.json, without the time spent on files.
    folder : Path
        Where the files the project names were looked for.
    adjusted : AdjustedTable or None
        The boundary as it was changed for a net that closes.

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project(
    ...     {"surface": {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}, "network": {"cells": 12}}
    ... )
    >>> results = lamella.compute(project)
    >>> results.network, results.parts
    (Network(12 cells: 24 lamellas, 144 nodes, 120 faces), Parts(24 parts, 48 pieces, 481.9 kg))
    """

    project: Project
    surface: Surface[Any]
    mesh: SurfaceMesh
    network: Network | None
    lamellas: Lamellas | None
    parts: Parts | None
    nesting: Nesting | None
    summary: dict[str, Any] = field(compare=False)
    folder: Path = field(default=Path(), compare=False)
    adjusted: AdjustedTable | None = None

    def _line(self) -> str:
        last = next(stage for stage in reversed(STAGES) if self.summary.get(stage) is not None)
        return f"{self.surface.kind}, up to {last}: {counted(len(self.summary['warnings']), 'warning')}"

    @property
    def _last(self) -> Shown:
        """What is shown of a run."""
        return self.lamellas or self.network or self.mesh

    def _repr_html_(self) -> str:
        return f"<div>{self._last._repr_html_()}<div><code>{escape(repr(self))}</code></div></div>"

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """The strips, the net or the surface, whichever the run came to, see `lamella.Shown.plot`."""
        return self._last.plot(ax, **options)

    @property
    def origin(self) -> Origin:
        """Point of the drawing that points are measured from, m; not 0 where it is in survey coordinates."""
        return drawing_origin(self.surface)


Planned = tuple[Surface[Any], "Density | None", "AdjustedTable | None"]
"""The surface, the density of the net where that is arithmetic, and the boundary where it was adjusted."""


def plan(
    project: Project, *, until: str | None = None, folder: Path = Path(), progress: Progress = silent
) -> tuple[Surface[Any], Density | None]:
    """The surface of a project and, where that is arithmetic, the density of its net.

    Whatever can be refused without a net is refused here. A closed form takes no time; other surfaces have to be found,
    and how far apart their lamellas are is known once their isothermic coordinates are (`lamella.stages.check`).

    Parameters
    ----------
    project, until, folder, progress
        See `compute`.

    Raises
    ------
    InputError
    """
    depth = _last_of(project, until)
    if depth:
        refuse_lines(project)
        _refuse_adjusting(project)
    surface = make_surface(project, folder, progress)
    _check_layers(project, surface, depth)
    if depth >= STAGES.index("fabrication"):
        _check_fabrication(fill_in(project, surface), _normal_curvature(project, surface))
    table = project.network
    with keys("network", surface="surface"):
        if depth and is_traced(surface, pattern_of(table)):
            check_traced(surface, pattern_of(table), table.closing)
            return surface, None
        if not isinstance(surface, ClosedForm):
            return surface, None
        return surface, choose_density(surface, cells=table.cells, spacing=table.spacing, pattern=pattern_of(table))


def _refuse_adjusting(project: Project) -> None:
    """Say where `closing = "adjust"` cannot work, before anything is looked for."""
    if project.network.closing != "adjust":
        return
    if project.surface.kind == "mesh":
        raise InputError(
            'closing = "adjust" changes boundary curves, and a mesh has none',
            'write closing = "open" or "round", or find the surface from curves (kind = "form-found")',
            "network.closing",
        )
    if isinstance(project.surface, FormFoundTable):
        from lamella.stages.adjusted_table import refuse_held_table

        refuse_held_table(project.surface)


def _planned(project: Project, until: str | None, folder: Path, progress: Progress) -> Planned:
    """`plan`, with the boundary adjusted where the project asks for it."""
    table = project.surface
    depth = _last_of(project, until)
    if not depth or project.network.closing != "adjust" or table.kind != "form-found":
        return *plan(project, until=until, folder=folder, progress=progress), None
    from lamella.stages.adjusted_table import adjust_table

    refuse_lines(project)
    _refuse_adjusting(project)
    adjusted = adjust_table(
        table,
        folder,
        cells=project.network.cells,
        spacing=project.network.spacing,
        pattern=pattern_of(project.network),
        progress=progress,
    )
    surface = adjusted.surface
    _check_layers(project, surface, depth)
    if depth >= STAGES.index("fabrication"):
        _check_fabrication(fill_in(project, surface), _normal_curvature(project, surface))
    return surface, None, adjusted


def fill_in(project: Project, surface: Surface[Any]) -> Project:
    """The project with those defaults filled in that follow from its other values."""
    cut, strip = project.fabrication, project.lamella
    slot_width = default_slot_width(strip.thickness) if cut.slot_width is None else cut.slot_width
    end_distance = cut.end_distance
    if end_distance is None:
        end_distance = default_end_distance(slot_width, _normal_curvature(project, surface), strip.height)
    hub_radius = cut.hub_radius
    # how far apart layers on lamella curves are next to a singular node, the net decides
    if hub_radius is None and (strip.layers == 1 or strip.layer_curves != "lamella"):
        rays = max((2 * (order + 2) for order in surface.singular_orders()), default=0)
        hub_radius = default_hub_radius(clear_hub(rays, strip.layers, strip.offset, strip.thickness))
    measures = {"slot_width": slot_width, "end_distance": float(end_distance), "hub_radius": hub_radius}
    filled = cut.model_copy(update=measures)
    update: dict[str, Any] = {"fabrication": filled}
    if any(drawing_origin(surface)):
        update["surface"] = project.surface.model_copy(update={"origin": drawing_origin(surface)})
    return project.model_copy(update=update)


@keys("lamella", section="lamella")
def _check_layers(project: Project, surface: Surface[Any], depth: int) -> None:
    """Refuse layers that the net's lamellas cannot have."""
    strip = project.lamella
    if depth >= STAGES.index("lamellas") and strip.layers > 1 and strip.layer_curves == "lamella":
        check_layer_curves(surface, pattern_of(project.network))


def _normal_curvature(project: Project, surface: Surface[Any]) -> float:
    """Of the lamellas, 1/m."""
    wanted = project.network.normal_curvature
    return surface.mean_curvature if wanted is None else wanted


@keys("fabrication", height="lamella.height")
def _check_fabrication(project: Project, curvature: float) -> None:
    """Refuse measures that no part can be made with, by the key in the project."""
    strip, cut = project.lamella, project.fabrication
    rules = Rules(
        layers=strip.layers,
        offset=strip.offset,
        height=strip.height,
        thickness=strip.thickness,
        curvature=float(curvature),
        density=project.material().density,
        **cut.model_copy(update={"hub_radius": cut.hub_radius or 0.0}).model_dump(),
    )
    rules.check()


def compute(
    project: Project, *, until: str | None = None, folder: str | Path = Path(), progress: Progress = silent
) -> Results:
    """Run the stages of a project up to `until`, in memory.

    Parameters
    ----------
    project : Project
    until : str, optional
        Last stage, one of `STAGES`; as far as this kind of surface goes when not given.
    folder : str or Path
        Where the files a project names are looked for: the folder of the project file.
    progress : callable
        Is told what is being done, a line at a time; details are indented by four spaces.

    Raises
    ------
    InputError

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project(
    ...     {"surface": {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}, "network": {"cells": 12}}
    ... )
    >>> results = lamella.compute(project, until="network")
    >>> results.network
    Network(12 cells: 24 lamellas, 144 nodes, 120 faces)
    """
    clock = Clock(progress)
    _last_of(project, until)
    clock.start("surface", project.surface.kind)
    return complete(
        project, _planned(project, until, Path(folder), clock.progress), clock, until=until, folder=Path(folder)
    )


def complete(
    project: Project, planned: Planned, clock: Clock, *, until: str | None, folder: Path, finer: float = 1.0
) -> Results:
    """The stages of a project whose surface is there, see `compute`; the clock runs for the surface already.

    Errors of the surface's elements are warned of as on a surface of a tolerance `finer` times smaller.
    """
    with reported_from(drawing_origin(planned[0])):
        return _complete(project, planned, clock, until=until, folder=folder, finer=finer)


def _complete(
    project: Project, planned: Planned, clock: Clock, *, until: str | None, folder: Path, finer: float
) -> Results:
    depth = _last_of(project, until)
    warnings: list[Message] = []
    if depth < STAGES.index("lamellas") and until is None:
        warnings.append(
            Message("ends_with_network", f"the run ends with the network: {pattern_of(project.network).no_strips}")
        )
    surface, density, adjusted = planned
    project = fill_in(project, surface)
    clock.progress(Report.detail("sampling the surface for files and pictures"))
    mesh = surface.mesh(project.files.mesh_tolerance)
    loops = summary.loop_summary(surface, getattr(project.surface, "boundary", ()))
    figures: dict[str, Any] = {"surface": summary.surface_summary(surface, mesh) | loops}
    clock.stop("surface", f"area {figures['surface']['area']:.4g} m2, H = {surface.mean_curvature:.6g} 1/m")
    warnings += [
        *(with_keys(warning, "surface.tolerance =", "surface.radius =") for warning in surface.warnings()),
        *cautions.size_cautions(mesh, project.lamella.height),
    ]
    warnings += cautions.surface_file_cautions(surface)

    if depth and until is None and not density:
        reason = umbilic_reason(surface.check_points())
        if reason:
            depth = 0
            warnings.append(
                Message(
                    "ends_with_surface", f"the run ends with the surface: it is {reason}, and has no net of lamellas"
                )
            )
    network = lamellas = parts = nesting = others = None
    reported: list[Message] = []
    woven: ElementNetwork | TracedNetwork | None = None
    if depth >= STAGES.index("network"):
        table = project.network
        if density:
            assert isinstance(surface, ClosedForm)
            clock.start("network", f"{density.requested}, about {density.estimated_nodes:,} nodes")
            with keys("network", surface="surface"):
                network = trace_closed_form(surface, density, minimum_length=table.minimum_length)
            figures["network"] = f = summary.network_summary(network, density.requested)
        else:
            # heavy, and closed forms do without
            from lamella.stages.weaving import MANNERS, lay, trace, weave

            traced = is_traced(surface, pattern_of(table))
            clock.start("network", MANNERS[traced])
            with unit_first(surface):
                if traced:
                    woven = trace(surface, project, clock.progress)
                else:
                    woven = weave(lay(surface, project, adjusted.step if adjusted else None, clock.progress), project)
            network = woven.network
            figures["network"] = f = summary.network_summary(network, woven.requested) | woven.describe()
            if adjusted:
                figures["network"]["adjustment"] = adjusted.figures
            reported = [with_keys(warning, "surface.tolerance") for warning in woven.warnings(finer)]
            warnings += reported
        others = OtherCells(project, surface, network, len(reported))
        clock.stop(
            "network",
            f"{network.cells} cells: {f['lamellas']} lamellas, {f['nodes']:,} nodes, cell edge "
            f"{f['cell_edge_min']:.3g} to {f['cell_edge_max']:.3g} m (median {f['cell_edge_median']:.3g} m)",
        )
        warnings += cautions.network_cautions(
            network,
            project.lamella.height,
            table.closing if density else "open",
            traced=is_traced(surface, pattern_of(table)),
            without=others.without,
        )
    if network and depth >= STAGES.index("lamellas"):
        strip = project.lamella
        clock.start("lamellas", f"{strip.height * 1000:g} x {strip.thickness * 1000:g} mm, {strip.material}")
        with keys("lamella", section="lamella", network="network"):
            section = Section(**strip.model_dump(exclude={"material"}))
            strips = partial(make_lamellas, section=section, material=project.material(), surface=surface)
            lamellas = strips(network)
        figures["lamellas"] = f = summary.lamella_summary(network, lamellas, strip.material, project.material())
        f |= woven.corner_stresses(lamellas.utilisation) if woven else {}
        clock.stop("lamellas", f"{f['total_length']:.4g} m of lamella, utilisation up to {f['utilisation_max']:.2f}")
        advice = None
        if woven:
            from lamella.stages.corner_search import corner_help

            advice = corner_help(
                woven, lamellas.utilisation, project, partial(make_surface, folder=folder), clock.progress
            )
        warnings += cautions.lamella_cautions(
            mesh,
            network,
            lamellas,
            project.fabrication.slot_width or 0.0,
            project.material(),
            project.known_materials(),
            lambda other, of: float(strips(network, section=other, material=of).utilisation.max()),
            advice,
        )
        warnings += cautions.layer_cautions(network, lamellas, project.material())
    if network and lamellas and others and depth >= STAGES.index("fabrication"):
        cut = project.fabrication
        clock.start("fabrication", "parts and sheets")
        with keys("fabrication", height="lamella.height"):
            parts = make_parts(
                network,
                lamellas,
                density=project.material().density,
                others=lambda fault: others.without(lambda net: fault(net, strips(net))),
                **cut.model_dump(),
            )
        nesting = nest(parts, sheet=cut.sheet, gap=cut.gap)
        figures["fabrication"] = f = summary.fabrication_summary(parts, nesting, figures["surface"]["area"])
        clock.stop("fabrication", f"{f['parts']:,} parts, {f['mass']:.4g} kg, {f['sheets']} sheets")
        told_keys = ("fabrication.end_distance", "fabrication.hub_radius")
        warnings += [with_keys(warning, *told_keys) for warning in parts.warnings]

    content: dict[str, Any] = {"schema": SCHEMA, "version": __version__, "name": project.name}
    content |= {stage: figures.get(stage) for stage in STAGES} | {"warnings": warnings, "seconds": clock.seconds}
    content = summary.cleaned(with_drawn_points(content, drawing_origin(surface)))
    return Results(project, surface, mesh, network, lamellas, parts, nesting, content, folder, adjusted)


def _last_of(project: Project, until: str | None) -> int:
    """Number of the last stage; of principal lines that is the network."""
    depth, last = _depth(LAST_STAGE if until is None else until), STAGES.index("network")
    if not pattern_of(project.network).no_strips or depth <= last:
        return depth
    if until is not None:
        raise InputError(
            f"stage {until!r} needs a net of lamellas: {pattern_of(project.network).no_strips}",
            'write --until network, or kind = "lamellas"',
            "network.kind",
        )
    return last


def _depth(until: str) -> int:
    if until not in STAGES:
        near = get_close_matches(until, STAGES, 1, 0.5)
        meant = f", did you mean {near[0]!r}?" if near else ""
        raise InputError(
            f"unknown stage {until[:40]!r}{meant}",
            f"choose one of {', '.join(STAGES[: STAGES.index(LAST_STAGE) + 1])}",
            "--until",
        )
    if STAGES.index(until) > STAGES.index(LAST_STAGE):
        raise InputError(
            f"stage {until!r} is not part of version {__version__} yet",
            f"leave --until out, or choose one of {', '.join(STAGES[: STAGES.index(LAST_STAGE) + 1])}",
            "--until",
        )
    return STAGES.index(until)


def run(
    project_file: str | Path,
    *,
    out: str | Path | None = None,
    until: str | None = None,
    progress: Progress = silent,
    warn: Callable[[str], None] | None = None,
) -> Path:
    r"""Run a project file and write its folder.

    Parameters
    ----------
    project_file : str or Path
    out : str or Path, optional
        Default ``out/<project file's stem>``.
    until : str, optional
        Last stage; as far as this kind of surface goes when not given.
    progress, warn : callable
        Are told what is being done, and every warning.

    Returns
    -------
    Path
        The folder written.

    Raises
    ------
    InputError
        What the user can mend; nothing has been written then.
    OSError
        The disk is full, for instance; an earlier folder is whole still.

    Examples
    --------
    >>> import lamella, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "roof.toml"
    ...     _ = file.write_text('[surface]\nkind = "catenoid"\nneck_radius = 2.5\nheight = [-2.0, 3.0]\n')
    ...     written = lamella.run(file, out=pathlib.Path(folder) / "roof", until="surface")
    ...     print((written / "summary.json").exists())
    True
    """
    from lamella.files.folder import check_target

    _depth(LAST_STAGE if until is None else until)
    project_file = Path(project_file)
    project = read_project(project_file)
    target = Path("out") / project_file.stem if out is None else Path(out)
    check_target(target)
    try:
        results = compute(project, until=until, folder=project_file.parent, progress=progress)
    except InputError as error:
        raise located(error, project_file) from None
    write(results, target, progress=progress)
    if warn:
        for message in results.summary["warnings"]:
            warn(message)
    return target


def write(results: Results, target: str | Path, *, progress: Progress = silent) -> None:
    """Write the folder of a run; it appears whole or not at all.

    Parameters
    ----------
    results : Results
    target : str or Path
        Made if it is not there; an earlier run's folder is replaced.
    progress : callable

    Examples
    --------
    >>> import lamella, pathlib, tempfile
    >>> project = lamella.parse_project({"surface": {"kind": "cylinder", "radius": 2.0, "height": [0.0, 3.0]}})
    >>> results = lamella.compute(project, until="surface")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     lamella.write(results, pathlib.Path(folder) / "roof")
    ...     print((pathlib.Path(folder) / "roof" / "summary.json").exists())
    True
    """
    from lamella.files.folder import staged_folder
    from lamella.files.own import write_summary
    from lamella.stages.output import write_files

    start, target = time.process_time(), Path(target)
    progress = in_stage(progress, "files")
    progress(Report.heading(f"writing {target}"))
    with staged_folder(target) as folder:
        write_files(results, folder, progress=progress)
        seconds = results.summary["seconds"] | {"files": round(time.process_time() - start, 4)}
        write_summary(folder, results.summary | {"seconds": seconds})


__all__ = ["STAGES", "Results", "compute", "plan", "run", "write"]

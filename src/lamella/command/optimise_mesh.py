"""A quad mesh from a file, optimised as asked: what `lamella optimise` does, less its printing."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast, get_args

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.wording import counted
from lamella.command.optimise_options import Options
from lamella.files.quad_mesh_files import QuadFile
from lamella.projection.foot_points import foot_surface
from lamella.projection.optimised import Optimised
from lamella.projection.polylines import diagonal_ring, polylines
from lamella.projection.problems.crossing import AngleForm
from lamella.projection.problems.deform import deform
from lamella.projection.problems.planar_strips import planar_strips
from lamella.projection.problems.sphere_stars import sphere_stars
from lamella.projection.problems.straighten import straighten
from lamella.projection.quad_mesh import QuadMesh, quad_mesh
from lamella.projection.report import Iteration
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface
from lamella.surface.umbilic import refuse_umbilic

# what the solutions of a problem with several are called
STAGES = {"deform": "state", "planar": "round"}
# root mean square of the moves, in edges, from which a mesh is not the one it was
FAR = 0.25
# largest residual on a surface that was found: its own directions are off by more
FOUND = 1e-6
# points a strip needs at least
STRIP_POINTS = 4


def reported_mesh(mesh: QuadMesh) -> str:
    """The same in a line."""
    singular = [f"{k} (valence {mesh.valence[k]})" for k in mesh.singular[:6]]
    more = f" and {len(mesh.singular) - 6} more" if len(mesh.singular) > 6 else ""
    return (
        f"{counted(len(mesh.vertices), 'vertex', 'vertices')}, {counted(len(mesh.faces), 'quad')}, mean edge "
        f"{mesh.mean_edge:.4g} m, {int(mesh.on_boundary.sum())} vertices on the boundary; "
        + (f"singular vertices {', '.join(singular)}{more}" if singular else "no singular vertices")
    )


def optimise(given: QuadFile, problem: str, options: Options, *, progress: Progress = silent) -> Optimised:
    """Optimise a mesh.

    Parameters
    ----------
    given : QuadFile
    problem : str
        A key of `lamella.command.optimise_options.USED`.
    options : Options
        Those that are not None have to be of use to the problem.
    progress : callable
        Receives each iteration.

    Raises
    ------
    InputError
        A wish that is missing, of no use or out of range, and what the problem refuses.
    """
    options.check(problem)
    mesh, count = given.mesh, 0

    def on_iteration(state: Iteration) -> None:
        nonlocal count
        if not count:
            progress(
                Report.heading("iteration: root mean square residual by constraint, in edges or radians; step, damping")
            )
        count += state.number == 0
        if state.number == 0 and (count > 1 or problem in STAGES):
            progress(
                Report.heading(
                    f"{STAGES.get(problem, 'with the radius found')} {count if problem in STAGES else ''}".rstrip()
                )
            )
        progress(Report.step(str(state)))

    common: dict[str, Any] = {"on_iteration": on_iteration}
    for name in ("iterations", "tolerance"):
        if getattr(options, name) is not None:
            common[name] = getattr(options, name)
    match problem:
        case "straighten":
            return _straighten(given, options, common, progress)
        case "deform":
            return _deform(mesh, options, common)
        case "planar":
            return _planar(given, options, common, progress)
    return _stars(mesh, problem, options, common)


def _stars(mesh: QuadMesh, problem: str, options: Options, common: dict[str, Any]) -> Optimised:
    if options.form is not None and options.form not in get_args(AngleForm):
        raise InputError(f"--form {options.form} is not known", f"one of {', '.join(get_args(AngleForm))}")
    net = sphere_stars(
        mesh,
        radius=np.inf if problem == "asymptotic" else options.radius,
        angle=90.0 if options.angle is None else options.angle,
        form=cast(AngleForm, options.form or "circles"),
        **common,
    )
    found = problem != "asymptotic" and options.radius is None
    reported: dict[str, Any] = {"radius": float(net.radius) if np.isfinite(net.radius) else None, "radius_found": found}
    remarks: tuple[str, ...] = (_reported_moves(mesh, net.mesh),)
    if found:
        reported["radius_uncertainty"] = float(net.radius_uncertainty)  # infinite: null
        reported["ill_determined"] = bool(net.ill_determined)
        known = np.isfinite(net.radius_uncertainty)
        doubt = f"standard deviation {net.radius_uncertainty:.2g} m" if known else "no limit to its uncertainty"
        remarks += (f"radius found: {net.radius:.6g} m, {doubt}",)
        if net.ill_determined:
            remarks += ("the net says too little about the radius: others would do as well; give it with --radius",)
    return Optimised(net.mesh, (net.solution,), reported=reported, remarks=remarks)


def _reported_moves(before: QuadMesh, after: QuadMesh) -> str:
    """How far vertices have gone, in a line; with a caution where that is another mesh."""
    moved = np.linalg.norm(after.vertices - before.vertices, axis=1)
    mean, edge = float(np.sqrt((moved**2).mean())), before.mean_edge
    line = (
        f"vertices moved by {mean:.3g} m root mean square, {moved.max():.3g} m at most ({moved.max() / edge:.2g} edges)"
    )
    far = mean > FAR * edge
    return line + ": the mesh was no such net by far, look whether the result still is your design" if far else line


def _straighten(given: QuadFile, options: Options, common: dict[str, Any], progress: Progress) -> Optimised:
    surface = _surface(given, options, progress)
    refuse_umbilic(surface)
    _require_near(given.mesh, surface, options)
    if not isinstance(surface, ClosedForm):
        common.setdefault("tolerance", FOUND)
    found = straighten(given.mesh, foot_surface(cast(Any, surface)), **common)
    return Optimised(
        found.isothermic,
        (found.solution,),
        lamellas=found.lamellas,
        remarks=(
            "closeness, directions and squares are 4 conditions on 3 coordinates of a vertex: a remainder of the "
            "square of the edge stays where the surface has no symmetry",
        )
        if found.solution.verdict in ("settled", "stagnated")
        else (),
    )


def _deform(mesh: QuadMesh, options: Options, common: dict[str, Any]) -> Optimised:
    assert options.driver is not None
    vertices, share = options.driver
    ring = diagonal_ring(mesh, vertices[0]) if len(vertices) == 1 else np.array(vertices, np.int64)
    states = deform(mesh, ring, share, radius=options.radius, closed=not options.open_driver, **common)
    reported = {
        "ring": ring.tolist(),
        "states": [
            {
                "share": state.share,
                "verdict": state.solution.verdict,
                "residual": state.solution.last.residual,
                "angle_change": {
                    "least": float(state.angle_change.min()),
                    "mean": float(state.angle_change.mean()),
                    "largest": float(state.angle_change.max()),
                },
            }
            for state in states
        ],
    }
    last = states[-1]
    remarks = [
        f"ring of {len(ring)} vertices at {last.share:.4g} of its size in {len(states) - 1} steps; angles changed by "
        f"{last.angle_change.min():.3g} to {last.angle_change.max():.3g} degrees"
    ]
    if abs(last.share - share) > 1e-9:
        remarks.append(f"the way to {share:.4g} ended there: {last.solution.verdict}")
    if not last.solution.solved:
        remarks.append(
            "edge lengths and stars of given radius are 4 conditions on 3 coordinates of a vertex: only symmetric "
            "nets keep both, here the remainder is shared out"
        )
    return Optimised(last.mesh, tuple(state.solution for state in states), reported=reported, remarks=tuple(remarks))


def _planar(given: QuadFile, options: Options, common: dict[str, Any], progress: Progress) -> Optimised:
    assert options.height is not None
    lines = polylines(given.mesh)
    long = [line for line in lines if len(line) >= STRIP_POINTS]
    if not long:
        longest = max((len(line) for line in lines), default=0)
        raise InputError(
            f"no polyline has {STRIP_POINTS} vertices, the longest has {longest}",
            f"give a mesh with at least {STRIP_POINTS - 1} quads in a row",
        )
    if options.rounds is not None:
        common["rounds"] = options.rounds
    surface = _surface(given, options, progress)
    _require_near(given.mesh, surface, options)
    if not isinstance(surface, ClosedForm):
        common.setdefault("tolerance", FOUND)
    strips = planar_strips(
        [given.mesh.vertices[line] for line in long], foot_surface(cast(Any, surface)), options.height, **common
    )
    figures = strips.figures()
    remarks = [
        f"{len(long)} strips; planarity score median {figures['median_before']:.2g} -> {figures['median_after']:.2g}, "
        f"share of 0.005 and above {figures['red_before']:.0%} -> {figures['red_after']:.0%}",
        f"at most: lower borders left their curves by {1000 * figures['largest_shift']:.3g} mm, rulings lean sideways "
        f"by {figures['largest_tilt']:.2g} degrees and turn by {figures['largest_turn']:.3g} from one to the next",
    ]
    if len(long) < len(lines):
        remarks.append(f"{counted(len(lines) - len(long), 'polyline')} of fewer than four vertices left out")
    if figures["not_developable"]:
        remarks.append(
            f"no developable strip of this height exists at {figures['not_developable']:.0%} of the vertices: planar "
            "quads bridge them by moving the border and turning the rulings; take twisted strips there, or less height"
        )
    mesh, strip = strip_mesh(strips.lower, strips.upper)
    reported = {
        "figures": figures,
        "strips": [
            {"vertices": line.tolist(), "buildable_height": height.tolist()}
            for line, height in zip(long, strips.buildable, strict=True)
        ],
    }
    faces = {"planarity_before": np.concatenate(strips.before), "strip": strip}
    return Optimised(mesh, strips.solutions, same=False, reported=reported, remarks=tuple(remarks), faces=faces)


def strip_mesh(lowers: Sequence[Floats], uppers: Sequence[Floats]) -> tuple[QuadMesh, Floats]:
    """Strips as one mesh, lower border before upper border, strip after strip; and the strip of each face, (f,)."""
    points, faces, strip, start = [], [], [], 0
    for number, (lower, upper) in enumerate(zip(lowers, uppers, strict=True)):
        count = len(lower)
        k = start + np.arange(count - 1)
        faces.append(np.column_stack([k, k + 1, k + 1 + count, k + count]))
        points += [lower, upper]
        strip.append(np.full(count - 1, number, np.float64))
        start += 2 * count
    return quad_mesh(np.concatenate(points), np.concatenate(faces)), np.concatenate(strip)


def _require_near(mesh: QuadMesh, surface: Surface[Any], options: Options) -> None:
    """Refuse a surface that is somewhere else: the mesh was drawn on it, but for what reaches beyond its rim."""
    foot = foot_surface(cast(Any, surface)).foot(mesh.vertices)
    away = np.linalg.norm(mesh.vertices - foot.position, axis=1)
    if np.median(away) > mesh.mean_edge:
        raise InputError(
            f"half of the vertices are more than {np.median(away):.3g} m from the surface, a mean edge is "
            f"{mesh.mean_edge:.3g} m",
            f"is {options.surface} the surface of this mesh, and --unit right?",
        )


def _surface(given: QuadFile, options: Options, progress: Progress) -> Surface[Any]:
    """That of a project, or the surface of constant mean curvature the mesh itself means."""
    from lamella.project.read import located, read_project
    from lamella.stages.surface.surface_of_table import make_surface
    from lamella.surface.from_mesh.fit_cmc import fit_cmc

    if options.surface is not None:
        project = read_project(options.surface)
        try:
            return make_surface(project, options.surface.parent, progress)
        except InputError as error:
            raise located(error, options.surface) from None
    progress(
        Report.heading("no --surface: looking for the surface of constant mean curvature that the mesh itself means")
    )
    try:
        return fit_cmc(given.mesh.vertices, given.mesh.faces, progress=progress)
    except InputError as error:
        raise InputError(
            f"no surface of constant mean curvature fits the mesh: {error.message}",
            "name a project with the surface: --surface PROJECT.toml",
        ) from None

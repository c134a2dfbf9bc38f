"""`lamella optimise`: its options, its files, what it prints. Heavy parts are imported when it runs."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.errors import InputError
from lamella.base.progress import Progress, silent
from lamella.base.wording import one_line, readable
from lamella.command.optimise_options import USED, Options, driver_of
from lamella.command.screen import Screen
from lamella.files.ours import is_ours

if TYPE_CHECKING:
    from lamella.base.arrays import Floats
    from lamella.files.quad_mesh_files import QuadFile
    from lamella.projection.mesh_figures import MeshFigures
    from lamella.projection.optimised import Optimised
    from lamella.projection.quad_mesh import QuadMesh
    from lamella.projection.report import Solution

DRIVEN = "#d60000"
# iterations to judge progress by, and what of the remainder a hopeful run leaves in them
LATELY, SLOW_SECONDS = 10, 0.5
NOT_SOLVED = 1
"""Exit code of a result that is written although not all conditions hold."""

_ABOUT = """\
Move the vertices of a quad mesh as little as needed until it is what was asked for. Edges of the mesh
are the lamellas, vertices the nodes.

problems, and the options they use:
  asymptotic    planar vertex stars, right angles: straight lamellas, H = 0     [--angle] [--form]
  sphere-stars  stars on spheres of one radius, right angles: circular lamellas [--radius] [--angle] [--form]
                Without --radius the radius is found, with its uncertainty; H = 1 / radius.
  angle         the same with another node angle: linear Weingarten surfaces    --angle [--radius] [--form]
                --radius inf: straight lamellas.
  straighten    principal mesh -> isothermic mesh (FILE) -> its edge middles, a net of lamellas
                (FILE with -lamellas behind its name)                           [--surface]
  deform        drive the size of a ring, keep edge lengths and stars           --driver [--open-driver] [--radius]
  planar        upright strips of planar quads along all polylines              --height [--surface] [--rounds]

examples:
  lamella optimise net.obj --as asymptotic --out straight.obj
  lamella optimise net.ply --as sphere-stars --radius 2 --out round.ply --json round.json
  lamella optimise net.json --as angle --angle 80 --radius inf --out eighty.json
  lamella optimise net.3dm --as deform --driver 42=0.9 --out narrower.3dm
  lamella optimise net.obj --unit mm --as planar --height 0.1 --surface vault.toml --out strips.ply

Radius and height are metres whatever the unit of the file; FILE has the unit of MESH. Vertices are counted
from 0. Formats in and out: .obj, .ply, .3dm, .json of COMPAS. All carry figures of vertices and faces: as comments,
as properties with colours, as user text with colours, as attributes.

exit codes: 0 all conditions hold; 1 written, but not all conditions hold (the message says which; FIGURES has
the remainder); 2 refused, nothing written."""


def add_optimise(commands: Any) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "optimise",
        help="optimise a quad mesh: straight or circular lamellas, planar strips, deformation",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description=_ABOUT,
    )
    parser.add_argument("mesh", type=Path, metavar="MESH", help="quad mesh: .obj, .ply, .3dm or COMPAS .json")
    parser.add_argument("--as", dest="problem", required=True, metavar="PROBLEM", help=f"one of {', '.join(USED)}")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="file to write; its ending says how")
    parser.add_argument("--json", type=Path, metavar="FIGURES", help="JSON file with iterations and all figures")
    parser.add_argument("--picture", type=Path, metavar="PNG", help="picture of the mesh before and after")
    parser.add_argument(
        "--colour",
        default=None,
        help="of .ply, .3dm and picture: planarity, sphericity, radius or angle (default: sphericity; "
        "planarity for planar)",
    )
    parser.add_argument(
        "--unit", help="unit of MESH: mm, cm, dm, m, km, in, ft or yd (default: m; a .3dm says its own)"
    )
    parser.add_argument("--radius", type=float, metavar="R", help="of the stars' spheres, m; inf: planes")
    parser.add_argument("--angle", type=float, metavar="A", help="between polylines, degrees (default: 90)")
    parser.add_argument(
        "--form",
        help="where angles are measured: circles (through a vertex and its neighbours, the default), chords, "
        "faces (right angles only)",
    )
    parser.add_argument(
        "--driver",
        metavar="V[,V...]=SHARE",
        help="ring to drive and its size at the end: a vertex of it (it runs from corner to corner of quads), or all "
        "its vertices in order; 42=0.9 shrinks it by 10 %%",
    )
    parser.add_argument("--open-driver", action="store_true", default=None, help="the ring listed is open")
    parser.add_argument("--height", type=float, metavar="H", help="of strips, m; below 0: to the other side")
    parser.add_argument(
        "--surface",
        type=Path,
        metavar="TOML",
        help="project file with the reference surface, best larger than the mesh (default: the surface of constant "
        "mean curvature that the mesh itself means)",
    )
    parser.add_argument("--rounds", type=int, metavar="N", help="of subdivision of strips (default: 2)")
    parser.add_argument(
        "--iterations",
        type=int,
        metavar="N",
        help="most steps of a solution (default: 100; 50 a state for deform, 20 a round for planar)",
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        metavar="T",
        help="largest root mean square residual of a condition "
        "that holds, in edges or radians (default: 1e-10; for straighten and planar 1e-8, and 1e-6 on surfaces that "
        "were found, whose directions are not known better)",
    )
    parser.add_argument("--quiet", action="store_true", help="print nothing but what went wrong")


def run_optimise(arguments: argparse.Namespace) -> int:
    """Do it; 0, or 1 where not all conditions hold."""
    options = Options(
        radius=arguments.radius,
        angle=arguments.angle,
        form=arguments.form,
        driver=driver_of(arguments.driver) if arguments.driver is not None else None,
        open_driver=arguments.open_driver,
        surface=arguments.surface,
        height=arguments.height,
        rounds=arguments.rounds,
        iterations=arguments.iterations,
        tolerance=arguments.tolerance,
    )
    options.check(arguments.problem)
    _check_targets(arguments)

    from lamella.command.optimise_mesh import optimise, reported_mesh
    from lamella.files.quad_mesh_files import read_quad_mesh, require_format
    from lamella.files.whole import write_all_whole
    from lamella.projection.mesh_figures import mesh_figures

    def say(line: str) -> None:
        if not arguments.quiet:
            print(readable(line), file=sys.stderr, flush=True)

    progress: Progress = silent if arguments.quiet else Screen(verbose=False)
    require_format(arguments.out)
    given = read_quad_mesh(arguments.mesh, arguments.unit)
    say(f"{arguments.mesh}: {reported_mesh(given.mesh)}")
    for note in given.notes:
        say(f"  {note}")
    result = optimise(given, arguments.problem, options, progress=progress)
    figures = mesh_figures(result.mesh, given.mesh if result.same else None)
    figures = replace(figures, faces={**figures.faces, **result.faces})
    files = _files(arguments, given, result, figures)
    if arguments.picture is not None:
        files[arguments.picture] = _picture(arguments, given, result)
    # hours may lie between: what came meanwhile is not replaced either
    _check_targets(arguments)
    write_all_whole(files)
    last = result.solutions[-1]
    for remark in result.remarks:
        say(remark)
    if not result.solved:
        print(readable(_not_solved(last)), file=sys.stderr, flush=True)
    if not arguments.quiet:
        print(readable(f"{last.verdict}; wrote " + ", ".join(str(path) for path in files)))
    return 0 if result.solved else NOT_SOLVED


def _not_solved(solution: Solution) -> str:
    state = solution.last
    missing = ", ".join(
        f"{name} by {state.residual[name]:.2g} (largest {state.largest[name]:.2g})" for name in solution.unmet
    )
    what = f"not met, in edges or radians: {missing}" if missing else "the steps had not ended"
    if solution.verdict == "collapsed":
        what = "edges have lost their length"
    if solution.verdict == "left the surface":
        what = "vertices have gone over the border of the surface, where only its tangent planes go on"
    share = fallen(solution)
    used_up = (
        "allow more with --iterations"
        if share < SLOW_SECONDS
        else "ask for less, or start from a fairer mesh nearer by"
    )
    remedy = {
        "iterations used up": f"{used_up}: the last {min(LATELY, state.number)} brought the remainder down to "
        f"{share:.2g} of what it was",
        "broken off": "start from a fairer mesh, without folds and flattened faces",
        "left the surface": "give a larger surface with --surface, or a mesh whose faces are more nearly square",
        "collapsed": "there is no such net near this mesh: take another radius, angle, --form or surface",
    }.get(solution.verdict, "ask for less, or take this, the least remainder nearby; --tolerance says what is met")
    return f"not all conditions hold: {solution.verdict} after {state.number} iterations; {what}\n  remedy: {remedy}"


def fallen(solution: Solution) -> float:
    """What the last few iterations left of the remainder."""
    before, now = solution.iterations[-1 - LATELY :][0], solution.last
    return float((now.objective / before.objective) ** 0.5) if before.objective > 0 else 0.0


def _check_targets(arguments: argparse.Namespace) -> None:
    """Refuse targets before anything is computed."""
    given = [arguments.mesh, *([arguments.surface] if arguments.surface is not None else [])]
    taken = {path.resolve() for path in given}
    for option, path in _targets(arguments):
        if not path.parent.is_dir():
            raise InputError(f"{path.parent}: no such folder", f"make it first, or name another file with --{option}")
        if path.is_dir():
            raise InputError(f"--{option} {path} is a folder", "name a file")
        if path.resolve() in taken or any(path.exists() and path.samefile(one) for one in given if one.exists()):
            raise InputError(f"--{option} {path} is in use already", "name another file: what is given stays")
        if not is_ours(path):
            raise InputError(
                f"--{option} {path} is there already and was not written by lamella",
                "name another file, or move it away",
            )
        taken.add(path.resolve())
    if arguments.colour is not None and arguments.colour not in ("planarity", "sphericity", "radius", "angle"):
        raise InputError(f"--colour {arguments.colour} is not known", "planarity, sphericity, radius or angle")
    if arguments.picture is not None:
        if arguments.picture.suffix.lower() != ".png":
            raise InputError(
                f"--picture {arguments.picture.name} is no .png", "name a .png: other formats are not drawn"
            )
        from lamella.view.figure import require_matplotlib

        require_matplotlib()


def _targets(arguments: argparse.Namespace) -> list[tuple[str, Path]]:
    """Files to be written, each with the option it follows from."""
    found = [(option, getattr(arguments, option)) for option in ("out", "json", "picture")]
    if arguments.problem == "straighten":
        found.insert(1, ("out", _lamellas_file(arguments.out)))
    return [(option, path) for option, path in found if path is not None]


def _lamellas_file(out: Path) -> Path:
    return out.with_name(f"{out.stem}-lamellas{out.suffix}")


def _colour(arguments: argparse.Namespace) -> Any:
    return arguments.colour or ("planarity" if arguments.problem == "planar" else "sphericity")


def _files(
    arguments: argparse.Namespace, given: QuadFile, result: Optimised, figures: MeshFigures
) -> dict[Path, bytes]:
    """Bytes of all files but the picture."""
    from lamella.files.quad_mesh_files import quad_mesh_bytes
    from lamella.files.write.optimise_json import optimise_bytes
    from lamella.projection.mesh_figures import mesh_figures
    from lamella.view.net_colours import net_colours

    out: Path = arguments.out
    name = f"{one_line(arguments.mesh.name)} as {arguments.problem}"
    colours = net_colours(result.mesh, figures, _colour(arguments))
    common: dict[str, Any] = {"like": given, "name": name, "version": __version__}
    files = {out: quad_mesh_bytes(out.suffix, result.mesh, figures, colours={colours.on: colours.rgb}, **common)}
    if result.lamellas is not None:
        own = mesh_figures(result.lamellas)
        target = _lamellas_file(out)
        files[target] = quad_mesh_bytes(out.suffix, result.lamellas, own, **common)
    if arguments.json is not None:
        about = optimise_bytes(result, figures, given, problem=arguments.problem, file=one_line(arguments.mesh.name))
        files[arguments.json] = about
    return files


def _picture(arguments: argparse.Namespace, given: QuadFile, result: Optimised) -> bytes:
    import tempfile

    from lamella.files.ours import signed_png
    from lamella.view.net_picture import NetPanel, draw_nets

    colour = _colour(arguments)
    ring = result.reported.get("ring", [])
    if ring and not arguments.open_driver:
        ring = [*ring, ring[0]]

    def driven(mesh: QuadMesh) -> tuple[tuple[Floats, str], ...]:
        return ((mesh.vertices[ring], DRIVEN),) if ring else ()

    after = NetPanel("after", result.mesh, colour, driven(result.mesh), "all" if result.same else "boundary")
    # strips are no other state of the mesh they follow
    title, own = ("before", colour) if result.same else ("polylines", None)
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        draw_nets([NetPanel(title, given.mesh, own, driven(given.mesh)), after], picture)
        return signed_png(picture.read_bytes())

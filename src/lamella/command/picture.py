"""`lamella picture`: a picture of a project or of a run, without a screen. Heavy parts are imported when it runs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamella.base.errors import InputError
from lamella.base.progress import silent
from lamella.base.wording import readable
from lamella.command.screen import Screen

if TYPE_CHECKING:
    from lamella.base.progress import Progress
    from lamella.project.tables import Project
    from lamella.stages.results import Results
    from lamella.stages.stage import Stage

BUILT = "fabrication"
"""Stage whose output is what is built: no later one changes what a picture shows."""

_ABOUT = """\
Draw a project, or the project of a run's folder, as a PNG file: strips at their thickness with all layers,
hardware, ground and a person, 1.75 m tall. No screen and no browser is needed; the same project and
version give the same bytes.

examples:
  lamella picture roof.toml
  lamella picture out/roof --view eye --size 1600x1000 --out roof.png
  lamella picture roof.toml --view=-120,15 --colour utilisation
  lamella picture roof.toml --frames erection:10
"""


def add_picture(commands: Any) -> None:
    """Add the command with its options."""
    parser = commands.add_parser(
        "picture",
        help="draw a project or a run as a PNG file, without a screen",
        description=_ABOUT,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("project", type=Path, help="project file (.toml), or the folder of a run")
    parser.add_argument(
        "--view",
        default="iso",
        help="iso (default), top, front, back, side, left, eye (from where a person stands), or azimuth,elevation in "
        "degrees",
    )
    parser.add_argument("--size", default="1600x1000", metavar="WxH", help="pixels (default: 1600x1000)")
    parser.add_argument("--out", type=Path, metavar="FILE", help="file to write (default: <project file's stem>.png)")
    parser.add_argument(
        "--colour",
        default="",
        metavar="KEY",
        help='what strips are coloured by: utilisation, mises, layers, twist, geodesic, planarity, "family" (default: '
        "as their material looks)",
    )
    parser.add_argument("--surface", action="store_true", help="show the surface too")
    parser.add_argument(
        "--frames",
        default="",
        metavar="NAME:K",
        help="frame K (from 0, -1 is the last) of what the report's slider shows: erection:0 is the flat state",
    )
    parser.add_argument("--until", metavar="STAGE", help="last stage that is computed (default: what is built)")
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")


def run_picture(arguments: argparse.Namespace) -> None:
    """Draw it, and tell where the file is."""
    from lamella.base.drawing_origin import reported_from
    from lamella.files.whole import write_whole
    from lamella.project.read import located, read_project
    from lamella.stages.scene import scene_of
    from lamella.stages.shown_names import check_colour, check_slider
    from lamella.view.render.png import png_bytes
    from lamella.view.render.render import refuse_size, render
    from lamella.view.render.soup import shown_layers
    from lamella.view.render.standpoint import direction_of
    from lamella.view.scene.still import at_frame
    from lamella.view.surroundings import standing

    size = size_of(arguments.size)
    # before anything is computed
    refuse_size(size)
    direction_of(arguments.view)
    name, frame = frame_of(arguments.frames)
    file = project_file(arguments.project)
    target = arguments.out or Path(f"{arguments.project.stem if file != arguments.project else file.stem}.png")
    if target.suffix.lower() not in ("", ".png"):
        raise InputError(f"{target}: pictures are PNG files", f"name it {target.with_suffix('.png').name}", "--out")
    if not target.parent.is_dir():
        raise InputError(f"{target.parent}: no such folder", "make it first, or name another file with --out")
    project = read_project(file)
    screen = Screen(verbose=False)
    try:
        progress = silent if arguments.quiet else screen
        wanted = _wanted(project, arguments.until, whole=bool(name))
        check_slider(project, name, wanted)
        check_colour(arguments.colour, wanted)
        results = _computed(project, wanted, file.parent, progress, ends=arguments.until is None)
    except InputError as error:
        raise located(error, file) from None
    finally:
        screen.clear()
    with reported_from(results.origin):
        scene = scene_of(results, still=True)
        if name:
            moved = at_frame(scene, name, frame)
            scene = standing(moved, shown_layers(moved, surface=arguments.surface))
        pixels = render(
            scene,
            view=arguments.view,
            size=size,
            colour="layer" if arguments.colour == "family" else arguments.colour,
            surface=arguments.surface,
        )
    write_whole(target, png_bytes(pixels))
    if not arguments.quiet:
        for remark in scene.remarks:
            print(readable(remark))
        print(readable(f"picture: {target}"))


def size_of(text: str) -> tuple[int, int]:
    """Width and height of "1600x1000".

    Raises
    ------
    InputError
    """
    parts = text.lower().split("x")
    if len(parts) != 2 or not all(part.isascii() and part.isdigit() for part in parts):
        raise InputError(f"size {text!r}", "write width and height in pixels: 1600x1000", "--size")
    return int(parts[0]), int(parts[1])


def frame_of(text: str) -> tuple[str, int]:
    """Name and number of "erection:0"; the name alone stands for the first frame.

    Raises
    ------
    InputError
    """
    name, _, number = text.partition(":")
    try:
        return name, int(number or 0)
    except ValueError:
        raise InputError(f"frame {number!r}", "write a whole number: erection:0", "--frames") from None


def project_file(given: Path) -> Path:
    """The project file itself, or that of a run's folder.

    Raises
    ------
    InputError
        A folder that no run has written.
    """
    if not given.is_dir():
        return given
    file = given / "project.toml"
    if not file.is_file():
        raise InputError(f"{given} holds no project.toml", "name a project file, or the folder of a run")
    return file


def _wanted(project: Project, until: str | None, *, whole: bool) -> tuple[Stage[Any], ...]:
    """Stages of a project as far as it comes, but no farther than what is built where not the whole is wanted."""
    from lamella.stages.wanted import wanted_stages

    wanted, _ = wanted_stages(project, until)
    names = [stage.name for stage in wanted]
    if until is None and not whole and BUILT in names:
        return wanted[: names.index(BUILT) + 1]
    return wanted


def _computed(
    project: Project, wanted: tuple[Stage[Any], ...], folder: Path, progress: Progress, *, ends: bool
) -> Results:
    from lamella.stages.clock import Clock
    from lamella.stages.computation import Computation
    from lamella.stages.memory import Memory

    computation = Computation(project, wanted, folder, Memory(), Clock(progress))
    computation.run_all(wanted, ends=ends)
    return computation.results()

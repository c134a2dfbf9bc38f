"""The command line. Heavy parts are imported by the command that needs them: --help is instant."""

from __future__ import annotations

import argparse
import contextlib
import errno
import io
import os
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import FrameType
from typing import NoReturn

from lamella import __version__
from lamella.base.errors import InputError
from lamella.base.progress import silent
from lamella.base.wording import readable
from lamella.command.optimise import add_optimise, run_optimise
from lamella.command.picture import add_picture, run_picture
from lamella.command.screen import Screen
from lamella.command.studio import add_studio, run_studio
from lamella.command.study import add_study, run_study

_ABOUT = """\
lamella takes a designer from a surface of constant mean curvature to the net of lamellas on it,
the flat strips with every slot marked, the drawings for the laser and the stresses that bending and
twisting leave in the strips.

  lamella new unduloid            write a commented starter project, unduloid.toml
  lamella new form-found          the same for a film between boundary curves of your own
  lamella run unduloid.toml       compute it and write the folder out/unduloid
  lamella check unduloid.toml     only look for mistakes
  lamella study variants.toml     compute many variants of a project, and find the best
  lamella picture unduloid.toml   draw it as a PNG file, without a screen
  lamella studio unduloid.toml    design it on a page in the browser
  lamella optimise net.obj ...    make a net of a quad mesh from elsewhere

Open out/unduloid/report.html in a browser, model.3dm in Rhino, fabrication/*.dxf at the laser."""


# of OpenBLAS, MKL, BLIS and Apple's Accelerate
_BLAS_THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")


class _Parser(argparse.ArgumentParser):
    """Mistakes in the arguments read like all others: what, and the remedy.

    Attributes
    ----------
    describe : callable or None
        Makes the description when help is asked for: it may need heavy parts.
    """

    describe: Callable[[], str] | None = None

    def format_help(self) -> str:
        if self.describe:
            self.description = self.describe()
        return super().format_help()

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message}\n  remedy: see {self.prog} --help\n")


def _run_description() -> str:
    from lamella.stages import all_stages

    def files(writes: tuple[tuple[str, str], ...]) -> str:
        return "".join(f"    {names:40s} {meaning}\n" for names, meaning in writes)

    stages = "".join(
        f"  {stage.name}{', after ' + stage.needs[-1] if stage.needs else ''}\n{files(stage.writes)}"
        for stage in all_stages.STAGES
    )
    return (
        "Compute a project and write its folder, whole or not at all.\n\n"
        f"every run writes\n{files(all_stages.WRITES)}\nstages, and what each adds:\n{stages}"
    )


def _parser() -> argparse.ArgumentParser:
    plain = argparse.RawDescriptionHelpFormatter
    parser = _Parser(prog="lamella", description=_ABOUT, formatter_class=plain)
    parser.add_argument("--version", action="version", version=f"lamella {__version__}")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND")

    run = commands.add_parser(
        "run",
        help="compute a project and write its folder",
        formatter_class=plain,
    )
    run.describe = _run_description
    run.add_argument("project", type=Path, help="project file (.toml); see `lamella new`")
    run.add_argument("--out", type=Path, metavar="DIR", help="folder to write (default: out/<project file's stem>)")
    run.add_argument("--until", metavar="STAGE", help="last stage (default: as far as this kind of surface goes)")
    loudness = run.add_mutually_exclusive_group()
    loudness.add_argument("--quiet", action="store_true", help="print nothing but warnings and errors")
    _add_verbose(loudness)

    new = commands.add_parser("new", help="write a commented starter project")
    new.add_argument(
        "kind",
        help="surface: unduloid, nodoid, catenoid, cylinder, helicoid, enneper, scherk, form-found or mesh",
    )
    new.add_argument(
        "--out",
        type=Path,
        metavar="FILE",
        help="file to write (default: <kind>.toml; - for the screen); a mesh goes beside it",
    )

    check = commands.add_parser(
        "check",
        help="look for mistakes in a project without running it",
        description="Look for mistakes in a project and tell the size of its net, in a few seconds; nothing is "
        "written. A surface that is no closed form is found on coarse elements, which tells whether there is one, and "
        "its net is laid on it. What only a run can tell is said.",
    )
    check.add_argument("project", type=Path, help="project file (.toml)")
    _add_verbose(check)

    add_optimise(commands)
    add_study(commands)
    add_picture(commands)
    add_studio(commands)

    examples = commands.add_parser("examples", help="list the examples, or copy them")
    examples.add_argument("names", nargs="*", metavar="NAME", help="with --copy: the examples to copy (default: all)")
    examples.add_argument("--copy", type=Path, metavar="DIR", help="folder to copy them into")

    schema = commands.add_parser(
        "schema",
        help="print the JSON schema of a project or a file: summary.json, network.json, ...",
    )
    schema.add_argument("which", choices=["project", "summary", "network", "lamellas", "optimise", "study"])
    return parser


def _add_verbose(parser: argparse._ActionsContainer) -> None:
    parser.add_argument(
        "-v", "--verbose", action="store_true", help="print details too, such as each step towards a surface"
    )


def _tell(result: str) -> None:
    print(readable(result))


def _say(message: str) -> None:
    print(readable(message), file=sys.stderr, flush=True)


def _run(arguments: argparse.Namespace) -> None:
    from lamella.stages.write import run

    quiet, screen = arguments.quiet, Screen(verbose=arguments.verbose)
    try:
        folder = run(
            arguments.project,
            out=arguments.out,
            until=arguments.until,
            progress=silent if quiet else screen,
            warn=lambda message: _say(f"warning: {message}"),
        )
    finally:
        screen.clear()
    if not quiet:
        _tell(f"report: {folder / 'report.html'}")


def _check(arguments: argparse.Namespace) -> None:
    from lamella.project.read import located, read_project
    from lamella.stages.check import check_project

    project = read_project(arguments.project)
    screen = Screen(verbose=arguments.verbose)
    try:
        checked = check_project(project, folder=arguments.project.parent, progress=screen)
    except InputError as error:
        raise located(error, arguments.project) from None
    finally:
        screen.clear()
    for message in checked.warnings:
        _say(f"warning{' (from coarse elements)' if checked.coarse else ''}: {message}")
    _tell(f"{arguments.project}: {checked}")


def _new(arguments: argparse.Namespace) -> None:
    from lamella.project.messages import explain_kind
    from lamella.project.starter import starter, starter_mesh

    kind = arguments.kind
    message, remedy = explain_kind(kind)
    if message:
        raise InputError(message, remedy)
    target: Path = arguments.out or Path(f"{kind}.toml")
    if str(target) == "-":
        print(starter(kind, kind), end="")
        return
    mesh = target.with_name(f"{target.stem if target.suffix != '.obj' else target.name}.obj")
    files = {target: starter(kind, target.stem, mesh.name)} | ({mesh: starter_mesh()} if kind == "mesh" else {})
    from lamella.files.whole import write_new_whole

    if not target.parent.is_dir():
        raise InputError(f"{target.parent}: no such folder", "make it first, or name another file with --out")
    # the project last: what it names is there when it is
    write_new_whole(
        {file: text.encode() for file, text in reversed(files.items())},
        "name another file with --out, or move it away",
    )
    _tell(f"wrote {' and '.join(map(str, files))}; next: lamella run {target}")


def _examples(arguments: argparse.Namespace) -> None:
    from lamella.command.examples import copy_examples, list_examples, list_further

    if arguments.copy is None and arguments.names:
        raise InputError("no folder to copy into", f"lamella examples --copy DIR {' '.join(arguments.names)}")
    if arguments.copy is None:
        for name, title in [*list_examples(), *list_further()]:
            print(f"{name:28s} {title}")
        print("\ncopy them with: lamella examples --copy DIR [NAME ...]")
        return
    for path in copy_examples(arguments.names, arguments.copy):
        _tell(str(path))


def _schema(arguments: argparse.Namespace) -> None:
    import json

    if arguments.which == "project":
        from lamella.project.tables import project_schema as schema
    elif arguments.which == "optimise":
        from lamella.files.write.optimise_json import optimise_schema as schema
    elif arguments.which == "study":
        from lamella.studies.tables import study_schema as schema
    elif arguments.which == "summary":
        from lamella.stages.schema import summary_schema as schema
    elif arguments.which == "lamellas":
        from lamella.files.write.lamellas_json import lamellas_schema as schema
    else:
        from lamella.files.write.network_json import network_schema as schema
    print(json.dumps(schema(), indent=2))


_COMMANDS: dict[str, Callable[[argparse.Namespace], int | None]] = {
    "run": _run,
    "check": _check,
    "new": _new,
    "optimise": run_optimise,
    "study": run_study,
    "picture": run_picture,
    "studio": run_studio,
    "examples": _examples,
    "schema": _schema,
}


def _terminate(number: int, frame: FrameType | None) -> None:
    # a polite kill unwinds like an interrupt, so that temporary folders go
    raise SystemExit(128 + number)


def _one_blas_thread() -> None:
    """Let the linear algebra of this process run in one thread.

    How many threads share a dot product of long vectors decides how its sum is rounded: files would differ in their
    last digits from machine to machine. The matrices here are small, and more threads only make them slower. The sparse
    solver has threads of its own, which do not change its results.
    """
    # read once, when numpy is loaded
    if "numpy" not in sys.modules:
        os.environ.update(dict.fromkeys(_BLAS_THREADS, "1"))


def _mend(error: OSError) -> str:
    if error.errno in (errno.ENOSPC, errno.EFBIG, getattr(errno, "EDQUOT", errno.ENOSPC)):
        return "free some space on the disk, or write to another one"
    if error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
        return "write to another folder, or have the rights changed"
    return "check the path, or write to another folder"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the exit code is 0, 2 for what the user can mend, 1 as `optimise` says."""
    _one_blas_thread()
    with contextlib.suppress(ValueError):
        signal.signal(signal.SIGTERM, _terminate)
    if isinstance(sys.stdout, io.TextIOWrapper):
        # a file name or a unit the terminal cannot show must not end a run
        sys.stdout.reconfigure(errors="backslashreplace")
    parser = _parser()
    parsed = parser.parse_args(arguments)
    if parsed.command is None:
        parser.print_help(sys.stderr)
        return 2
    try:
        code = _COMMANDS[parsed.command](parsed)
        sys.stdout.flush()
    except InputError as error:
        _say(f"lamella: {error}")
        return 2
    except BrokenPipeError:
        # the reader of our output has gone; there is nobody to tell
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (sys.stdout, sys.stderr):
            os.dup2(nowhere, stream.fileno())
        return 1
    except KeyboardInterrupt:
        _say("lamella: interrupted, nothing written")
        return 130
    except OSError as error:
        name = f"{error.filename}: " if error.filename else ""
        _say(f"lamella: {name}{error.strerror or error}; what was there before is unchanged")
        _say(f"  remedy: {_mend(error)}")
        return 2
    except MemoryError:
        _say("lamella: not enough memory; what was there before is unchanged\n  remedy: choose fewer cells")
        return 2
    return code or 0

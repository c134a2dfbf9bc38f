"""The command `lamella study`."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path
from typing import Any

from lamella.base.progress import silent
from lamella.base.wording import counted, readable
from lamella.command.screen import Screen

_DESCRIPTION = """\
Compute many variants of a project side by side: a table of their figures, a page that shows
them, and each variant as a project that `lamella run` takes.

  project = "oculus.toml"                  beside the study's file

  [[variable]]                             any number of the project by its path
  key = "surface.boundary.1.circle.radius"
  range = [1.0, 1.6]                       or values = [...]

  [[variable]]                             or what a loop may do
  loop = "rim"
  freedom = "scale"                        or move, tilt, wave
  range = [0.9, 1.1]

  [sampler]
  kind = "grid"                            count values a range; latin-hypercube or sobol: count in all
  count = 5

  [[objective]]
  figure = "fabrication.mass"              a key of summary.json; goal = "max" for the largest

  [[constraint]]
  figure = "lamellas.utilisation_max"
  at_most = 1.0

  [optimise]                               search for the best instead of sampling

Variants that are in the folder already are not computed again: what an interruption or a lost
machine has left out is computed by a second call. Write until = "lamellas" above the tables for
what needs no more."""


def add_study(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to the parser."""
    parser = commands.add_parser(
        "study",
        help="compute many variants of a project, and find the best of them",
        description=_DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("study", type=Path, help="file of the study (.toml)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder to write (default: out/<study file's stem>)")
    parser.add_argument(
        "--jobs", type=int, metavar="N", help="processes on this machine (default: as many as it has cores)"
    )
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="Dask scheduler of a cluster instead, such as tcp://host:8786; its workers need lamella of this version",
    )
    parser.add_argument("--quiet", action="store_true", help="print nothing but errors")


def run_study(arguments: argparse.Namespace) -> int:
    """Compute a study; 0, or 1 where variants were lost with their workers and are missing."""
    from lamella.studies.study import study
    from lamella.studies.variant import DONE, FAILED

    screen = Screen(verbose=False)
    began = time.monotonic()
    try:
        result = study(
            arguments.study,
            out=arguments.out,
            jobs=arguments.jobs,
            scheduler=arguments.scheduler,
            progress=silent if arguments.quiet else screen,
        )
    except KeyboardInterrupt:
        screen.clear()
        print("lamella: interrupted; the variants that are done are kept, and a second call computes the others")
        return 130
    finally:
        screen.clear()
    wall = time.monotonic() - began
    failed = result.columns["status"].count(FAILED)
    if not arguments.quiet:
        if result.ended:
            print(f"search: {result.ended}")
        if result.computed:
            cores = counted(arguments.jobs or os.cpu_count() or 1, "process", "processes")
            where = f"at {arguments.scheduler}" if arguments.scheduler else f"on {cores}"
            print(
                f"{counted(result.computed, 'variant')} computed in {wall:.3g} s {where}: {result.seconds:.3g} CPU s"
                + (f", {result.seconds / wall:.2f} at a time" if arguments.jobs != 1 else "")
            )
        without = sum(
            status == DONE and bool(reason)
            for status, reason in zip(result.columns["status"], result.columns["reason"], strict=True)
        )
        if without:
            print(f"{counted(without, 'variant')} without a value of an objective or constraint: see the column reason")
        for name in result.best[:10]:
            print(readable(f"best: {result.project(name)}"))
        if len(result.best) > 10:
            print(f"and {len(result.best) - 10} more: column best of table.csv")
        print(readable(f"{result!r}; page: {result.folder / 'study.html'}"))
    return 1 if failed else 0

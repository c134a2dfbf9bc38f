"""Running a project file, and the folder of a run, which appears whole or not at all."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from lamella import __version__
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, in_stage, silent
from lamella.base.wording import one_line
from lamella.files.side_by_side import run_side_by_side
from lamella.files.whole import write_whole
from lamella.files.write.model_3dm import model_bytes
from lamella.files.write.rhino_file import Frame
from lamella.project.read import located, moved, read_project
from lamella.stages import all_stages
from lamella.stages.computation import compute
from lamella.stages.report import report_data
from lamella.stages.results import Results
from lamella.stages.stage import File, Stage
from lamella.stages.wanted import check_name
from lamella.view.report import write_report

# samples of a net whose files are written in less time than it takes to begin a second process and to see it end
SAMPLES_WRITTEN_ALONE = 100_000


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
    progress : callable
        Receives what is being done; `print` will do.
    warn : callable, optional
        Receives every warning.

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

    check_name(until)
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

    progress = in_stage(progress, "files")
    start, target = time.process_time(), Path(target)
    progress(Report.heading(f"writing {target}"))
    with staged_folder(target) as folder:
        elsewhere = write_files(results, folder, progress=progress)
        seconds = results.summary["seconds"] | {"files": round(time.process_time() - start + elsewhere, 4)}
        write_summary(folder, results.summary | {"seconds": seconds})


def write_files(results: Results, folder: Path, *, progress: Progress = silent) -> float:
    """Write all files but summary.json into an existing folder.

    Parameters
    ----------
    results : Results
    folder : Path
    progress : callable
        Receives each file's name, with the share of the files that are begun.

    Returns
    -------
    float
        CPU seconds of another process, which writes some of the files of a large net.
    """
    files = list(_files(results))
    begun = 0

    def begins(number: int) -> None:
        nonlocal begun
        progress(Report.step(", ".join((files[number].name, *files[number].also)), begun / len(files)))
        begun += 1

    for file in files:
        (folder / file.name).parent.mkdir(parents=True, exist_ok=True)
    table = results.project.files.csv
    style = None if table is None else (table.separator, table.decimal)
    few = results.network is None or len(results.network.sample_points) < SAMPLES_WRITTEN_ALONE
    return run_side_by_side([partial(write_styled, file, folder, style) for file in files], begins, alone=few)


def write_styled(file: File, folder: Path, style: tuple[str, str] | None) -> None:
    """Write a file, and those beside it, lists in a style: separator and decimal sign."""
    file.write(folder / file.name)
    if style is not None:
        from lamella.files.write.csv_style import restyle

        for name in (file.name, *file.also):
            if name.endswith(".csv"):
                restyle(folder / name, *style)


def _files(results: Results) -> Iterator[File]:
    """All files but summary.json: the project, those of the stages, the model and the report."""
    yield File("project.toml", lambda path: _write_project(results, path))
    for stage in _run_stages(results):
        yield from stage.files(results.outputs[stage.name], results.upstream)
    if results.network is not None:
        yield File("model.3dm", lambda path: write_whole(path, model_of(results)))
    yield File("report.html", lambda path: write_report(path, report_data(results)))


def _run_stages(results: Results) -> Iterator[Stage[Any]]:
    """The stages that were run."""
    return (stage for stage in all_stages.STAGES if stage.name in results.outputs)


def _write_project(results: Results, path: Path) -> None:
    heading = f"# {one_line(results.project.name)}, all defaults filled in by lamella {__version__}\n"
    write_whole(path, (heading + moved(results.project, results.folder, path.parent).to_toml()).encode())


def model_of(results: Results) -> bytes:
    """model.3dm: the model of all stages for Rhino; results that have a network."""
    content: Any = {"surface": results.mesh, "network": results.network, "lamellas": results.lamellas}
    models = (stage.model(results.outputs[stage.name], results.upstream) for stage in _run_stages(results))
    further = [layer for model in models for layer in model]
    frame = Frame(results.project.files.unit, results.origin)
    # rhino3dm's own Write says nothing of a full disk
    return model_bytes(**content, further=further, frame=frame, name=results.project.name, version=__version__)

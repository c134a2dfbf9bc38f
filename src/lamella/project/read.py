"""Reading a project file: errors name the file, the line, the key and the remedy."""

from __future__ import annotations

import os
import re
import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from lamella.base.byte_order import unmarked
from lamella.base.errors import InputError
from lamella.base.wording import cut, one_line
from lamella.project.messages import explain, reported_once
from lamella.project.tables import FormFoundTable, MeshTable, Project

# a project file is written by hand; anything larger is some other file
PROJECT_BYTES_MAX = 5_000_000
# of a dotted key; the reader's time grows with the square of it
KEY_PARTS_MAX = 32
_DEEP = re.compile(rf"""(?<![\w.'"-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{KEY_PARTS_MAX}}}""")
# errors looked at
MOST_ERRORS = 200
# errors told at once
REPORTED_MAX = 6


def read_project(path: str | Path) -> Project:
    r"""Read and check a project file.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    InputError
        Whatever is wrong with it, with file, line and key.

    Examples
    --------
    >>> import lamella, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder) / "roof.toml"
    ...     _ = file.write_text('[surface]\nkind = "catenoid"\nneck_radius = 2.5\nheight = [-2.0, 3.0]\n')
    ...     print(lamella.read_project(file).surface.kind)
    catenoid
    """
    path = Path(path)
    try:
        if path.is_dir():
            raise InputError(f"{path} is a folder, not a project file", "name the .toml file inside it")
        with path.open("rb") as file:
            raw = file.read(PROJECT_BYTES_MAX + 1)
    except FileNotFoundError:
        raise InputError(
            f"{path}: no such file", "check the path, or write a starter project with: lamella new unduloid"
        ) from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(f"{path} cannot be read: {reason}", "check the path and its permissions") from None
    if len(raw) > PROJECT_BYTES_MAX:
        raise InputError(
            f"more than {PROJECT_BYTES_MAX / 1e6:g} MB long: no project file is",
            "name the project's .toml file",
            str(path),
        )
    try:
        text = unmarked(raw).decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(
            f"not a text file in UTF-8 (byte {error.start})", "a project file is TOML text, saved as UTF-8", str(path)
        ) from None
    return project_of_text(text, path)


def project_of_text(text: str, path: Path) -> Project:
    """The project of the text that a file holds, or is to hold.

    Parameters
    ----------
    text : str
    path : Path
        Its name is the project's where the text has none.

    Raises
    ------
    InputError
        Whatever is wrong with it, with file, line and key.
    """
    project = parse_project(toml_values(text, str(path)), source=str(path), text=text)
    if project.name.strip():
        return project
    # a file name may hold bytes that are no text
    return project.model_copy(update={"name": one_line(os.fsencode(path.stem).decode("utf-8", "replace"))})


def toml_values(text: str, source: str) -> dict[str, Any]:
    """The values of a text, as nested dictionaries.

    Parameters
    ----------
    text : str
    source : str
        File name, for errors.

    Raises
    ------
    InputError
        It is not TOML.
    """
    deep = _DEEP.search(text)
    if deep:
        line = text.count("\n", 0, deep.start()) + 1
        raise InputError(
            f"a key of more than {KEY_PARTS_MAX} parts: {cut(deep[0], 60)}",
            "see `lamella new` for a project that is",
            f"{source}:{line}",
        )
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise InputError("not valid TOML: nested too deep", "see `lamella new` for a project that is", source) from None
    except ValueError as error:
        # an impossible date or number is a plain ValueError
        at = re.search(r" \(at line (\d+), column (\d+)\)$", str(error))
        message = str(error)[: at.start()] if at else str(error).removesuffix(" (at end of document)")
        remedy = "see `lamella new` for a project that is"
        twice = re.match(r"Cannot declare \((.*?),?\) twice", message)
        if twice:
            table = ".".join(part.strip(" '\"") for part in twice[1].split(","))
            message, remedy = f"the table [{cut(table)}] is there twice", "keep one of the two"
        elif message == "Cannot overwrite a value":
            message, remedy = "the same key is there twice", "keep one of the two"
        elif message.startswith("Exceeds the limit"):
            message = "a number of thousands of digits"
        where, column = (f"{source}:{at[1]}", f" (column {at[2]})") if at else (source, "")
        if str(error).endswith("(at end of document)"):
            where, column = f"{source}:{max(len(text.splitlines()), 1)}", " (end of the file)"
        raise InputError(f"not valid TOML: {cut(message, 200)}{column}", remedy, where) from None


def parse_project(values: dict[str, Any], *, source: str = "", text: str = "") -> Project:
    """Check the values of a project given as nested dictionaries.

    Parameters
    ----------
    values : dict
        As a TOML reader gives them.
    source, text : str, optional
        File name and text, to say where an error is.

    Raises
    ------
    InputError

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project({"surface": {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}})
    >>> project.lamella.material
    '1.4301'
    """
    if not isinstance(values, dict):
        raise InputError(
            f"the project is a {type(values).__name__}, not a table of keys and values",
            "give a dictionary, as tomllib.loads makes it of a project's text; read_project takes the path of a file",
            source,
        )
    if not values:
        raise InputError("the project is empty", "write a starter project with: lamella new unduloid", source)
    try:
        project = Project.model_validate(values)
    except ValidationError as failure:
        found = failure.errors(include_url=False)
        errors = reported_once([explain(error, values) for error in found[:MOST_ERRORS]])
        more = len(errors) - REPORTED_MAX + max(len(found) - MOST_ERRORS, 0)
        reported = [InputError(m, r, _where(source, text, key)) for key, m, r in errors[:REPORTED_MAX]]
        if more > 0:
            reported.append(InputError(f"and {more} more {'error' if more == 1 else 'errors'}", where=source))
        if len(reported) == 1:
            raise reported[0] from None
        raise InputError("\n".join(str(error) for error in reported)) from None
    try:
        _check_material(project)
        _check_slots(project)
    except InputError as error:
        raise InputError(error.message, error.remedy, _where(source, text, error.where)) from None
    return project


def moved(project: Project, folder: Path, other: Path) -> Project:
    """The project as it has to read in another folder, so that the files it names are the same.

    Parameters
    ----------
    project : Project
    folder, other : Path
        Where relative names of files begin, and where they are to begin.
    """

    def name(file: str) -> str:
        if Path(file).is_absolute():
            return file
        there = os.path.realpath(folder / file)
        try:
            return Path(os.path.relpath(there, os.path.realpath(other))).as_posix()
        except ValueError:
            return there  # on another drive no relative name leads there

    table: FormFoundTable | MeshTable
    if isinstance(project.surface, MeshTable):
        table = project.surface.model_copy(update={"file": name(project.surface.file)})
    elif isinstance(project.surface, FormFoundTable):
        loops = tuple(
            loop.model_copy(update={"file": name(loop.file)}) if loop.file else loop
            for loop in project.surface.boundary
        )
        table = project.surface.model_copy(update={"boundary": loops})
    else:
        return project
    return project.model_copy(update={"surface": table})


def _check_material(project: Project) -> None:
    try:
        project.material()
    except InputError as error:
        raise InputError(error.message, error.remedy, f"lamella.{error.where}") from None


def _check_slots(project: Project) -> None:
    width, thickness = project.fabrication.slot_width, project.lamella.thickness
    if width is not None and width < thickness:
        raise InputError(
            f"slot_width = {width:g} m is less than the thickness {thickness:g} m of the strip that goes in",
            "leave slot_width out: it is twice the thickness then",
            "fabrication.slot_width",
        )


def located(error: InputError, path: Path) -> InputError:
    """The same error with the project file's name and line in front of its key."""
    try:
        text = path.read_text("utf-8-sig")
    except (OSError, ValueError):
        text = ""  # a pipe is read once
    return InputError(error.message, error.remedy, _where(str(path), text, error.where))


def line_of(text: str, key: str) -> int:
    """Line of a key in a project's text, from 1, or of the table that it is missed in; 0 where there is none."""
    line, at = 0, key
    while at and not line:
        line = _line_of(text, at)
        at = at.rpartition(".")[0]
    return line


def _where(source: str, text: str, key: str) -> str:
    line = line_of(text, key)
    file = f"{source}:{line}" if source and line else source
    return ": ".join(part for part in (file, cut(key)) if part)


def _line_of(text: str, key: str) -> int:
    """Line of a dotted key in TOML text (0 when it is not there), for tables and plain keys as people write them.

    Lists of tables carry their index, from 0: surface.boundary[1].circle.radius.
    """
    parent, _, leaf = key.rpartition(".")
    # a list that is no list of tables is written where its key is
    plain = key.partition("[")[0] if "." not in key else leaf.partition("[")[0]
    table, best = "", 0
    counts: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), 1):
        header = re.match(r"\s*(\[+)\s*([^\]]+?)\s*\]", line)
        key_of = key if not table else plain if table == parent else ""
        if header:
            named = re.sub(r"""["']""", "", header[2])
            table = _indexed(named, counts, is_list=len(header[1]) > 1)
            # a list as a whole is where its first table is
            if table == key or (named == key and not best):
                best = number
        elif key_of and re.match(rf"""\s*["']?{re.escape(key_of)}["']?\s*[=.]""", line):
            return number
    return best


def _indexed(table: str, counts: dict[str, int], *, is_list: bool) -> str:
    """A header's name with the index of each list of tables it is in; counts holds those met so far."""
    if is_list:
        counts[table] = counts.get(table, -1) + 1
        for inner in [name for name in counts if name.startswith(f"{table}.")]:
            del counts[inner]
    name, keys = "", []
    for part in table.split("."):
        name = f"{name}.{part}" if name else part
        keys.append(f"{part}[{counts[name]}]" if name in counts else part)
    return ".".join(keys)

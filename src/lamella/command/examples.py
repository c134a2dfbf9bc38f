"""The examples that come with the program."""

from __future__ import annotations

import os
from difflib import get_close_matches
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path

from lamella.base.errors import InputError
from lamella.files.whole import write_new_whole


def _folder() -> Traversable:
    packaged = files("lamella") / "examples"
    # an editable install has them beside the sources
    return packaged if packaged.is_dir() else Path(__file__).parents[3] / "examples"


def _all() -> dict[str, Traversable]:
    return {
        item.name: item for item in sorted(_folder().iterdir(), key=lambda i: i.name) if item.name.endswith(".toml")
    }


REMEDY = "name another folder with --copy"
FOLDERS = ("optimise", "studies")
"""Folders of quad meshes for `lamella optimise` and of studies; the name of one stands for all that is in it."""


def _inside(folder: str) -> dict[str, Traversable]:
    return {f"{folder}/{item.name}": item for item in sorted((_folder() / folder).iterdir(), key=lambda i: i.name)}


def _beside(name: str) -> list[str]:
    """Files that go with an example: those of its name with another ending."""
    stem = name.removesuffix(".toml")
    return sorted(item.name for item in _folder().iterdir() if Path(item.name).stem == stem and item.name != name)


def list_examples() -> list[tuple[str, str]]:
    """File name and first comment line of every project."""
    return _titled(_all())


def list_further() -> list[tuple[str, str]]:
    """The same of the quad meshes and studies."""
    return [item for folder in FOLDERS for item in _titled(_inside(folder))]


def _titled(files: dict[str, Traversable]) -> list[tuple[str, str]]:
    return [(name, item.read_text(encoding="utf-8").partition("\n")[0].lstrip("# ")) for name, item in files.items()]


def copy_examples(names: list[str], target: Path) -> list[Path]:
    """Copy examples into a folder, which is made if it is not there; files that are there are kept.

    Raises
    ------
    InputError
        Unknown name; a file of that name is there already.
    """
    known = _all()
    names = names or [*known, *FOLDERS]
    folders = [folder for folder in FOLDERS if folder in names]
    further = {name: item for folder in folders for name, item in _inside(folder).items()}
    wanted = [name if name.endswith(".toml") else f"{name}.toml" for name in names if name not in FOLDERS]
    for name in wanted.copy():
        if name not in known:
            near = get_close_matches(Path(name).stem, [Path(one).stem for one in known], 1, 0.6)
            raise InputError(
                f"no example {name[:80]!r}" + (f", did you mean {near[0] + '.toml'!r}?" if near else ""),
                f"there are {', '.join(known)}, {', '.join(FOLDERS)}",
            )
        wanted += _beside(name)
    known = {item.name: item for item in _folder().iterdir()} | further
    wanted += further
    for name in wanted:
        if os.path.lexists(target / name):
            raise InputError(f"{target / name} is there already", REMEDY)
    if target.exists() and not target.is_dir():
        raise InputError(f"{target} is a file", "name a folder with --copy")
    target.mkdir(parents=True, exist_ok=True)
    for folder in folders:
        (target / folder).mkdir(exist_ok=True)
    write_new_whole({target / name: known[name].read_bytes() for name in wanted}, REMEDY)
    return [target / name for name in wanted]

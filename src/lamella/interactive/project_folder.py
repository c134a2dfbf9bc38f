"""What the studio reads and writes: files in the project's folder and below, and nothing else."""

from __future__ import annotations

import os
from pathlib import Path

from lamella.base.errors import InputError
from lamella.base.wording import cut
from lamella.project.tables import FormFoundTable, MeshTable, Project

REMEDY = "copy the file into the project's folder"


def refuse_outside(project: Project, folder: Path) -> None:
    """Refuse a project that names files outside of its folder, by their true places.

    Raises
    ------
    InputError
    """
    table = project.surface
    named: list[tuple[str, str]] = []
    if isinstance(table, MeshTable):
        named.append(("surface.file", table.file))
    elif isinstance(table, FormFoundTable):
        named += [(f"surface.boundary[{k}].file", loop.file) for k, loop in enumerate(table.boundary) if loop.file]
    for where, name in named:
        if not is_inside(folder / name, folder):
            raise InputError(
                f"{cut(name, 200)} is outside of the project's folder, which is all that is read", REMEDY, where
            )


def is_inside(path: Path, folder: Path) -> bool:
    """Whether a path leads to the folder or below it, whatever links are on the way."""
    there, inside = os.path.realpath(path), os.path.realpath(folder)
    return os.path.commonpath([there, inside]) == inside


def new_name(name: str, folder: Path) -> Path:
    """Path of a project file in the folder by a plain name.

    Raises
    ------
    InputError
        The name leads elsewhere, or is none of a project file.
    """
    plain = Path(name).name
    if not name or plain != name or name.startswith(".") or "\\" in name or "\0" in name or len(name) > 200:
        raise InputError(f"{cut(name, 80)!r} is no name of a file", "write a name without folders, such as roof.toml")
    path = folder / (name if name.endswith(".toml") else f"{name}.toml")
    if path.is_symlink() or not is_inside(path, folder):
        raise InputError(f"{cut(name, 80)!r} leads out of the project's folder", "choose another name")
    return path

"""Telling a run's own folder from what users put there: summary.json lists the files of its run with their hashes.

A folder is a run's own while it holds nothing but listed files as they were written (some may be gone) and a
summary.json as it was written, which a seal tells. Whatever else is in it belongs to the user.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import orjson

SUMMARY = "summary.json"
SCHEMA = "lamella/summary/1"
UNSEALED = ("seconds", "seal")
"""Keys that the seal does not cover: times differ from run to run, and files should not."""

MARK = ".lamella-run-"
"""Beginning of the name of an empty file in a folder that a run fills; it goes when the folder is complete."""

LITTER = (".DS_Store", "Thumbs.db")
"""What file managers leave in folders they have shown; they make it anew."""

JUNCTION = 0xA0000003
"""Tag of a folder that leads to another one: IO_REPARSE_TAG_MOUNT_POINT of winnt.h."""

OWN_BYTES_MAX = 64_000_000
MOST_FOUND = 1000


def write_summary(folder: Path, content: dict[str, Any]) -> None:
    """Write summary.json, the last file of a run, with the list of all others.

    Parameters
    ----------
    folder : Path
        Holds all other files of the run.
    content : dict
        Without the keys "files" and "seal", which are added.
    """
    from lamella.files.whole import write_whole

    files = {
        name: _hash(folder / name) for name in sorted(_names(folder)) if name != SUMMARY and not name.startswith(MARK)
    }
    listed = content | {"files": files}
    plain = orjson.loads(orjson.dumps(listed, option=orjson.OPT_SERIALIZE_NUMPY))
    listed["seal"] = _seal(plain)
    write_whole(folder / SUMMARY, orjson.dumps(listed, option=orjson.OPT_INDENT_2 | orjson.OPT_SERIALIZE_NUMPY) + b"\n")


def run_files(folder: Path) -> dict[str, str] | None:
    """Names of a run's files and their hashes, summary.json left out; None for a folder that is no run's.

    A summary.json that was edited lists nothing that can be relied on, so it counts as none.
    """
    content = _summary(folder)
    if content is None or content.get("seal") != _seal(content):
        return None
    files = content.get("files")
    return files if isinstance(files, dict) and all(_is_inside(name) for name in files) else None


def was_written_by_a_run(folder: Path) -> bool:
    """Whether a folder holds a summary.json of this program, edited or of an older version even."""
    content = _summary(folder)
    return content is not None and content.get("schema") == SCHEMA


def foreign_entries(folder: Path, files: dict[str, str] | None) -> list[str]:
    """What is in a folder besides a run's files as they were written, in words, at most `MOST_FOUND`.

    Parameters
    ----------
    folder : Path
    files : dict or None
        As `run_files` gives them; None: everything is foreign, and only the uppermost level is listed.
    """
    own = {} if files is None else files
    known = LITTER if files is None else (*LITTER, SUMMARY)
    inner = {parent.as_posix() for name in own for parent in Path(name).parents} - {"."}
    found: list[str] = []

    def look(place: Path, before: str) -> None:
        for entry in sorted(os.scandir(place), key=lambda entry: entry.name):
            name = before + entry.name
            if len(found) >= MOST_FOUND:
                return
            if _is_link(entry):
                found.append(f"{name} (a link)")
            elif entry.is_dir(follow_symlinks=False):
                if name in inner:
                    look(place / entry.name, f"{name}/")
                else:
                    found.append(f"{name}/")
            elif not entry.is_file(follow_symlinks=False):
                found.append(name)
            elif name in own:
                # gone meanwhile: a run at the same time removes what it has replaced
                there = _hash(place / entry.name)
                if there not in (own[name], None):
                    found.append(f"{name} ({'edited' if there else 'cannot be read'})")
            elif name not in known and entry.name not in LITTER:
                found.append(name)

    look(folder, "")
    return found


def _is_link(entry: os.DirEntry[str]) -> bool:
    """Whether an entry leads elsewhere: a symbolic link, or a junction of Windows, which passes for a folder."""
    tag = getattr(entry.stat(follow_symlinks=False), "st_reparse_tag", 0)
    return entry.is_symlink() or tag == JUNCTION


def remove_run(folder: Path, files: dict[str, str]) -> bool:
    """Remove a run's own files, and the folder if nothing else is in it; the list goes last.

    Returns
    -------
    bool
        Whether the folder is gone.
    """
    inner = {parent for name in files for parent in Path(name).parents} - {Path(".")}
    with contextlib.suppress(OSError):
        for name in files:
            (folder / name).unlink(missing_ok=True)
        for parent in sorted(inner, key=lambda one: len(one.parts), reverse=True):
            _remove_folder(folder / parent)
        # killed before this line, the rest can still be told to be a run's
        if not [name for name in os.listdir(folder) if name not in (SUMMARY, *LITTER)]:
            (folder / SUMMARY).unlink(missing_ok=True)
            _remove_folder(folder)
    return not os.path.lexists(folder)


def _remove_folder(folder: Path) -> None:
    with contextlib.suppress(FileNotFoundError):
        for name in LITTER:
            (folder / name).unlink(missing_ok=True)
        folder.rmdir()


def _is_inside(name: str) -> bool:
    """Whether a listed name stays inside its folder: the list decides what is removed."""
    return bool(name) and not {"", ".", ".."} & set(name.split("/")) and not set(name) & set("\\:\0")


def _summary(folder: Path) -> dict[str, Any] | None:
    path = folder / SUMMARY
    try:
        about = path.lstat()
        if not stat.S_ISREG(about.st_mode) or about.st_size > OWN_BYTES_MAX:
            return None
        content = orjson.loads(path.read_bytes())
    except (OSError, ValueError):
        return None
    return content if isinstance(content, dict) else None


def _seal(content: dict[str, Any]) -> str:
    covered = {key: value for key, value in content.items() if key not in UNSEALED}
    return hashlib.sha256(orjson.dumps(covered)).hexdigest()


def _hash(path: Path) -> str | None:
    """Hash of a file's content; None where it is gone, "" where it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except FileNotFoundError:
        return None
    except OSError:
        return ""


def _names(folder: Path) -> Iterator[str]:
    """Names of all files in a folder but its summary.json and mark, with those of the folders they are in."""
    for path in folder.rglob("*"):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and name != SUMMARY and not name.startswith(MARK):
            yield name

"""The folder of a study: each variant a folder that appears whole, so that a second call computes the missing ones."""

from __future__ import annotations

import hashlib
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import orjson

from lamella import __version__
from lamella.base.errors import InputError
from lamella.files.lock import lock_folder, unlock_folder
from lamella.files.whole import write_whole
from lamella.project.read import moved, parse_project
from lamella.studies.variant import DONE, Base, Outcome

MARK = "study.json"
"""File that tells a study's folder from others."""

SCHEMA, VARIANT_SCHEMA = "lamella/study/1", "lamella/variant/1"
VARIANTS, VARIANT = "variants", "variant.json"
NAMES = (MARK, "table.csv", "study.html", "study.toml", VARIANTS)
PART = ".part-"
"""Beginning of the name of a variant's folder while it is written."""


@dataclass(frozen=True)
class Kept:
    """A variant as its folder has it.

    Attributes
    ----------
    status, reason, remedy : str
    summary : dict or None
    headrooms : dict
    view : bytes
    """

    status: str
    reason: str
    remedy: str
    summary: dict[str, Any] | None
    headrooms: dict[str, float | None]
    view: bytes

    @classmethod
    def of(cls, outcome: Outcome) -> Kept:
        """What is kept of an outcome."""
        return cls(outcome.status, outcome.reason, outcome.remedy, outcome.summary, outcome.headrooms, outcome.view)


class StudyFolder:
    """The folder of a study on the disk.

    Parameters
    ----------
    path : Path
    base : Base
    source : Path
        Folder that relative names of the project's files begin in.
    """

    def __init__(self, path: Path, base: Base, source: Path) -> None:
        self.path, self._base, self._source = path, base, source
        shared = orjson.dumps(base.study.model_dump(mode="json", include={"variable", "until", "headroom"}))
        files = [f"{name} {hashlib.sha256(content).hexdigest()}" for name, content in sorted(base.files.items())]
        self._shared = hashlib.sha256(
            b"\n".join([__version__.encode(), shared, orjson.dumps(base.values), *(file.encode() for file in files)])
        )

    def key(self, chosen: tuple[Any, ...]) -> str:
        """Hash of all that decides a variant: values, project, files, version."""
        hashed = self._shared.copy()
        hashed.update(orjson.dumps(chosen))
        return hashed.hexdigest()

    def variant(self, name: str) -> Path:
        """Folder of a variant."""
        return self.path / VARIANTS / name

    def kept(self, name: str, chosen: tuple[Any, ...]) -> Kept | None:
        """A variant that was computed before; None where it was not, or for other values."""
        folder = self.variant(name)
        try:
            about = orjson.loads((folder / VARIANT).read_bytes())
            if about["key"] != self.key(chosen):
                return None
            summary = orjson.loads((folder / "summary.json").read_bytes()) if about["status"] == DONE else None
            view = (folder / "view.js").read_bytes() if summary is not None else b""
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return Kept(about["status"], about["reason"], about["remedy"], summary, about["headrooms"], _unwrapped(view))

    def write(self, name: str, chosen: tuple[Any, ...], outcome: Outcome) -> None:
        """Write a variant's folder, which takes the place of an earlier one."""
        stage = self.path / VARIANTS / f"{PART}{secrets.token_hex(6)}"
        stage.mkdir()
        try:
            self._fill(stage, name, chosen, outcome)
            target = self.variant(name)
            if target.exists():
                # one of other values: what a variant's folder holds was all written here
                aside = stage.with_name(f"{PART}{secrets.token_hex(6)}")
                os.rename(target, aside)
                shutil.rmtree(aside, ignore_errors=True)
            os.rename(stage, target)
        except BaseException:
            shutil.rmtree(stage, ignore_errors=True)
            raise

    def _fill(self, stage: Path, name: str, chosen: tuple[Any, ...], outcome: Outcome) -> None:
        columns = [variable.column for variable in self._base.study.variable]
        about = {
            "schema": VARIANT_SCHEMA,
            "version": __version__,
            "name": name,
            "values": dict(zip(columns, chosen, strict=True)),
            "key": self.key(chosen),
            "status": outcome.status,
            "reason": outcome.reason,
            "remedy": outcome.remedy,
            "headrooms": outcome.headrooms,
        }
        write_whole(stage / "project.toml", self._project(name, chosen, outcome))
        if outcome.summary is not None:
            write_whole(stage / "summary.json", orjson.dumps(outcome.summary, option=orjson.OPT_INDENT_2) + b"\n")
            write_whole(stage / "view.js", _wrapped(name, outcome.view))
        write_whole(stage / VARIANT, orjson.dumps(about, option=orjson.OPT_INDENT_2) + b"\n")

    def _project(self, name: str, chosen: tuple[Any, ...], outcome: Outcome) -> bytes:
        """The project of a variant, to be run from its folder; as far as it is one."""
        heading = f"# variant {name} of a study"
        with suppress(InputError):
            project = moved(parse_project(outcome.values), self._source, self.variant(name))
            return f"{heading}, lamella {__version__}\n{project.to_toml()}".encode()
        return f"{heading}: its values make no project\n".encode()

    @contextmanager
    def opened(self) -> Iterator[None]:
        """Make the folder where it is not there, and hold it against other studies.

        Raises
        ------
        InputError
            It holds what no study wrote, or another study is at work in it.
        """
        check_study_folder(self.path)
        (self.path / VARIANTS).mkdir(parents=True, exist_ok=True)
        lock = lock_folder(self.path, self.path / ".lamella-study", wait=False)
        if lock is None and os.name != "nt":
            raise InputError(f"another study is at work in {self.path}", "wait for it, or choose another --out")
        try:
            for litter in (self.path / VARIANTS).glob(f"{PART}*"):
                shutil.rmtree(litter, ignore_errors=True)
            write_whole(self.path / MARK, orjson.dumps({"schema": SCHEMA, "version": __version__}) + b"\n")
            yield
        finally:
            unlock_folder(lock)

    def remove_others(self, names: set[str]) -> int:
        """Remove variants that the study no longer has; returns how many."""
        gone = 0
        for folder in sorted((self.path / VARIANTS).iterdir()):
            if folder.name not in names and (folder / VARIANT).is_file() and not folder.is_symlink():
                shutil.rmtree(folder, ignore_errors=True)
                gone += 1
        return gone


def check_study_folder(path: Path) -> None:
    """Refuse a folder that a study should not write into; writes nothing.

    Raises
    ------
    InputError
    """
    if path.is_symlink() and not path.exists():
        raise InputError(f"{path} is a link that leads nowhere", "choose another folder with --out")
    if not path.exists():
        return
    if not path.is_dir():
        raise InputError(f"{path} is a file", "choose another folder with --out")
    there = sorted(entry for entry in os.listdir(path) if not entry.startswith("."))
    try:
        ours = orjson.loads((path / MARK).read_bytes()).get("schema") == SCHEMA
    except (OSError, ValueError, AttributeError):
        ours = False
    if there and not ours:
        shown = ", ".join(there[:4]) + (" ..." if len(there) > 4 else "")
        raise InputError(
            f"{path} holds what no study wrote: {shown}", "choose another folder with --out, or move them away"
        )


_BEFORE = "lamellaVariant("


def _wrapped(name: str, view: bytes) -> bytes:
    """A script that hands a variant's lines to the page: a page on a disk may load scripts and nothing else."""
    return f"{_BEFORE}{orjson.dumps(name).decode()}, ".encode() + view + b");\n"


def _unwrapped(script: bytes) -> bytes:
    return script.partition(b", ")[2].removesuffix(b");\n")

"""The output folder of a run: it appears whole or not at all.

A run fills a hidden folder beside the target and swaps it in when it is complete. While it works it holds a
lock on that folder; the system lets go of the lock when the run dies, so a later run knows which folders were
left behind.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import secrets
import shutil
import stat
from collections.abc import Iterator
from pathlib import Path

from lamella.errors import InputError
from lamella.files.exchange import exchange
from lamella.files.lock import lock_folder, unlock_folder

SUMMARY = "summary.json"
ATTEMPTS = 50
TAKEN = (errno.ENOTEMPTY, errno.EEXIST)


def check_target(target: Path) -> Path:
    """Refuse an output folder that a run could not, or should not, replace; writes nothing.

    Parameters
    ----------
    target : Path
        Where the output is to appear; a symbolic link is followed.

    Returns
    -------
    Path
        The folder that will be written, without links.

    Raises
    ------
    InputError
        If the target is a file, a mount point, or a folder with anything in it but no summary.json, or if it
        could not be made or replaced where it is.
    """
    try:
        place = target.resolve()
        _check(place)
    except InputError:
        raise
    except (OSError, RuntimeError) as error:
        raise InputError(f"the output folder {target} cannot be used: {error}", _ELSEWHERE) from error
    return place


@contextlib.contextmanager
def staged_folder(target: Path) -> Iterator[Path]:
    """Yield a temporary folder that takes the target's place when the block ends well.

    On any exception, an interrupt included, the temporary folder goes and the target stays as it was. Of two
    runs at once with one target the last to end wins whole.

    Parameters
    ----------
    target : Path
        Checked as `check_target` does.

    Yields
    ------
    Path
        An empty folder beside the target.
    """
    place = check_target(target)
    _clear_up(place)
    made: list[Path] = []
    stage: Path | None = None
    lock: int | None = None
    try:
        stage, lock = _make_stage(place, made)
        yield stage
        _swap_in(stage, place)
    except BaseException:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)
        for folder in reversed(made):
            # Another run may have put something there meanwhile.
            with contextlib.suppress(OSError):
                folder.rmdir()
        raise
    else:
        shutil.rmtree(stage, ignore_errors=True)
    finally:
        unlock_folder(lock)


_ELSEWHERE = "choose another folder with --out"


def _check(place: Path) -> None:
    # Each question is asked once: another run may take the folder away, or put one there, between two.
    try:
        is_folder = stat.S_ISDIR(place.stat().st_mode)
    except (FileNotFoundError, NotADirectoryError):
        pass
    else:
        if not is_folder:
            raise InputError(f"the output folder {place} is a file", f"{_ELSEWHERE}, or move the file away")
        if os.path.ismount(place):
            raise InputError(
                f"the output folder {place} is the root of a disk or mount and cannot be replaced as a whole",
                f"name a folder inside it: --out {place / 'out'}",
            )
        if not _replaceable(place):
            raise InputError(
                f"the output folder {place} is not empty and holds no {SUMMARY}: it is not an earlier run's",
                f"{_ELSEWHERE}, or empty it",
            )
    parent = place.parent
    while not parent.exists() and parent != parent.parent:
        parent = parent.parent
    if not parent.is_dir():
        raise InputError(
            f"the output folder {place} cannot be made: {parent} is a file",
            f"{_ELSEWHERE}, or move the file away",
        )
    if not os.access(parent, os.W_OK | os.X_OK, effective_ids=os.access in os.supports_effective_ids):
        raise InputError(
            f"the output folder {place} cannot be made: no right to write in {parent}",
            f"{_ELSEWHERE}, or have the rights changed",
        )


def _replaceable(place: Path) -> bool:
    """Whether a folder is empty, an earlier run's, or gone meanwhile."""
    for _ in range(ATTEMPTS):
        try:
            before = place.stat()
            names = os.listdir(place)
            after = place.stat()
        except FileNotFoundError:
            return True
        if not names or SUMMARY in names:
            return True
        # Another run may have swapped the folder while it was listed, and be deleting what was listed.
        if os.path.samestat(before, after):
            return False
    return True


def _prefix(place: Path, role: str) -> str:
    name = place.name
    if len(os.fsencode(name)) > 200:  # file systems allow 255 bytes
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return f".{name}.lamella-{role}-"


def _clear_up(place: Path) -> None:
    """Remove what killed runs left beside the target; give an output set aside its name back."""
    with contextlib.suppress(OSError):
        left = sorted(place.parent.iterdir())
        for folder in left:
            if folder.name.startswith(_prefix(place, "old")):
                if not place.exists():
                    with contextlib.suppress(OSError):
                        os.rename(folder, place)
                if place.exists():
                    shutil.rmtree(folder, ignore_errors=True)
            elif folder.name.startswith(_prefix(place, "new")):
                lock = lock_folder(folder, wait=False)
                if lock is not None:
                    shutil.rmtree(folder, ignore_errors=True)
                    unlock_folder(lock)


def _make_stage(place: Path, made: list[Path]) -> tuple[Path, int | None]:
    """Make and lock the temporary folder; missing parents made for it are added to ``made``."""
    for _ in range(ATTEMPTS):
        # Another run that fails takes the parents it made away again, at any moment.
        with contextlib.suppress(FileNotFoundError):
            _make_parents(place.parent, made)
            stage = place.parent / (_prefix(place, "new") + secrets.token_hex(6))
            stage.mkdir()
            lock = lock_folder(stage)
            # A run that clears up may have come between the making and the locking.
            if stage.exists():
                return stage, lock
            unlock_folder(lock)
    raise OSError(f"no temporary folder could be made beside {place}")


def _make_parents(parent: Path, made: list[Path]) -> None:
    missing = []
    while not parent.exists():
        missing.append(parent)
        parent = parent.parent
    for folder in reversed(missing):
        with contextlib.suppress(FileExistsError):
            folder.mkdir()
            made.append(folder)


def _swap_in(stage: Path, place: Path) -> None:
    """Put a complete folder in the target's place; what was there may have the stage's name afterwards."""
    for _ in range(ATTEMPTS):
        try:
            os.rename(stage, place)  # a free place, or an empty folder's
            return
        except OSError as error:
            if error.errno not in TAKEN:
                raise
        # Another run may end at the same time: then the target is gone, or back, a moment later.
        with contextlib.suppress(FileNotFoundError):
            _check(place)
            if exchange(stage, place) or _replace_in_two_steps(stage, place):
                return
    raise OSError(f"the output folder {place} could not be replaced: other runs keep replacing it")


def _replace_in_two_steps(stage: Path, place: Path) -> bool:
    """Set the target aside and put the stage in its place; False if another run took the place between."""
    aside = place.parent / (_prefix(place, "old") + secrets.token_hex(6))
    try:
        os.rename(place, aside)
        os.rename(stage, place)
    except BaseException as error:
        if isinstance(error, OSError) and error.errno in TAKEN:
            shutil.rmtree(aside, ignore_errors=True)
            return False
        if not place.exists():
            # Gone where another run has already given it its place back.
            with contextlib.suppress(FileNotFoundError):
                os.rename(aside, place)
        raise
    shutil.rmtree(aside, ignore_errors=True)
    return True

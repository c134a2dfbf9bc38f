"""The output folder of a run: it appears whole or not at all, and takes the place of nothing but a run's own folder.

A run fills a hidden folder beside the target and swaps it in when it is complete. While it works it holds a
lock on that folder; the system lets go of the lock when the run dies, so a later run knows which folders were
left behind. What a user has put into the target before or meanwhile is never touched: the run refuses before it
begins, or leaves its own folder beside the target.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import re
import secrets
import shutil
import stat
import time
from collections.abc import Iterator
from pathlib import Path

from lamella.base.errors import InputError
from lamella.base.wording import cut
from lamella.files.exchange import exchange
from lamella.files.lock import let_go_to_move, lock_folder, on_windows, unlock_folder
from lamella.files.own import MARK, foreign_entries, remove_run, run_files, was_written_by_a_run

ATTEMPTS = 50
TAKEN = (errno.ENOTEMPTY, errno.EEXIST)
WAITS, WAIT = 20, 0.1
"""How often, and how long each time (s), a folder is waited for that Windows does not rename: a scanner may be looking
into files just written."""

MOST_LISTED = 4
_ELSEWHERE = "choose another folder with --out"


def check_target(target: Path) -> Path:
    """Refuse an output folder that a run could not, or should not, replace; writes nothing.

    Parameters
    ----------
    target : Path
        Where the output is to appear; a symbolic link to a folder is followed.

    Returns
    -------
    Path
        The folder that will be written, without links.

    Raises
    ------
    InputError
        If the target is a file, a link that leads nowhere, a mount point, or a folder with anything in it that
        no run wrote, or if it could not be made or replaced where it is.
    """
    try:
        place = _as_stored(target.resolve())
        _check_links(target)
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
        An empty folder beside the target (but for its mark); `lamella.files.own.write_summary` is to write its last
        file, without which it is no run's folder for the next run.

    Raises
    ------
    InputError
        The target cannot be replaced. If that turns out at the end, because of what came into it meanwhile, the
        complete folder is kept beside it; the message has its name.
    """
    place = check_target(target)
    _clear_up(place)
    made: list[Path] = []
    stage: Path | None = None
    lock: int | None = None
    try:
        stage, lock = _make_stage(place, made)
        yield stage
    except BaseException:
        lock = let_go_to_move(lock)
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)
        for folder in reversed(made):
            # Another run may have put something there meanwhile.
            with contextlib.suppress(OSError):
                folder.rmdir()
        raise
    else:
        lock = let_go_to_move(lock)
        _finish(stage, place)
    finally:
        unlock_folder(lock)


def _finish(stage: Path, place: Path) -> None:
    try:
        _mark(stage).unlink()
        _swap_in(stage, place)
    except (OSError, InputError) as error:
        raise _kept_beside(stage, place, error) from error
    except BaseException:
        # whichever of the two folders has this name now
        with contextlib.suppress(OSError):
            _discard(stage)
        raise


def _as_stored(place: Path) -> Path:
    """The path with its last name as the disk has it, where that is the same folder in another case."""
    with contextlib.suppress(OSError):
        names = os.listdir(place.parent)
        if place.name not in names and place.exists():
            alike = [name for name in names if name.casefold() == place.name.casefold()]
            return next((place.with_name(name) for name in alike if place.with_name(name).samefile(place)), place)
    return place


def _check_links(target: Path) -> None:
    """Refuse a path through a link that leads nowhere: what it should lead to is not ours to make."""
    for step in (target, *target.parents):
        if step.is_symlink() and not step.exists():
            raise InputError(
                f"the output folder {target} leads over the link {step}, which leads to nothing",
                f"{_ELSEWHERE}, remove the link, or make the folder {os.path.realpath(step)} first",
            )


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
        _check_content(place)
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


def _check_content(place: Path) -> None:
    """Refuse a folder that holds anything that no run wrote."""
    for _ in range(ATTEMPTS):
        try:
            before = place.stat()
            files = run_files(place)
            foreign = foreign_entries(place, files)
            after = place.stat()
        except FileNotFoundError:
            return
        if not foreign:
            return
        # Another run may have swapped the folder while it was looked at, and be deleting what was listed. A new folder
        # may even have got the number of one just deleted: it differs by its time then.
        if os.path.samestat(before, after) and before.st_ctime_ns == after.st_ctime_ns:
            break
    else:
        raise OSError(f"{place} changes all the time")
    raise _foreign(place, files, foreign)


def _foreign(place: Path, files: dict[str, str] | None, foreign: list[str]) -> InputError:
    listed = ", ".join(cut(name, 60) for name in foreign[:MOST_LISTED])
    if len(foreign) > MOST_LISTED:
        listed += f" and {len(foreign) - MOST_LISTED} more"
    if files is not None:
        return InputError(
            f"the output folder {place} holds what its run did not write: {listed}",
            f"{_ELSEWHERE}, or move {'it' if len(foreign) == 1 else 'them'} away",
        )
    if was_written_by_a_run(place):
        return InputError(
            f"the output folder {place} has a summary.json that was edited, or is of an older version that kept no "
            "list of its files: what in it is yours cannot be told",
            f"{_ELSEWHERE}, or move the folder away",
        )
    return InputError(
        f"the output folder {place} is not empty and is no earlier run's: it holds {listed}",
        f"{_ELSEWHERE}, or empty it",
    )


def _prefix(place: Path, role: str) -> str:
    name = place.name
    if len(os.fsencode(name)) > 200:  # file systems allow 255 bytes
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return f".{name}.lamella-{role}-"


def _beside(place: Path, role: str) -> Path:
    return place.parent / (_prefix(place, role) + secrets.token_hex(6))


def _left_beside(place: Path, role: str) -> list[Path]:
    """Folders that runs have named so, in order."""
    named = re.compile(re.escape(_prefix(place, role)) + "[0-9a-f]{12}")
    with contextlib.suppress(OSError):
        return sorted(path for path in place.parent.iterdir() if named.fullmatch(path.name) and not path.is_symlink())
    return []


def _clear_up(place: Path) -> None:
    """Remove what killed runs left beside the target; give an output set aside its name back.

    A name alone is no proof: only folders with a run's mark or list in them are touched, and empty ones.
    """
    for folder in _left_beside(place, "old"):
        with contextlib.suppress(OSError):
            if not os.path.lexists(place) and run_files(folder) is not None:
                os.rename(folder, place)
            else:
                _discard(folder)
    for folder in _left_beside(place, "new"):
        lock = lock_folder(folder, _mark(folder), wait=False)
        if lock is not None:
            lock = let_go_to_move(lock)
            with contextlib.suppress(OSError):
                if os.path.lexists(_mark(folder)):
                    _remove_marked(folder)
                else:
                    _discard(folder)
            unlock_folder(lock)


def _mark(stage: Path) -> Path:
    """The file that marks a folder as being filled: it repeats the folder's own number, so that no copy has it."""
    return stage / (MARK + stage.name[-12:])


def _remove_marked(folder: Path) -> None:
    """Remove a folder that a killed run was filling; the mark goes last, so that a kill leaves it to the next run."""
    for entry in os.scandir(folder):
        if entry.name != _mark(folder).name:
            if entry.is_dir(follow_symlinks=False):
                shutil.rmtree(entry.path)
            else:
                os.unlink(entry.path)
    _mark(folder).unlink()
    folder.rmdir()


def _discard(folder: Path) -> None:
    """Remove a run's complete folder, or an empty one; anything else stays."""
    files = run_files(folder)
    if not foreign_entries(folder, files):
        remove_run(folder, files or {})


def _make_stage(place: Path, made: list[Path]) -> tuple[Path, int | None]:
    """Make, lock and mark the temporary folder; missing parents made for it are added to ``made``."""
    for _ in range(ATTEMPTS):
        # Another run that fails takes the parents it made away again, at any moment.
        with contextlib.suppress(FileNotFoundError):
            _make_parents(place.parent, made)
            stage = _beside(place, "new")
            stage.mkdir()
            lock = lock_folder(stage, _mark(stage))
            # A run that clears up may have come between the making and the locking.
            if stage.exists():
                _mark(stage).touch()
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
    """Put a complete folder in the target's place, and discard the run's folder that was there.

    Raises
    ------
    InputError
        Something that no run wrote is there; it has its place still.
    """
    for _ in range(ATTEMPTS):
        try:
            _rename(stage, place)  # a free place, or an empty folder's
            return
        except OSError as error:
            if error.errno not in TAKEN:
                raise
        # Another run may end at the same time: then the target is gone, or back, a moment later.
        with contextlib.suppress(FileNotFoundError):
            _check(place)
            if _exchanged(stage, place) or _replace_in_two_steps(stage, place):
                return
    raise OSError(f"the output folder {place} could not be replaced: other runs keep replacing it")


def _rename(folder: Path, name: Path) -> None:
    for left in reversed(range(WAITS)):
        try:
            os.rename(folder, name)
            return
        except PermissionError:
            if not left or not on_windows():
                raise
        time.sleep(WAIT)


def _exchanged(stage: Path, place: Path) -> bool:
    """Swap both in one step; False where that cannot be done."""
    if not exchange(stage, place):
        return False
    try:
        # nobody finds it under its hidden name, so what is in it now is all
        _check_content(stage)
    except InputError:
        exchange(stage, place)
        raise
    with contextlib.suppress(OSError):
        _discard(stage)
    return True


def _replace_in_two_steps(stage: Path, place: Path) -> bool:
    """Set the target aside and put the stage in its place; False if another run took the place between."""
    aside = _beside(place, "old")
    try:
        _rename(place, aside)
        _check_content(aside)
        _rename(stage, place)
    except BaseException as error:
        if isinstance(error, OSError) and error.errno in TAKEN:
            _discard(aside)
            return False
        if not place.exists():
            # Gone where another run has already given it its place back.
            with contextlib.suppress(FileNotFoundError):
                os.rename(aside, place)
        raise
    with contextlib.suppress(OSError):
        _discard(aside)
    return True


def _kept_beside(stage: Path, place: Path, error: OSError | InputError) -> InputError:
    """Give a complete folder that cannot take its place a name beside it, and say so: hours may have gone into it."""
    kept = stage
    for number in range(2, 1000):
        free = place.with_name(f"{place.name}-{number}")
        if not os.path.lexists(free):
            with contextlib.suppress(OSError):
                os.rename(stage, free)
                kept = free
                break
    reason = error.message if isinstance(error, InputError) else f"{place}: {error.strerror or error}"
    return InputError(
        f"{reason}. That came while the run worked; its files are complete in {kept}",
        f"take them from there, or clear {place} and run again",
    )

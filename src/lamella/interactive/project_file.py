"""The project file of a session: its bytes as text and back, what was saved last, and the copy kept beside it."""

from __future__ import annotations

from pathlib import Path

from lamella.base.errors import InputError
from lamella.files.whole import write_whole
from lamella.project.read import PROJECT_BYTES_MAX

_MARK = "\ufeff"


class ProjectFile:
    """A project file, whether it is there already or not.

    Attributes
    ----------
    path : Path
    saved : str or None
        Its text when it was read or written last; None: it is not there yet.
    """

    def __init__(self, path: Path, *, is_new: bool = False) -> None:
        self.path = path
        self.saved = None if is_new else self._read()

    def _read(self) -> str:
        try:
            with self.path.open("rb") as file:
                raw = file.read(PROJECT_BYTES_MAX + 1)
        except FileNotFoundError:
            raise InputError(
                f"{self.path}: no such file", "check the path, or leave it out for a new project"
            ) from None
        if len(raw) > PROJECT_BYTES_MAX:
            raise InputError(f"{self.path}: more than {PROJECT_BYTES_MAX / 1e6:g} MB long", "no project file is")
        try:
            # line ends and a byte order mark stay: what is undone to is what was there, to the byte
            return raw.decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(
                f"{self.path}: not a text file in UTF-8 (byte {error.start})", "save it as UTF-8"
            ) from None

    @property
    def autosave(self) -> Path:
        """Where unsaved changes are kept: beside the file."""
        return self.path.with_name(f".{self.path.name}.autosave")

    def save(self, text: str, *, anyway: bool = False) -> None:
        """Write the text.

        Raises
        ------
        InputError
            Somebody else has changed the file since.
        """
        there = self._read() if self.path.exists() else None
        if not anyway and there is not None and there not in (self.saved, text):
            raise InputError(
                f"{self.path.name} has been changed by another program since it was read",
                "save under another name, or save anyway",
                "changed",
            )
        write_whole(self.path, text.encode())
        self.saved = text
        self.autosave.unlink(missing_ok=True)

    def keep(self, text: str) -> None:
        """Keep unsaved text beside the file; nothing is kept of what is saved."""
        if text == self.saved:
            self.autosave.unlink(missing_ok=True)
        else:
            write_whole(self.autosave, text.encode())

    def kept(self) -> str | None:
        """Text that an earlier session left unsaved."""
        try:
            text = self.autosave.read_bytes()[: PROJECT_BYTES_MAX + 1].decode("utf-8")
        except (OSError, ValueError):
            return None
        return text if text != self.saved else None


def unmarked_text(text: str) -> str:
    """The text without a byte order mark, as TOML readers want it."""
    return text.removeprefix(_MARK)

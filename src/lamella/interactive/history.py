"""The project's text through time: undo and redo, to the byte."""

from __future__ import annotations

# of them are kept
TEXTS_MAX = 1000


class History:
    """Texts one after the other, and which of them is the present one."""

    def __init__(self, text: str) -> None:
        self._texts, self._at = [text], 0

    @property
    def text(self) -> str:
        """The present one."""
        return self._texts[self._at]

    @property
    def can_undo(self) -> bool:
        """Whether there is one before it."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Whether one behind it was left by undoing."""
        return self._at + 1 < len(self._texts)

    def put(self, text: str) -> None:
        """A new text; those that were undone are gone."""
        if text == self.text:
            return
        self._texts = [*self._texts[: self._at + 1], text][-TEXTS_MAX:]
        self._at = len(self._texts) - 1

    def undo(self) -> None:
        """Back by one."""
        self._at = max(self._at - 1, 0)

    def redo(self) -> None:
        """Forth by one."""
        self._at = min(self._at + 1, len(self._texts) - 1)

"""The one exception a user is meant to read."""

from __future__ import annotations

import math

from lamella.base.wording import readable


class InputError(ValueError):
    """Something the user can mend: what is wrong, the value, the limit and the remedy, in one message.

    The command line prints the message on stderr and exits with 2; nothing has been written by then.

    Parameters
    ----------
    message : str
        What is wrong, with the value and the limit.
    remedy : str, optional
        What to change.
    where : str, optional
        What the message is about, put in front: the parameter of the function that raises it, or a part of it
        (`loops[1]`); where a project was read, its file and key.

    Examples
    --------
    >>> import lamella
    >>> try:
    ...     lamella.circle((0, 0, 0), -1.0)
    ... except lamella.InputError as error:
    ...     print(error)
    radius: radius = -1.0 is out of range
      remedy: radius has to be a finite number above 0
    """

    def __init__(self, message: str, remedy: str = "", where: str = "") -> None:
        self.message, self.remedy, self.where = (readable(text) for text in (message, remedy, where))
        super().__init__(f"{self.where}: {self.message}" if where else self.message)

    def __str__(self) -> str:
        head = f"{self.where}: {self.message}" if self.where else self.message
        return f"{head}\n  remedy: {self.remedy}" if self.remedy else head


def require_positive(**values: float) -> None:
    """Raise an `InputError` naming the first value that is not a finite number above 0."""
    for name, value in values.items():
        if not (isinstance(value, int | float) and math.isfinite(value) and value > 0):
            raise InputError(f"{name} = {value!r} is out of range", f"{name} has to be a finite number above 0", name)

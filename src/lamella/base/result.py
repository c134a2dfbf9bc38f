"""What every result can do: print in a line, show itself in a notebook, be compared, be pickled without its caches."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from lamella.base.onward import onward

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Lean:
    """Objects whose cached properties are left out of pickles and copies, and computed again where they are needed.

    Pickles are as small as what the object is made of, and hold no solver's or search tree's memory.
    """

    def __getstate__(self) -> dict[str, Any]:
        own = type(self)
        return {k: v for k, v in vars(self).items() if not isinstance(getattr(own, k, None), cached_property)}


class Result(Lean):
    """What every result is: it prints in a line, pickles and copies without its caches, and is compared by `allclose`.

    Results are frozen; `==` asks whether two are the same object. A class gives `_line`, what is printed between the
    brackets behind its name.
    """

    def _line(self) -> str:
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._line()})"

    def allclose(self, other: object, tolerance: float = 1e-9) -> bool:
        """Whether another result is the same up to rounding.

        Parameters
        ----------
        other : object
        tolerance : float
            Largest difference of two numbers, as a share of the largest number of their array, or of 1 where that is
            less. Whole numbers, names and shapes have to be equal.

        Examples
        --------
        >>> import lamella
        >>> roof = lamella.Catenoid(2.5, (-2.0, 3.0))
        >>> roof.allclose(lamella.Catenoid(2.5 + 1e-12, (-2.0, 3.0)))
        True
        >>> roof.allclose(lamella.Catenoid(2.6, (-2.0, 3.0)))
        False
        """
        from lamella.base.compare import close

        return close(self, other, tolerance)


class Shown(Result):
    """A result with a picture: in a notebook, and by `plot`.

    Examples
    --------
    >>> import lamella
    >>> lamella.circle((0, 0, 0), 2.0)._repr_html_()[:9]
    '<div><svg'
    """

    def _repr_html_(self) -> str:
        """What it prints below a picture, as notebooks show it."""
        html: str = onward("lamella.view.sketch.html")(self)
        return html

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """A picture of it by matplotlib (``pip install lamella[pictures]``), in perspective or flat where it is flat.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw, axes of two dimensions; those of a new figure when not given.
        **options
            `view`, azimuth and elevation of the eye, degrees; of nets and strips also `colour`, see
            `lamella.view.picture.draw`.

        Returns
        -------
        matplotlib Axes

        Raises
        ------
        InputError
            matplotlib is not installed; an unknown colour.
        """
        axes: Axes = onward("lamella.view.plot.plot")(self, ax, **options)
        return axes

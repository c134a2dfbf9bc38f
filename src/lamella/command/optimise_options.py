"""What can be wished of `lamella optimise`, and of which problem. Light: --help reads it."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from pathlib import Path

from lamella.base.errors import InputError

ALWAYS = ("iterations", "tolerance")
USED: dict[str, tuple[str, ...]] = {
    "asymptotic": ("angle", "form"),
    "sphere-stars": ("radius", "angle", "form"),
    "angle": ("angle", "radius", "form"),
    "straighten": ("surface",),
    "deform": ("driver", "open_driver", "radius"),
    "planar": ("height", "surface", "rounds"),
}
"""Options each problem makes use of, besides `ALWAYS`."""

LARGEST_TOLERANCE = 0.01

NEEDED: dict[str, tuple[str, str]] = {
    "angle": ("angle", "say the angle: --angle 80"),
    "deform": ("driver", "name a vertex of the ring and the ring's size at the end: --driver 42=0.9"),
    "planar": ("height", "say how high the strips are, m: --height 0.1"),
}


@dataclass(frozen=True, kw_only=True)
class Options:
    """Options of a problem; None: as the problem does it by itself.

    Attributes
    ----------
    radius : float
        Of the stars' spheres, m; infinite: planes.
    angle : float
        Between polylines, degrees.
    form : str
        See `lamella.projection.problems.crossing.AngleForm`.
    driver : ((k,) int, float)
        Ring to drive, one vertex or all, counted from 0, and its size at the end over that at the start.
    open_driver : bool
        Whether the ring's ends are apart.
    surface : Path
        Project file with the reference surface.
    height : float
        Of strips, m; below 0: to the other side.
    rounds, iterations : int
    tolerance : float
    """

    radius: float | None = None
    angle: float | None = None
    form: str | None = None
    driver: tuple[tuple[int, ...], float] | None = None
    open_driver: bool | None = None
    surface: Path | None = None
    height: float | None = None
    rounds: int | None = None
    iterations: int | None = None
    tolerance: float | None = None

    def check(self, problem: str) -> None:
        """Raise `InputError` for an unknown problem, and for wishes it lacks or has no use for."""
        if problem not in USED:
            raise InputError(f"--as {problem} is not known", f"one of {', '.join(USED)}")
        for field in fields(self):
            value = getattr(self, field.name)
            if value is None:
                continue
            option = "--" + field.name.replace("_", "-")
            if field.name not in (*USED[problem], *ALWAYS):
                users = [name for name, used in USED.items() if field.name in used]
                raise InputError(f"{option} is of no use to --as {problem}", f"leave it out; {', '.join(users)} use it")
            if isinstance(value, float) and (math.isnan(value) or (math.isinf(value) and field.name != "radius")):
                raise InputError(f"{option} {value} is no number", "give a finite number")
        needed, remedy = NEEDED.get(problem, ("", ""))
        if needed and getattr(self, needed) is None:
            raise InputError(f"--as {problem} needs --{needed}", remedy)
        if self.rounds is not None and not 1 <= self.rounds <= 5:
            raise InputError(f"--rounds {self.rounds} is out of range", "from 1 to 5; each doubles the rulings")
        if self.radius is not None and not self.radius > 0:
            raise InputError(f"--radius {self.radius:g} is out of range", "above 0; inf: planes")
        if self.angle is not None and not 10 <= self.angle <= 170:
            raise InputError(f"--angle {self.angle:g} is out of range", "between 10 and 170 degrees")
        if self.height == 0:
            raise InputError("--height 0 is out of range", "the height of the strips, m; below 0: to the other side")
        if self.tolerance is not None and not 0 < self.tolerance <= LARGEST_TOLERANCE:
            raise InputError(
                f"--tolerance {self.tolerance:g} is out of range", f"above 0 and at most {LARGEST_TOLERANCE:g} edges"
            )
        if self.iterations is not None and not 1 <= self.iterations <= 10_000:
            raise InputError(f"--iterations {self.iterations} is out of range", "from 1 to 10,000")


def driver_of(text: str) -> tuple[tuple[int, ...], float]:
    """Read VERTEX[,VERTEX...]=SHARE.

    Raises
    ------
    InputError
        It reads otherwise.
    """
    vertices, equals, share = text.partition("=")
    try:
        if not equals:
            raise ValueError
        return tuple(int(word) for word in vertices.split(",")), float(share)
    except ValueError:
        raise InputError(
            f"--driver {text!r} does not read VERTEX[,VERTEX...]=SHARE",
            "42=0.9 shrinks the ring through vertex 42 by 10 %; 42=0.8 by 20 %",
        ) from None

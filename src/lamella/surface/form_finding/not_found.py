"""What a search that found no film tells: how far it went, and what may be tried."""

from __future__ import annotations

from lamella.base.errors import InputError
from lamella.base.progress import Report
from lamella.base.wording import rounded
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.first_film import FirstFilm
from lamella.surface.form_finding.nearest_existing import Tries
from lamella.surface.form_finding.necessary_conditions import ImpossibleError
from lamella.surface.form_finding.search_error import SearchError

# no bound says that there is no such surface: the search alone ended
MAY_EXIST = "no bound is broken, so that there may be one"
# of the volume at which the films followed turn back, what is offered: next to a fold films are found with difficulty
NEXT_TO_FOLD = 0.98


def not_found(
    search: FirstFilm,
    error: SearchError,
    mean_curvature: float,
    volume: float | None,
    unstable: bool,
    tries: Tries,
) -> InputError:
    """The error of a search for a mean curvature (1/m), or for a volume (m^3), that ended without a film."""
    how = "; ".join(error.reasons) or "Newton's method did not arrive from any start"
    went = f"{how} ({error.steps} Newton steps)"
    if volume is not None:
        return _no_volume(search, went, volume)
    wanted = f"mean_curvature = {mean_curvature:.6g} 1/m"
    if unstable:
        return InputError(
            f"{wanted}: the search did not arrive at an unstable surface; {MAY_EXIST}. {went}",
            'leave branch out, or write branch = "stable"',
            "branch",
        )
    if search.unstable:
        inside = enclosed_volume(search.unstable.film)
        return InputError(
            f"{wanted}: there is an unstable surface ({search.unstable.negative} negative eigenvalues of its second "
            f"variation: a soap film would leave it), but the search did not arrive at a stable one. {went}",
            f'write branch = "unstable" to take it, or give a volume instead (its own is {inside:.6g} m3)',
            "branch",
        )
    if not mean_curvature:
        return InputError(
            f"the search did not arrive at a surface in this boundary; {MAY_EXIST}. {went}",
            _of_vault(tries, error.fold)
            if any(loop.slides for loop in search.loops)
            else _of_tube(tries, 0.0) or "bring the loops closer together, or make them less bent",
            "loops",
        )
    if _again(search).exists(-mean_curvature):
        return InputError(
            f"{wanted}: the search did not arrive at a surface, but there is one of {-mean_curvature:.6g} 1/m. The "
            "surface bends towards its normal where H is above 0, and the normal follows the first loop by the "
            "right-hand rule",
            f"write mean_curvature = {-mean_curvature:.6g}, or reverse the first loop",
            "mean_curvature",
        )
    near = tries.nearest_curvature(mean_curvature, error.fold)
    if near is not None:
        return InputError(
            f"{wanted}: the search did not arrive at a stable surface that bends that much; {MAY_EXIST}. {went}",
            _smaller(near, mean_curvature),
            "mean_curvature",
        )
    return InputError(
        f"{wanted}: the search did not arrive at a surface; {MAY_EXIST}. {went}",
        _of_tube(tries, mean_curvature) or "give a volume instead: more films can be followed by their volume",
        "mean_curvature",
    )


def impossible(error: ImpossibleError, tries: Tries, mean_curvature: float, unstable: bool) -> InputError:
    """The error of a bound that is broken, with what exists instead."""
    if error.where == "branch":
        value = tries.curvature_of_bubble()
        other = "" if value is None else f", or write mean_curvature = {value:g}"
        return InputError(error.message, f"leave branch out{other}", error.where)
    if not mean_curvature:
        remedy = _of_tube(tries, 0.0, error.limit) or "move the loops closer together, or make them larger"
        return InputError(error.message, remedy, error.where)
    largest = abs(error.limit or mean_curvature)
    wanted = min(abs(mean_curvature), largest) * (1 if mean_curvature > 0 else -1)
    near = None if unstable else tries.nearest_curvature(wanted)
    remedy = _smaller(near, mean_curvature) if near else "choose a mean_curvature nearer to 0, or a smaller boundary"
    return InputError(error.message, remedy, error.where)


def _smaller(near: float, wanted: float) -> str:
    """Less H, or by similarity a smaller boundary."""
    scale = rounded(abs(near / wanted), up=False)
    return f"write mean_curvature = {near:g}, the largest of which a film was found, or a boundary {scale:g} x as large"


def _of_vault(tries: Tries, fold: float | None) -> str:
    """A film under pressure where a boundary slides, if one was found."""
    value = tries.curvature_beyond(fold)
    given = "give a mean_curvature or a volume" if value is None else f"write mean_curvature = {value:g}"
    return f"{given}, or bring the held parts closer together"


def _of_tube(tries: Tries, mean_curvature: float, limit: float | None = None) -> str:
    """A tube under another pressure, or a shorter one; empty: neither was found."""
    value, distance = tries.curvature_of_tube(), tries.closer(mean_curvature, limit)
    ways = [f"write mean_curvature = {value:g}: a tube under pressure"] if value is not None else []
    if distance is not None:
        ways.append(f"move the loops along the line between their middles until these are {distance:g} m apart")
    return ", or ".join(ways)


def _again(search: FirstFilm) -> FirstFilm:
    search.progress(Report.detail("the other sign is tried"))
    return FirstFilm(search.loops, search.order, search.progress)


def _no_volume(search: FirstFilm, went: str, volume: float) -> InputError:
    wanted = f"volume = {volume:.6g} m3"
    if len(search.loops) > 1 or any(loop.slides for loop in search.loops):
        try:
            _again(search).of_volume(-volume)
        except SearchError:
            pass
        else:
            return InputError(
                f"{wanted}: the search did not arrive at a surface, but there is one of {-volume:.6g} m3. It is "
                "above 0 where the normal points out of it, and the normal follows the first loop by the right-hand "
                "rule",
                f"write volume = {-volume:.6g}, or reverse the first loop",
                "volume",
            )
    if search.most is not None:
        return InputError(
            f"{wanted}: the search did not arrive at a surface. {went}",
            f"choose a volume of up to {NEXT_TO_FOLD * search.most:.3g} m3 in size",
            "volume",
        )
    return InputError(
        f"{wanted}: the search did not arrive at a surface; {MAY_EXIST}. {went}",
        "choose a volume nearer to that of a film that is found"
        + (
            " (a run with mean_curvature = 0 tells one)"
            if search.calm
            else ", or bring the held curves closer together"
        )
        + "; it is above 0 where the normal points out of it",
        "volume",
    )

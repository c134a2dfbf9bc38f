"""A film that follows changes of its boundary, its mean curvature or its volume, on elements that it keeps.

A changed film costs one factorisation and some chord steps on the elements at hand; where these do not hold for it,
they are made anew, and the film says why. On given elements a film depends on its boundary alone, not on those before
it (`lamella.surface.form_finding.reference_film`), and wherever the first elements hold it is found on these: after any
changes and back it is the first film, to the last digit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

from numpy.typing import ArrayLike

from lamella.base.drawing_origin import NOWHERE, Origin, origin_figure, reported_from
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.result import Result
from lamella.surface.boundary.checks import check_corner_count, check_loops
from lamella.surface.boundary.curve import Loop
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.adaptivity import Deviation, deviation_of
from lamella.surface.form_finding.carried_rim import NotKeptError
from lamella.surface.form_finding.chord import settled
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.find import Found, find_film, notes_on, remarks_on
from lamella.surface.form_finding.found_film import surface_of
from lamella.surface.form_finding.given_loops import given_loops, refuse_both
from lamella.surface.form_finding.kept_elements import Boundary, Kept, kept
from lamella.surface.form_finding.newton import Equilibrium, FixedH, Volume, find_equilibrium
from lamella.surface.form_finding.reference_film import ReferenceFilm
from lamella.surface.form_finding.refinement import adapted
from lamella.surface.form_finding.stability import stability_of


@dataclass(frozen=True)
class FilmRequest:
    """How a film is found, whatever its boundary.

    Attributes
    ----------
    order, tolerance, branch, most_nodes
        See `lamella.surface.form_finding.find.find_film`.
    leeway : float
        Times the tolerance, up to which |H - H0| may come before elements are made anew.
    """

    order: int = 4
    tolerance: float = 2e-3
    branch: Literal["stable", "unstable"] = "stable"
    most_nodes: int = 100_000
    leeway: float = 5.0


@dataclass(frozen=True, eq=False, repr=False)
class FollowedFilm(Result):
    """A film, and what films of other boundaries take over from it.

    Attributes
    ----------
    request : FilmRequest
    boundary : Boundary
        Loops, the outer one first, measured from `origin`; H or volume.
    equilibrium : Equilibrium
        The film.
    deviation : Deviation
        How far its mean curvature is off.
    made_anew : str
        Why the elements of the film before it were not kept; empty: they were, or it is the first film.
    factorisations : int
        Factorisations it took; 0 where its elements were made anew.
    elements : ReferenceFilm or None
        What its elements were made for; None: they serve no other film (a loop slides).
    home : ReferenceFilm or None
        The same of the first film.
    origin : (x, y, z)
        Point of the drawing that loops and film are measured from, m.

    Examples
    --------
    A soap film blown up to a bubble:

    >>> import lamella
    >>> flat = lamella.follow(lamella.circle((0, 0, 0), 1.0), tolerance=0.02)
    >>> bubble = flat.at(volume=0.5)
    >>> print(f"H = {bubble.equilibrium.mean_curvature:.4f} 1/m, {bubble.surface.volume():.4f} m3")
    H = -0.5634 1/m, 0.5000 m3
    """

    request: FilmRequest
    boundary: Boundary
    equilibrium: Equilibrium
    deviation: Deviation
    made_anew: str
    factorisations: int
    elements: ReferenceFilm | None
    home: ReferenceFilm | None
    origin: Origin = NOWHERE

    @classmethod
    def first(
        cls, boundary: Boundary, request: FilmRequest, *, origin: Origin = NOWHERE, progress: Progress = silent
    ) -> FollowedFilm:
        """The film of a boundary from nothing.

        Parameters
        ----------
        boundary : Boundary
            Loops that are checked, measured from `origin`.
        request : FilmRequest
        origin : (x, y, z), optional
        progress : callable

        Raises
        ------
        InputError
            See `lamella.surface.form_finding.find.find_film`.
        """
        found = find_film(
            boundary.loops,
            boundary.mean_curvature,
            volume=boundary.volume,
            order=request.order,
            tolerance=request.tolerance,
            branch=request.branch,
            most_nodes=request.most_nodes,
            progress=progress,
        )
        return cls._of(found.equilibrium, boundary, request, origin)

    @classmethod
    def _of(cls, here: Equilibrium, boundary: Boundary, request: FilmRequest, origin: Origin) -> FollowedFilm:
        """A film on elements of its own."""
        try:
            elements = _reference(here, boundary)
            there = kept(elements, boundary, request.tolerance, request.leeway)
        except NotKeptError:
            deviation = deviation_of(here.film, here.mean_curvature)
            return cls(request, boundary, here, deviation, "", 0, None, None, origin=origin)
        return cls(request, boundary, there.equilibrium, there.deviation, "", 0, elements, elements, origin=origin)

    def refined(self, tolerance: float, *, progress: Progress = silent) -> FollowedFilm:
        """The same film as the first one of others to another tolerance, on elements that are made from those at hand.

        Parameters
        ----------
        tolerance : float
            See `lamella.surface.form_finding.find.find_film`.
        progress : callable

        Raises
        ------
        InputError
            See `lamella.surface.form_finding.refinement.adapted`.
        """
        here, volume = self.equilibrium, self.boundary.volume

        def settled(film: Film) -> Equilibrium:
            if volume is None:
                stable = self.request.branch == "stable"
                return find_equilibrium(film, here.mean_curvature, FixedH(stable=stable), progress=progress)
            missing = Volume(volume - enclosed_volume(film))
            return find_equilibrium(film, here.mean_curvature, missing, progress=progress)

        found = adapted(here, settled, tolerance, self.request.most_nodes, here.steps, True, progress)
        request = replace(self.request, tolerance=tolerance)
        return FollowedFilm._of(found.equilibrium, self.boundary, request, self.origin)

    def moved(self, boundary: Boundary, *, anew: bool = True, progress: Progress = silent) -> FollowedFilm:
        """The film of another boundary.

        Parameters
        ----------
        boundary : Boundary
            Loops that are checked, measured from `origin`.
        anew : bool
            Whether elements that do not hold are made anew, from nothing.
        progress : callable

        Raises
        ------
        NotKeptError
            Elements do not hold, and none shall be made.
        InputError
            There is no such film, or none was found.
        """
        reason = "its boundary slides"
        for elements in dict.fromkeys((self.home, self.elements)):
            if elements is None:
                continue
            try:
                there = kept(elements, boundary, self.request.tolerance, self.request.leeway)
            except NotKeptError as error:
                reason = str(error)
            else:
                return self._on(elements, boundary, there)
        if not anew:
            raise NotKeptError(reason)
        progress(Report.step(f"elements made anew: {reason}"))
        fresh = FollowedFilm.first(boundary, self.request, origin=self.origin, progress=progress)
        return replace(fresh, made_anew=reason, home=self.home or fresh.home)

    def at(
        self,
        loops: Sequence[Loop | ArrayLike] | Loop | None = None,
        mean_curvature: float | None = None,
        *,
        volume: float | None = None,
        progress: Progress = silent,
    ) -> FollowedFilm:
        """The film of another boundary, mean curvature or volume; this one stays as it is.

        Parameters
        ----------
        loops : sequence of Loop, optional
            As for `lamella.follow`; the present ones when not given.
        mean_curvature : float, optional
            H, 1/m; as before when neither it nor a volume is given.
        volume : float, optional
            m^3, see `lamella.film`.
        progress : callable
            Is called with what is done where elements are made anew.

        Raises
        ------
        InputError
            There is no such film, or none was found; loops that cross or touch.
        """
        curves = self.boundary.loops if loops is None else given_loops(loops, self.origin)[0]
        boundary = self.boundary._replace(loops=curves)
        if mean_curvature is not None or volume is not None:
            boundary = _boundary(curves, mean_curvature or 0.0, volume)
        with reported_from(self.origin):
            if loops is not None:
                _check(curves, self.request)
            return self.moved(boundary, progress=progress)

    def _on(self, elements: ReferenceFilm, boundary: Boundary, there: Kept) -> FollowedFilm:
        return replace(
            self,
            boundary=boundary,
            equilibrium=there.equilibrium,
            deviation=there.deviation,
            made_anew="",
            factorisations=there.factorisations,
            elements=elements,
        )

    @cached_property
    def found(self) -> Found:
        """The film with its stability, as `find_film` gives it."""
        here = self.equilibrium
        verdict = stability_of(here.film, here.mean_curvature)
        return Found(here, verdict, self.deviation.largest, self.deviation.scale, here.steps, True)

    @cached_property
    def surface(self) -> ElementSurface:
        """The film as nets are made on it; it is not asked whether it is stable (`assessed`)."""
        connectivity, deviation = self.equilibrium.film.connectivity, self.deviation
        figures = {
            "order": connectivity.basis.order,
            "surface_nodes": connectivity.node_count,
            "elements": len(connectivity.elements),
            "curvature_scale": deviation.scale,
            "mean_curvature_deviation": deviation.largest,
            "mean_curvature_deviation_max": deviation.largest * deviation.scale,
            "tolerance": self.request.tolerance,
        }
        return surface_of(self.equilibrium, "form-found", figures | origin_figure(self.origin))

    @cached_property
    def assessed(self) -> ElementSurface:
        """The same surface with its stability, and with what to know before building it, as `lamella.film` gives it."""
        boundary = self.boundary
        notes = remarks_on(boundary.loops) + notes_on(self.found, given_curvature=boundary.volume is None)
        return self.found.surface("form-found", notes, tolerance=self.request.tolerance, **origin_figure(self.origin))

    def _line(self) -> str:
        connectivity = self.equilibrium.film.connectivity
        return (
            f"H = {self.equilibrium.mean_curvature:.6g} 1/m, {len(connectivity.elements):,} elements "
            f"{'made anew' if self.made_anew else 'kept' if self.factorisations else 'of its own'}, "
            f"{connectivity.node_count:,} nodes"
        )


def follow(
    loops: Sequence[Loop | ArrayLike] | Loop,
    mean_curvature: float = 0.0,
    *,
    volume: float | None = None,
    tolerance: float = 2e-3,
    order: int = 4,
    branch: Literal["stable", "unstable"] = "stable",
    most_nodes: int = 100_000,
    leeway: float = 5.0,
    progress: Progress = silent,
) -> FollowedFilm:
    """A film that follows changes of its boundary, its mean curvature or its volume.

    Parameters
    ----------
    loops, mean_curvature, volume, tolerance, order, branch, most_nodes, progress
        See `lamella.film`.
    leeway : float
        Times the tolerance, up to which |H - H0| may come before elements are made anew: `deviation` tells how far it
        came.

    Returns
    -------
    FollowedFilm
        `surface` is the film, `assessed` the same with its stability; `at` follows it.

    Raises
    ------
    InputError
        See `lamella.film`.

    Examples
    --------
    A ring drawn away from another one, on the same elements:

    >>> import lamella
    >>> base = lamella.circle((0, 0, 0), 3.0)
    >>> film = lamella.follow([base, lamella.circle((0, 0, 3.0), 3.0)], tolerance=0.02)
    >>> for height in (3.1, 3.2):
    ...     film = film.at([base, lamella.circle((0, 0, height), 3.0)])
    >>> places, nearest = film.surface.closest([[2.0, 0.0, 1.6]])
    >>> print(f"{nearest[0, 0]:.3f} m, made anew: {film.made_anew or 'no'}")
    2.461 m, made anew: no
    """
    if not leeway >= 1:
        raise InputError(f"leeway = {leeway:g} is below 1", "write 1 or more", "leeway")
    request = FilmRequest(order, tolerance, branch, most_nodes, leeway)
    curves, origin = given_loops(loops)
    boundary = _boundary(curves, mean_curvature, volume)
    with reported_from(origin):
        _check(curves, request)
        return FollowedFilm.first(boundary, request, origin=origin, progress=progress)


def _boundary(loops: tuple[Loop, ...], mean_curvature: float, volume: float | None) -> Boundary:
    """What a film is found from; H and a volume are not both given."""
    refuse_both(mean_curvature, volume)
    return Boundary(loops, mean_curvature, volume)


def _check(loops: tuple[Loop, ...], request: FilmRequest) -> None:
    """Refuse loops that are no boundary."""
    check_loops(loops)
    check_corner_count(loops, request.most_nodes, request.tolerance)


def _reference(found: Equilibrium, boundary: Boundary) -> ReferenceFilm:
    """A found film as the reference of others.

    Newton's method ends where the film is in equilibrium along the directions that it took last. Along the normals it
    has now, that is next to it, by what the elements are off.
    """
    film, curvature = found.film, found.mean_curvature
    if any(loop.slides for loop in boundary.loops):
        raise NotKeptError("a loop slides")
    bare = ReferenceFilm(film, boundary.loops, film.directions(), curvature, found.negative, 0.0)
    there = settled(bare, film, curvature, boundary.volume)
    return replace(
        bare,
        film=there.film,
        mean_curvature=there.mean_curvature,
        negative=there.factored.negative,
        deviation=deviation_of(there.film, there.mean_curvature).weighted,
    )

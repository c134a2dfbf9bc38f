"""Frames while something is dragged: a film on coarse elements that follows the one before, and the net's lines.

What is kept from frame to frame: elements and their places, symbolic factors, the film that others are found from, the
elements to integrate on, the cut, the signs of roots, the lattice (`lamella.follow`, `lamella.follow_net`). A frame
costs one factorisation for the film and one for the net; it depends on the project alone, not on those in between.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, reported_from
from lamella.base.errors import InputError
from lamella.base.progress import Progress
from lamella.base.vectors import lengths
from lamella.interactive.frame import Frame, line_arrays
from lamella.interactive.net_misses import NetMisses
from lamella.interactive.point_stresses import line_utilisation
from lamella.interactive.warm_scene import closing_shown, line_layers, surface_layer
from lamella.network.density_request import DensityRequest
from lamella.network.elements.followed_net import FollowedNet, NetRequest
from lamella.network.streamlines.applicability import is_traced
from lamella.project.tables import FormFoundTable, Project
from lamella.stages.keys import keys
from lamella.stages.pattern_of_table import pattern_of
from lamella.stages.section_of_table import section_of
from lamella.stages.surface.boundary_of_tables import boundary_loops, with_origin
from lamella.stages.surface.surface_of_table import followed_film
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.sampling import sampled_places
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.followed_film import FollowedFilm
from lamella.surface.umbilic import umbilic_reason
from lamella.view.scene.scene import Shown, make_scene

# tolerance of films that are dragged, at least: about 1,400 nodes
WARM_TOLERANCE = 3e-2
# parts of an element's edge that are drawn
EDGE_PARTS = 4


class WarmFrames:
    """Frames of one project after the other, each from the one before."""

    def __init__(self) -> None:
        self._film: FollowedFilm | None = None
        self._net: FollowedNet | None = None
        self._misses = NetMisses()
        self._drawn: tuple[Connectivity, Any, Integers] | None = None

    @staticmethod
    def serves(project: Project) -> bool:
        """Whether the surface of a project is one that follows its boundary: a film of constant mean curvature."""
        return isinstance(project.surface, FormFoundTable) and project.network.angle == 90

    def frame(self, project: Project, folder: Path, progress: Progress) -> Frame:
        """The frame of a project.

        Parameters
        ----------
        project : Project
            With a form-found surface.
        folder : Path
            Where files it names are.
        progress : callable
            Receives what is done where elements are made anew; what it raises ends the frame.

        Raises
        ------
        InputError
            There is no such film, with the limit; what is kept stays.
        """
        assert isinstance(project.surface, FormFoundTable)
        tolerance = max(WARM_TOLERANCE, project.surface.tolerance)
        table = with_origin(project.surface.model_copy(update={"tolerance": tolerance}), folder)
        with reported_from(table.origin or NOWHERE):
            loops = boundary_loops(table, folder)
            with keys("surface", loops="surface.boundary"):
                self._film = film = followed_film(table, loops, progress, self._film)
            return self._drawn_frame(project, film, tuple(loop.name for loop in table.boundary))

    def _drawn_frame(self, project: Project, film: FollowedFilm, names: tuple[str, ...]) -> Frame:
        surface = film.surface
        place, faces = self._places(surface)
        at = surface.frames(place)
        arrays: dict[str, Any] = {"vertices": at.position, "faces": faces}
        shown: list[Shown] = []
        figures = {"area": surface.area(), "mean_curvature": float(surface.mean_curvature)}
        details: dict[str, Any] = {"made_anew": film.made_anew}
        pattern = pattern_of(project.network)
        if is_traced(surface, pattern):
            details["no_lines"] = "lines of another normal curvature are traced when the boundary is let go"
        else:
            try:
                with keys("network", surface="surface"):
                    net = self._followed_net(project, surface)
                    lines, more, layers = self._lines(project, net, pattern.no_strips == "")
            except InputError as error:
                details["no_lines"] = str(error)
            else:
                arrays |= lines
                figures |= more
                details |= self._misses.of(net, names)
                shown = [*layers, *closing_shown(details)]
        skin = surface_layer(at.position, at.normal, faces, alone=not shown)
        scene = make_scene(project.name, [skin, *shown], film.origin)
        return Frame("coarse", arrays, figures, scene, details, film.origin)

    def _places(self, surface: ElementSurface) -> tuple[Any, Integers]:
        """Places and triangles that are drawn of a surface; those of the same elements are the same."""
        if self._drawn is None or self._drawn[0] is not surface.connectivity:
            self._drawn = (surface.connectivity, *sampled_places(surface.connectivity, surface.nodes, EDGE_PARTS))
        return self._drawn[1:]

    def _followed_net(self, project: Project, surface: ElementSurface) -> FollowedNet:
        table = project.network
        density = DensityRequest.of(table.cells, table.spacing)
        request = NetRequest(density, table.minimum_length, pattern_of(table), "open")
        if self._net is None or self._net.request != request:
            reason = umbilic_reason(surface.check_points())
            if reason:
                raise InputError(f"no net: the surface is {reason}")
            self._net = FollowedNet.first(surface, request)
        else:
            before = self._net
            self._net = None
            with suppress(InputError):
                self._net = before.at(surface)
            if self._net is None:
                # what holds for the surface is said anew
                self._net = FollowedNet.first(surface, request)
        return self._net

    def _lines(
        self, project: Project, net: FollowedNet, strips: bool
    ) -> tuple[dict[str, Any], dict[str, float], list[Shown]]:
        """Arrays, figures and layers of the net's lines."""
        lines = net.lines
        section, material = section_of(project), project.material()
        values = line_utilisation(net, section, material) if strips else np.zeros(len(lines.points))
        length = total_length(lines.points, lines.offsets)
        figures = {"lamellas": float(len(lines.families)), "total_length": length}
        if strips:
            volume = length * section.layers * section.height * section.thickness
            figures |= {"utilisation_max": float(values.max(initial=0.0)), "mass": volume * material.density}
        arrays = line_arrays(lines.points, lines.offsets, lines.families, values)
        return arrays, figures, list(line_layers(lines, values if strips else None))


def total_length(points: Floats, offsets: Integers) -> float:
    """Length of polylines, m."""
    steps = lengths(np.diff(points, axis=0))
    # from one line to the next
    steps[offsets[1:-1] - 1] = 0.0
    return float(steps.sum())

"""What a search tells: while it runs, and where it ends."""

from __future__ import annotations

import re
import time

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.base.progress import LONGEST_SILENCE, Report, patient
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.arcs import arc_through
from lamella.surface.boundary.pieces import lines, stack
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding.continuation import FoldError, to_curvature
from lamella.surface.form_finding.find import find_film
from lamella.surface.form_finding.newton import find_equilibrium
from surface.form_finding.exact_patches import ring
from surface.form_finding.films import disc_film

TAU = 2 * np.pi


def waving(height: float):
    """A rim that rises and falls three times."""
    t = TAU * np.arange(48) / 48
    return make_loop("rim", closed_spline(np.column_stack([np.cos(t), np.sin(t), height * np.cos(3 * t)])))


def waisted():
    """A rim whose plan is not convex: that no theorem gives one film alone."""
    t = TAU * np.arange(48) / 48
    r = 1 + 0.4 * np.cos(2 * t)
    return make_loop("rim", closed_spline(np.column_stack([r * np.cos(t), r * np.sin(t), 0.2 * np.cos(3 * t)])))


def test_details_become_lines_after_two_seconds(monkeypatch) -> None:
    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    told: list[str] = []
    progress = patient(lambda report: told.append(str(report)))
    progress(Report.detail("a"))
    now[0] = LONGEST_SILENCE + 0.1
    progress(Report.detail("b"))
    progress(Report.detail("c"))
    now[0] += LONGEST_SILENCE - 0.2
    progress(Report.step("line"))
    now[0] += LONGEST_SILENCE - 0.2
    progress(Report.detail("d"))
    now[0] += LONGEST_SILENCE
    progress(Report.detail("e"))
    assert told == ["    a", "  b", "    c", "  line", "    d", "  e"]


def test_fold_is_an_estimate_and_no_proof() -> None:
    """Caps of a waving rim have their largest H at a fold, which no bound knows."""
    with pytest.raises(InputError, match="the search did not arrive at a stable surface") as error:
        find_film((waving(0.3),), 1.15)
    message = str(error.value)
    assert "no bound is broken" in message
    assert "turn back at about H = " in message
    assert "estimate" in message
    fold = float(message.split("turn back at about H = ")[1].split()[0])
    # below it there is a film, and the remedy says so
    assert find_film((waving(0.3),), 0.99 * fold, tolerance=0.05).stability.lowest > 0


def test_fold_of_caps_is_the_hemisphere() -> None:
    """At H R = 1; the estimate, by cubics along the family, is good to a thousandth from coarse steps."""
    with pytest.raises(FoldError) as error:
        to_curvature(find_equilibrium(disc_film(4, 5), 0.2), 1.5, lambda message: None)
    assert error.value.mean_curvature == pytest.approx(1, rel=2e-3)


def test_broken_bound_is_named_with_what_exists() -> None:
    """Caps over a ring of radius R have |H| < 1 / R; what is offered is just below."""
    with pytest.raises(InputError, match=r"\|H\| <= length") as refused:
        find_film((ring(1.0, 0.0),), 1.2)
    offered = re.match(r"write mean_curvature = (\S+),", refused.value.remedy)
    assert offered
    assert 0.9 < float(offered[1]) < 1


def test_unstable_film_that_the_search_does_not_find() -> None:
    with pytest.raises(
        InputError, match="the search did not arrive at an unstable surface; no bound is broken"
    ) as error:
        find_film((waisted(),), branch="unstable")
    assert error.value.where == "branch"


def test_tangent_joints_of_lines_and_arcs_keep_the_tolerance() -> None:
    """A stadium of straight sides and half circles: at the joints the film's curvature has a logarithm, which no
    element follows; everywhere else H is found to the tolerance, and the area settles.
    """
    sides = [lines(np.array([[-2.0, y, 0.0], [2.0, y, 0.0]]) * [-y, 1, 1], closed=False) for y in (-1.0, 1.0)]
    bends = [
        arc_through(*(np.array([x * (2 + np.cos(a)), x * np.sin(a), 0]) for a in (-TAU / 4, 0, TAU / 4)))
        for x in (1, -1)
    ]
    loop = make_loop("stadium", stack([sides[0], bends[0], sides[1], bends[1]]))
    assert len(loop.corners) == 4
    assert loop.turns.max() < 1e-9
    found = find_film((loop,), -0.2, tolerance=0.02, most_nodes=15_000)
    assert found.deviation <= 0.02
    finer = find_film((loop,), -0.2, tolerance=0.005, most_nodes=30_000)
    areas = [one.surface("x").area() for one in (found, finer)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-5)

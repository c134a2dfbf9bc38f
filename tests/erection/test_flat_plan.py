"""Drawings of the flat net, and its way in few points."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import Section
from lamella.drawings.page import Label
from lamella.drawings.paper import PAPERS
from lamella.drawings.terms import terms
from lamella.erection.erect import erect
from lamella.erection.erection import Erection
from lamella.erection.flat_drawing import _ids
from lamella.erection.flat_plan import FlatPlan
from lamella.erection.flat_sheets import flat_pages, flat_pdf
from lamella.erection.polylines_csv import few_states


@pytest.fixture(scope="module")
def made() -> Erection:
    net = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.8)
    return erect(net.strips(Section(0.1, 0.0015, layers=1)), states=3, elements=1)


def test_few_states_keep_to_the_way() -> None:
    """Arcs and waves: no node is farther off the polylines than told, and fewer points are farther off."""
    shares = np.linspace(0, 1, 101)
    turn = np.pi * shares[:, None] * np.array([1.0, 0.5, 2.0])
    points = np.stack([np.cos(turn), np.sin(turn), 0.1 * turn], 2)
    before = np.inf
    for most in (2, 3, 5, 9, 17):
        chosen, off = few_states(shares, points, 0.0, most)
        assert len(chosen) == most
        there = np.stack(
            [
                np.stack([np.interp(shares, shares[chosen], points[chosen, n, c]) for c in range(3)], 1)
                for n in range(3)
            ],
            1,
        )
        assert np.linalg.norm(there - points, axis=2).max() == pytest.approx(off)
        assert off < before
        before = off
    chosen, off = few_states(shares, points, 0.02, 60)
    assert off <= 0.02
    assert len(chosen) < 60
    straight = shares[:, None, None] * np.ones((1, 4, 3))
    assert few_states(shares, straight, 1e-9)[0].tolist() == [0, 100]


def test_order_is_from_one_side_to_the_other(made: Erection) -> None:
    """All A, then all B, each beside the last one."""
    plan = FlatPlan.of(made)
    families = made.model.lamellas.network.families[plan.order].tolist()
    assert families == sorted(families)
    for family in "AB":
        middles = np.array(
            [
                plan.lines[k][len(plan.lines[k]) // 2]
                for k in plan.order
                if made.model.lamellas.network.families[k] == family
            ]
        )
        steps = np.diff(middles, axis=0)
        assert ((steps[:-1] * steps[1:]).sum(1) > 0).all()


def test_sheets_tell_every_lamella_and_joint(made: Erection) -> None:
    """In English and German; the file is the same twice."""
    ids = made.model.lamellas.network.ids
    for language in ("en", "de"):
        plan, *tables = flat_pages("", made, PAPERS["A3"], terms(language))
        told = [item.text for item in plan.content if isinstance(item, Label)]
        assert set(ids) <= set(told)
        # both lengths of the floor
        assert sorted(one.value for one in plan.dimensions) == pytest.approx(
            sorted(np.ptp(np.concatenate(FlatPlan.of(made).lines), axis=0))
        )
        rows = [item.text for page in tables for item in page.content if isinstance(item, Label)]
        assert all(one in rows for one in ids)
    signed = {"name": "x", "version": "0", "material": "steel"}
    assert flat_pdf([("", made)], **signed) == flat_pdf([("", made)], **signed)


def test_ids_do_not_cover_each_other(made: Erection) -> None:
    """Where two lamellas end at one corner one stands farther out."""
    plan = FlatPlan.of(made)
    ids = made.model.lamellas.network.ids
    ends = [placed.block.ends for placed in _ids(plan, [*ids], "x")]
    low, high = (np.array([one[k] for one in ends]) for k in (0, 1))
    assert len(low) == 2 * len(ids)
    cover = ((low[:, None] < high) & (low < high[:, None])).all(2)
    assert not cover[~np.eye(len(low), dtype=bool)].any()
    # two lamellas that end alike
    line = np.array([[0.0, 0.0], [1.0, 0.0]])
    both = FlatPlan((line, line), (line, line), line, line, np.arange(2))
    first, _, second, _ = (placed.block.ends for placed in _ids(both, ["A1", "A2"], "x"))
    assert not ((first[0] < second[1]) & (second[0] < first[1])).all()

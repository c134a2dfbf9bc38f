"""Where strips are cut into pieces: at borders of segments, and where stock, transport or their own turn ask for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.rules import Rules
from lamella.fabrication.spans import Span
from lamella.fabrication.splice_choice import choose_splices
from lamella.fabrication.splitting import cut_bounds
from lamella.fabrication.stock import Supply
from lamella.fabrication.warnings import FabricationWarnings


def split(
    spans: Sequence[Span],
    rules: Rules,
    notes: FabricationWarnings,
    *,
    quantity: int,
    supply: Supply | None = None,
    borders: Sequence[Integers] | None = None,
    reach: float = 0.0,
) -> list[Floats]:
    """Stations at which each strip is cut, m.

    Parameters
    ----------
    spans : sequence of Span
    rules : Rules
    notes : FabricationWarnings
        Told how many are split, and why.
    quantity : int
        Equal strips of each.
    supply : Supply, optional
        Stock with which cuts are chosen; without it pieces are as long as `rules.sheet` allows.
    borders : sequence of (b,) int, optional
        Of each lamella: cells in whose middle it is cut, by the number of the node before.
    reach : float
        Least distance from a chosen cut to a slot, m: room for a splice.
    """
    fixed = [span.borders(borders[span.strip.lamella]) if borders else np.empty(0) for span in spans]
    if supply is not None:
        cuts = _with_stock(spans, fixed, supply, rules, quantity, reach)
    else:
        cuts = [_equal(span, own, rules, notes) for span, own in zip(spans, fixed, strict=True)]
    for span, own in zip(spans, cuts, strict=True):
        if len(own):
            notes.split(span.length, len(own) + 1, rules, chosen=supply is not None)
    return cuts


def _equal(span: Span, fixed: Floats, rules: Rules, notes: FabricationWarnings) -> Floats:
    """Cuts into few and nearly equal pieces."""
    longest = min(rules.longest_on_sheet, rules.longest_ring, rules.transport_length)
    found = []
    for bounds in _between(span.bounds(), fixed):
        cuts = cut_bounds(bounds, longest)
        if cuts is None:
            notes.oversize.append((span.strip.name, span.length))
            cuts = cut_bounds(bounds, rules.longest_ring)
        found.append(np.empty(0) if cuts is None else cuts)
    return np.sort(np.concatenate([fixed, *found]))


def _between(bounds: Floats, fixed: Floats) -> list[Floats]:
    """Bounds of the pieces between fixed cuts."""
    ends = np.concatenate(([bounds[0]], fixed, [bounds[-1]]))
    inner = bounds[1:-1]
    return [
        np.concatenate(([low], inner[(inner > low) & (inner < high)], [high]))
        for low, high in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)
    ]


def _with_stock(
    spans: Sequence[Span], fixed: Sequence[Floats], supply: Supply, rules: Rules, quantity: int, reach: float
) -> list[Floats]:
    """Cuts with which stock and splices cost least."""
    # on levels the families' curvatures differ
    groups: dict[float, list[int]] = {}
    for number, span in enumerate(spans):
        groups.setdefault(round(span.strip.curvature, 12), []).append(number)
    cuts = list(fixed)
    for curvature in sorted(groups):
        own = replace(rules, curvature=curvature)
        for number, found in _chosen(spans, fixed, groups[curvature], supply, own, quantity, reach):
            cuts[number] = np.sort(np.concatenate([cuts[number], found]))
    return cuts


def _chosen(
    spans: Sequence[Span],
    fixed: Sequence[Floats],
    numbers: Sequence[int],
    supply: Supply,
    rules: Rules,
    quantity: int,
    reach: float,
) -> list[tuple[int, Floats]]:
    """Cuts of some strips of one curvature, each with the strip's number; a strip may be there several times."""
    owners, bounds = [], []
    for number in numbers:
        for part in _between(spans[number].bounds(reach), fixed[number]):
            owners.append(number)
            bounds.append(part)
    found = choose_splices(bounds, supply, rules, quantity)
    if np.isinf(found.cost) and reach:
        # cells too short for splices are told when these are made
        return _chosen(spans, fixed, numbers, supply, rules, quantity, 0.0)
    return list(zip(owners, found.cuts, strict=True))

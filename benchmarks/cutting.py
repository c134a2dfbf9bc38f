"""Cutting 5,000 pieces: what is used of bars and sheets, and CPU seconds, beside first-fit-decreasing."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from bench import Limit, Row, Table, clocked, show

PIECES = 5000
SECONDS_MAX = 10.0
"""CPU seconds for choosing splices and laying all pieces."""
BARS_USED_MIN, SHEETS_USED_MIN = 0.9, 0.7
BAR, GAP, HEIGHT, RADIUS = 6.0, 0.01, 0.1, 4.4
SHEET = (3.0, 1.5)


def strips(count: int, low: float, high: float) -> list[np.ndarray]:
    """Strips of cells 0.25 to 0.55 m long that may be cut between them."""
    rng = np.random.default_rng(1)
    found = []
    for length in rng.uniform(low, high, count):
        steps = rng.uniform(0.25, 0.55, max(int(length / 0.4), 3))
        found.append(np.concatenate([[0.0], np.cumsum(steps) / steps.sum() * length]))
    return found


def straight(low: float, high: float) -> dict[str, float]:
    """Strips of some lengths cut from bars, their splices chosen with them."""
    from lamella.cutting.filling import cut_and_pack
    from lamella.cutting.lanes import Lane

    mean = 0.5 * (low + high)
    chosen = strips(int(PIECES / np.ceil(mean / BAR)), low, high)
    whole = sum(float(one[-1]) for one in chosen)
    seconds, packing = clocked(lambda: cut_and_pack(chosen, [Lane(BAR, BAR)], GAP, 0.0, 0.25))
    return {
        "pieces": sum(map(len, packing.lanes)),
        "bars or sheets": len(packing.lanes),
        "used": whole / (BAR * len(packing.lanes)),
        "choice and laying, s": seconds,
    }


def round_ones() -> dict[str, float]:
    """Arcs laid on sheets, their splices chosen with them."""
    from lamella.fabrication.blanks import plain_blanks
    from lamella.fabrication.rules import Rules
    from lamella.fabrication.splice_choice import choose_splices
    from lamella.fabrication.stock import Stock, Supply
    from lamella.fabrication.stock_layout import lay

    supply = Supply((Stock("sheet", *SHEET),), 0.0015, "1.4301", 7900.0, GAP)
    measures = {"end_distance": 0.05, "rim_overhang": 0.01, "hub_radius": 0.0, "slot_width": 0.003}
    rules = Rules(
        layers=1,
        offset=0.025,
        height=HEIGHT,
        thickness=0.0015,
        curvature=1 / RADIUS,
        density=7900.0,
        sheet=SHEET,
        gap=GAP,
        **measures,
    )
    chosen = strips(PIECES // 5, 3.0, 9.0)

    def cut() -> tuple[int, int, float]:
        choice = choose_splices(chosen, supply, rules, 1)
        lengths = [np.diff(np.concatenate(([b[0]], c, [b[-1]]))) for b, c in zip(chosen, choice.cuts, strict=True)]
        every = np.concatenate(lengths)
        laid = lay(plain_blanks(every, HEIGHT, 1 / RADIUS, 0.0), supply, 0.0)
        return len(every), len(laid.sizes), float(every.sum())

    seconds, (pieces, sheets, length) = clocked(cut)
    used = length * HEIGHT / (sheets * SHEET[0] * SHEET[1])
    return {"pieces": pieces, "bars or sheets": sheets, "used": used, "choice and laying, s": seconds}


def _area(points: np.ndarray) -> float:
    x, y = points.T
    return abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2


def plates() -> dict[str, float]:
    """Star washers with long arms and square keys of some sizes on sheets, by rectangles and by their outlines."""
    from lamella.cutting.nesting import nested
    from lamella.fabrication.flat import outline_points
    from lamella.hardware.shape import crossed, rectangle

    rng = np.random.default_rng(1)
    kinds = [crossed(0.04, 0.012, angle) for angle in rng.uniform(1.3, 1.84, 12)]
    kinds += [rectangle(size, size) for size in rng.uniform(0.02, 0.03, 12)]
    outlines = [outline_points(one)[:-1] for one in kinds]
    count = np.full(len(kinds), -(-PIECES // len(kinds)))
    area = sum(n * _area(points) for n, points in zip(count.tolist(), outlines, strict=True))
    seconds, ways = clocked(lambda: nested(outlines, count, SHEET, GAP / 2))
    sheets = [len(one.ends) for one in ways]
    return {
        "pieces": int(count.sum()),
        "bars or sheets": min(sheets),
        "by rectangles": sheets[0],
        "used": area / (min(sheets) * SHEET[0] * SHEET[1]),
        "choice and laying, s": seconds,
    }


def tables() -> Iterator[Table]:
    """One table: strips of several lengths on bars, arcs on sheets."""
    rows: list[Row] = [
        {"strips": f"straight, {low:g} to {high:g} m, on bars of {BAR:g} m", **straight(low, high)}
        for low, high in ((2.0, 14.0), (3.2, 3.8), (6.5, 7.0))
    ]
    rows.append({"strips": f"arcs of radius {RADIUS:g} m on sheets of {SHEET[0]:g} x {SHEET[1]:g} m", **round_ones()})
    rows.append({"strips": f"plates on sheets of {SHEET[0]:g} x {SHEET[1]:g} m", **plates()})
    slowest = max(float(row["choice and laying, s"] or 0) for row in rows)
    *bars, sheets = (1 - float(row["used"] or 0) for row in rows[:-1])
    yield Table(
        "Cutting",
        "Pieces cut from stock, splices chosen with the cutting. Used is length of the bars, or area of the sheets.",
        tuple(rows),
        (
            Limit(f"CPU seconds of {PIECES:,} pieces", slowest, SECONDS_MAX),
            Limit("bars left over, share of their length", max(bars), 1 - BARS_USED_MIN),
            Limit("sheets left over, share of their area", sheets, 1 - SHEETS_USED_MIN),
        ),
    )


if __name__ == "__main__":
    show(tables())

"""Where a surface is cut: along straight lines of the plane of w.

In the metric |dw| shortest lines are straight and lengths are numbers of cells. Every umbilic of odd order hangs on the
nearest loop by the shortest line; boundary loops are connected by a minimum spanning tree of lines that leave a hole
halfway between the umbilics nearest to it. So a net that does not meet itself across a piece of the cut is interrupted
along a line that is the surface's own, on whatever elements and turned in whatever way; and what fails at one umbilic,
or around one hole, fails along one line. Shortest lines do not cross, and none goes through a triangle that is taken.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.network.isothermic.straight_walk import WALK_PARTS, FlatTriangles, Heads
from lamella.network.isothermic.tight_lines import TIGHT_CLEAR, Course, Passed, tightened

# directions out of each small triangle at an umbilic; from a place on a rim, within CUT_WIDTH of its normal, rad
FAN, RIM_FAN, CUT_WIDTH = 12, 9, 1.0
# lines this much longer than the shortest one are as short
AS_SHORT = 2e-3
# of a loop: places this near to each other are one
ONE_PLACE = 0.02
# times that an end is moved; it has arrived when it is moved by less than this part of the line's length
MOST_MOVES, AT_GOAL = 6, 1e-4
# small triangles around an umbilic that are tried for a line's direction
MOST_WEDGES = 8


@dataclass(frozen=True)
class _Start:
    """Where a line sets out: over a share of a small edge on the rim, or of that opposite to an umbilic."""

    begin: int
    triangle: int
    edge: int
    share: float


@dataclass(frozen=True)
class _Sight:
    """A straight line that was seen to arrive at a loop, not drawn yet.

    Attributes
    ----------
    length : float
        In the plane of w, sqrt(m).
    start : _Start
    end : int
    foot, seen : complex
        The nearest place on the small edge where it arrives, and where it does, on the sheet where it sets out.
    course : Course, optional
        As it was drawn.
    """

    length: float
    start: _Start
    end: int
    foot: complex
    seen: complex
    course: Course | None = None


class CrossedError(ValueError):
    """Lines that do not arrive, or cross, or leave coordinates with several values."""


def straight_cuts(flat: FlatTriangles) -> list[Course]:
    """Lines that connect all holes and umbilics of odd order with the outer rim.

    Raises
    ------
    CrossedError
        The small triangles fold, or umbilics lie too near to each other, for lines to be followed.
    """
    taken = flat.at_umbilic.copy()
    courses: list[Course] = []

    def lay(course: Course | None) -> None:
        if course is None:
            raise CrossedError("a straight line does not arrive")
        taken[course.triangle] = True
        courses.append(course)

    reached, sights = {-1}, _between_loops(flat, taken)
    while len(reached) <= int(flat.loop.max()):
        sight = _shortest_of(sights, reached)
        course = _drawn(flat, taken, sight)
        if course is None:
            # one that is there already was in its way
            sights = _between_loops(flat, taken)
            sight = _shortest_of(sights, reached)
            course = _drawn(flat, taken, sight)
        lay(course)
        reached |= {sight.start.begin, sight.end}
    for vertex in flat.iso.odd.tolist():
        lay(_drawn(flat, taken, _shortest_of(_from_umbilic(flat, taken, vertex), reached)))
    return courses


def _between_loops(flat: FlatTriangles, taken: Booleans) -> list[_Sight]:
    """Straight lines from each hole to each other loop, through no triangle that is taken."""
    result = []
    for hole in range(1, int(flat.loop.max()) + 1):
        feet = _feet(flat, taken, hole)
        result += _between_feet(flat, taken, hole, feet) if len(feet) else _from_loop(flat, taken, hole)
    return result


def _feet(flat: FlatTriangles, taken: Booleans, hole: int) -> Floats:
    """Where umbilics are nearest to a hole, as sorted shares of its length from its start on."""
    begin, span = flat.rim_places
    places = []
    for vertex in flat.iso.mesh.umbilics[flat.iso.mesh.umbilics >= 0].tolist():
        sight = next((sight for sight in _from_umbilic(flat, taken, vertex) if sight.end == -1 - hole), None)
        found = _to_nearest(flat, taken, sight) if sight is not None else None
        if found is not None:
            at, share = flat.small_edge(int(found[0].element[-1]), int(found[0].edge[-1]), found[0].local[-1])
            places.append((begin[at] + share * span[at]) % 1)
    return np.sort(np.array(places))


def _between_feet(flat: FlatTriangles, taken: Booleans, hole: int, feet: Floats) -> list[_Sight]:
    """Lines at right angles to a hole, halfway between the places where umbilics are nearest to it.

    A shortest line from a hole to the next loop passes through an umbilic as a rule, which has more than a full angle
    in the metric |dw| around it: these are the ones farthest from that, and the shortest of them to each loop counts.
    """
    triangle, edge = flat.rim_chain(hole)
    begin, span = (part[triangle, edge] for part in flat.rim_places)
    gaps = np.diff(np.append(feet, feet[0] + 1))
    middles = np.sort((feet + gaps / 2)[gaps > ONE_PLACE] % 1)
    order = np.argsort(begin)
    at = order[np.searchsorted(begin[order], middles, side="right") - 1]
    share = np.clip(((middles - begin[at]) % 1) / span[at], TIGHT_CLEAR, 1 - TIGHT_CLEAR)
    first, last = flat.w[triangle[at], edge[at]], flat.w[triangle[at], (edge[at] + 1) % 3]
    place = first + share * (last - first)
    inwards = flat.inwards(triangle[at], edge[at], share)
    hits = _shoot(flat, taken, Heads.out(triangle[at], edge[at], place, inwards), place, -1 - hole)
    result = []
    for end in np.unique(hits.end).tolist():
        # the first of those that are as short
        mine = np.flatnonzero(hits.end == end)
        index = int(mine[np.rint(np.log(hits.distance[mine] / hits.distance[mine].min()) / AS_SHORT).argmin()])
        line = hits.line[index]
        start = _Start(-1 - hole, int(triangle[at][line]), int(edge[at][line]), float(share[line]))
        sight = hits.sight(start, index)
        passed = _followed(flat, taken, start, end, sight.seen)
        if passed is not None:
            result.append(replace(sight, course=tightened(flat, start.begin, end, passed, free=False).course))
    return result


def _shortest_of(sights: list[_Sight], reached: set[int]) -> _Sight:
    """The shortest line between what is reached and what is not; of equal ones that between the first loops."""
    there = [sight for sight in sights if (sight.start.begin in reached) != (sight.end in reached)]
    if not there:
        raise CrossedError("no straight line leads to a part of the surface")
    least = min(sight.length for sight in there)
    return max(
        (sight for sight in there if sight.length <= (1 + AS_SHORT) * least),
        key=lambda sight: sorted((sight.start.begin, sight.end), reverse=True),
    )


@dataclass(frozen=True)
class _Hits:
    """What lines meet."""

    line: Integers
    end: Integers  # the boundary loop, as -1 - k
    place: Floats  # share of the loop's length from its start
    seen: Complexes  # where the line arrives, on the sheet where it set out
    foot: Complexes  # the nearest place on the small edge where it does
    distance: Floats  # of both from where the line set out
    foot_distance: Floats

    def best(self, end: int) -> int:
        """The shortest line to a loop; of equal ones the first one from the loop's start on."""
        mine = np.flatnonzero(self.end == end)
        near = mine[_shortest(self.distance[mine], self.place[mine])]
        return int(near[self.foot_distance[near].argmin()])

    def sight(self, start: _Start, index: int) -> _Sight:
        """One of the lines."""
        end, foot, seen = int(self.end[index]), complex(self.foot[index]), complex(self.seen[index])
        return _Sight(float(self.distance[index]), start, end, foot, seen)


def _shoot(flat: FlatTriangles, taken: Booleans, heads: Heads, origins: Complexes, itself: int) -> _Hits:
    """Lines followed to a rim other than the one where they begin; those that come to what is taken are given up."""
    begin, span = flat.rim_places
    none = np.zeros(0, np.int64)
    rows = [(none, none, np.zeros(0), np.zeros(0, complex), np.zeros(0, complex))]
    for _ in range(flat.most_steps):
        heads = heads[~taken[heads.triangle]]
        if not len(heads.line):
            break
        edge, arrived, place = heads.exits(flat)
        loop = flat.loop[heads.triangle, edge]
        out = loop >= 0
        if out.any():
            some, side = heads[out], edge[out]
            first = some.at_start(flat.w[some.triangle, side])
            last = some.at_start(flat.w[some.triangle, (side + 1) % 3])
            share = np.clip(arrived[out], TIGHT_CLEAR, 1 - TIGHT_CLEAR)
            at = (begin[some.triangle, side] + share * span[some.triangle, side]) % 1
            foot = first + _foot(origins[some.line], first, last) * (last - first)
            rows.append((some.line, -1 - loop[out], at, first + share * (last - first), foot))
        heads = heads[~out].through(flat, edge[~out], place[~out])
    line, end, place_of, seen, foot = (np.concatenate(column) for column in zip(*rows, strict=True))
    kept = end != itself
    line, end, place_of, seen, foot = line[kept], end[kept], place_of[kept], seen[kept], foot[kept]
    return _Hits(line, end, place_of, seen, foot, np.abs(seen - origins[line]), np.abs(foot - origins[line]))


def _foot(origin: Complexes, first: Complexes, last: Complexes) -> Floats:
    """Shares of segments at which they are nearest to origins, off their ends."""
    along = last - first
    share = ((origin - first) * along.conj()).real / np.maximum(np.abs(along) ** 2, 1e-300)
    return np.asarray(np.clip(share, TIGHT_CLEAR, 1 - TIGHT_CLEAR))


def _from_umbilic(flat: FlatTriangles, taken: Booleans, vertex: int) -> list[_Sight]:
    """The shortest straight line from an umbilic to each loop."""
    triangle, corner = np.nonzero(flat.grid.faces == vertex)
    triangle, corner = np.repeat(triangle, FAN), np.repeat(corner, FAN)
    edge = (corner + 1) % 3
    share = (np.arange(len(triangle)) % FAN + 0.5) / FAN
    first, last = flat.w[triangle, edge], flat.w[triangle, (edge + 1) % 3]
    origin, place = flat.w[triangle, corner], first + share * (last - first)
    # set out from the umbilic itself, out through the edge opposite to it
    heads = Heads.out(triangle, corner, origin, (place - origin) / np.abs(place - origin))
    hits = _shoot(flat, taken, heads.through(flat, edge, place), origin, 0)
    result = []
    for end in np.unique(hits.end).tolist():
        index = hits.best(end)
        out = int(hits.line[index])
        result.append(hits.sight(_Start(vertex, int(triangle[out]), int(edge[out]), float(share[out])), index))
    return result


def _from_loop(flat: FlatTriangles, taken: Booleans, hole: int) -> list[_Sight]:
    """The shortest straight lines from a hole to each other loop."""
    triangle, edge = flat.rim_chain(hole)
    # from the middle of every element's edge
    some = np.arange(WALK_PARTS // 2, len(triangle), WALK_PARTS)
    hits, start = _fan(flat, taken, hole, triangle[some], edge[some], np.full(len(some), 0.5), RIM_FAN)
    begin, span = (part[triangle, edge] for part in flat.rim_places)
    result = []
    for end in np.unique(hits.end).tolist():
        mine = np.flatnonzero(hits.end == end)
        least = np.full(len(some), np.inf)
        np.minimum.at(least, start[hits.line[mine]], hits.distance[mine])
        if np.isfinite(least).all() and least.max() < (1 + AS_SHORT) * least.min():
            # alike all around: from where the loop begins
            at, share = int(begin.argmin()), TIGHT_CLEAR
        else:
            near = _shortest(least, ((begin + span / 2) % 1)[some])
            step = _least_of_parabola(least, int(near[least[near].argmin()]))
            at = (WALK_PARTS // 2 + int(np.floor(WALK_PARTS * step + 0.5))) % len(triangle)
            share = float(np.clip((WALK_PARTS * step + 0.5) % 1, TIGHT_CLEAR, 1 - TIGHT_CLEAR))
        sight = _from_place(flat, taken, _Start(-1 - hole, int(triangle[at]), int(edge[at]), share), end)
        if sight is not None:
            result.append(sight)
    return result


def _from_place(flat: FlatTriangles, taken: Booleans, start: _Start, end: int) -> _Sight | None:
    """The shortest straight line from a place on a rim to a loop."""
    at = np.array([start.triangle]), np.array([start.edge]), np.array([start.share])
    hits, _ = _fan(flat, taken, -1 - start.begin, *at, 8 * RIM_FAN)
    return hits.sight(start, hits.best(end)) if (hits.end == end).any() else None


def _fan(
    flat: FlatTriangles, taken: Booleans, hole: int, triangle: Integers, edge: Integers, share: Floats, count: int
) -> tuple[_Hits, Integers]:
    """What lines from places on a rim meet, so many from each; and from which place (n,) each line begins."""
    start = np.repeat(np.arange(len(triangle)), count)
    first, last = flat.w[triangle, edge], flat.w[triangle, (edge + 1) % 3]
    origin = (first + share * (last - first))[start]
    inwards = (1j * (last - first) / np.abs(last - first))[start]
    turn = np.tile(np.linspace(-CUT_WIDTH, CUT_WIDTH, count), len(triangle))
    heads = Heads.out(triangle[start], edge[start], origin, inwards * np.exp(1j * turn))
    return _shoot(flat, taken, heads, origin, -1 - hole), start


def _shortest(distance: Floats, place: Floats) -> Integers:
    """Which lines are the shortest; of places along a loop that are as near, those at the first from its start on."""
    near = np.flatnonzero(distance <= (1 + AS_SHORT) * distance.min())
    order = near[np.argsort((place[near] + ONE_PLACE) % 1)]
    gap = np.flatnonzero(np.diff((place[order] + ONE_PLACE) % 1) > ONE_PLACE)
    return order[: gap[0] + 1] if len(gap) else order


def _least_of_parabola(values: Floats, index: int) -> float:
    """Where, as a fractional index, a parabola through a value and those next to it around a loop is least."""
    before, here, after = (float(values[(index + k) % len(values)]) for k in (-1, 0, 1))
    bend = before - 2 * here + after
    if not np.isfinite(bend) or bend <= 0:
        return float(index)
    return index + float(np.clip((before - after) / (2 * bend), -1, 1))


def _drawn(flat: FlatTriangles, taken: Booleans, sight: _Sight) -> Course | None:
    """A line drawn straight, its ends where they are nearest to each other; None: something is in its way."""
    course = sight.course or _at_right_angles(flat, taken, sight)
    if course is None:
        # an umbilic is in the way to what is nearest: as it was seen to arrive
        passed = _followed(flat, taken, sight.start, sight.end, sight.seen)
        return None if passed is None else tightened(flat, sight.start.begin, sight.end, passed, free=False).course
    # an umbilic's own triangle is taken
    return None if taken[course.triangle[1:]].any() else course


def _at_right_angles(flat: FlatTriangles, taken: Booleans, sight: _Sight) -> Course | None:
    """A line at right angles to the rims on which it ends, or to a corner of them."""
    now: _Sight | None = sight
    for _ in range(MOST_MOVES):
        found = _to_nearest(flat, taken, now) if now is not None else None
        if now is None or found is None:
            break
        course, first = found
        if 0 <= first <= 1:
            return course
        now = _from_place(flat, taken, _next_element(flat, now.start, first), sight.end)
    return None


def _to_nearest(flat: FlatTriangles, taken: Booleans, sight: _Sight) -> tuple[Course, float] | None:
    """A line to the nearest place of a loop, and where its start belongs on its element's edge."""
    start, goal = sight.start, sight.foot
    for _ in range(MOST_MOVES):
        passed = _followed(flat, taken, start, sight.end, goal)
        if passed is None:
            return None
        line = tightened(flat, start.begin, sight.end, passed)
        if 0 <= line.last <= 1 and abs(line.goal - goal) < AT_GOAL * sight.length:
            return line.course, line.first
        start, goal = replace(start, triangle=int(passed.triangle[0]), edge=int(passed.edge[0])), line.goal
    return None


def _next_wedge(flat: FlatTriangles, start: _Start, goal: complex, aside: int) -> tuple[_Start, complex]:
    """The next small triangle around an umbilic, beyond the last end (aside 1) or the first of the edge opposite."""
    edge = (start.edge + (1 if aside > 0 else 2)) % 3
    at = start.triangle, edge
    triangle, back = int(flat.grid.neighbours[at]), int(flat.grid.neighbour_edges[at])
    opposite = (back + (2 if aside > 0 else 1)) % 3
    return _Start(start.begin, triangle, opposite, 0.5), complex(flat.sign[at] * goal + flat.shift[at])


def _next_element(flat: FlatTriangles, start: _Start, share: float) -> _Start:
    """The end of the next element's edge along a rim, behind (share above 1) or before that of a start."""
    triangle, edge = flat.rim_chain(-1 - start.begin)
    index = int(np.flatnonzero((triangle == start.triangle) & (edge == start.edge))[0]) // WALK_PARTS * WALK_PARTS
    index = (index + WALK_PARTS if share > 1 else index - 1) % len(triangle)
    return _Start(start.begin, int(triangle[index]), int(edge[index]), TIGHT_CLEAR if share > 1 else 1 - TIGHT_CLEAR)


def _followed(flat: FlatTriangles, taken: Booleans, start: _Start, end: int, goal: complex) -> Passed | None:
    """A line to a goal, from small edge to small edge; None: it comes to what is taken, or to another loop."""
    if start.begin >= 0:
        start, goal = _wedge_of(flat, start, goal)
    first, last = (complex(flat.w[start.triangle, (start.edge + k) % 3]) for k in (0, 1))
    if start.begin < 0:
        origin = first + start.share * (last - first)
        head = Heads.out(*(np.array([x]) for x in (start.triangle, start.edge, origin, goal - origin)))
        share = start.share
    else:
        corner = (start.edge + 2) % 3
        origin = complex(flat.w[start.triangle, corner])
        share = _where_crossed(origin, goal - origin, first, last)
        head = Heads.out(*(np.array([x]) for x in (start.triangle, corner, origin, goal - origin)))
        head = head.through(flat, np.array([start.edge]), np.array([origin]))
    passed = [(start.triangle, start.edge, float(np.clip(share, TIGHT_CLEAR, 1 - TIGHT_CLEAR)), 1.0, 0j)]
    for _ in range(flat.most_steps):
        if taken[head.triangle[0]]:
            return None
        # `place` stays where the line set out: which vertices lie to its left is a matter of one straight line
        edge, share_there, _ = head.exits(flat)
        there = int(head.triangle[0]), int(edge[0]), float(np.clip(share_there[0], TIGHT_CLEAR, 1 - TIGHT_CLEAR))
        passed.append((*there, float(head.sign[0]), complex(head.shift[0])))
        loop = int(flat.loop[head.triangle, edge][0])
        if loop >= 0:
            return Passed(*(np.array(part) for part in zip(*passed, strict=True))) if end == -1 - loop else None
        head = head.through(flat, edge, head.place)
    return None


def _wedge_of(flat: FlatTriangles, start: _Start, goal: complex) -> tuple[_Start, complex]:
    """The small triangle around an umbilic through which the line to a goal leaves it, and the goal on its sheet."""
    for _ in range(MOST_WEDGES):
        first, last, origin = (complex(flat.w[start.triangle, (start.edge + k) % 3]) for k in range(3))
        share = _where_crossed(origin, goal - origin, first, last)
        if 0 <= share <= 1:
            break
        start, goal = _next_wedge(flat, start, goal, 1 if share > 1 else -1)
    return start, goal


def _where_crossed(origin: complex, towards: complex, first: complex, last: complex) -> float:
    """Share of a segment at which a line crosses it; below 0 or above 1 beyond its ends."""
    along = last - first
    across = (towards.conjugate() * along).imag
    return (towards.conjugate() * (origin - first)).imag / across if across else 0.5

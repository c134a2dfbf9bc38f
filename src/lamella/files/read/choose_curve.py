"""The choice of the closed curve of a file that is meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.vectors import diagonal
from lamella.base.wording import counted, cut
from lamella.files.read.file_curves import CurveFile, FileCurve
from lamella.files.read.tidy_curves import without_doubles, without_short
from lamella.surface.boundary.arc_length import Course
from lamella.surface.boundary.curve import place
from lamella.surface.boundary.joining import GAP_LIMIT, crowded_end, find_chains, nearly_closed
from lamella.surface.boundary.pieces import Pieces

DRAWN = 1e-4
"""m. Ends of a drawing that are nearer than this are meant as one point: CAD works within 0.01 to 0.1 mm."""

DRAWN_SHARE, OWN_SHARE = 1e-4, 1e-3
"""Of the size of all curves: the most of `DRAWN`, and of a tolerance that the file itself says."""

ALMOST = 0.02
"""Of the length of a chain: with gaps up to this it is meant as closed."""

_WRITTEN = 1e-6
"""m; ends nearer than this differ by how the file was written."""

_MOST_LISTED = 6
_MOST_WORD = 40


@dataclass(frozen=True, eq=False)
class Chosen:
    """The curve that is meant.

    Attributes
    ----------
    pieces : Pieces
        Closed, in the file's unit.
    remarks : tuple of Message
        What was done to it.
    """

    pieces: Pieces
    remarks: tuple[Message, ...]


@dataclass(frozen=True, eq=False)
class _Candidate:
    reported: str
    members: Sequence[FileCurve]
    pieces: Pieces
    remarks: tuple[Message, ...] = ()


def choose_loop(file: CurveFile, layer: str | None, name: str | None, where: str, unit: float) -> Chosen:
    """The one closed curve, or closed chain of open curves, with the layer and id of the project.

    Parameters
    ----------
    file : CurveFile
    layer, name : str or None
        None: any.
    where : str
        Key for messages.
    unit : float
        Metres per unit of the file.

    Raises
    ------
    InputError
        None or several; what there is is listed.
    """
    return _Choice(file, layer, name, where, unit).chosen()


class _Choice:
    def __init__(self, file: CurveFile, layer: str | None, name: str | None, where: str, unit: float) -> None:
        self.file, self.layer, self.name, self.where, self.unit = file, layer, name, where, unit
        self.wanted = " and ".join(
            f"{key} {cut(value, _MOST_WORD)!r}" for key, value in (("layer", layer), ("id", name)) if value is not None
        )
        self.with_wanted = f" with {self.wanted}" if self.wanted else ""

    def chosen(self) -> Chosen:
        matching = self._matching()
        if not matching:
            raise self._nothing()
        self.limit = self._limit(matching)
        tidy, self.remarks = self._tidied(matching)
        seen = [curve for curve in tidy if not curve.hidden]
        candidates, opened = self._candidates(seen)
        if not candidates and len(seen) < len(tidy):
            candidates, opened = self._candidates(tidy)
        if not candidates and self.name:
            candidates = self._chains_of(matching)
        if len(candidates) > 1:
            raise InputError(
                f"{len(candidates)} closed curves{self.with_wanted}: " + _listed([c.reported for c in candidates]),
                "name one of them with layer = ... or id = ...",
                self.where,
            )
        if not candidates:
            raise self._open(tidy, opened)
        (best,) = candidates
        self._refuse_larger(best, opened)
        return Chosen(best.pieces, (*self.remarks, *best.remarks))

    def _matching(self) -> list[FileCurve]:
        """Curves of the layer and id; edges of surfaces only where they are named and no curve is."""
        on = [curve for curve in self.file.curves if self._on(curve)]
        named = [curve for curve in on if self.name is None or curve.answers_to(self.name)]
        if not named and self.name:
            # an id may be cut off where no other begins like it
            named = [curve for curve in on if curve.begins_with(self.name)]
            if len({curve.ids for curve in named}) > 1 and not all(curve.edge for curve in named):
                raise InputError(
                    f"{len(named)} ids begin with {cut(self.name, _MOST_WORD)!r}: "
                    + _listed([self._reported(curve) for curve in named]),
                    "write more of the id",
                    self.where,
                )
        curves = [curve for curve in named if not curve.edge]
        return curves or (named if self.wanted else [])

    def _limit(self, curves: Sequence[FileCurve]) -> float:
        """Within which ends meet, in the file's unit."""
        size = diagonal(np.concatenate([curve.pieces.hull for curve in curves]))
        own = self.file.tolerance or 0.0
        return max(GAP_LIMIT * size, min(DRAWN / self.unit, DRAWN_SHARE * size), min(own, OWN_SHARE * size))

    def _tidied(self, curves: Sequence[FileCurve]) -> tuple[list[FileCurve], tuple[Message, ...]]:
        """Curves without what is shorter than the tolerance, none of them twice, and remarks on what was left out."""
        long = [curve for curve in curves if curve.pieces.extent > self.limit]
        shorter = len(curves) - len(long)
        cleared = []
        for curve in long:
            pieces, dropped = without_short(curve.pieces, self.limit)
            shorter += dropped
            cleared.append(curve if not dropped else replace(curve, pieces=pieces))
        kept = without_doubles([curve.pieces for curve in cleared], self.limit)
        remarks = []
        if shorter:
            remarks.append(Message("pieces_short", f"{counted(shorter, 'piece')} of no length left out"))
        if len(kept) < len(cleared):
            remarks.append(
                Message("curves_doubled", f"{counted(len(cleared) - len(kept), 'curve')} drawn twice left out")
            )
        return [cleared[k] for k in kept], tuple(remarks)

    def _candidates(self, curves: Sequence[FileCurve]) -> tuple[list[_Candidate], list[FileCurve]]:
        """Closed curves and chains; and what stays open, each chain as one curve."""
        candidates = [self._shut(curve) for curve in curves if curve.closed(self.limit)]
        opened = [curve for curve in curves if not curve.closed(self.limit)]
        # chains of one layer first: another layer may touch them
        for layers in [*([one] for one in sorted({curve.layer for curve in opened})), None]:
            members = [curve for curve in opened if layers is None or curve.layer in layers]
            chains = find_chains([curve.pieces for curve in members], self.limit)
            for chain in chains:
                if chain.closed:
                    mine = [members[k] for k in chain.members]
                    candidates.append(self._chained(mine, chain.pieces, chain.gaps))
                    opened = [curve for curve in opened if all(curve is not one for one in mine)]
        rest = find_chains([curve.pieces for curve in opened], self.limit)
        return candidates, [self._as_one([opened[k] for k in chain.members], chain.pieces) for chain in rest]

    def _chains_of(self, named: Sequence[FileCurve]) -> list[_Candidate]:
        """Closed chains that hold an open curve of the project's id: messages name a chain by one of its curves."""
        ids = {curve.ids for curve in named}
        # the named first: of curves drawn twice the first is kept
        every = sorted((c for c in self.file.curves if not c.edge and self._on(c)), key=lambda c: c.ids not in ids)
        tidy, remarks = self._tidied(every)
        candidates, _ = self._candidates(tidy)
        chains = [c for c in candidates if len(c.members) > 1 and any(one.ids in ids for one in c.members)]
        if chains:
            self.remarks = remarks
        return chains

    def _on(self, curve: FileCurve) -> bool:
        return self.layer is None or curve.on(self.layer)

    def _as_one(self, members: Sequence[FileCurve], pieces: Pieces) -> FileCurve:
        if len(members) == 1:
            return members[0]
        return replace(members[0], kind=f"chain of {len(members)}", pieces=pieces)

    def _shut(self, curve: FileCurve) -> _Candidate:
        start, end = curve.pieces.starts[0], curve.pieces.ends[-1]
        meeting = (start + end) / 2
        remarks = (*self._gap_remark(np.array([np.linalg.norm(end - start)])), *_hidden([curve]))
        return _Candidate(self._reported(curve), [curve], curve.pieces.from_to(meeting, meeting), remarks)

    def _chained(self, members: Sequence[FileCurve], pieces: Pieces, gaps: Floats) -> _Candidate:
        layers = sorted({curve.layer for curve in members})
        reported = self._words(members[0], f"chain of {len(members)}", pieces, "closed")
        joined = Message(
            "layers_joined", f"joined over the layers {', '.join(repr(cut(layer, _MOST_WORD)) for layer in layers[:4])}"
        )
        remarks = ((joined,) if len(layers) > 1 else ()) + self._gap_remark(gaps) + _hidden(members)
        return _Candidate(reported, members, pieces, remarks)

    def _gap_remark(self, gaps: Floats) -> tuple[Message, ...]:
        wide = gaps[gaps * self.unit > _WRITTEN]
        if not len(wide):
            return ()
        return (
            Message(
                "gaps_closed", f"{counted(len(wide), 'gap')} of up to {wide.max() * self.unit * 1000:.2g} mm closed"
            ),
        )

    def _refuse_larger(self, best: _Candidate, opened: Sequence[FileCurve]) -> None:
        """Refuse a closed curve beside a larger one that is open by a gap alone: that one is the boundary."""
        for length, reported in self._almost(opened):
            if length > Course(best.pieces).length:
                raise InputError(
                    f"{reported}; the only closed curve{self.with_wanted} is smaller: {best.reported}",
                    f"close the gap, or write {_naming(best.members)} if the closed curve is meant",
                    self.where,
                )

    def _almost(self, opened: Sequence[FileCurve]) -> list[tuple[float, str]]:
        """Lengths of open chains that only gaps keep open, the longest first, each in words."""
        lengths = [Course(curve.pieces).length for curve in opened]
        found = []
        for near in nearly_closed([curve.pieces for curve in opened], lengths, ALMOST):
            first = opened[near.members[0]]
            kind = first.kind if len(near.members) == 1 else f"chain of {len(near.members)}"
            name = self._named(first)
            a, b = (place(end * self.unit) for end in near.between)
            reported = (
                f"{name} ({kind}, {near.length * self.unit:.4g} m) is open by {_length(near.gap * self.unit)} between "
                f"{a} and {b} (closed up to {_length(self.limit * self.unit)})"
            )
            found.append((near.length, reported))
        return sorted(found, reverse=True)

    def _open(self, matching: Sequence[FileCurve], opened: Sequence[FileCurve]) -> InputError:
        """The refusal of curves of which none is closed."""
        almost = self._almost(opened)
        head = f"no closed curve{self.with_wanted}"
        if almost:
            return InputError(
                f"{head}: {'; '.join(reported for _, reported in almost[:3])}",
                "close the gap in the drawing",
                self.where,
            )
        layers, mine = self._other_layers()
        if mine:
            return InputError(
                f"{head}, but together with curves on {layers} it closes",
                f"instead of the layer write {_naming(mine)}, or put all parts of the curve on one layer",
                self.where,
            )
        crowd = crowded_end([curve.pieces for curve in matching if not curve.closed(self.limit)], self.limit)
        crossing = f"; {crowd[0]} ends meet at {place(crowd[1] * self.unit)}" if crowd else ""
        return InputError(
            f"{head}, and the open ones do not join to one: " + _listed([self._reported(c) for c in opened]) + crossing,
            f"close it: ends have to meet within {_length(self.limit * self.unit)}, two at each place",
            self.where,
        )

    def _other_layers(self) -> tuple[str, list[FileCurve]]:
        """Layers whose curves close those of the layer of the project, in words, and the latter; none: none do."""
        if self.layer is None or self.name is not None:
            return "", []
        every, _ = self._tidied([curve for curve in self.file.curves if not curve.edge])
        opened = [curve for curve in every if not curve.closed(self.limit)]
        for chain in find_chains([curve.pieces for curve in opened], self.limit):
            layers = {opened[k].layer for k in chain.members if not opened[k].on(self.layer)}
            mine = [opened[k] for k in chain.members if opened[k].on(self.layer)]
            if chain.closed and layers and mine:
                return f"layer {', '.join(repr(cut(layer, _MOST_WORD)) for layer in sorted(layers)[:4])}", mine
        return "", []

    def _nothing(self) -> InputError:
        """The refusal of a file without such a curve, with what it does hold."""
        curves = [curve for curve in self.file.curves if not curve.edge]
        edges = [curve for curve in self.file.curves if curve.edge]
        held = ", ".join(counted(count, kind) for kind, count in self.file.others.items())
        missing = f"no curve{self.with_wanted}"
        if curves:
            there = _listed([self._reported(curve) for curve in curves])
            return InputError(f"{missing}; {there}", "name a closed curve that is there", self.where)
        if edges:
            return InputError(
                f"{missing} outside of surfaces; it holds {held}, with the edges "
                + _listed([self._reported(curve) for curve in edges]),
                "name the edge that is meant with id = ..., or duplicate it as a curve (in Rhino: DupBorder, DupEdge)",
                self.where,
            )
        if held:
            return InputError(
                f"{missing}: it holds no curves in model space, but {held}", _remedy(self.file.others), self.where
            )
        return InputError(f"{missing}; it holds no curves", "name a closed curve that is there", self.where)

    def _reported(self, curve: FileCurve) -> str:
        state = "closed" if curve.closed(GAP_LIMIT * curve.pieces.extent) else "open"
        return self._words(curve, curve.kind, curve.pieces, state + (f", {curve.hidden}" if curve.hidden else ""))

    def _words(self, curve: FileCurve, kind: str, pieces: Pieces, state: str) -> str:
        length = Course(pieces).length * self.unit if pieces.extent > 0 else 0.0
        name = self._named(curve)
        return f"{name} ({kind}, {length:.4g} m, {state})".strip()

    def _named(self, curve: FileCurve) -> str:
        name = next((word for word in curve.ids if word), "")
        parts = [f"layer {cut(curve.layer, _MOST_WORD)!r}"] if curve.layer else []
        parts += [f"id {cut(name, _MOST_WORD)!r}"] if name else []
        return " ".join(parts)


def _length(metres: float) -> str:
    """A length in a message, in mm where it is small."""
    return f"{metres * 1000:.3g} mm" if metres < 0.1 else f"{metres:.3g} m"


def _naming(members: Sequence[FileCurve]) -> str:
    """The key of a project that names these curves alone: of a chain an id of one of its curves."""
    name = next((word for curve in members for word in curve.ids if word), "")
    return f'id = "{cut(name, _MOST_WORD)}"' if name else f'layer = "{cut(members[0].layer, _MOST_WORD)}"'


def _hidden(members: Sequence[FileCurve]) -> tuple[Message, ...]:
    why = sorted({curve.hidden for curve in members if curve.hidden})
    return tuple(Message("curve_hidden", f"it is hidden in the file: {one}") for one in why)


def _remedy(others: Iterable[str]) -> str:
    """What to do about a file that holds such things alone."""
    kinds = " ".join(others)
    if "paper space" in kinds:
        return "move the curve into model space (in AutoCAD: CHSPACE)"
    if "FACE" in kinds or "mesh" in kinds:
        return 'draw the boundary as a closed curve, or take the mesh itself (kind = "mesh", saved as .obj)'
    if "external reference" in kinds:
        return "bind the external reference (in AutoCAD: XREF, Bind), or name the drawing it refers to"
    return "draw the boundary as a closed curve, or turn what is there into one (polyline, spline, circle)"


def _listed(reported: Sequence[str]) -> str:
    more = len(reported) - _MOST_LISTED
    return "; ".join(reported[:_MOST_LISTED]) + (f"; and {more} more" if more > 0 else "")

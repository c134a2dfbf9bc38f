"""What happened while parts were made, in a few sentences for the user."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from lamella.base.message import Message
from lamella.base.wording import counted, rounded
from lamella.fabrication.rules import LENGTH_ROUNDING, Rules


@dataclass
class FabricationWarnings:
    """Lamellas and parts that did not come out as plain strips.

    Attributes
    ----------
    too_long : list of float
        Lengths (m) of the lamellas split to fit the sheet.
    too_round : int
        Lamellas split since they would overlap themselves.
    pieces : int
        Pieces of all the split lamellas.
    oversize : list of (str, float)
        Id and length (m) of the lamellas with a cell too long for the sheet.
    left_out : list of str
        Ids of the lamellas no part is made of.
    unslotted : list of (str, float)
        Id and smallest cell edge (m) of the parts without slots.
    collisions : list of str
        Pairs of strips whose ends meet beyond the rim.
    too_far : float
        How much shorter the ends would have to be, m.
    other_cells : str
        With how many cells no ends meet, in words; empty: not searched.
    hub_cut : float
        Radius (m) asked of the hubs where it would have taken the first slots with it, else 0.
    hub_needed : float
        Radius (m) the hubs should have where theirs lets strips run into each other, else 0.
    chosen : int
        Lamellas split where stock is used up by it.
    too_far_to_carry : int
        Lamellas split since they are longer than what is carried.
    at_borders : int
        Lamellas split at borders of segments alone.
    """

    too_long: list[float] = field(default_factory=list)
    too_round: int = 0
    pieces: int = 0
    oversize: list[tuple[str, float]] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    unslotted: list[tuple[str, float]] = field(default_factory=list)
    collisions: list[str] = field(default_factory=list)
    too_far: float = 0.0
    other_cells: str = ""
    hub_cut: float = 0.0
    hub_needed: float = 0.0
    chosen: int = 0
    too_far_to_carry: int = 0
    at_borders: int = 0

    def split(self, length: float, pieces: int, rules: Rules, *, chosen: bool) -> None:
        """Note that a strip of a length (m) is cut into pieces."""
        self.pieces += pieces
        if length > rules.longest_ring:
            self.too_round += 1
        elif chosen:
            self.chosen += 1
        elif length > rules.longest_on_sheet:
            self.too_long.append(length)
        elif length > rules.transport_length:
            self.too_far_to_carry += 1
        else:
            self.at_borders += 1

    def sentences(self, rules: Rules, lamellas: int, parts: int) -> Iterator[Message]:
        """One warning a matter, given the numbers of all lamellas and parts."""
        sheet = f"{max(rules.sheet):g} x {min(rules.sheet):g} m"
        if self.pieces:
            reasons = []
            if self.too_long:
                longest = f"the longest has {max(self.too_long):.3f} m"
                arcs = f" as arcs of radius {1 / abs(rules.curvature):.3g} m" if rules.curvature else ""
                reasons.append(f"{len(self.too_long)} do not fit the sheet of {sheet}{arcs} ({longest})")
            if self.too_round:
                reasons.append(f"{self.too_round} turn through more than 1.9 pi and would overlap themselves")
            if self.chosen:
                reasons.append(f"{self.chosen} so that stock is used up")
            if self.too_far_to_carry:
                reasons.append(f"{self.too_far_to_carry} are longer than the {rules.transport_length:g} m carried")
            if self.at_borders:
                reasons.append(f"{self.at_borders} at borders of segments")
            split = len(self.too_long) + self.too_round + self.chosen + self.too_far_to_carry + self.at_borders
            yield Message(
                "lamellas_split",
                f"{split} of {lamellas} lamellas were split midway between "
                f"nodes into {self.pieces} pieces: {'; '.join(reasons)}",
            )
        if self.oversize:
            name, length = max(self.oversize, key=lambda item: item[1])
            yield Message(
                "lamellas_oversize",
                f"{len(self.oversize)} of {lamellas} lamellas do not fit the sheet of {sheet} even if cut at "
                f"every cell (the longest is {name} with {length:.3f} m): drawn alone on over-size sheets",
            )
        if self.left_out:
            yield Message(
                "lamellas_left_out",
                f"{len(self.left_out)} of {lamellas} lamellas are left out of the parts "
                f"({_few(self.left_out)}): nothing remains of them between hubs of radius "
                f"{1e3 * rules.hub_radius:g} mm, or a single cell turns through more than 1.9 pi",
            )
        if self.hub_cut:
            yield Message(
                "hub_cut",
                f"a hub radius of {1e3 * self.hub_cut:.1f} mm would reach the first slots around the singular node: "
                f"{1e3 * rules.hub_radius:.1f} mm is used",
            )
        if self.hub_needed:
            yield Message(
                "hub_small",
                f"strips run into each other around the singular node: hub_radius is "
                f"{1e3 * rules.hub_radius:g} mm, it takes {1e3 * self.hub_needed:.1f} mm, or fewer layers",
            )
        if self.collisions:
            count = len(self.collisions)
            yield Message(
                "ends_meet",
                f"{counted(count, 'pair')} of strips ({_few(self.collisions)}) {'meets' if count == 1 else 'meet'} "
                "beyond the rim, where no slot is cut: " + self._shorter(rules),
            )
        if self.unslotted:
            between = 2 * rules.slot_width / rules.edge_scale
            spread = 0.5 * (rules.layers - 1) * rules.offset
            edge = min(edge for _, edge in self.unslotted)
            smallest = f"their smallest cell edge is {1e3 * edge:.1f} mm; " if np.isfinite(edge) else ""
            if edge < 0:
                smallest = "on layers beside the middle slots of theirs change places; "
            offset = f", an offset of {1e3 * between:.1f} mm" if rules.layers > 1 else ""
            layers = f"{rules.layers} layer{'s' if rules.layers > 1 else ''}"
            yield Message(
                "parts_unslotted",
                f"{len(self.unslotted)} of {parts} parts are drawn without slots, with marks only "
                f"({_few([name for name, _ in self.unslotted])}): less than one slot width "
                f"({1e3 * rules.slot_width:g} mm) would be left between slots or to an end; {smallest}"
                f"{layers} at {1e3 * rules.offset:g} mm need {1e3 * (2 * spread + between):.1f} mm from node "
                f"to node{offset} and {1e3 * (spread + 0.75 * between):.1f} mm from a node to an end",
            )

    def ends_help(self, rules: Rules) -> bool:
        """Whether shorter ends, with their slots still in them, keep strips apart beyond the rim."""
        return rules.end_distance - self.too_far - LENGTH_ROUNDING > rules.least_end_distance

    def _shorter(self, rules: Rules) -> str:
        """Ends so short that no strips meet beyond the rim."""
        if not self.ends_help(rules):
            return f"{self.other_cells}; or move the rim" if self.other_cells else "move the rim"
        end_distance = rules.end_distance - self.too_far - LENGTH_ROUNDING
        overhang = max(rules.rim_overhang - self.too_far - LENGTH_ROUNDING, 0.0)
        lengths = f"end_distance = {rounded(end_distance, up=False):g}"
        if rules.rim_overhang:
            lengths += f" and rim_overhang = {rounded(overhang, up=False):g}"
        return f"write {lengths}, or move the rim"


def _few(names: Sequence[str]) -> str:
    """The first names of a list."""
    return ", ".join(names[:5]) + (", ..." if len(names) > 5 else "")

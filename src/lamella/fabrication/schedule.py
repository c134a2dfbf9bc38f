"""The part list: a CSV table with one row a part."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.sheet import Nesting
from lamella.files.write.table import Column, write_table
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas

# parts that differ by less (m) can stand for each other
CONGRUENT = 1e-5
# places along a bowed centre line at which it is compared
COMPARED = 33


@dataclass(frozen=True)
class Row:
    """What a row of the part list is made from.

    Attributes
    ----------
    part : Part
    darboux : (3,)
        Largest magnitudes of kg, tg and kn along the part, 1/m.
    stresses : (6,)
        Largest magnitudes along the part: bending, torsion, helix, restraint, layer, von Mises, MPa.
    utilisation, net_section : float
        The largest along the part, and at its slots.
    sheets : tuple of int
        Numbers of the sheets its pieces lie on, from 1.
    same_as : str
        Id of the first part congruent to it; empty where there is none.
    """

    part: Part
    darboux: Floats
    stresses: Floats
    utilisation: float
    net_section: float
    sheets: tuple[int, ...]
    same_as: str


def _largest(name: str, meaning: str, value: Callable[[Row], float]) -> Column[Row]:
    """A column of figures with six digits."""
    return Column(name, meaning, lambda row: f"{value(row):.6g}")


COLUMNS: tuple[Column[Row], ...] = (
    Column("id", "of the part", lambda row: row.part.id),
    Column("family", "`A` or `B`", lambda row: row.part.family),
    Column("quantity", "pieces to cut: one for each layer", lambda row: row.part.quantity),
    Column("length_mm", "of the centre line, end to end", lambda row: f"{1e3 * row.part.length:.4f}"),
    Column(
        "radius_mm",
        "of the centre line; empty for straight parts",
        lambda row: f"{1e3 / abs(row.part.curvature):.4f}" if row.part.curvature else "",
    ),
    Column(
        "node_distances_mm",
        "between the nodes on the part, with `;` between",
        lambda row: ";".join([f"{distance:.4f}" for distance in (1e3 * np.diff(row.part.nodes)).tolist()]),
    ),
    Column("slots", "their number", lambda row: len(row.part.slots)),
    Column("mass_kg", "of one piece", lambda row: f"{row.part.mass:.6g}"),
    _largest("geodesic_curvature_max_1/m", "largest magnitude along the part", lambda row: row.darboux[0]),
    _largest("geodesic_torsion_max_1/m", "largest magnitude along the part", lambda row: row.darboux[1]),
    _largest("normal_curvature_max_1/m", "largest magnitude along the part", lambda row: row.darboux[2]),
    _largest("bending_MPa", "largest magnitude along the part, as the following", lambda row: row.stresses[0]),
    _largest("torsion_MPa", "", lambda row: row.stresses[1]),
    _largest("helix_MPa", "the larger of edge and centre", lambda row: row.stresses[2]),
    _largest("restraint_MPa", "", lambda row: row.stresses[3]),
    _largest("layer_MPa", "", lambda row: row.stresses[4]),
    _largest("von_mises_MPa", "", lambda row: row.stresses[5]),
    _largest("utilisation", "", lambda row: row.utilisation),
    _largest("utilisation_net_section", "at the part's slots", lambda row: row.net_section),
    Column(
        "layer",
        "of a part that is one of several layers: its number from the right one",
        lambda row: row.part.layer or "",
    ),
    Column(
        "side",
        "`R`, `L` (`M` the middle one of three, `RR` and `LL` the outer ones of four); else empty",
        lambda row: row.part.side,
    ),
    Column(
        "distance_mm",
        "the layer's distance from the centre line, > 0 to the left; else empty",
        lambda row: f"{1e3 * row.part.distance:.4f}" if row.part.layer else "",
    ),
    Column(
        "bow_mm",
        "how far its centre line leaves a straight line or `radius_mm`, where it is cut to its own curvature",
        lambda row: f"{1e3 * row.part.bow:.4f}" if row.part.bow else "",
    ),
    Column("sheets", "numbers of the sheets its pieces lie on, from 1", lambda row: ";".join(map(str, row.sheets))),
    Column("same_as", "first part of the family congruent to it within 0.01 mm, else empty", lambda row: row.same_as),
)


def write_schedule(
    path: Path,
    parts: Parts,
    nesting: Nesting,
    network: Network,
    lamellas: Lamellas,
    *,
    name: str,
    version: str,
) -> None:
    """Write the part list.

    The first row, after "#", names version and project; the second the columns and their units. Lengths and the mass
    are those of one piece; curvatures and stresses are the largest magnitudes along the part, where
    ``helix_MPa`` is the larger of the edge's tension and the centre's compression. ``layer``, ``side`` and
    ``distance_mm`` say where a part lies that is one of several layers, and ``bow_mm`` how far its centre line leaves a
    straight line or the radius, where it is cut to its own curvature. ``same_as`` names the
    first part of the family that is congruent to this one within 0.01 mm.

    Parameters
    ----------
    path : Path
    parts : Parts
    nesting : Nesting
        Of those parts.
    network : Network
    lamellas : Lamellas
        Of that network.
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    rows = schedule_rows(parts, nesting, network, lamellas)
    write_table(path, [column.name for column in COLUMNS], rows, name=name, version=version)


def schedule_rows(parts: Parts, nesting: Nesting, network: Network, lamellas: Lamellas) -> Iterator[list[object]]:
    """Rows of the part list, a value for each of `COLUMNS`."""
    sheets: list[list[int]] = [[] for _ in parts.parts]
    for part, sheet in zip(nesting.parts.tolist(), nesting.sheets.tolist(), strict=True):
        if sheet + 1 not in sheets[part]:
            sheets[part].append(sheet + 1)
    values = _along_samples(network, lamellas)
    same = congruent_parts(parts)
    for index, part in enumerate(parts.parts):
        samples = _samples(part, network, lamellas)
        largest = values[:, samples].max(axis=1)
        row = Row(
            part,
            largest[:3],
            largest[3:9],
            float(largest[9]),
            _net_section(part, samples, network, lamellas),
            tuple(sorted(sheets[index])),
            "" if same[index] == index else parts.parts[same[index]].id,
        )
        yield [column.value(row) for column in COLUMNS]


def _along_samples(network: Network, lamellas: Lamellas) -> Floats:
    """Magnitudes along all samples, (10, k): kg, tg, kn (1/m), six stresses (MPa), utilisation."""
    pascals = (
        lamellas.bending,
        lamellas.torsion,
        np.maximum(np.abs(lamellas.helix_edge), np.abs(lamellas.helix_centre)),
        lamellas.restraint,
        lamellas.layer,
        lamellas.von_mises,
    )
    return np.abs(
        [
            network.sample_darboux.kg,
            network.sample_darboux.tg,
            network.sample_darboux.kn,
            *[1e-6 * stress for stress in pascals],
            lamellas.utilisation,
        ]
    )


def _net_section(part: Part, samples: Integers, network: Network, lamellas: Lamellas) -> float:
    """Largest utilisation of the half height left at the part's slots, at its samples; 0 where there are none."""
    stops = slice(int(network.stop_offsets[part.lamella]), int(network.stop_offsets[part.lamella + 1]))
    at = network.stop_samples[stops] + network.sample_offsets[part.lamella]
    # both ascend
    on = samples[np.minimum(np.searchsorted(samples, at), len(samples) - 1)] == at
    return float(lamellas.net_utilisation[stops][on].max(initial=0.0))


def _samples(part: Part, network: Network, lamellas: Lamellas) -> Integers:
    """Indices of the network's samples that lie on a part; a part has a node, so there is one at least."""
    stops = slice(int(network.stop_offsets[part.lamella]), int(network.stop_offsets[part.lamella + 1]))
    first, last = int(network.sample_offsets[part.lamella]), int(network.sample_offsets[part.lamella + 1])
    arc = network.sample_arclengths[first:last]
    # marks may be lengthened, so stations on the strip are not arc lengths in space
    stations, arcs = lamellas.stop_stations[stops], network.stop_arclengths[stops]
    low = float(np.interp(part.start, stations, arcs)) if part.start > stations[0] else -np.inf
    high = float(np.interp(part.end, stations, arcs)) if part.end < stations[-1] else np.inf
    inside = (arc >= low) & (arc <= high)
    if network.closed[part.lamella] and part.start < stations[0]:
        # a ring begins half a cell before its first node, which is the end of the last cell
        turn = stations[-1] - stations[0]
        inside |= arc >= np.interp(part.start + turn, stations, arcs)
    if not inside.any():
        middle = np.interp(0.5 * (part.start + part.end), stations, arcs)
        inside[int(np.argmin(np.abs(arc - middle)))] = True
    return np.flatnonzero(inside) + first


def congruent_parts(parts: Parts) -> list[int]:
    """For each part the index of the first one congruent to it within `CONGRUENT`; its own where none is.

    Parts are compared as drawn from their start on: a part and its mirror image count as different. Of one that is cut
    to its own curvature places along the centre line are compared too.
    """
    known: dict[tuple[object, ...], list[tuple[int, Floats]]] = {}
    result = []
    for index, part in enumerate(parts.parts):
        profile = np.concatenate(([part.end], part.nodes, part.slots)) - part.start
        if not part.axis.is_arc:
            along = part.place(np.linspace(part.start, part.end, COMPARED), 0.0)
            profile = np.concatenate((profile, along.ravel()))
        kind = (
            part.family,
            part.curvature,
            part.height,
            part.thickness,
            len(part.nodes),
            len(part.slots),
            len(profile),
        )
        cell = int(np.floor(part.length / CONGRUENT))
        found = index
        for near in (cell - 1, cell, cell + 1):
            for other, shape in known.get((*kind, near), ()):
                if other < found and np.abs(shape - profile).max() <= CONGRUENT:
                    found = other
        if found == index:
            known.setdefault((*kind, cell), []).append((index, profile))
        result.append(found)
    return result

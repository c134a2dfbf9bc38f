"""The part list: a CSV table with one row a part."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.sheet import Nesting
from lamella.files.write.text import csv_comment
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas

# parts that differ by less (m) can stand for each other
CONGRUENT = 1e-5
# places along a bowed centre line at which it is compared
COMPARED = 33

COLUMNS = (
    "id",
    "family",
    "quantity",
    "length_mm",
    "radius_mm",
    "node_distances_mm",
    "slots",
    "mass_kg",
    "geodesic_curvature_max_1/m",
    "geodesic_torsion_max_1/m",
    "normal_curvature_max_1/m",
    "bending_MPa",
    "torsion_MPa",
    "helix_MPa",
    "restraint_MPa",
    "layer_MPa",
    "von_mises_MPa",
    "utilisation",
    "utilisation_net_section",
    "layer",
    "side",
    "distance_mm",
    "bow_mm",
    "sheets",
    "same_as",
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
    sheets: list[list[int]] = [[] for _ in parts.parts]
    for part, sheet in zip(nesting.parts.tolist(), nesting.sheets.tolist(), strict=True):
        if sheet + 1 not in sheets[part]:
            sheets[part].append(sheet + 1)
    values = _along_samples(network, lamellas)
    same = congruent_parts(parts)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        file.write(f"# lamella {csv_comment(version)} · project {csv_comment(name)}\n")
        writer.writerow(COLUMNS)
        for index, part in enumerate(parts.parts):
            largest = values[:, _samples(part, network, lamellas)].max(axis=1)
            writer.writerow(
                (
                    part.id,
                    part.family,
                    part.quantity,
                    f"{1e3 * part.length:.4f}",
                    f"{1e3 / abs(part.curvature):.4f}" if part.curvature else "",
                    ";".join([f"{distance:.4f}" for distance in (1e3 * np.diff(part.nodes)).tolist()]),
                    len(part.slots),
                    f"{part.mass:.6g}",
                    *[f"{value:.6g}" for value in largest.tolist()],
                    f"{_net_section(part, network, lamellas):.6g}",
                    part.layer or "",
                    part.side,
                    f"{1e3 * part.distance:.4f}" if part.layer else "",
                    f"{1e3 * part.bow:.4f}" if part.bow else "",
                    ";".join(map(str, sorted(sheets[index]))),
                    "" if same[index] == index else parts.parts[same[index]].id,
                )
            )


def _along_samples(network: Network, lamellas: Lamellas) -> Floats:
    """Magnitudes along all samples in the columns' order and units, (10, k)."""
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


def _net_section(part: Part, network: Network, lamellas: Lamellas) -> float:
    """Largest utilisation of the half height left at the part's slots; 0 where there are none."""
    stops = slice(int(network.stop_offsets[part.lamella]), int(network.stop_offsets[part.lamella + 1]))
    at = network.stop_samples[stops] + network.sample_offsets[part.lamella]
    on = np.isin(at, _samples(part, network, lamellas))
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

"""Strips both ways: figures of the developable ones beside the twisted ones, which is recommended, where none exist."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella.base.drawing_origin import coordinates
from lamella.base.message import Message
from lamella.base.wording import counted, rounded
from lamella.stages.figure import ABSENT, INTEGER, NUMBER, TEXT, list_of, nullable, record
from lamella.stages.lamellas.output import LamellasOutput
from lamella.strip.developable_strips import DevelopableStrips, meeting_offsets

TIES = 9
"""Decimals of a metre to which heights are compared: which of equal places is named does not hang on the last bits."""

SCHEMA = record(
    share=NUMBER,
    height_min=nullable(NUMBER),
    strain_max=nullable(NUMBER),
    stress_bending_max=nullable(NUMBER),
    utilisation_max=nullable(NUMBER),
    meeting_off_max=nullable(NUMBER),
    recommended=TEXT,
    lamellas=INTEGER,
    optimised=nullable(
        record(
            (
                "planarity_before_max",
                "planarity_max",
                "shift_max",
                "tilt_max_deg",
                "turn_max_deg",
            ),
            lamellas=INTEGER,
            fault=nullable(TEXT),
            planarity_before_max=NUMBER,
            planarity_max=NUMBER,
            shift_max=NUMBER,
            tilt_max_deg=NUMBER,
            turn_max_deg=NUMBER,
        )
    ),
    places=list_of(
        record(lamella=TEXT, start=NUMBER, end=NUMBER, height_min=NUMBER, point=list_of(NUMBER)),
    ),
)
MEANING = (
    '`lamella.strips = "developable"`: `share` of the lamellas along which a developable strip of the height exists, '
    "`height_min` (m) up to which one does everywhere, null where nothing limits it; where it exists `strain_max` and "
    "`stress_bending_max` (Pa) at its faces, "
    "`utilisation_max`, and `meeting_off_max` (m), how far from the normal two strips meet at their edges; "
    "`recommended`: `twisted` or `developable`, and how many `lamellas` are stressed less as developable strips; "
    "`optimised`, null where strips exist everywhere: of the `lamellas` along which none does somewhere, strips "
    "between the surface and its parallel surface at their height, both borders moved until they are planar: largest "
    "planarity score before and after, how far borders moved (`shift_max`, m), how far rulings lean "
    "(`tilt_max_deg`), and how much they turn between two quads (`turn_max_deg`: they jump where no developable strip "
    "is); or the `fault` that prevented it; "
    "`places` where none exists, with `start` and `end` (m along the lamella), `height_min` (m) and the `point` of that"
)


def developable_figure(out: LamellasOutput) -> Any:
    """The value of the figure."""
    strips = out.developable
    if strips is None:
        return ABSENT
    network, section = out.network, out.lamellas.section
    there = strips.exists.any()
    curvature = float(strips.curvatures[strips.exists].max()) if there else None
    stress = float(strips.bending[strips.exists].max()) if there else None
    off = meeting_offsets(network, strips, section.height)
    # on two levels strips do not meet
    off = off[np.isfinite(off)] if section.level == 0 else off[:0]
    least = float(strips.heights.min())
    places = []
    for lamella, first, last in strips.gaps(network):
        worst = first + int(np.argmin(np.round(strips.heights[first : last + 1], TIES)))
        places.append(
            {
                "lamella": network.ids[lamella],
                "start": float(network.sample_arclengths[first]),
                "end": float(network.sample_arclengths[last]),
                "height_min": float(strips.heights[worst]),
                "point": network.sample_points[worst].tolist(),
            }
        )
    return {
        "share": strips.share,
        "height_min": least if np.isfinite(least) else None,
        "strain_max": None if curvature is None else section.thickness / 2 * curvature,
        "stress_bending_max": stress,
        "utilisation_max": None if stress is None else stress / out.material.strength,
        "meeting_off_max": float(off.max()) if len(off) else None,
        "recommended": recommended(out, strips),
        "lamellas": int(np.sum(_better(out, strips))),
        "optimised": None if out.optimised is None else out.optimised.figures(),
        "places": places,
    }


def recommended(out: LamellasOutput, strips: DevelopableStrips) -> str:
    """Developable strips where they exist everywhere and are stressed less, else twisted ones."""
    stress = float((strips.bending / out.material.strength).max())
    return "developable" if stress < float(out.lamellas.utilisation.max()) else "twisted"


def _better(out: LamellasOutput, strips: DevelopableStrips) -> Any:
    """Lamellas that are stressed less as developable strips."""
    starts = out.network.sample_offsets[:-1]
    own = np.maximum.reduceat(strips.bending / out.material.strength, starts)
    return own < np.maximum.reduceat(out.lamellas.utilisation, starts)


def developable_warnings(out: LamellasOutput) -> Iterator[Message]:
    """Where no developable strip of the height exists, and which strips are recommended."""
    strips = out.developable
    if strips is None:
        return
    network, height = out.network, out.lamellas.section.height
    gaps = strips.gaps(network)
    if gaps:
        worst = int(np.argmin(np.round(strips.heights, TIES)))
        lamella = int(np.searchsorted(network.sample_offsets, worst, "right")) - 1
        least = float(strips.heights[worst])
        lower = f"lower strips (height = {rounded(least, up=False):g}) or " if rounded(least, up=False) > 1e-4 else ""
        yield Message(
            "not_developable",
            f"no developable strip {height:g} m high exists at {counted(len(gaps), 'place')} "
            f"({1 - strips.share:.0%} of the lamellas): the buildable height is {least:.3g} m in lamella "
            f"{network.ids[lamella]} at ({coordinates(network.sample_points[worst], 3)}) m (all places are in the "
            f"summary, lamellas.developable.places): {lower}strips = 'twisted' can be built",
        )
    best = recommended(out, strips)
    stress = float((strips.bending / out.material.strength).max())
    used = float(out.lamellas.utilisation.max())
    told = f"{stress:.2f}" if np.isfinite(stress) else "without bound, where none exists"
    yield Message(
        "strips_recommended",
        f"{best} strips are recommended: the utilisation of developable ones is {told}, that of twisted ones {used:.2f}"
        f"; {int(np.sum(_better(out, strips)))} of {counted(len(network.ids), 'lamella')} are stressed less as "
        "developable strips",
    )

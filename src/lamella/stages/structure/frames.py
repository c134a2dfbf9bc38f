"""Load cases, load factors and modes of a structure as frames of the viewer's sliders."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.network.network import FAMILIES
from lamella.solid.finish import finish
from lamella.stages.lamellas.scene import LOOKS
from lamella.stages.network.scene import stop_places
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.sample_motion import SampleMotion
from lamella.structure.beam.poses import Poses
from lamella.view.scene.frames import Frames, Motion
from lamella.view.scene.layer import LinesLayer, StripsLayer
from lamella.view.scene.quantity import FAMILY_COLOURS, magnitude
from lamella.view.scene.thinning import kept_samples, kept_stops

FRAMED_SAMPLES = 1_000_000
"""Samples times frames of a slider."""

MOST_STEPPED = 6
"""Cases whose load steps have a slider: those that are used most."""

DRAWN_SHIFT = 0.03
"""Of the size of the net: what the largest shift is drawn as at first."""

MODE_SHARE = 1e-3
"""Of the size of the net: the largest shift of a mode before it is drawn larger."""

TO_MPA = 1e-6
CABLES = "structure cables"
CABLE_COLOUR = "#3d4650"
HIDDEN = (
    *(f"{kind} {family}" for kind in ("strips", "solids", "lines") for family in FAMILIES),
    *(f"nodes {kind}" for kind in ("regular", "boundary", "singular", "seam")),
    "group:Hardware",
)


@dataclass(frozen=True, eq=False)
class _State:
    """A frame: a pose, the one that its shifts are drawn from, what it is called, and what strips and cables have."""

    caption: str
    value: float
    poses: Poses
    origin: Poses
    use: Floats
    stress: Floats
    cables: Floats


def structure_frames(analysis: Analysis) -> Iterator[Frames]:
    """Cases, the load steps of those that are used most, buckling and swinging."""
    cases = [_of_case(k, case) for k, case in enumerate(analysis.cases)]
    yield from _frames("cases", "Load cases", analysis, cases, continuous=False)
    stepped = [case for case in analysis.cases if case.before]
    stepped.sort(key=lambda case: -round(case.utilisation_max, 9))
    for case in stepped[:MOST_STEPPED]:
        yield from _frames(f"steps {case.name}", f"Load factor: {case.name}", analysis, _steps(case))
    worst = min(analysis.cases, key=lambda case: round(float(case.buckling[0]), 9) if len(case.buckling) else np.inf)
    if len(worst.buckling):
        captions = [f"{worst.name}: buckles at {factor:.4g} times the load" for factor in worst.buckling]
        modes = _modes(analysis, worst, worst.modes, captions)
        yield from _frames("buckling", f"Buckling: {worst.name}", analysis, modes, continuous=False, colour="")
    if len(analysis.frequencies):
        captions = [f"swings with {frequency:.4g} Hz" for frequency in analysis.frequencies]
        modes = _modes(analysis, analysis.cases[0], analysis.swing_modes, captions)
        yield from _frames("swinging", "Natural vibration", analysis, modes, continuous=False, colour="")


def _of_case(number: float, case: CaseResult) -> _State:
    # the state without loads is told from the designed shape, where all the others are drawn from as well
    far = case.displacement_max if case.equilibrium is case.rest else case.deflection_max
    told = f"{case.name}: {1e3 * far:.3g} mm, utilisation {case.utilisation_max:.2f}"
    if not case.converged:
        told += f", {case.load_factor:.3g} of the load"
    use = case.use
    poses, designed = case.equilibrium.poses, case.model.structure.poses
    return _State(told, number, poses, designed, use.utilisation, TO_MPA * use.von_mises, case.cable_forces)


def _steps(case: CaseResult) -> list[_State]:
    """From the state without loads to the last one."""
    states = []
    for state in (case.rest, *case.before, case.equilibrium):
        here = CaseResult(case.name, case.model, state, case.rest, "", np.zeros(0))
        states.append(_of_case(0.0 if state is case.rest else state.factor, here))
    return states


def _modes(analysis: Analysis, case: CaseResult, modes: Floats, captions: Sequence[str]) -> list[_State]:
    """Motions from the state they are about, drawn from the designed shape."""
    size, count = case.equilibrium.structure.size, len(case.equilibrium.poses.points)
    use, states = case.use, []
    for k, (mode, caption) in enumerate(zip(modes, captions, strict=True)):
        shift = np.abs(mode[: 6 * count].reshape(-1, 6)[:, :3]).max()
        moved = case.equilibrium.poses.moved(MODE_SHARE * size / max(float(shift), np.finfo(float).tiny) * mode)
        still = np.zeros_like(use.utilisation)
        states.append(_State(caption, k + 1, moved, case.equilibrium.poses, still, still, case.cable_forces))
    return states


def _frames(
    name: str,
    label: str,
    analysis: Analysis,
    states: Sequence[_State],
    *,
    continuous: bool = True,
    colour: str = "case_use",
) -> Iterator[Frames]:
    """One slider, with strips and cables of its own."""
    model = analysis.model
    network, section = model.lamellas.network, model.lamellas.section
    stops = stop_places(network)[kept_stops(network.stop_offsets, FRAMED_SAMPLES // len(states))]
    samples = kept_samples(network.sample_offsets, stops, FRAMED_SAMPLES // len(states))
    offsets = np.searchsorted(samples, network.sample_offsets)
    layers: list[StripsLayer | LinesLayer] = []
    motions: list[Motion] = []
    largest = 0.0
    for family in FAMILIES:
        own = np.flatnonzero(network.families == family)
        if not len(own):
            continue
        some, begin = _of_lamellas(offsets, own)
        motion = SampleMotion.of(model, samples[some])
        places = [motion.at(state.poses) for state in states]
        shifts = np.stack(
            [place - motion.at(state.origin)[0] for (place, _), state in zip(places, states, strict=True)]
        )
        largest = max(largest, float(np.linalg.norm(shifts, axis=2).max(initial=0.0)))
        values = {
            "case_use": np.stack([motion.values(state.use) for state in states]),
            "case_mises": np.stack([motion.values(state.stress) for state in states]),
        }
        quantities = (
            magnitude("case_use", "Utilisation", "of strength", values["case_use"].max(0)),
            magnitude("case_mises", "Von Mises stress", "MPa", values["case_mises"].max(0)),
        )
        layer = StripsLayer(
            name=f"{name} {family}",
            label=f"Lamellas {family}",
            groups=(family,),
            material=LOOKS[finish(model.lamellas.material.density)],
            colour=FAMILY_COLOURS[family],
            quantities=quantities if colour else (),
            ids=tuple(network.ids[k] for k in own.tolist()),
            positions=motion.points,
            normals=motion.normals,
            offsets=begin,
            sides=section.layer_offsets,
            height=section.height,
            thickness=section.thickness,
        )
        normals = np.stack([normal for _, normal in places])
        layers.append(layer)
        motions.append(Motion(layer.name, displacements=shifts, normals=normals, values=values if colour else {}))
    if len(model.structure.cables):
        cables, moved = _cables(name, analysis, states, colour)
        layers.append(cables)
        motions.append(moved)
    yield Frames(
        name,
        label,
        np.array([state.value for state in states]),
        captions=tuple(state.caption for state in states),
        motions=tuple(motions),
        layers=tuple(layers),
        hides=HIDDEN,
        colour=colour,
        continuous=continuous,
        exaggeration=_round_factor(DRAWN_SHIFT * model.structure.size / largest) if largest else 1.0,
        first=len(states) - 1 if continuous else 0,
    )


def _of_lamellas(offsets: Integers, own: Integers) -> tuple[Integers, Integers]:
    """Places of the samples of some lamellas, and where those of each begin."""
    counts = np.diff(offsets)[own]
    begin = np.concatenate(([0], np.cumsum(counts)))
    return np.arange(begin[-1]) + np.repeat(offsets[:-1][own] - begin[:-1], counts), begin


def _cables(name: str, analysis: Analysis, states: Sequence[_State], colour: str) -> tuple[LinesLayer, Motion]:
    structure = analysis.model.structure
    attachment = structure.cables.attachment
    designed = attachment.ends(structure.poses)[0].reshape(-1, 3)
    shifts = np.stack([(attachment.ends(at.poses)[0] - attachment.ends(at.origin)[0]).reshape(-1, 3) for at in states])
    forces = np.stack([np.repeat(state.cables, 2) for state in states])
    count = len(structure.cables)
    layer = LinesLayer(
        name=f"{name} {CABLES}",
        label="Cables",
        groups=("Cables",),
        colour=CABLE_COLOUR,
        quantities=(magnitude("cable_force", "Cable force", "N", forces.max(0)),) if colour else (),
        ids=tuple(f"cable {k}" for k in range(count)),
        owner=np.repeat(np.arange(count), 2),
        positions=designed,
        offsets=2 * np.arange(count + 1),
        width=2.0,
    )
    values = {"cable_force": forces} if colour else {}
    return layer, Motion(layer.name, displacements=shifts, values=values)


def _round_factor(factor: float) -> float:
    """1, 2, 5, 10, ... at most a factor, and at least 1."""
    if not 1 < factor < np.inf:
        return 1.0
    power = 10.0 ** np.floor(np.log10(factor))
    return float(max(step for step in (1.0, 2.0, 5.0) if step * power <= factor * (1 + 1e-9)) * power)

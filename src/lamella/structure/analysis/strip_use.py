"""Stresses of a net's strips in an equilibrium."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.fibre_stress import strip_stresses
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.model.curve_samples import CurveSamples
from lamella.structure.model.model import Model


@dataclass(frozen=True)
class StripUse:
    """At both ends of the elements, (m, 2).

    Attributes
    ----------
    von_mises : (m, 2)
        Pa, with residual stress.
    utilisation : (m, 2)
        Share of the material's strength; at slots also that of the half height that is left.
    axial : (m,)
        Mean normal stress over the section, Pa.
    """

    von_mises: Floats
    utilisation: Floats
    axial: Floats


def strip_use(model: Model, equilibrium: Equilibrium) -> StripUse:
    """Stresses of all elements of lamellas.

    Combined layers share forces; the strong-axis curvature of a layer beside its centre line, which one line of
    beams does not have, is added as `lamella.strip.lamellas.Lamellas.layer` has it.
    """
    lamellas, lines = model.lamellas, model.lines
    section, network = lamellas.section, lamellas.network
    each = bool((lines.layer >= 0).any())
    # of edge beams nothing is asked here
    m = len(lines.length)
    beside = np.zeros(2 * len(model.structure.beams))
    if section.layer_curves == "offset" and section.layers > 1 and not each:
        lamella = np.broadcast_to(lines.lamella[:, None], lines.arclengths.shape)
        curve = CurveSamples.of_centre_lines(network)
        slopes = curve.integrated(lamella, lines.arclengths, np.abs(network.sample_slopes))
        beside[: 2 * m] = (np.abs(section.layer_offsets).max() * slopes).ravel()
    state = equilibrium.state
    found = strip_stresses(
        state,
        lamellas.material,
        section.height,
        section.thickness,
        layers=1 if each else section.layers,
        beside=beside,
    )
    slot = np.where(lines.crossed, found.net_utilisation[: 2 * m].reshape(-1, 2), 0.0)
    area = section.height * section.thickness * (1 if each else section.layers)
    return StripUse(
        found.von_mises[: 2 * m].reshape(-1, 2),
        np.maximum(found.utilisation[: 2 * m].reshape(-1, 2), slot),
        (state.stress[0] / state.beams.law.length)[:m] / area,
    )

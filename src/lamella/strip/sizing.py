"""How thick, how high and how far apart strips may be and stay elastic.

The utilisation of every sample is computed anew for other measures, by the formulas of `lamella.strip.stress`; of a
lamella the largest counts. With the height the helix stress goes first up and then, where the strip bends as a plate,
down again: what is told is the measure up to which all smaller ones are elastic too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.material import Material
from lamella.network.network import Network
from lamella.strip.lamellas import Section, stresses_of

# of the present measure: from where to where it is looked for, and by which factor at once
LEAST_SHARE_TRIED, LARGEST_SHARE, STEP = 1 / 64, 16.0, 2**0.5
# then the step is halved so often: to 2e-5 of the measure
STEP_HALVINGS = 14


@dataclass(frozen=True, eq=False)
class Sizing:
    """Largest measures of strips, one at a time, the others as they are.

    Attributes
    ----------
    safety : float
        Strength over stress.
    thickness, height, offset : (m,)
        Of each lamella, m; infinite where `LARGEST_SHARE` of the present one is elastic still, or where the measure has
        no part in the stresses, 0 where not even `LEAST_SHARE_TRIED` of it is.
    """

    safety: float
    thickness: Floats
    height: Floats
    offset: Floats

    def measures(self) -> dict[str, Floats]:
        """By name."""
        return {"thickness": self.thickness, "height": self.height, "offset": self.offset}


def largest_measures(network: Network, section: Section, material: Material, safety: float) -> Sizing:
    """Largest thickness, height and layer distance of every lamella with which it stays elastic.

    Parameters
    ----------
    network : Network
    section : Section
    material : Material
    safety : float
        Strength over the largest stress, above 0.
    """
    owner = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))

    def used(**measure: Floats) -> Floats:
        """Safety times the utilisation of each lamella with a measure of its own."""
        at_samples = {name: values[owner] for name, values in measure.items()}
        found = stresses_of(network, section, material, **at_samples)
        return np.asarray(safety * np.maximum.reduceat(found.utilisation, network.sample_offsets[:-1]))

    t, h, d = (np.full(len(network.ids), value) for value in (section.thickness, section.height, section.offset))
    bend = abs(network.normal_curvature)
    # a strip is thinner than high, and its inner edge does not reach the centre of its circle
    highest = 2 / bend if bend else np.inf
    layered = section.layers > 1 and section.layer_curves == "offset"
    return Sizing(
        safety,
        _first_over(lambda x: used(thickness=x), t, section.height),
        _first_over(lambda x: used(height=x), h, highest),
        _first_over(lambda x: used(offset=x), d, np.inf) if layered else np.full(len(d), np.inf),
    )


def _first_over(share: Callable[[Floats], Floats], present: Floats, limit: float) -> Floats:
    """Up to which measure `share` is at most 1, for each lamella; 0 and infinity as in `Sizing`."""
    ratios = LEAST_SHARE_TRIED * STEP ** np.arange(round(np.log(LARGEST_SHARE / LEAST_SHARE_TRIED) / np.log(STEP)) + 1)
    low = np.zeros(len(present))
    high = np.full(len(present), np.inf)
    for ratio in ratios.tolist():
        x = present * ratio
        if x[0] >= limit:
            break
        over = share(x) > 1
        high = np.where(np.isinf(high) & over, x, high)
        low = np.where(np.isinf(high), x, low)
        if np.all(np.isfinite(high)):
            break
    found = np.isfinite(high) & (low > 0)
    for _ in range(STEP_HALVINGS if found.any() else 0):
        middle = np.where(found, np.sqrt(low * np.where(found, high, 1.0)), present)
        over = share(middle) > 1
        high, low = np.where(found & over, middle, high), np.where(found & ~over, middle, low)
    return np.where(np.isinf(high), np.inf, np.where(found, low, 0.0))

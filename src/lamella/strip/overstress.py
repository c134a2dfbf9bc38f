"""What brings an overstressed strip to its strength: how thin, how low, of which material."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Literal

import numpy as np

from lamella.base.material import Material
from lamella.base.wording import rounded
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas, Section
from lamella.strip.sections import bearable, bearable_scale

MEASURES: tuple[Literal["thickness", "height"], ...] = ("thickness", "height")
# materials of the largest strength over stiffness whose utilisation is computed
MATERIALS_TRIED_MAX = 3

Used = Callable[[Section, Material], float]
"""The largest utilisation of the strips of a section and material."""


def ways_to_stand(
    network: Network, lamellas: Lamellas, material: Material, known: Mapping[str, Material], used: Used
) -> str:
    """The measures, or the strength, that bring the utilisation to 1, in words.

    Where no known material of the kind is as strong as the present section takes, the one that is used least stands
    with a smaller section; where neither measure alone is enough, both are made smaller alike, until it does.

    Parameters
    ----------
    network, lamellas, material
        Overstressed.
    known : mapping of str to Material
        By the names that a project may write.
    used : callable
    """
    ways = _measures(lamellas.section, partial(_of, used, material))
    worst = float(lamellas.utilisation.max())
    kind = {
        name: one for name, one in known.items() if (one.shear_strength is None) == (material.shear_strength is None)
    }
    if any(
        worst * material.strength <= one.strength
        and worst * (material.shear_strength or 0.0) <= (one.shear_strength or 0.0)
        for one in kind.values()
    ):
        ways.append(_strength(material, worst))
    else:
        other = _of_known(network, lamellas, kind, used)
        # what is the best one already is named by its measures
        ways += [other] if not ways or repr(_name_of(material, kind)) not in other else []
    return f"{' or '.join(ways)} brings it to 1"


def _name_of(material: Material, known: Mapping[str, Material]) -> str:
    """The name of a material, "" where it has none."""
    return next((name for name, one in known.items() if one == material), "")


def _of(used: Used, material: Material, section: Section) -> float:
    return used(section, material)


def _measures(section: Section, utilisation: Callable[[Section], float]) -> list[str]:
    found = {measure: bearable(section, measure, utilisation) for measure in MEASURES}
    return [f"a {measure} of {value * 1000:g} mm" for measure, value in found.items() if value is not None]


def _strength(material: Material, times: float) -> str:
    """Of a material whose strengths are so many times as large, in words."""
    shear = material.shear_strength
    also = f" and a shear strength of {rounded(shear * times / 1e6, up=True):g} MPa" if shear else ""
    return f"a material as stiff with a strength of {rounded(material.strength * times / 1e6, up=True):g} MPa{also}"


def _of_known(network: Network, lamellas: Lamellas, kind: Mapping[str, Material], used: Used) -> str:
    """The best known material, with the section it stands with, in words."""
    section = lamellas.section
    # bending and torsion go with the stiffness
    first = sorted(kind, key=lambda name: -kind[name].strength / kind[name].youngs_modulus)[:MATERIALS_TRIED_MAX]
    share = {name: used(section, kind[name]) for name in first}
    best = min(first, key=share.__getitem__)
    name = f"material = {best!r}"
    if share[best] <= 1:
        return name
    utilisation = partial(_of, used, kind[best])
    measures = _measures(section, utilisation)
    if measures:
        return f"{name} with {' or '.join(measures)}"
    small = bearable_scale(section, utilisation)
    worst = int(np.argmax(lamellas.utilisation))
    darboux = network.sample_darboux
    bent = (
        f"the surface bends strips there by {abs(darboux.kg[worst]):.3g} 1/m and twists them by "
        f"{abs(darboux.tg[worst]):.3g} 1/m"
    )
    if small is None:
        return f"a less curved surface ({bent}, more than any section of {best} bears)"
    return f"{name} with a section of {small[0] * 1000:g} x {small[1] * 1000:g} mm ({bent})"

"""What the strips of a project may be used while its boundary is adjusted."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.network.adjust.strip_limit import StripLimit
from lamella.network.network import Network
from lamella.project.tables import Project
from lamella.stages.section_of_table import section_of
from lamella.strip.lamellas import stresses_of
from lamella.strip.levels import on_levels
from lamella.strip.stress import stresses


def strip_limit(project: Project) -> StripLimit | None:
    """The limit of a project's table [network], for strips as its table [lamella] has them."""
    limit = project.network.limit
    if limit is None:
        return None
    section, material = section_of(project), project.material()

    def on_net(network: Network) -> Floats:
        return stresses_of(on_levels(network, section.level), section, material).utilisation

    def alone(kg: Floats, tg: Floats) -> Floats:
        still, held = np.zeros(len(kg)), section.marks == "arc-length"
        found = stresses(
            material,
            section.height,
            section.thickness,
            curvature_error=still,
            layer_curvature=still,
            kg=kg,
            tg=tg,
            held=held,
        )
        return found.utilisation

    return StripLimit(limit.utilisation, on_net, alone, project.network.minimum_length)

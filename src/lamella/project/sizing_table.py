"""The table [sizing]: which measures strips may have."""

from __future__ import annotations

from lamella.project.values import Table, number


class SizingTable(Table):
    """The largest thickness, height and layer distance that stay elastic are looked for, for every lamella."""

    safety: float = number(
        "Strength over stress that is kept, without loads; with k_mod and gamma_m of the material the design strength.",
        "",
        ge=0.1,
        le=100,
        default=1.0,
    )

"""What a part looks like, from its material."""

from __future__ import annotations

METAL_DENSITY, FIBRE_DENSITY = 2_500.0, 1_200.0
"""kg/m3: metals that are built with are denser (aluminium 2,700), timber is lighter (hardwood 900), laminates of fibres
lie between (1,600 to 2,000)."""


def finish(density: float) -> str:
    """ "metal", "fibre" or "timber"."""
    if density >= METAL_DENSITY:
        return "metal"
    return "fibre" if density >= FIBRE_DENSITY else "timber"

"""Good projects as text, to be spoilt."""

from __future__ import annotations

UNDULOID = """name = "x"
[surface]
kind = "unduloid"
neck_radius = 1.6
bulge_radius = 2.8
height = [-2.0, 2.0]
"""
SURFACES = {
    "unduloid": {"neck_radius": "1.6", "bulge_radius": "2.8", "height": "[-2.0, 2.0]"},
    "nodoid": {"neck_radius": "3.0", "bulge_radius": "9.0", "height": "[-1.5, 1.5]"},
    "catenoid": {"neck_radius": "2.0", "height": "[-2.0, 2.5]"},
    "cylinder": {"radius": "2.0", "height": "[0.0, 4.0]"},
    "helicoid": {"pitch": "4.0", "inner_radius": "1.0", "outer_radius": "4.0", "turns": "1.25"},
    "enneper": {"order": "3", "radius": "0.9", "scale": "4.0"},
    "scherk": {"extent": "1.25", "scale": "3.0"},
}
FULL = "density = 7850\nyoungs_modulus = 210e9\nshear_modulus = 81e9\nstrength = 420e6\n"


def surface(kind: str, /, **values: str) -> str:
    table = SURFACES[kind] | values
    return f'[surface]\nkind = "{kind}"\n' + "".join(f"{key} = {value}\n" for key, value in table.items())

"""Node angles other than 90 degrees: what network.angle and surface.normal_curvature ask of each other."""

from __future__ import annotations

from typing import Any

from lamella.base.number_lists import Refusal
from lamella.project.surface_tables import FormFoundTable


def with_angle(values: Any) -> Any:
    """A project's values, for another angle than 90 degrees with the lamellas' normal curvature in both tables."""
    if not isinstance(values, dict):
        return values
    network, surface = values.get("network"), values.get("surface")
    if not isinstance(network, dict) or not isinstance(surface, dict) or network.get("angle", 90) == 90:
        return values
    curvature = surface.get("normal_curvature", 0.0)
    surface = {"normal_curvature": curvature} | surface if surface.get("kind") == "form-found" else surface
    if network.get("kind", "lamellas") == "lamellas" and isinstance(curvature, float | int):
        network = {"normal_curvature": float(curvature)} | network
    return values | {"network": network, "surface": surface}


def check_angle(surface: Any, angle: float, normal_curvature: float | None) -> None:
    """Refuse what no surface is found for.

    Raises
    ------
    Refusal
    """
    if angle == 90:
        return
    key = "network.angle"
    if not isinstance(surface, FormFoundTable):
        raise Refusal(
            f'angle = {angle:g} deg: lamellas of kind = "{surface.kind}" cross at 90 deg',
            'write angle = 90, or find a surface for the angle between curves: kind = "form-found"',
            key,
        )
    if surface.volume is not None:
        raise Refusal(
            f"a volume is given, and angle = {angle:g} deg has the normal curvature of the lamellas instead",
            "leave volume out and write normal_curvature in [surface]",
            "surface.volume",
        )
    if surface.mean_curvature:
        raise Refusal(
            f"mean_curvature = {surface.mean_curvature:g} 1/m is given, and on a surface of angle = {angle:g} deg it "
            "varies",
            "leave mean_curvature out and write normal_curvature in [surface]",
            "surface.mean_curvature",
        )
    if surface.branch != "stable":
        raise Refusal(
            f"only the surface that goes over into the stable film is found for angle = {angle:g} deg",
            'write branch = "stable" or leave it out',
            "surface.branch",
        )
    if normal_curvature is not None and normal_curvature != surface.normal_curvature:
        raise Refusal(
            f"normal_curvature = {normal_curvature:g} 1/m is another than that of the surface, "
            f"{surface.normal_curvature or 0:g} 1/m: lamellas of that one would cross at other angles",
            "leave it out of [network]",
            "network.normal_curvature",
        )

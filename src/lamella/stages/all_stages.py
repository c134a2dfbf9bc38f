"""The stages of a run, each before those that need it. A new stage is a line here."""

from __future__ import annotations

from typing import Any

from lamella.stages.erection.stage import ErectionStage
from lamella.stages.fabrication.stage import FabricationStage
from lamella.stages.lamellas.stage import LamellasStage
from lamella.stages.network.stage import NetworkStage
from lamella.stages.panels.stage import PanelsStage
from lamella.stages.stage import Stage
from lamella.stages.structure.stage import StructureStage
from lamella.stages.surface.stage import SurfaceStage

STAGES: tuple[Stage[Any], ...] = (
    SurfaceStage(),
    NetworkStage(),
    LamellasStage(),
    FabricationStage(),
    ErectionStage(),
    StructureStage(),
    PanelsStage(),
)

WRITES = (
    ("summary.json", "all figures and warnings"),
    ("project.toml", "the project with all defaults filled in"),
    ("report.html", "the same to look at"),
)
"""Files of every run, besides those of its stages."""

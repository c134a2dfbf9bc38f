"""What the stage "structure" computes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamella.structure.analysis.analyse import Analysis


@dataclass(frozen=True)
class StructureOutput:
    """The analysis of a net as a structure."""

    analysis: Analysis

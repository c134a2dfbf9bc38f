"""What the stage "structure" computes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lamella.structure.analysis.analyse import Analysis
    from lamella.structure.analysis.compared_case import ComparedCase
    from lamella.structure.analysis.driven import Driven
    from lamella.structure.analysis.failure import Failure


@dataclass(frozen=True)
class StructureOutput:
    """A net as a structure.

    Attributes
    ----------
    analysis : Analysis
    failures : tuple of Failure
        Load factors to failure, of the cases that are asked for.
    driven : Driven or None
        Displacement control.
    sensitivity, variants : tuple of ComparedCase
        Others beside the designed structure.
    """

    analysis: Analysis
    failures: tuple[Failure, ...] = ()
    driven: Driven | None = None
    sensitivity: tuple[ComparedCase, ...] = ()
    variants: tuple[ComparedCase, ...] = ()

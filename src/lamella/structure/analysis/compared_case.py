"""One load case of one variant of a structure, as a row of a table."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.load_shares import LoadShares


@dataclass(frozen=True)
class ComparedCase:
    """One case of one variant.

    Attributes
    ----------
    variant, case : str
    reason : str
        Why there are no results, or not of the whole load; empty: there are.
    load_factor : float or None
        Share of the load that was reached; None, as all that follows: the variant cannot stand.
    deflection_max : float or None
        From the state without loads, m.
    von_mises_max : float or None
        Pa.
    utilisation_max, buckling_factor : float or None
        The second one None as well where nothing buckles.
    cable_force_max : float or None
        N.
    shares : LoadShares or None
    """

    variant: str
    case: str
    reason: str
    load_factor: float | None = None
    deflection_max: float | None = None
    von_mises_max: float | None = None
    utilisation_max: float | None = None
    buckling_factor: float | None = None
    cable_force_max: float | None = None
    shares: LoadShares | None = None

    @classmethod
    def of(cls, variant: str, case: CaseResult) -> ComparedCase:
        """Of a case that has been analysed."""
        return cls(
            variant,
            case.name,
            case.reason,
            case.load_factor,
            case.deflection_max,
            case.von_mises_max,
            case.utilisation_max,
            float(case.buckling[0]) if len(case.buckling) else None,
            float(case.cable_forces.max(initial=0.0)),
            LoadShares.of(case.rest, case.equilibrium),
        )

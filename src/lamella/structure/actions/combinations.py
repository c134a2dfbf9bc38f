"""Combinations of actions of EN 1990:2002 with the values of its annex A1 for buildings.

Persistent situations (6.4.3.2): expression 6.10, or 6.10a and 6.10b, whose less favourable one counts. Serviceability
(6.5.3): characteristic 6.14b, frequent 6.15b and quasi-permanent 6.16b combinations.

Which actions are favourable follows from what is looked at, and differs from fibre to fibre: each variable action is
there or not, in every combination one of those that are there leads, and permanent actions come with their upper and
with their lower factor, all of one source with the same (table A1.2(B), note 3).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Literal

from lamella.base.errors import InputError

PSI: dict[str, tuple[float, float, float]] = {
    "A": (0.7, 0.5, 0.3),
    "B": (0.7, 0.5, 0.3),
    "C": (0.7, 0.7, 0.6),
    "D": (0.7, 0.7, 0.6),
    "E": (1.0, 0.9, 0.8),
    "F": (0.7, 0.7, 0.6),
    "G": (0.7, 0.5, 0.3),
    "H": (0.0, 0.0, 0.0),
    "snow": (0.5, 0.2, 0.0),
    "snow above 1000 m": (0.7, 0.5, 0.2),
    "wind": (0.6, 0.2, 0.0),
    "temperature": (0.6, 0.5, 0.0),
}
"""psi0, psi1, psi2 by category of variable actions, table A1.1; snow in Scandinavia is that above 1000 m."""

PERMANENT, SETTLEMENT = "permanent", "settlement"

MOST_COMBINATIONS = 500

Ultimate = Literal["6.10", "6.10a/b"]
Serviceability = Literal["characteristic", "frequent", "quasi-permanent"]


@dataclass(frozen=True)
class Action:
    """What a combination needs to know of a load.

    Attributes
    ----------
    name : str
    category : str
        "permanent", "settlement" or one of `PSI`.
    psi : (psi0, psi1, psi2) or None
        Instead of those of the category.
    group : str
        Variable actions of one group never act together: winds from different sides. Permanent ones of one group come
        from one source. "": permanent actions are one source, wind, snow and temperature one group each, of others
        each is its own.
    """

    name: str
    category: str
    psi: tuple[float, float, float] | None = None
    group: str = ""

    def __post_init__(self) -> None:
        """Raise an `InputError` for a category that is none."""
        if self.category not in (PERMANENT, SETTLEMENT, *PSI):
            raise InputError(
                f"the category {self.category!r} of {self.name!r} is none of EN 1990",
                f"choose one of {', '.join((PERMANENT, SETTLEMENT, *PSI))}",
                "category",
            )

    @property
    def combined_by(self) -> tuple[float, float, float]:
        """psi0, psi1, psi2."""
        return self.psi or PSI[self.category]

    @property
    def source(self) -> str:
        """Name of its group."""
        if self.group:
            return f"group {self.group}"
        kind = self.category.partition(" ")[0]
        return kind if kind in (PERMANENT, "snow", "wind", "temperature") else f"load {self.name}"


@dataclass(frozen=True)
class PartialFactors:
    """Partial factors, set B of table A1.2(B); of settlements annex A2, table A2.4(B), note 3, non-linear analysis.

    Attributes
    ----------
    permanent, favourable : float
        gamma_G,sup and gamma_G,inf.
    variable : float
        gamma_Q of unfavourable actions; favourable ones are left out.
    settlement : float
    reduction : float
        xi of 6.10b.
    """

    permanent: float = 1.35
    favourable: float = 1.0
    variable: float = 1.5
    settlement: float = 1.35
    reduction: float = 0.85


@dataclass(frozen=True)
class Combination:
    """Loads that act together.

    Attributes
    ----------
    name : str
    factors : mapping
        By the loads' names; of those that take part.
    rule : str
        Where it comes from: "6.10", "6.10a", ..., or "listed".
    """

    name: str
    factors: Mapping[str, float] = field(hash=False)
    rule: str = "listed"

    @property
    def formula(self) -> str:
        """ "1.35 weight + 1.5 snow + 0.9 wind"."""
        return " + ".join(f"{factor:.6g} {name}" for name, factor in self.factors.items())


def ultimate_combinations(
    actions: Sequence[Action], factors: PartialFactors | None = None, expression: Ultimate = "6.10"
) -> tuple[Combination, ...]:
    """Combinations for persistent situations.

    Parameters
    ----------
    actions : sequence of Action
    factors : PartialFactors, optional
    expression : "6.10" or "6.10a/b"

    Raises
    ------
    InputError
        More combinations than anybody looks at.
    """
    given = factors or PartialFactors()
    permanent = list(_permanent(actions, given))
    found: list[tuple[str, dict[str, float]]] = []
    for together in _together(actions):
        for upper, lower in permanent:
            base = upper | lower
            if expression == "6.10":
                found += [("6.10", base | q) for q in _led(together, given.variable, None, 0)]
                continue
            found.append(("6.10a", base | {a.name: given.variable * a.combined_by[0] for a in together}))
            reduced = {name: given.reduction * factor for name, factor in upper.items()} | lower
            found += [("6.10b", reduced | q) for q in _led(together, given.variable, None, 0) if together]
    return _named(actions, found)


def serviceability_combinations(actions: Sequence[Action], kind: Serviceability) -> tuple[Combination, ...]:
    """Combinations for the serviceability limit state.

    Raises
    ------
    InputError
        More combinations than anybody looks at.
    """
    leading, others = {"characteristic": (None, 0), "frequent": (1, 2), "quasi-permanent": (2, 2)}[kind]
    ones = PartialFactors(1.0, 1.0, 1.0, 1.0)
    found = [
        (kind, upper | lower | q)
        for together in _together(actions)
        for upper, lower in _permanent(actions, ones)
        for q in _led(together, 1.0, leading, others)
    ]
    return _named(actions, found)


def _permanent(actions: Sequence[Action], given: PartialFactors) -> Iterator[tuple[dict[str, float], dict[str, float]]]:
    """Factors of permanent actions: the unfavourable ones and the others, for every choice of sources."""
    sources: dict[str, list[str]] = {}
    for action in actions:
        if action.category == PERMANENT:
            sources.setdefault(action.source, []).append(action.name)
    settling = [action.name for action in actions if action.category == SETTLEMENT]
    # settlements that are favourable are not counted on
    for settles in product((True, False), repeat=len(settling)):
        moved = {name: given.settlement for name, there in zip(settling, settles, strict=True) if there}
        for unfavourable in product((True, False), repeat=len(sources)):
            upper: dict[str, float] = {}
            lower = dict(moved)
            for names, bad in zip(sources.values(), unfavourable, strict=True):
                if bad:
                    upper |= dict.fromkeys(names, given.permanent)
                else:
                    lower |= dict.fromkeys(names, given.favourable)
            yield upper, lower


def _together(actions: Sequence[Action]) -> Iterator[tuple[Action, ...]]:
    """Every set of variable actions that can act together, the largest first, the empty one last."""
    groups: dict[str, list[Action]] = {}
    for action in actions:
        if action.category not in (PERMANENT, SETTLEMENT):
            groups.setdefault(action.source, []).append(action)
    number = 1
    for group in groups.values():
        number *= len(group) + 1
    if number > MOST_COMBINATIONS:
        raise InputError(
            f"{number:,} sets of variable loads can act together, more than {MOST_COMBINATIONS}",
            "give loads that never act together one group, or list the combinations that matter",
            "combinations",
        )
    sets = [tuple(a for a in chosen if a is not None) for chosen in product(*([*g, None] for g in groups.values()))]
    yield from sorted(sets, key=len, reverse=True)


def _led(together: tuple[Action, ...], factor: float, leading: int | None, others: int) -> Iterator[dict[str, float]]:
    """Factors of variable actions, each of them once leading; `leading` and `others` choose psi, None: 1."""
    if not together:
        yield {}
    for first in together:
        own = 1.0 if leading is None else first.combined_by[leading]
        yield {action.name: factor * (own if action is first else action.combined_by[others]) for action in together}


def _named(actions: Sequence[Action], found: Sequence[tuple[str, dict[str, float]]]) -> tuple[Combination, ...]:
    """Combinations with names, without those that are there already, loads in their own order."""
    order = [action.name for action in actions]
    seen: dict[tuple[tuple[str, float], ...], str] = {}
    for rule, factors in found:
        kept = tuple((name, round(factors[name], 9)) for name in order if factors.get(name))
        if kept:
            seen.setdefault(kept, rule)
    if len(seen) > MOST_COMBINATIONS:
        raise InputError(
            f"{len(seen):,} combinations are more than {MOST_COMBINATIONS}",
            "give loads that never act together one group, or list the combinations that matter",
            "combinations",
        )
    counts: dict[str, int] = {}
    combinations = []
    for kept, rule in seen.items():
        counts[rule] = counts.get(rule, 0) + 1
        combinations.append(Combination(f"{rule} {counts[rule]}", dict(kept), rule))
    return tuple(combinations)

"""Quantities along curves, for plots and lists beside the view."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers


@dataclass(frozen=True, eq=False)
class Series:
    """A line of a plot: one value a sample.

    Attributes
    ----------
    key, label : str
    values : (n,)
        In the plot's unit.
    """

    key: str
    label: str
    values: Floats


@dataclass(frozen=True, eq=False)
class Plot:
    """Lines over the arc length.

    Attributes
    ----------
    title, unit : str
    series : tuple of Series
    digits : int
        Shown of a value.
    """

    title: str
    unit: str
    series: tuple[Series, ...]
    digits: int = 3


@dataclass(frozen=True, eq=False)
class Fact:
    """A figure of every curve.

    Attributes
    ----------
    label, unit : str
    values : tuple of str or (m,)
        Text, or numbers that the viewer writes with `decimals`.
    decimals : int
        Places behind the point; below 0: three digits.
    """

    label: str
    unit: str
    values: tuple[str, ...] | Floats
    decimals: int = -1


@dataclass(frozen=True, eq=False)
class Curves:
    """Curves that can be chosen; those of layers of strips with the same ids.

    Stages may each give some: those of one name are put together, with the first one's samples.

    Attributes
    ----------
    name : str
        "lamellas".
    noun : str
        What one of them is called, "Lamella".
    ids : tuple of str
    offsets : (m + 1,) int
        Where the samples of each curve begin.
    arclengths : (n,)
        m.
    stop_offsets : (m + 1,) int
        Where the nodes of each curve begin.
    stop_nodes, stop_samples : (q,) int
        Numbers of the nodes, and their samples within the curve.
    facts : tuple of Fact
    plots : tuple of Plot
    worst : str
        Label of the button that chooses the curve with the largest value of the series `worst_by`; empty: no button.
    worst_by : str
    """

    name: str
    noun: str
    ids: tuple[str, ...]
    offsets: Integers
    arclengths: Floats
    stop_offsets: Integers
    stop_nodes: Integers
    stop_samples: Integers
    facts: tuple[Fact, ...] = ()
    plots: tuple[Plot, ...] = ()
    worst: str = ""
    worst_by: str = ""

"""`plot` of results: on axes of the user's, and what it says where matplotlib is not installed."""

from __future__ import annotations

import builtins
from typing import Any

import pytest

import lamella
from lamella import InputError

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")


@pytest.fixture(scope="module")
def strips() -> lamella.Lamellas:
    return lamella.net(lamella.Enneper(3, 0.9, 2.0), cells=8).strips()


def results(strips: lamella.Lamellas) -> list[Any]:
    parts = strips.parts()
    quads = lamella.quad_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0.2], [0, 1, 0]], [[0, 1, 2, 3]])
    surface = strips.network.surface
    return [
        surface,
        surface.mesh(0.02),
        strips.network,
        strips,
        parts,
        parts.parts[0],
        parts.nest(),
        lamella.circle((0, 0, 0), 2.0, (1, 0, 1)),
        quads,
    ]


def test_all_results_are_drawn_on_given_axes(strips: lamella.Lamellas) -> None:
    from matplotlib import pyplot

    for result in results(strips):
        figure, own = pyplot.subplots()
        drawn = result.plot(own)
        assert drawn is own
        assert drawn.collections or drawn.lines, result
        low, high = drawn.get_xlim()
        assert high > low
        figure.canvas.draw()
        pyplot.close(figure)


def test_axes_of_its_own_and_colours(strips: lamella.Lamellas) -> None:
    from matplotlib import pyplot

    plain, torsion = strips.network.plot(), strips.plot(colour="torsion", view=(-30, 40))
    assert plain.figure is not torsion.figure
    # strips and surface; a strip's quads have the colours of both families, or of a scale
    assert len({tuple(c) for c in torsion.collections[0].get_facecolors().round(2)}) > 20
    # and the scale is explained
    assert [axes.get_ylabel() for axes in torsion.figure.axes] == ["", "|geodesic torsion| (1/m)"]
    assert len(plain.figure.axes) == 1
    # the singular node is marked
    assert len(plain.lines) == 1
    pyplot.close("all")
    with pytest.raises(InputError) as caught:
        strips.network.plot(colour="utilisation")
    assert "'utilisation'" in str(caught.value)
    pyplot.close("all")


def test_without_matplotlib(strips: lamella.Lamellas, monkeypatch: pytest.MonkeyPatch) -> None:
    original = builtins.__import__

    def no_matplotlib(name: str, *args: Any, **options: Any) -> Any:
        if name.split(".")[0] == "matplotlib":
            raise ImportError(name)
        return original(name, *args, **options)

    monkeypatch.setattr(builtins, "__import__", no_matplotlib)
    with pytest.raises(InputError) as caught:
        strips.plot()
    assert "lamella[pictures]" in caught.value.remedy
    # the sketch of a notebook needs nothing
    assert "<svg" in strips._repr_html_()

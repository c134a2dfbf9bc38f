"""The scene of a run: what its stages show, with a ground below it and a person beside it."""

from __future__ import annotations

from collections.abc import Iterator

from lamella.stages import all_stages
from lamella.stages.results import Results
from lamella.view.scene.scene import Scene, Shown, make_scene
from lamella.view.surroundings import surroundings


def scene_of(results: Results, *, still: bool = False) -> Scene:
    """What a report or a notebook, or, where it is to stand still, a picture shows of a run."""
    shown = list(_shown(results, still=still))
    name = results.project.name
    low, high = make_scene(name, shown).box
    return make_scene(name, [*shown, *surroundings(low, high)], results.origin)


def _shown(results: Results, *, still: bool) -> Iterator[Shown]:
    for stage in all_stages.STAGES:
        if stage.name in results.outputs:
            give = stage.still if still else stage.scene
            yield from give(results.outputs[stage.name], results.upstream)

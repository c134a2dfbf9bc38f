"""The scene of a run: what its stages show, with a ground below it and a person beside it."""

from __future__ import annotations

from collections.abc import Iterator

from lamella.stages import all_stages
from lamella.stages.results import Results
from lamella.view.scene.scene import Scene, Shown, make_scene
from lamella.view.surroundings import surroundings


def scene_of(results: Results) -> Scene:
    """What a report, a notebook or a picture shows of a run."""
    shown = list(_shown(results))
    name = results.project.name
    low, high = make_scene(name, shown).box
    return make_scene(name, [*shown, *surroundings(low, high)], results.origin)


def _shown(results: Results) -> Iterator[Shown]:
    for stage in all_stages.STAGES:
        if stage.name in results.outputs:
            yield from stage.scene(results.outputs[stage.name], results.upstream)

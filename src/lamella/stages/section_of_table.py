"""The cross section and layout of a project's lamellas."""

from __future__ import annotations

from lamella.project.tables import Project
from lamella.strip.lamellas import Section

LEVEL_PLAY = 0.001
"""m; more than the plate between them that two levels are apart: the strips bend and twist over its length."""


def section_of(project: Project) -> Section:
    """The section of the table [lamella], on two levels where [joint] stacks the families."""
    joint, measures = project.joint, project.lamella.model_dump(exclude={"material", "strips"})
    if joint is None or joint.kind != "stacked":
        return Section(**measures)
    gap = joint.washer_thickness + LEVEL_PLAY if joint.level_gap is None else joint.level_gap
    return Section(**measures, level=(project.lamella.height + gap) / 2)

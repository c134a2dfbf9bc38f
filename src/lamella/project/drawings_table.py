"""The table [drawings]: sheets for people, as PDF and SVG."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from lamella.project.values import Name, Table


class DrawingsTable(Table):
    """Drawings for people: fabrication/drawings.pdf and the cutting drawings as SVG. They are written where this table
    or [joint] is given.
    """

    language: Name = Field(
        default="en",
        description='"en" or "de"; further languages are files of the folder drawings/terms of the program.',
    )
    paper: Literal["A3", "A1"] = Field(default="A3", description="Sheets, in landscape.")
    pdf: bool = Field(default=True, description="Whether drawings.pdf is written.")
    svg: bool = Field(default=True, description="Whether the cutting drawings are written as SVG too.")

"""The table files.csv: how lists are written."""

from __future__ import annotations

from typing import Literal

from pydantic import Field, model_validator

from lamella.base.number_lists import Refusal
from lamella.project.values import Table


class CsvTable(Table):
    """How .csv files are written."""

    separator: Literal[",", ";", "\t"] = Field(default=",", description="Between columns: a tabulator is \\t.")
    decimal: Literal[".", ","] = Field(default=".", description="Decimal sign.")

    @model_validator(mode="after")
    def _apart(self) -> CsvTable:
        if self.separator == self.decimal:
            raise Refusal(
                'a comma is both separator and decimal sign: "1,5" could be two columns',
                'write separator = ";" with decimal = ","',
                "decimal",
            )
        return self

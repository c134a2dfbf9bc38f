"""JSON schema of summary.json, made from the figures of all stages."""

from __future__ import annotations

from typing import Any

from lamella.stages import all_stages
from lamella.stages.figure import NUMBER, TEXT, figures_schema, list_of, nullable


def summary_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of summary.json."""
    stages = {
        stage.name: nullable(figures_schema(stage.figures)) | {"description": "null where it was not run"}
        for stage in all_stages.STAGES
    }
    hashes = {"type": "object", "additionalProperties": TEXT}
    properties = {
        "schema": {"const": "lamella/summary/1"},
        "version": TEXT | {"description": "of the program"},
        "name": TEXT | {"description": "of the project"},
        **stages,
        "warnings": list_of(TEXT) | {"description": "sentences"},
        "seconds": {
            "type": "object",
            "additionalProperties": NUMBER,
            "description": "CPU time of each stage, and of writing files [s]",
        },
        "files": hashes | {"description": "all other files of the run: name to SHA-256 of its bytes"},
        "seal": TEXT | {"description": "SHA-256 of this table as JSON without spaces, `seconds` and `seal` left out"},
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "lamella/summary/1",
        "title": "lamella summary.json",
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }

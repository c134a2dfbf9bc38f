"""Modules of the viewer in one script, for pages that are one file."""

from __future__ import annotations

import re
from importlib.resources import files

IMPORT = re.compile(r'^import \{[^}]*\} from "\./(\w+)\.js";\n', re.MULTILINE)
COMMENT = re.compile(r"^[ \t]*(?:/\*\*(?:(?!\*/).)*\*/|//[^\n]*)[ \t]*\n", re.MULTILINE | re.DOTALL)
"""Of whole lines: most of them are types for the checker."""
EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const)\b)", re.MULTILINE)


def asset(name: str) -> str:
    """A file of `view/assets` as text."""
    return files("lamella.view").joinpath("assets", name).read_text(encoding="utf-8")


def bundled(entry: str) -> str:
    """A module and all that it imports, each once and after those it needs, as one script without imports.

    Names at the top of a module are the script's: no two modules may have one in common, and imports give no other
    names (both have a test).

    Parameters
    ----------
    entry : str
        File of `view/assets`, "report.js".
    """
    done: dict[str, str] = {}

    def visit(name: str) -> None:
        if name in done:
            return
        text = asset(name)
        # a place in the order only once what it imports has one
        for other in IMPORT.findall(text):
            visit(f"{other}.js")
        done[name] = EXPORT.sub("", COMMENT.sub("", IMPORT.sub("", text))).strip()

    visit(entry)
    return "\n\n".join(done.values()) + "\n"

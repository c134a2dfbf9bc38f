"""`lamella studio`: its options, and the command."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def add_studio(commands: Any) -> None:
    """Add the command to those of the parser."""
    studio = commands.add_parser(
        "studio",
        help="design a project on a page in the browser",
        description="Open a page on which a project is designed: drag, slide, look, undo, save, run. It is served to "
        "this machine alone, and ends with Ctrl+C or half a minute after the page is closed. See docs/studio.md.",
    )
    studio.add_argument("project", type=Path, nargs="?", help="project file (.toml); without it a new one")
    studio.add_argument("--port", type=int, default=0, metavar="N", help="port (default: any that is free)")
    studio.add_argument("--no-browser", action="store_true", help="print the address and open no browser")


def run_studio(arguments: argparse.Namespace) -> None:
    """Serve the project until the end."""
    from lamella.interactive.serve import serve

    serve(arguments.project, port=arguments.port, browser=not arguments.no_browser)

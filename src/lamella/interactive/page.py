"""Files that the page is made of, and those of a run that it links to."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from lamella import __version__
from lamella.interactive.access import Access
from lamella.interactive.project_folder import is_inside

ASSET_TYPES = {
    ".js": "text/javascript; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".csv": "text/csv; charset=utf-8",
    ".pdf": "application/pdf",
}
# of a run that a page links to
REPORT_BYTES_MAX = 500_000_000
_ROOMS = ("lamella.interactive", "lamella.view")


def page(access: Access) -> bytes:
    """The page; its modules are below a path that holds the token."""
    text = _read("lamella.interactive", "studio.html")
    assert text is not None
    return text.replace(b"{{base}}", f"/t/{access.token}/".encode()).replace(b"{{version}}", __version__.encode())


def asset(name: str) -> bytes | None:
    """A module, style or font of the page, by its name alone; None: there is none."""
    if "/" in name or "\\" in name or name.startswith("."):
        return None
    found = (_read(room, name) for room in _ROOMS)
    return next((content for content in found if content is not None), None)


def report_file(name: str, folder: Path) -> Path | None:
    """A file of a run in the project's folder; None: there is none."""
    out = folder / "out"
    path = out / name
    if "\0" in name or not is_inside(path, out) or not path.is_file() or path.stat().st_size > REPORT_BYTES_MAX:
        return None
    return path


def _read(room: str, name: str) -> bytes | None:
    there = files(room) / "assets" / name
    return there.read_bytes() if there.is_file() else None

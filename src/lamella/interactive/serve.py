"""`lamella studio`: a design's session and server, the page in a browser, until it is ended."""

from __future__ import annotations

import threading
import webbrowser
from pathlib import Path

from lamella.base.errors import InputError
from lamella.interactive.server import Server
from lamella.interactive.session import Session
from lamella.project.starter import starter

NEW = "untitled"
"""Stem of a project that is begun anew."""


def studio_session(project: Path | None) -> Session:
    """The session of a project file, or of a new project in the present folder.

    Raises
    ------
    InputError
        There is no such file; every name for a new one is taken.
    """
    if project is not None:
        if project.is_dir():
            raise InputError(f"{project} is a folder, not a project file", "name the .toml file inside it")
        return Session(project.resolve())
    folder = Path.cwd()
    for number in range(1, 1000):
        stem = NEW if number == 1 else f"{NEW}-{number}"
        path = folder / f"{stem}.toml"
        if not path.exists():
            return Session(path, starter("form-found", stem))
    raise InputError(f"{NEW}.toml and 998 more are there already", "name a project file, or work in another folder")


def serve(project: Path | None, *, port: int = 0, browser: bool = True) -> None:
    """Serve a project until SIGINT, or until its pages have been closed for a while.

    Prints one line with the address when it is ready.

    Raises
    ------
    InputError
        See `studio_session`; the port is taken.
    """
    server = Server(studio_session(project), port=port)
    with server:
        print(server.address, flush=True)
        if browser:
            # a browser that stays in the foreground must not keep the server from answering
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        try:
            server.wait()
        except KeyboardInterrupt:
            return

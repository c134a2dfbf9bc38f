"""The studio from Python: a handle whose project and results follow the page, which a notebook shows below the cell."""

from __future__ import annotations

import re
from html import escape
from pathlib import Path

from lamella.base.errors import InputError
from lamella.interactive.serve import studio_session
from lamella.interactive.server import Server
from lamella.interactive.session import Session
from lamella.project.tables import Project
from lamella.stages.results import Results

# origins of notebooks on this machine
NOTEBOOKS = "'self' http://localhost:* http://127.0.0.1:* vscode-webview:"


class Studio:
    """A studio that is open; as the last value of a notebook's cell it is the page.

    Attributes
    ----------
    url : str
        Of the page, with its token.

    Examples
    --------
    >>> import lamella
    >>> table = {"kind": "cylinder", "radius": 2.0, "height": [0.0, 3.0]}
    >>> with lamella.studio(lamella.parse_project({"name": "pipe", "surface": table})) as page:
    ...     print(page.url.startswith("http://127.0.0.1:"), page.project.surface.radius)
    True 2.0
    """

    def __init__(self, session: Session, port: int, height: int) -> None:
        self._session, self._height = session, height
        # who holds the handle decides when it ends
        self._server = Server(session, port=port, linger=None, frames=NOTEBOOKS)
        self.url = self._server.address
        self._server.start()

    @property
    def text(self) -> str:
        """The project as the page has it now."""
        with self._session.changed:
            return self._session.text

    @property
    def project(self) -> Project:
        """The project as the page has it now; while its text has mistakes, the last one without."""
        with self._session.changed:
            if self._session.design is None:
                raise InputError("the project has mistakes", "see the page")
            return self._session.design.project

    @property
    def results(self) -> Results | None:
        """What was computed last, as `lamella.compute` gives it, up to the parts; None: nothing yet."""
        with self._session.changed:
            return self._session.results

    def wait(self, seconds: float = 60.0) -> Results:
        """Wait for the results of the project as it is now.

        Parameters
        ----------
        seconds : float
            At most.

        Raises
        ------
        InputError
            There are none, and why.
        TimeoutError
            They take longer.
        """
        session = self._session

        def is_there() -> bool:
            last = session.last_exact
            return session.problem is not None or (last is not None and last.revision == session.revision)

        with session.changed:
            if not session.changed.wait_for(is_there, seconds):
                raise TimeoutError(f"no results within {seconds:g} s")
            if session.problem is not None:
                raise InputError(session.problem.message, session.problem.remedy, session.problem.where)
            assert session.results is not None
            return session.results

    def close(self) -> None:
        """End it; project and results stay."""
        self._server.close()

    def __enter__(self) -> Studio:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Studio({self._session.file.path.name}, {'closed' if self._server.ended.is_set() else self.url})"

    def _repr_html_(self) -> str:
        if self._server.ended.is_set():
            return f"<code>{escape(repr(self))}</code>"
        style = f"width:100%;height:{self._height}px;border:0"
        return f'<iframe src="{escape(self.url)}" style="{style}" title="lamella studio"></iframe>'


def studio(project: str | Path | Project | None = None, *, port: int = 0, height: int = 720) -> Studio:
    """Open a studio: a page on this machine on which a project is designed.

    Parameters
    ----------
    project : str, Path or Project, optional
        Project file; or a project, which is saved beside the notebook only when the page saves it; or a new one.
    port : int
        0: any that is free.
    height : int
        Of the page in a notebook, pixels.

    Returns
    -------
    Studio
        Its `project` and `results` follow the page; `close` ends it, and so does a `with` statement.

    Raises
    ------
    InputError
        There is no such file, or the port is taken.

    Examples
    --------
    >>> import lamella
    >>> table = {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}
    >>> project = lamella.parse_project({"name": "demo", "surface": table, "network": {"cells": 12}})
    >>> with lamella.studio(project) as page:
    ...     results = page.wait()
    >>> results.network, page.project.surface.neck_radius
    (Network(12 cells: 24 lamellas, 144 nodes, 120 faces), 2.5)
    """
    if not isinstance(project, Project):
        return Studio(studio_session(None if project is None else Path(project)), port, height)
    stem = re.sub(r"[^\w.-]+", "-", project.name).strip(".-") or "project"
    session = Session(Path.cwd() / f"{stem}.toml", project.to_toml())
    return Studio(session, port, height)

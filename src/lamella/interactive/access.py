"""Who may ask the server for something: programs and pages of this machine that know the token."""

from __future__ import annotations

import hmac
import secrets
from dataclasses import dataclass, field
from typing import Protocol
from urllib.parse import parse_qs, urlsplit

ADDRESS = "127.0.0.1"
_NAMES = (ADDRESS, "localhost")


class Headers(Protocol):
    """Of a request."""

    def get(self, name: str, /) -> str | None:
        """A header; None: it is not there."""


@dataclass(frozen=True)
class Asked:
    """A request that may be answered.

    Attributes
    ----------
    path : str
        Without token and query.
    """

    path: str


class RefusedError(Exception):
    """A request that is not answered, and why; nothing else is said of it."""


@dataclass(frozen=True)
class Access:
    """The rule of one server.

    A request needs the token: in the query, as the first part of the path (`/t/TOKEN/...`, so that modules of the page
    find each other), or in the header Authorization. Its Host must be this machine by name or number, so that no other
    name can be made to lead here; an Origin, which browsers send for pages of others, must be the server's own.

    Attributes
    ----------
    port : int
    token : str
    """

    port: int
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24))

    @property
    def address(self) -> str:
        """Of the page, with the token."""
        return f"http://{ADDRESS}:{self.port}/?token={self.token}"

    @property
    def origins(self) -> tuple[str, ...]:
        """Of pages that are answered."""
        return tuple(f"http://{name}:{self.port}" for name in _NAMES)

    def asked(self, target: str, headers: Headers) -> Asked:
        """What is asked for.

        Parameters
        ----------
        target : str
            Path and query.
        headers : mapping
            By name, whatever its case: those that `http.server` gives.

        Raises
        ------
        RefusedError
        """
        host, origin = headers.get("Host"), headers.get("Origin")
        if host not in {f"{name}:{self.port}" for name in _NAMES}:
            raise RefusedError("another host")
        if origin is not None and origin not in self.origins:
            raise RefusedError("another origin")
        parts = urlsplit(target)
        path = parts.path
        given = parse_qs(parts.query, max_num_fields=20).get("token", [""])[0]
        if path.startswith("/t/"):
            _, _, given, *rest = path.split("/", 3)
            path = f"/{rest[0] if rest else ''}"
        authorization = headers.get("Authorization") or ""
        if authorization.startswith("Bearer "):
            given = authorization.removeprefix("Bearer ").strip()
        if not hmac.compare_digest(given.encode(), self.token.encode()):
            raise RefusedError("no or wrong token")
        return Asked(path)

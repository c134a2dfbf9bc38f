"""The server of a session: the page and its files, its websocket, and the door for programs, on loopback alone."""

from __future__ import annotations

import contextlib
import threading
import time
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import orjson

from lamella.base.errors import InputError
from lamella.interactive.access import ADDRESS, Access, RefusedError
from lamella.interactive.door import Answer, answer
from lamella.interactive.fields import key_help
from lamella.interactive.page import ASSET_TYPES, asset, page, report_file
from lamella.interactive.page_socket import PageSocket
from lamella.interactive.session import Session
from lamella.interactive.worker import Worker

# of what a program sends
BODY_BYTES_MAX = 32_000_000
# s without a byte of a request that has begun
REQUEST_PATIENCE = 20.0
# s after the last page has closed
LINGER = 30.0
# s that the end waits for what is being computed
END_PATIENCE = 10.0


class Server:
    """A session with its pages.

    Parameters
    ----------
    session : Session
    port : int
        0: any that is free.
    linger : float or None
        s from the last page's closing to the server's end; None: it does not end by itself.
    frames : str
        Origins of pages that may show this one inside of them, as in a Content-Security-Policy.

    Raises
    ------
    InputError
        The port is taken.
    """

    def __init__(
        self, session: Session, *, port: int = 0, linger: float | None = LINGER, frames: str = "'self'"
    ) -> None:
        self.session = session
        self.linger, self.frames = linger, frames
        self.ended = threading.Event()
        self._worker = Worker(session)
        self._pages, self._left = 0, 0.0
        self._lock = threading.Lock()
        handler = type("Handler", (_Handler,), {"server_": self})
        try:
            self._http = ThreadingHTTPServer((ADDRESS, port), handler)
        except (OSError, OverflowError) as error:
            reason = error.strerror if isinstance(error, OSError) else error
            raise InputError(
                f"port {port} cannot be listened on: {reason}", "choose another one, or leave --port out", "--port"
            ) from None
        self._http.daemon_threads = True
        self._http.block_on_close = False
        self.access = Access(self._http.server_address[1])
        self._thread = threading.Thread(
            target=self._http.serve_forever, args=(0.1,), name="lamella studio", daemon=True
        )

    @property
    def address(self) -> str:
        """Of the page, with the token."""
        return self.access.address

    def start(self) -> None:
        """Begin to answer and to compute."""
        self._worker.start()
        self._thread.start()

    def wait(self) -> None:
        """Wait for the end: that somebody closes it, or that the last page has been closed for a while."""
        while not self.ended.wait(0.25):
            if self._is_left():
                return

    def _is_left(self) -> bool:
        with self._lock:
            gone = self._pages == 0 and self._left > 0
            return gone and self.linger is not None and time.monotonic() - self._left > self.linger

    def close(self) -> None:
        """End everything; the port is free then."""
        if self.ended.is_set():
            return
        self.ended.set()
        self.session.close()
        self._http.shutdown()
        self._http.server_close()
        self._thread.join(END_PATIENCE)
        self._worker.join(END_PATIENCE)

    def __enter__(self) -> Server:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def page_came(self) -> None:
        """A page is there."""
        with self._lock:
            self._pages += 1

    def page_went(self) -> None:
        """A page is gone."""
        with self._lock:
            self._pages -= 1
            self._left = time.monotonic()

    def used(self) -> None:
        """A program has asked something: the server does not end before it has lingered once more."""
        with self._lock:
            if self._left:
                self._left = time.monotonic()


class _Handler(BaseHTTPRequestHandler):
    """One connection."""

    server_: Server
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "lamella", ""
    timeout = REQUEST_PATIENCE

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: standard output holds the address alone."""

    def do_GET(self) -> None:
        path = self._path()
        if path is None:
            return
        if path == "/socket" and "websocket" in (self.headers.get("Upgrade") or "").lower():
            self._socket()
        elif path == "/":
            self._send(page(self.server_.access), "text/html; charset=utf-8", policy=True)
        elif path == "/api":
            self._answered(answer("", b""))
        elif path.startswith("/api/"):
            self._other_method("POST")
        elif path.startswith("/help/"):
            self._send(orjson.dumps(key_help(path.removeprefix("/help/"))), "application/json")
        elif path.startswith("/assets/"):
            self._file(asset(path.removeprefix("/assets/")), path)
        elif path.startswith("/out/"):
            self._file(report_file(path.removeprefix("/out/"), self.server_.session.folder), path)
        else:
            self._fail(HTTPStatus.NOT_FOUND, "there is nothing of that name")

    def do_POST(self) -> None:
        path = self._path()
        if path is None:
            return
        length = self.headers.get("Content-Length") or ""
        if not length.isdigit() or self.headers.get("Transfer-Encoding"):
            self._fail(HTTPStatus.LENGTH_REQUIRED, "the length of the body is needed")
            return
        if int(length) > BODY_BYTES_MAX:
            self._fail(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"at most {BODY_BYTES_MAX / 1e6:g} MB are read")
            return
        body = self.rfile.read(int(length))
        if not path.startswith("/api/"):
            self._fail(HTTPStatus.NOT_FOUND, "there is nothing of that name")
            return
        self.server_.used()
        self._answered(answer(path.removeprefix("/api/"), body))
        self.server_.used()

    def do_PUT(self) -> None:
        if self._path() is not None:
            self._other_method("GET, POST")

    do_HEAD = do_DELETE = do_PATCH = do_OPTIONS = do_PUT

    def _other_method(self, ways: str) -> None:
        self._fail(HTTPStatus.METHOD_NOT_ALLOWED, f"{self.command} is not answered here: use {ways}", allow=ways)

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        """What `http.server` refuses by itself, in JSON as all else."""
        self._fail(HTTPStatus(code), message or HTTPStatus(code).phrase)

    def _path(self) -> str | None:
        """What is asked for; None: it is refused, and that is said already."""
        try:
            return self.server_.access.asked(self.path, self.headers).path
        except RefusedError as reason:
            self._fail(HTTPStatus.FORBIDDEN, f"refused: {reason}")
        except ValueError:
            self._fail(HTTPStatus.BAD_REQUEST, "no request")
        return None

    def _socket(self) -> None:
        lines = [self.requestline, *(f"{name}: {value}" for name, value in self.headers.items()), "", ""]
        self.close_connection = True
        self.connection.settimeout(None)
        # what is shown is sent at once
        self.connection.setsockopt(*_NO_DELAY)
        self.server_.page_came()
        try:
            with contextlib.suppress(OSError):
                PageSocket(self.connection, self.server_.session).serve("\r\n".join(lines).encode("latin-1"))
        finally:
            self.server_.page_went()

    def _file(self, content: bytes | Path | None, name: str) -> None:
        suffix = Path(name).suffix.lower()
        if content is None or suffix not in ASSET_TYPES:
            self._fail(HTTPStatus.NOT_FOUND, "there is nothing of that name")
            return
        self._send(content if isinstance(content, bytes) else content.read_bytes(), ASSET_TYPES[suffix])

    def _answered(self, given: Answer) -> None:
        self._send(given.content, given.type, HTTPStatus(given.status))

    def _fail(self, status: HTTPStatus, message: str, *, allow: str = "") -> None:
        self.close_connection = True
        self._send(orjson.dumps({"error": {"message": message}}), "application/json", status, allow=allow)

    def _send(
        self,
        content: bytes,
        kind: str,
        status: HTTPStatus = HTTPStatus.OK,
        *,
        policy: bool = False,
        allow: str = "",
    ) -> None:
        self.send_response(status)
        if allow:
            self.send_header("Allow", allow)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("Cross-Origin-Resource-Policy", "same-origin")
        if policy:
            self.send_header("Content-Security-Policy", _POLICY + f"; frame-ancestors {self.server_.frames}")
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)


def _no_delay() -> tuple[int, int, int]:
    import socket

    return socket.IPPROTO_TCP, socket.TCP_NODELAY, 1


_NO_DELAY = _no_delay()
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'"
)

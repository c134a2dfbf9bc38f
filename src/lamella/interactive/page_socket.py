"""The websocket of one page: what it does comes in as text, frames go out one at a time as it acknowledges them."""

from __future__ import annotations

import contextlib
import json
import socket
import threading
from collections.abc import Callable, Mapping
from typing import Any

import orjson
from websockets.exceptions import ProtocolError
from websockets.frames import Frame as SocketFrame
from websockets.frames import Opcode
from websockets.http11 import Request
from websockets.protocol import OPEN
from websockets.server import ServerProtocol

from lamella.base.errors import InputError
from lamella.interactive.session import Numbers, Session, Shown
from lamella.project.read import PROJECT_BYTES_MAX

# of a message of a page: a project's text with its escapes
MESSAGE_BYTES_MAX = 2 * PROJECT_BYTES_MAX
READ_BYTES = 65536


class PageSocket:
    """One page.

    Parameters
    ----------
    connection : socket
    session : Session
    """

    def __init__(self, connection: socket.socket, session: Session) -> None:
        self._connection, self._session = connection, session
        self._protocol = ServerProtocol(max_size=MESSAGE_BYTES_MAX)
        self._lock = threading.Lock()
        self._open = True
        self._drags = False
        self._seen = Numbers(-1, 0, 0, -1)
        # of the frame that the page has not acknowledged
        self._waiting: int | None = None
        self._parts: list[bytes] = []

    def serve(self, request: bytes) -> None:
        """Answer a handshake, and then the page until it closes.

        Parameters
        ----------
        request : bytes
            Line and headers of the handshake, as they came.
        """
        protocol = self._protocol
        protocol.receive_data(request)
        for event in protocol.events_received():
            assert isinstance(event, Request)
            protocol.send_response(protocol.accept(event))
        self._send_pending()
        if protocol.state is not OPEN:
            return
        sender = threading.Thread(target=self._send_all, name="lamella page", daemon=True)
        sender.start()
        try:
            self._receive_all()
        finally:
            self._open = False
            if self._drags:
                # what it was dragging when it went
                self._session.drop_draft()
            with self._session.changed:
                self._session.changed.notify_all()
            sender.join(10)

    # ------------------------------------------------------------------------------------------ in

    def _receive_all(self) -> None:
        while self._open:
            try:
                data = self._connection.recv(READ_BYTES)
            except TimeoutError:
                continue
            except OSError:
                data = b""
            with self._lock:
                if data:
                    self._protocol.receive_data(data)
                else:
                    self._protocol.receive_eof()
                events = self._protocol.events_received()
            self._send_pending()
            for event in events:
                if isinstance(event, SocketFrame):
                    self._received(event)
            if not data or self._protocol.close_expected():
                return

    def _received(self, event: SocketFrame) -> None:
        if event.opcode is Opcode.CLOSE:
            self._open = False
        if event.opcode not in (Opcode.TEXT, Opcode.CONT):
            return
        self._parts.append(bytes(event.data))
        if sum(map(len, self._parts)) > MESSAGE_BYTES_MAX:
            self._open = False
            return
        if event.fin:
            text, self._parts = b"".join(self._parts), []
            self._did(text)

    def _did(self, text: bytes) -> None:
        """What the page did; what cannot be is told to it alone."""
        try:
            message = json.loads(text)
            if not isinstance(message, dict):
                raise ValueError("not a table")
        except (ValueError, RecursionError) as error:
            self._tell({"type": "refused", "message": f"no message: {str(error)[:100]}", "remedy": ""})
            return
        try:
            self._act(str(message.get("type")), message)
        except InputError as error:
            record = {"type": "refused", "message": error.message, "remedy": error.remedy, "where": error.where}
            self._tell(record | {"of": message.get("type")})
        except OSError as error:
            self._tell({"type": "refused", "message": error.strerror or str(error), "remedy": "", "of": "save"})

    def _act(self, kind: str, message: Mapping[str, Any]) -> None:
        session = self._session
        if kind == "seen":
            with session.changed:
                if message.get("number") == self._waiting:
                    self._waiting = None
                session.changed.notify_all()
            return
        actions: dict[str, Callable[[], None]] = {
            "drag": lambda: session.edit(message["edit"], draft=True),
            "edit": lambda: session.edit(message["edit"]),
            "drop": session.drop_draft,
            "text": lambda: session.write(str(message["text"])),
            "undo": session.undo,
            "redo": lambda: session.undo(redo=True),
            "save": lambda: session.save(message.get("name"), anyway=bool(message.get("anyway"))),
            "restore": session.restore,
            "forget": lambda: session.restore(drop=True),
            "pin": lambda: session.pin(str(message.get("what", ""))),
            "run": session.start_run,
            "cancel": session.cancel_run,
        }
        if kind not in actions:
            raise InputError(f"unknown message {kind[:40]!r}", "load the page anew")
        if kind in ("drag", "edit") and not isinstance(message.get("edit"), dict):
            raise InputError("there is no edit in the message", "load the page anew")
        self._drags = kind == "drag"
        actions[kind]()

    # ------------------------------------------------------------------------------------------ out

    def _send_all(self) -> None:
        """Send what the page has not seen, until it goes: states and status as they come, frames when it is ready."""
        session = self._session
        with contextlib.suppress(OSError, ProtocolError):
            while self._open:
                with session.changed:
                    session.changed.wait_for(lambda: not self._open or self._has_news())
                    if not self._open:
                        return
                    messages = self._news()
                for one in messages:
                    self._tell(one)

    def _has_news(self) -> bool:
        now, seen = self._session.numbers, self._seen
        if (now.state, now.status) != (seen.state, seen.status):
            return True
        return self._waiting is None and (now.frame, now.pinned) != (seen.frame, seen.pinned)

    def _news(self) -> list[dict[str, Any] | bytes]:
        session, seen = self._session, self._seen
        now = session.numbers
        messages: list[dict[str, Any] | bytes] = []
        frame, pinned = seen.frame, seen.pinned
        if now.state != seen.state:
            messages.append(session.state())
        if now.status != seen.status:
            messages.append(session.status())
        if self._waiting is None and now.pinned != seen.pinned:
            pinned = now.pinned
            messages.append(_message("pinned", session.pinned) or {"type": "unpinned"})
        if self._waiting is None and now.frame != seen.frame:
            frame = now.frame
            whole = _message("frame", session.shown)
            if whole is not None and session.shown is not None:
                self._waiting = session.shown.number
                messages.append(whole)
        self._seen = Numbers(now.state, frame, pinned, now.status)
        return messages

    def _tell(self, message: dict[str, Any] | bytes) -> None:
        with self._lock:
            if self._protocol.state is not OPEN:
                return
            if isinstance(message, bytes):
                self._protocol.send_binary(message)
            else:
                self._protocol.send_text(orjson.dumps(message))
        self._send_pending()

    def _send_pending(self) -> None:
        with self._lock:
            for part in self._protocol.data_to_send():
                if part:
                    self._connection.sendall(part)
                else:
                    with contextlib.suppress(OSError):
                        self._connection.shutdown(socket.SHUT_WR)


def _message(kind: str, shown: Shown | None) -> bytes | None:
    if shown is None:
        return None
    more = {"revision": shown.revision, "seconds": shown.seconds}
    return shown.frame.message(kind, shown.number, more)

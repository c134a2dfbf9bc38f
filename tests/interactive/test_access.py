"""Who is answered: the page itself and programs that know the token, and nobody else."""

from __future__ import annotations

import http.client
import json
import os
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus

from interactive.designs import CATENOID, page_of, served, write
from lamella.base.errors import InputError
from lamella.interactive.project_folder import is_inside, new_name, refuse_outside
from lamella.interactive.server import BODY_BYTES_MAX, Server
from lamella.interactive.session import Session
from lamella.project.read import read_project


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    (tmp_path / "here" / "out" / "demo").mkdir(parents=True)
    (tmp_path / "secret.json").write_text("{}")
    (tmp_path / "here" / "out" / "demo" / "report.html").write_text("the report")
    with served(write(tmp_path / "here", CATENOID)) as server:
        yield server


def ask(
    server: Server, target: str, *, method: str = "GET", body: bytes | None = None, **headers: str
) -> tuple[int, bytes]:
    """Status and body of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", server.access.port, timeout=20)
    try:
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        connection.request(method, target, body, named)
        answer = connection.getresponse()
        return answer.status, answer.read()
    finally:
        connection.close()


def test_the_address_is_answered(server: Server) -> None:
    token = server.access.token
    assert len(token) >= 32
    assert ask(server, f"/?token={token}")[0] == 200
    assert ask(server, f"/api?token={token}", Host=f"localhost:{server.access.port}")[0] == 200
    assert ask(server, "/api", Authorization=f"Bearer {token}")[0] == 200
    assert ask(server, f"/api?token={token}", Origin=f"http://127.0.0.1:{server.access.port}")[0] == 200


def test_others_are_refused(server: Server) -> None:
    token, port = server.access.token, server.access.port
    for target in (
        "/",
        "/?token=",
        f"/?token={token[:-1]}",
        f"/?token={token}x",
        f"/t/{token[:-1]}/assets/studio.js",
        "/api",
    ):
        assert ask(server, target)[0] == 403, target
    good = f"/?token={token}"
    for origin in ("http://evil.example", "null", f"http://127.0.0.1:{port + 1}", f"https://127.0.0.1:{port}"):
        assert ask(server, good, Origin=origin)[0] == 403, origin
        assert ask(server, f"/api/net?token={token}", method="POST", body=b"{}", Origin=origin)[0] == 403, origin
    for host in ("evil.example", f"evil.example:{port}", "127.0.0.1", f"127.0.0.1.evil.example:{port}"):
        assert ask(server, good, Host=host)[0] == 403, host


def test_sockets_of_others_are_refused(server: Server) -> None:
    with page_of(server, Origin=f"http://127.0.0.1:{server.access.port}") as page:
        page.until(lambda: page.state)
    with pytest.raises(InvalidStatus) as refused, page_of(server, Origin="http://evil.example"):
        pass
    assert refused.value.response.status_code == 403


def test_it_listens_on_this_machine_alone(server: Server) -> None:
    assert server._http.server_address[0] == "127.0.0.1"
    with pytest.raises(InputError) as error:
        Server(Session(server.session.file.path), port=server.access.port)
    assert error.value.where == "--port"


def test_no_file_outside_is_read(server: Server, tmp_path: Path) -> None:
    token = server.access.token
    assert ask(server, f"/t/{token}/out/demo/report.html") == (200, b"the report")
    (tmp_path / "here/out/link.json").symlink_to(tmp_path / "secret.json")
    for name in ("../demo.toml", "../../secret.json", "%2e%2e/demo.toml", "link.json", "/etc/passwd", "demo", ""):
        assert ask(server, f"/t/{token}/out/{name}")[0] == 404, name
    for name in ("../studio.py", "..%2fserver.py", "nothing.js", "", ".hidden"):
        assert ask(server, f"/t/{token}/assets/{name}")[0] == 404, name
    assert ask(server, f"/t/{token}/assets/studio.js")[0] == 200


def test_sizes_are_limited(server: Server) -> None:
    target = f"/api/net?token={server.access.token}"
    assert ask(server, target, method="POST", body=b"{}", Content_Length=str(BODY_BYTES_MAX + 1))[0] == 413
    assert ask(server, target, method="POST", body=b"{}", Content_Length="many")[0] == 411
    assert ask(server, f"/?token={server.access.token}&x={'y' * 70_000}")[0] == 414


@pytest.mark.parametrize(
    ("method", "path", "status", "way"),
    [("GET", "/api/net", 405, "POST"), ("PUT", "/api/net", 405, "GET, POST"), ("FLY", "/api/net", 501, "")],
)
def test_other_methods_are_told_which_to_use(server: Server, method: str, path: str, status: int, way: str) -> None:
    found, body = ask(server, f"{path}?token={server.access.token}", method=method)
    assert found == status
    assert way in json.loads(body)["error"]["message"]
    if status == 405:
        assert ask(server, f"{path}?token=wrong", method=method)[0] == 403


def test_what_is_no_request_does_not_end_it(server: Server) -> None:
    for raw in (b"\x00\x01\x02\r\n\r\n", b"GET / HTTP/1.1\r\nHost: \xff\r\n\r\n", b"GET //[ HTTP/1.1\r\n\r\n", b""):
        with socket.create_connection(("127.0.0.1", server.access.port), 5) as connection:
            connection.sendall(raw)
            connection.shutdown(socket.SHUT_WR)
            while connection.recv(4096):
                pass
    with page_of(server) as page:
        page.until(lambda: page.state)
        for text in ("no json", "[]", '{"type": 3}', '{"type": "edit"}', '{"type": "edit", "edit": {"do": "fly"}}'):
            page._connection.send(text)
        page.until(lambda: len(page.refused) == 5)
        assert page.status["problem"] is None
    assert ask(server, f"/?token={server.access.token}")[0] == 200


def test_the_port_is_free_afterwards(tmp_path: Path) -> None:
    with served(write(tmp_path, CATENOID)) as server:
        port = server.access.port
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", port), 1)


def test_it_ends_a_while_after_the_page(tmp_path: Path) -> None:
    with served(write(tmp_path, CATENOID), linger=0.2) as server:
        assert not server._is_left()
        with page_of(server) as page:
            page.until(lambda: page.state)
            assert not server._is_left()
        server.wait()
        assert server._is_left()


def test_projects_name_files_of_their_folder(tmp_path: Path) -> None:
    (tmp_path / "here").mkdir()
    (tmp_path / "out.obj").write_text("")
    (tmp_path / "here" / "link.obj").symlink_to(tmp_path / "out.obj")
    for name, refused in (
        ("in.obj", False),
        ("../out.obj", True),
        ("link.obj", True),
        (str(tmp_path / "out.obj"), True),
    ):
        text = f'[surface]\nkind = "mesh"\nfile = "{name}"\n'
        project = read_project(write(tmp_path / "here", text))
        if not refused:
            refuse_outside(project, tmp_path / "here")
            continue
        with pytest.raises(InputError) as error:
            refuse_outside(project, tmp_path / "here")
        assert error.value.where == "surface.file"


@pytest.mark.parametrize("name", ["", "../x.toml", "a/b.toml", ".hidden.toml", "a\\b.toml", "a\0b", "x" * 300])
def test_names_lead_nowhere_else(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError):
        new_name(name, tmp_path)
    assert new_name("roof", tmp_path) == tmp_path / "roof.toml"
    assert is_inside(tmp_path, tmp_path)
    assert not is_inside(Path(f"{tmp_path}x"), tmp_path)


def test_links_do_not_lead_out(tmp_path: Path) -> None:
    os.symlink(tmp_path.parent / "elsewhere.toml", tmp_path / "roof.toml")
    with pytest.raises(InputError):
        new_name("roof", tmp_path)

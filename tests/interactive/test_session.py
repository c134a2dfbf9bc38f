"""A session: the text is the state, to the byte; what is computed of it is what a run computes."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import lamella
from interactive.designs import CATENOID, RINGS, Page, page_of, served, write
from lamella.base.errors import InputError
from lamella.interactive.server import Server
from lamella.interactive.session import Session

CRLF = "\ufeff" + CATENOID.replace("\n", "\r\n")


def set_cells(session: Session, cells: int) -> None:
    session.edit({"do": "set", "values": [[["network", "cells"], cells]]})


@pytest.mark.parametrize("text", [CATENOID, CRLF, CATENOID.rstrip("\n")])
def test_undo_is_to_the_byte(tmp_path: Path, text: str) -> None:
    path = write(tmp_path, text)
    session = Session(path)
    texts = [session.text]
    for cells in (13, 14, 15):
        set_cells(session, cells)
        texts.append(session.text)
    for text_before in reversed(texts[:-1]):
        session.undo()
        assert session.text == text_before
    session.undo()
    assert session.text == text
    for text_after in texts[1:]:
        session.undo(redo=True)
        assert session.text == text_after
    session.undo()
    set_cells(session, 20)
    assert not session.history.can_redo
    session.undo()
    session.undo()
    session.undo()
    session.save()
    assert path.read_bytes() == text.encode()


def test_a_drag_is_one_step(tmp_path: Path) -> None:
    session = Session(write(tmp_path, RINGS))
    for k in range(5):
        session.edit({"do": "move", "handles": {"0.points.0": [3.0, 0.0, 0.1 * k]}}, draft=True)
        assert session.history.text == RINGS
    session.edit({"do": "move", "handles": {"0.points.0": [3.0, 0.0, 0.5]}})
    assert "[3.0, 0.0, 0.5]," in session.text
    session.undo()
    assert session.text == RINGS
    session.edit({"do": "move", "handles": {"0.points.0": [3.0, 0.0, 0.7]}}, draft=True)
    session.drop_draft()
    assert session.text == RINGS


def test_a_value_that_cannot_be_is_refused(tmp_path: Path) -> None:
    session = Session(write(tmp_path, RINGS))
    for edit, where in (
        ({"do": "set", "values": [[["network", "cells"], 1]]}, "network.cells"),
        ({"do": "set", "values": [[["network", "cels"], 8]]}, "network.cels"),
        ({"do": "move", "handles": {"1.circle.radius": [0.0, 0.0, 2.0]}}, "1.circle.radius"),
        ({"do": "remove_loop", "loop": 0}, "surface.boundary"),
        ({"do": "move", "handles": {"0.points.0": [1.0, 2.0]}}, ""),
        ({"do": "move", "handles": {"0.points.99": [1.0, 2.0, 3.0]}}, "handles"),
        ({"do": "insert_point", "loop": 1, "after": 0}, "surface.boundary"),
        ({"do": "move"}, "do"),
    ):
        with pytest.raises(InputError) as error:
            session.edit(edit)
        assert error.value.where.endswith(where)
        assert session.text == RINGS
    assert session.problem is None


def test_a_text_with_mistakes_is_kept_and_located(tmp_path: Path) -> None:
    session = Session(write(tmp_path, CATENOID))
    session.write(CATENOID.replace("cells = 12", "cells = true"))
    assert session.problem is not None
    assert (session.problem.where, session.problem.line) == ("network.cells", 10)
    session.write(CATENOID.replace("cells = 12", "cells = = 12"))
    assert session.problem.line == 10
    assert session.design is not None
    session.undo()
    session.undo()
    assert (session.problem, session.text) == (None, CATENOID)


def test_what_is_typed_keeps_the_ends_of_lines(tmp_path: Path) -> None:
    session = Session(write(tmp_path, CATENOID.replace("\n", "\r\n")))
    session.write(CATENOID.replace("12", "13"))
    assert session.text == CATENOID.replace("12", "13").replace("\n", "\r\n")


def test_unsaved_changes_are_kept_beside_the_file(tmp_path: Path) -> None:
    path = write(tmp_path, CATENOID)
    first = Session(path)
    set_cells(first, 20)
    changed = first.text
    second = Session(path)
    assert (second.text, second.left) == (CATENOID, changed)
    second.restore()
    assert second.text == changed
    second.save()
    assert path.read_text() == changed
    assert sorted(one.name for one in tmp_path.iterdir()) == ["demo.toml"]
    set_cells(second, 21)
    third = Session(path)
    third.restore(drop=True)
    assert Session(path).left is None


def test_saving_never_overwrites_what_others_wrote(tmp_path: Path) -> None:
    path = write(tmp_path, CATENOID)
    session = Session(path)
    set_cells(session, 20)
    path.write_text("others")
    with pytest.raises(InputError) as error:
        session.save()
    assert error.value.where == "changed"
    assert path.read_text() == "others"
    session.save("copy.toml")
    assert (tmp_path / "copy.toml").read_text() == session.text
    assert session.file.path.name == "copy.toml"
    with pytest.raises(InputError):
        session.save("demo.toml")
    session.save("demo.toml", anyway=True)
    assert path.read_text() == session.text


@pytest.fixture
def rings(tmp_path: Path) -> Iterator[tuple[Server, Page]]:
    with served(write(tmp_path, RINGS)) as server, page_of(server) as page:
        page.until_exact()
        yield server, page


def test_frames_are_of_the_text(rings: tuple[Server, Page], tmp_path: Path) -> None:
    """While a point is dragged lines follow; let go, the net is that of a run of the saved file."""
    server, page = rings
    for k in range(4):
        page.edit("move", drag=True, handles={"0.points.0": [3.0, 0.0, 0.05 * k]})
        page.until(lambda k=k: page.frames[-1]["level"] == "coarse" and page.frames[-1]["revision"] == k + 1)
    page.edit("move", handles={"0.points.0": [3.0, 0.0, 0.2]})
    page.until(lambda: page.state["revision"] == 5)
    frame = page.until_exact()
    page.send("save")
    page.until(lambda: page.state["saved"])
    results = lamella.compute(lamella.read_project(tmp_path / "demo.toml"))
    _, (count, _), at = frame["arrays"]["nodes"]
    nodes = np.frombuffer(frame["bytes"], "<f4", 3 * count, at).reshape(-1, 3)
    assert results.network is not None
    assert count == len(results.network.node_points)
    assert np.abs(nodes - results.network.node_points).max() < 1e-6 * frame["size"]
    assert frame["figures"]["utilisation_max"] == results.summary["lamellas"]["utilisation_max"]
    assert page.state["before"]["utilisation_max"] != frame["figures"]["utilisation_max"]
    assert server.session.results is not None


def test_frames_wait_for_the_page_and_the_newest_wins(rings: tuple[Server, Page]) -> None:
    server, page = rings
    page.acknowledges = False
    page.edit("move", drag=True, handles={"0.points.0": [3.0, 0.0, 0.01]})
    page.until(lambda: page.frames[-1]["level"] == "coarse")
    seen = len(page.frames)
    for k in range(2, 7):
        page.edit("move", drag=True, handles={"0.points.0": [3.0, 0.0, 0.01 * k]})
        with server.session.changed:
            server.session.changed.wait_for(lambda k=k: server.session.revision >= k, 10)
    with server.session.changed:
        server.session.changed.wait_for(lambda: server.session.shown.revision == 6, 20)  # type: ignore[union-attr]
    while page.receive(0.2) is not None:
        pass
    assert len(page.frames) == seen
    page.send("seen", number=page.frames[-1]["number"])
    page.until(lambda: len(page.frames) > seen)
    assert page.frames[-1]["revision"] == 6


def test_a_film_that_ceases_to_exist(rings: tuple[Server, Page]) -> None:
    _, page = rings
    last = page.frames[-1]["number"]
    page.edit("move", drag=True, handles={"1.circle.center": [0.0, 0.0, 9.0]})
    page.until(lambda: page.status["problem"])
    assert page.status["problem"]["where"] == "surface.boundary"
    assert "limit" in page.status["problem"]["message"]
    assert page.frames[-1]["number"] == last
    page.edit("move", drag=True, handles={"1.circle.center": [0.0, 0.0, 2.1]})
    page.until(lambda: page.frames[-1]["number"] > last)
    assert page.status["problem"] is None
    page.send("drop")
    page.until(lambda: page.state["text"] == RINGS)
    page.until_exact()


def test_two_pages_share_a_state(rings: tuple[Server, Page]) -> None:
    server, page = rings
    with page_of(server) as other:
        other.until_exact()
        page.edit("set", values=[[["network", "cells"], 12]])
        other.until(lambda: "cells = 12" in other.state["text"])
        other.until_exact()
        assert other.frames[-1]["figures"]["cells"] == 12
        other.send("undo")
        page.until(lambda: page.state["text"] == RINGS)
    # one page that goes while it drags leaves nothing behind
    with page_of(server) as third:
        third.until(lambda: third.state)
        third.edit("move", drag=True, handles={"0.points.0": [3.0, 0.0, 0.3]})
        third.until(lambda: third.state["is_draft"])
    page.until(lambda: page.state["revision"] > 2 and page.state["text"] == RINGS)
    while page.receive(0.5) is not None:
        pass
    assert page.state["text"] == RINGS


def test_states_are_compared(rings: tuple[Server, Page]) -> None:
    _, page = rings
    pinned = dict(page.frames[-1]["figures"])
    page.send("pin")
    page.until(lambda: page.state["pinned"])
    page.edit("set", values=[[["network", "cells"], 12]])
    page.until(lambda: "cells = 12" in page.state["text"])
    page.until_exact()
    assert page.state["pinned"] == pinned
    assert any(frame["type"] == "pinned" for frame in page.frames)
    page.send("pin", what="back")
    page.until(lambda: page.state["text"] == RINGS)
    page.send("pin", what="drop")
    page.until(lambda: page.state["pinned"] is None)


@pytest.mark.slow
def test_the_server_answers_while_it_computes(tmp_path: Path) -> None:
    """An edit is seen at once, and what was computed of the text before is given up."""
    text = RINGS.replace("0.03", "0.0002")
    with served(write(tmp_path, text)) as server, page_of(server) as page:
        page.until(lambda: page.status.get("busy"))
        for cells in (11, 12, 13):
            begun = time.monotonic()
            page.edit("set", values=[[["network", "cells"], cells]])
            page.until(lambda cells=cells: f"cells = {cells}" in page.state["text"])
            assert time.monotonic() - begun < 5
        page.edit("set", values=[[["surface", "tolerance"], 0.03]])
        page.until(lambda: "tolerance = 0.03" in page.state["text"])
        assert page.until_exact()["figures"]["cells"] == 13


@pytest.mark.slow
def test_a_run_writes_its_folder(tmp_path: Path) -> None:
    with served(write(tmp_path, CATENOID)) as server, page_of(server) as page:
        page.until(lambda: page.state)
        page.edit("set", values=[[["network", "cells"], 10]])
        page.send("run")
        page.until(lambda: page.status.get("run") and not page.status["run"]["running"], 60)
        run = page.status["run"]
        assert run["done"], run["lines"]
        assert (tmp_path / run["report"]).exists()
        assert "cells = 10" in (tmp_path / "demo.toml").read_text()
        page.send("run")
        page.until(lambda: page.status["run"]["running"])
        page.send("cancel")
        page.until(lambda: not page.status["run"]["running"], 60)
        assert page.status["run"]["cancelled"]


def test_a_handle_follows_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path, CATENOID)
    with lamella.studio(path) as page:
        assert page.wait().network is not None
        page._session.edit({"do": "set", "values": [[["network", "cells"], 15]]})
        assert page.project.network.cells == 15
        results = page.wait()
        assert results.network is not None
        assert results.network.cells == 15
        assert "<iframe" in page._repr_html_()
        page._session.write("x = ")
        with pytest.raises(InputError):
            page.wait()
        assert page.project.network.cells == 15
    assert "<iframe" not in page._repr_html_()
    monkeypatch.chdir(tmp_path)
    project = lamella.parse_project(
        {"name": "../odd name", "surface": {"kind": "cylinder", "radius": 2, "height": [0, 3]}}
    )
    with lamella.studio(project) as page:
        assert page._session.file.path == tmp_path / "odd-name.toml"
        assert page.project == project
    assert not (tmp_path / "odd-name.toml").exists()

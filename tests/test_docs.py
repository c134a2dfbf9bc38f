"""The documentation: its code runs, its names exist, its links lead somewhere, its generated parts are up to date."""

from __future__ import annotations

import importlib
import importlib.util
import re
import runpy
import shlex
import tomllib
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import lamella
from lamella.command.main import _parser

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PAGES = sorted([*DOCS.glob("*.md"), *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md"))])


@cache
def builder() -> ModuleType:
    pytest.importorskip("matplotlib")
    spec = importlib.util.spec_from_file_location("docs_build", DOCS / "build.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def blocks(text: str, language: str = "") -> list[str]:
    return [code for word, code in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S) if word == language]


def test_library_example_of_the_readme_runs(capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = blocks((ROOT / "README.md").read_text(), "python")
    names: dict[str, Any] = {}
    exec(example, names)
    said = capsys.readouterr().out
    pieces, mass, utilisation = re.match(r"(\d+) pieces, (\d+) kg, utilisation (\d\.\d\d)\n", said).groups()
    # layers of 60 x 1 mm at 7850 kg/m3 weigh 0.471 kg a metre; slots take off and ends add a little
    assert int(mass) == pytest.approx(0.471 * 2 * names["net"].lengths.sum(), rel=0.02)
    # two layers, and none is too long for the sheet
    assert int(pieces) == 2 * len(names["net"].ids)
    # with the strong-axis stress of two layers, 12.5 mm beside the centre line
    assert float(utilisation) == pytest.approx(0.52, abs=0.01)
    assert said.splitlines()[1].startswith(f"Nesting({pieces} pieces on ")
    assert said.splitlines()[2] == "True"


def test_examples_of_the_library_page_run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    chain, curves, alone, follow, results = blocks((DOCS / "library.md").read_text(), "python")
    exec(chain, {})
    kinds = [line.partition("(")[0] for line in capsys.readouterr().out.splitlines()]
    assert kinds == ["ElementSurface", "Network", "Lamellas", "Parts", "Nesting"]
    exec(curves, {})
    assert re.fullmatch(r"stable, H = -\d\.\d{3} 1/m, 6\.000 m3\n", capsys.readouterr().out)
    exec(alone, {})
    assert capsys.readouterr().out.startswith("Parts(48 parts, ")
    assert (tmp_path / "net.json").exists()
    exec(follow, {})
    *frames, last = capsys.readouterr().out.splitlines()
    assert [frame.startswith("LevelLines(") and frame.endswith(" kept") for frame in frames] == [True] * 3
    assert last.startswith("Network(16 cells: ")
    assert last.endswith(" stable")
    exec(results, {})
    assert capsys.readouterr().out == "True\n"
    assert (tmp_path / "strips.png").stat().st_size > 10_000


def test_library_example_of_getting_started_runs(capsys: pytest.CaptureFixture[str]) -> None:
    found, computed = blocks((DOCS / "getting-started.md").read_text(), "python")
    exec(found, {})
    said = capsys.readouterr().out
    # R = c cosh(d / 2 c) for R = 3, d = 3.6
    assert said.startswith("62.997 m2, stable, neck 2.2")
    exec(computed, {})
    lamellas, utilisation, *_ = capsys.readouterr().out.split()
    assert lamellas == "48"
    assert float(utilisation) == pytest.approx(0.400, abs=0.005)


def test_examples_of_guided_projection_run(capsys: pytest.CaptureFixture[str]) -> None:
    net, constraint = blocks((DOCS / "projection.md").read_text(), "python")
    exec(net, {})
    said = capsys.readouterr().out
    assert said.startswith("solved after")
    assert float(re.search(r"moved by (\d+\.\d) mm", said).group(1)) == pytest.approx(2.0, abs=0.3)
    exec(constraint, {})
    assert capsys.readouterr().out == "solved 2.0\n"


@cache
def projection_pictures() -> dict[str, Any]:
    pytest.importorskip("matplotlib")
    return runpy.run_path(str(DOCS / "build_projection.py"))


@pytest.mark.parametrize(
    ("picture", "quoted"),
    [
        ("figure_6", {r"off 90 degrees by (\d\.\d\d)": "are off by {} degrees at most at 24 cells"}),
        (
            "figure_7",
            {
                r"median before (\d\.\d+)": "(median {})",
                r"largest tilt (\d\.\d)": "upright to {} degrees",
                r"red after (\d)\b": None,
            },
        ),
        (
            "figure_8",
            {r"90%.* by ([\d.]+ to [\d.]+) deg": "by {} and", r"80%.* by ([\d.]+ to [\d.]+) deg": "by {} deg"},
        ),
        pytest.param(
            "figures_9_and_10",
            {r"2 rounds.*largest tilt (\d\.\d\d)": "by {} degrees", r"2 rounds.*turn (\d\.\d)": "by up to {} degrees"},
            marks=pytest.mark.slow,
        ),
    ],
)
def test_quoted_figures_of_the_papers_pictures(
    picture: str, quoted: dict[str, str | None], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Figures that docs/projection.md quotes of the paper's pictures, computed anew."""
    projection_pictures()[picture](tmp_path)
    said, page = capsys.readouterr().out, " ".join((DOCS / "projection.md").read_text().split())
    assert "stagnated" not in said
    assert "settled" not in said
    for figure, words in quoted.items():
        found = re.search(figure, said)
        assert found, figure
        if words is None:
            assert found.group(1) == "0"
        else:
            assert words.format(found.group(1)) in page, found.group(0)
    for made in tmp_path.iterdir():
        assert 10_000 < made.stat().st_size < 400_000
        assert (DOCS / "pictures" / made.name).exists()


def test_project_in_getting_started_is_good() -> None:
    project, *further = blocks((DOCS / "getting-started.md").read_text(), "toml")
    assert lamella.parse_project(tomllib.loads(project)).name == "Pavilion"
    # the tables of stock, joints and what follows go below it
    joined = lamella.parse_project(tomllib.loads("\n".join((project, *further))))
    assert joined.erection is not None
    assert joined.segments is not None
    assert joined.stock is not None
    assert [one.kind for one in joined.stock] == ["bar", "sheet", "coil"]
    assert joined.joint is not None
    assert joined.cables is not None
    assert joined.cables.every == 2
    assert joined.edge_beam is not None
    assert joined.edge_beam.ground == 0


@pytest.mark.parametrize("page", ["README.md", "docs/getting-started.md", "docs/projection.md"])
def test_command_lines_parse(page: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = [line for block in blocks((ROOT / page).read_text()) for line in block.splitlines()]
    commands = [re.split(r"\s{3,}", line)[0] for line in lines if line.startswith("lamella ")]
    assert len(commands) >= 5
    for command in commands:
        arguments = shlex.split(command)[1:]
        if arguments == ["--version"]:
            with pytest.raises(SystemExit, match="0"):
                _parser().parse_args(arguments)
            assert lamella.__version__ in capsys.readouterr().out
        else:
            _parser().parse_args(arguments)


def resolve(name: str) -> object:
    parts = name.split(".")
    for split in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:split]))
        except ModuleNotFoundError:
            continue
        for part in parts[split:]:
            found = getattr(found, part)
        return found
    raise AttributeError(name)


NAME = re.compile(r"`(lamella(?:\.[A-Za-z_]\w*)+)`")
# keys of the project file
KEYS = {"lamella.material", "lamella.offset", "lamella.height", "lamella.strips"}


def test_names_in_the_theory_exist() -> None:
    names = NAME.findall((DOCS / "theory.md").read_text())
    assert len(names) > 40
    for name in names:
        resolve(name)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_names_on_every_page_exist(page: Path) -> None:
    for name in set(NAME.findall(page.read_text())) - KEYS:
        resolve(name)


def anchors(page: Path) -> set[str]:
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_pictures_exist(page: Path) -> None:
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.M | re.S)
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path) if path else page
        assert target.exists(), f"{page.name}: {link}"
        assert not anchor or anchor in anchors(target), f"{page.name}: {link}"


def test_every_page_and_picture_is_reached() -> None:
    texts = [page.read_text() for page in PAGES]
    for file in [*DOCS.glob("*.md"), *DOCS.glob("pictures/*.png"), *DOCS.glob("schema/*.json")]:
        if file.name != "README.md":
            assert any(file.name in text for text in texts), file.name


def test_pages_keep_to_what_a_stranger_has() -> None:
    for page in PAGES:
        found = re.findall(r"(?<![\w.])/(?:home|work|root|tmp|usr|Users)/\S*|\bDESIGN\b", page.read_text())
        assert not found, f"{page.name}: {found}"


def test_changelog_knows_this_version() -> None:
    assert lamella.__version__ in (ROOT / "CHANGELOG.md").read_text()


def test_every_example_has_picture_and_text() -> None:
    names = {path.stem for path in (ROOT / "examples").glob("*.toml")}
    views = [*builder().VIEWS, *builder().SURFACE_VIEWS]
    assert sorted(names) == sorted(views) == sorted(builder().ABOUT)
    for name in names:
        assert 10_000 < (DOCS / "pictures" / f"{name}.png").stat().st_size < 400_000

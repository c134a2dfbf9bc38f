"""The contract of imports: which folder of the package may import which, and no circle between modules.

Imports inside functions and those for annotations only count like all others, but for the signatures of methods that
lead on along the flow (`ONWARD`). The table is the one of CONTRIBUTING.md.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from types import MappingProxyType

import pytest

from lamella.stages import all_stages

PACKAGE = Path(__file__).parents[1] / "src" / "lamella"

# what each group of folders may be built on
SURFACES = ("surface", "surface.closed_forms", "surface.element")
FILMS = (*SURFACES, "surface.boundary", "surface.remesh", "surface.form_finding")
NETS = ("network", "network.charts", "network.lattice", "network.isothermic", "network.elements", "network.streamlines")
PROJECTIONS = ("projection", "projection.constraints", "projection.problems")
FILES = ("files", "files.read", "files.write")

STAGES = tuple(f"stages.{stage.name}" for stage in all_stages.STAGES)
RUNS = ("stages", *STAGES, "stages.run")
STAGE_NEEDS = (
    "base",
    *FILMS,
    "surface.from_mesh",
    "surface.constant_angle",
    *NETS,
    "network.adjust",
    "network.net",
    "strip",
    "fabrication",
    "hardware",
    "segments",
    "solid",
    "structure",
    "structure.beam",
    "drawings",
    "structure.actions",
    "structure.model",
    "structure.analysis",
    "structure.export",
    "structure.export.saf",
    "erection",
    "panels",
    *PROJECTIONS,
    "project",
    *FILES,
    "view.scene",
    "version",
)

MAY_IMPORT: dict[str, tuple[str, ...]] = {
    "base": (),
    "surface": ("base",),
    "surface.closed_forms": ("base", "surface"),
    "surface.element": ("base", "surface"),
    "surface.boundary": ("base", "surface"),
    "surface.remesh": ("base", *SURFACES),
    "surface.form_finding": ("base", *SURFACES, "surface.boundary", "surface.remesh"),
    "surface.from_mesh": ("base", *FILMS),
    "surface.constant_angle": ("base", *FILMS),
    "network": ("base", "surface"),
    "network.charts": ("base", *SURFACES),
    "network.lattice": ("base", *SURFACES, "network"),
    "network.isothermic": ("base", *SURFACES, "network"),
    "network.elements": ("base", *SURFACES, "surface.boundary", "network", "network.isothermic"),
    "network.streamlines": ("base", *SURFACES, "network", "network.charts"),
    "network.adjust": ("base", *FILMS, "network", "network.isothermic", "network.elements"),
    "network.net": ("base", *SURFACES, *NETS),
    "strip": ("base", *SURFACES, "network", "network.charts"),
    "projection": ("base", *SURFACES, "surface.boundary", "strip", "projection.constraints"),
    "projection.constraints": ("base", "projection"),
    "projection.problems": ("base", "projection", "projection.constraints", "strip"),
    "project": ("base",),
    "files": ("base", "files.read", "files.write", *PROJECTIONS, "version"),
    "files.read": ("base", *FILMS, "surface.from_mesh", "network"),
    "files.write": ("base", "files", *FILMS, "network", "strip", *PROJECTIONS, "version"),
    "structure": ("base", "structure.beam"),
    "structure.beam": ("base", "strip"),
    "structure.actions": ("base", "surface", "network", "hardware"),
    "structure.model": (
        "base",
        "network",
        "strip",
        "fabrication",
        "hardware",
        "structure",
        "structure.beam",
        "structure.actions",
    ),
    "structure.analysis": (
        "base",
        "hardware",
        "structure",
        "structure.beam",
        "structure.actions",
        "structure.model",
    ),
    "structure.export": (
        "base",
        "files",
        "files.write",
        "strip",
        "structure",
        "structure.beam",
        "structure.model",
        "structure.analysis",
    ),
    "structure.export.saf": (
        "base",
        "files",
        "files.write",
        "structure.actions",
        "structure.model",
        "structure.analysis",
        "structure.export",
    ),
    "cutting": ("base",),
    "erection": (
        "base",
        "network",
        "strip",
        "structure",
        "structure.beam",
        "structure.actions",
        "structure.model",
        "fabrication",
        "hardware",
        "segments",
        "drawings",
        "files",
        "files.write",
    ),
    "panels": ("base", "network", "fabrication", "hardware", "files.write"),
    "fabrication": ("base", "network", "strip", "cutting", "files.write"),
    "hardware": ("base", *SURFACES, "network", "strip", "cutting", "fabrication", "files", "files.write"),
    "segments": ("base", "network", "strip", "fabrication", "hardware", "files.write"),
    "solid": ("base", "network", "strip", "fabrication", "hardware"),
    "drawings": ("base", "network", "strip", "fabrication", "hardware", "segments", "solid"),
    "view.scene": ("base", "surface"),
    "view.render": ("base", "view.scene"),
    "view": (
        "base",
        *SURFACES,
        "surface.boundary",
        "network",
        "strip",
        "fabrication",
        *FILES,
        *PROJECTIONS,
        "view.scene",
    ),
    "stages": STAGE_NEEDS,
    "stages.run": (*STAGE_NEEDS, "view", "stages", *STAGES),
    "studies": (
        "base",
        "surface.boundary",
        "project",
        "files",
        "stages",
        *STAGES,
        "stages.run",
        "version",
    ),
    "interactive": (
        "base",
        *FILMS,
        *NETS,
        "strip",
        "project",
        "files",
        "files.read",
        "files.write",
        "view.scene",
        "stages",
        *STAGES,
        "stages.run",
        "version",
    ),
    "command": (
        "base",
        "studies",
        *FILMS,
        "surface.from_mesh",
        "project",
        *PROJECTIONS,
        *FILES,
        "view",
        "view.scene",
        "view.render",
        "stages",
        *STAGES,
        "stages.run",
        "interactive",
        "version",
    ),
}
# each stage may use those before it
MAY_IMPORT |= {room: (*STAGE_NEEDS, "stages", *STAGES[:k]) for k, room in enumerate(STAGES)}
# methods of results that make the next stage's result; these imports are inside the method, or for annotations only
METHODS = {
    "lamella.network.network": {"lamella.strip.lamellas", "lamella.base.material"},
    "lamella.strip.lamellas": {"lamella.fabrication.part", "lamella.fabrication.parts"},
    "lamella.fabrication.part": {"lamella.fabrication.sheet"},
}
# modules that stand above their folder: they choose among the folders below it
ABOVE = {"lamella.network.net": "network.net"} | {
    f"lamella.stages.{module}": "stages.run"
    for module in (
        "all_stages",
        "wanted",
        "computation",
        "results",
        "check",
        "write",
        "report",
        "scene",
        "schema",
        "shown_names",
    )
}
# results whose methods lead on to a later module by lamella.base.onward: their signatures name its types
ONWARD = {
    "lamella.network.network": {"lamella.strip.lamellas", "lamella.base.material"},
    "lamella.strip.lamellas": {"lamella.fabrication.part"},
    "lamella.fabrication.part": {"lamella.fabrication.sheet"},
}


def _is_for_annotations(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


class Imports:
    """The modules of a package and what each of them imports from it."""

    def __init__(self, package: Path, onward: Mapping[str, set[str]] = MappingProxyType({})) -> None:
        self.name = package.name
        self.folders = {
            ".".join((self.name, *path.relative_to(package).with_suffix("").parts)).removesuffix(".__init__"): path
            for path in sorted(package.rglob("*.py"))
        }
        trees = {module: ast.parse(path.read_text("utf-8")) for module, path in self.folders.items()}
        self.of = {module: set(self._imported(ast.walk(tree))) for module, tree in trees.items()}
        for module in onward.keys() & trees.keys():
            nodes = list(ast.walk(trees[module]))
            named = {node for part in nodes if _is_for_annotations(part) for node in ast.walk(part)}
            outside = set(self._imported(node for node in nodes if node not in named))
            self.of[module] -= onward[module] - outside

    def _imported(self, nodes: Iterable[ast.AST]) -> Iterator[str]:
        for node in nodes:
            if isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    whole = f"{node.module}.{alias.name}"
                    if whole in self.folders:
                        yield whole
                    elif node.module in self.folders:
                        # the package itself gives its version, or it gives everything
                        yield "version" if (node.module, alias.name) == (self.name, "__version__") else node.module
            elif isinstance(node, ast.Import):
                yield from (alias.name for alias in node.names if alias.name in self.folders)

    def room(self, module: str) -> str:
        """The folder a module is in, without the package's name; "" for the package's own modules."""
        if module in ABOVE or module == "version":
            return ABOVE.get(module, module)
        path = self.folders[module]
        parts = module.split(".")
        return ".".join(parts[1:] if path.name == "__init__.py" else parts[1:-1])

    def leave_out(self, some: dict[str, set[str]]) -> None:
        """Forget some imports."""
        for module, others in some.items():
            self.of[module] -= others

    def against(self, may_import: dict[str, tuple[str, ...]]) -> list[str]:
        """Imports from one folder into another that the table does not have, and folders that it does not know."""
        found = []
        for module, others in self.of.items():
            room = self.room(module)
            if room and room not in may_import:
                found.append(f"{module} is in the folder {room!r}, which has no row")
            elif room:
                rooms = (*may_import[room], room)
                found += [f"{module} imports {other}" for other in sorted(others) if self.room(other) not in rooms]
        return found

    def circle(self) -> list[str]:
        """Modules that import each other in a circle; empty where none do."""
        try:
            TopologicalSorter(self.of).prepare()
        except CycleError as error:
            return list(error.args[1])
        return []


def test_folders_import_what_they_may() -> None:
    """No import against the table of rooms."""
    assert Imports(PACKAGE, ONWARD).against(MAY_IMPORT) == []


def test_no_modules_import_each_other_in_a_circle() -> None:
    imports = Imports(PACKAGE, ONWARD)
    imports.leave_out(METHODS)
    assert imports.circle() == []


def test_no_folders_may_import_each_other_in_a_circle() -> None:
    """But for a folder and those inside it, of which one holds what they share."""
    nested = {
        room: {other for other in others if not (room.startswith(f"{other}.") or other.startswith(f"{room}."))}
        for room, others in MAY_IMPORT.items()
    }
    TopologicalSorter(nested).prepare()


def test_contributing_lists_every_folder() -> None:
    text = (PACKAGE.parents[1] / "CONTRIBUTING.md").read_text("utf-8")
    folders = [room for room in MAY_IMPORT if room not in (*ABOVE.values(), *STAGES)]
    assert [room for room in folders if f"| `{room.replace('.', '/')}/` |" not in text] == []


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package of two folders, of which `upper` is built on `base`."""
    for name in ("small/__init__.py", "small/base/__init__.py", "small/upper/__init__.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / "small/base/one.py").write_text("ONE = 1\n")
    (tmp_path / "small/upper/two.py").write_text("from small.base.one import ONE\n")
    return tmp_path / "small"


SMALL = {"base": (), "upper": ("base",)}


def test_an_import_against_the_table_is_found(package: Path) -> None:
    assert Imports(package).against(SMALL) == []
    (package / "base/one.py").write_text("def one():\n    import small.upper.two\n")
    imports = Imports(package)
    assert imports.against(SMALL) == ["small.base.one imports small.upper.two"]
    assert set(imports.circle()) == {"small.base.one", "small.upper.two"}


def test_a_folder_without_a_row_is_found(package: Path) -> None:
    (package / "cellar").mkdir()
    (package / "cellar/three.py").write_text("from small.base import one\n")
    assert Imports(package).against(SMALL) == ["small.cellar.three is in the folder 'cellar', which has no row"]


def test_signatures_may_lead_on_and_nothing_else(package: Path) -> None:
    onward = {"small.base.one": {"small.upper.two"}}
    line = "from small.upper.two import ONE"
    (package / "base/one.py").write_text(f"if TYPE_CHECKING:\n    {line}\n")
    assert Imports(package).against(SMALL) == ["small.base.one imports small.upper.two"]
    assert Imports(package, onward).against(SMALL) == []
    assert Imports(package, onward).circle() == []
    (package / "base/one.py").write_text(f"if TYPE_CHECKING:\n    {line}\ndef one():\n    {line}\n")
    assert Imports(package, onward).against(SMALL) == ["small.base.one imports small.upper.two"]


def test_a_circle_of_annotations_is_one(package: Path) -> None:
    lines = ("from typing import TYPE_CHECKING", "if TYPE_CHECKING:", "    from small.base.four import FOUR", "")
    (package / "base/three.py").write_text("\n".join(lines))
    (package / "base/four.py").write_text("from small.base.three import THREE\n")
    assert set(Imports(package).circle()) == {"small.base.three", "small.base.four"}

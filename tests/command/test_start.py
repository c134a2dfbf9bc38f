"""What a command imports before it does its work: no library that it has no use for."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
# drawings, models, sparse systems and search trees, meshing, pictures
FILES = ("ezdxf", "rhino3dm", "lamella.files.write.network_json", "lamella.files.write.lamellas_json")
SOLVERS = ("scipy.sparse", "scipy.spatial", "scipy.optimize", "scipy.interpolate", "rslab", "pythoncdt")
ELEMENTS = ("lamella.surface.element.surface", "lamella.surface.form_finding", "lamella.surface.from_mesh")
CLOSED_FORM = (*FILES, *SOLVERS, *ELEMENTS, "matplotlib", "lamella.view")
STAGES = ("lamella.stages", "lamella.network", "lamella.strip", "lamella.fabrication", "lamella.structure")
NOTHING = ("numpy", "scipy", "pydantic", "orjson", "ezdxf", "rhino3dm", "tomli_w", "lamella.project", *STAGES)


@pytest.mark.parametrize(
    ("arguments", "without"),
    [
        (["--help"], NOTHING),
        (["--version"], NOTHING),
        (["optimise", "--help"], NOTHING),
        (["studio", "--help"], NOTHING),
        (["examples"], NOTHING),
        (["schema", "project"], ("scipy", "orjson", *STAGES)),
        (["new", "unduloid", "--out", "-"], ("scipy", "orjson", *STAGES)),
        (["schema", "summary"], CLOSED_FORM),
        (["run", "--help"], CLOSED_FORM),
        (["check", str(EXAMPLES / "01_unduloid.toml")], CLOSED_FORM),
        # found on coarse elements and checked through all stages: nothing is written
        (["check", str(EXAMPLES / "08_two_rings.toml")], (*FILES, "matplotlib", "lamella.view")),
    ],
    ids=" ".join,
)
def test_commands_import_what_they_use(arguments: list[str], without: tuple[str, ...]) -> None:
    """Each command in a process of its own: heavy modules that it has no use for are not loaded."""
    # argparse ends after --help with an exit of its own
    code = (
        "import sys\nfrom lamella.command.main import main\n"
        "try: code = main(sys.argv[1:])\nexcept SystemExit as end: code = end.code\n"
        f"sys.exit(code or ' '.join(sorted(set({without!r}) & set(sys.modules))) or None)"
    )
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-500:]

"""The compiled kernel of the remesher gives the meshes that numpy gives, to the last bit."""

from __future__ import annotations

import importlib.util
import shutil
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from lamella.surface.remesh import collapse, draft, flip, kernel, smooth, topology
from surface.remesh.test_remesh import CASES, Case

ROOT = Path(__file__).parents[3]


@pytest.fixture(scope="module")
def hook() -> ModuleType:
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not module.commands(ROOT / module.SOURCE, Path("x")):
        pytest.skip("there is no C compiler")
    return module


@pytest.fixture(scope="module")
def compiled(hook: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> kernel.Kernel:
    library = tmp_path_factory.mktemp("kernel") / kernel.LIBRARY
    assert hook.build(ROOT, library) == ""
    return kernel.Kernel(library)


@pytest.fixture
def switch(monkeypatch: pytest.MonkeyPatch) -> Iterator[object]:
    """Sets the kernel that the remesher takes."""

    def taken(one: kernel.Kernel | None) -> None:
        for module in (collapse, draft, flip, smooth, topology):
            monkeypatch.setattr(module, "kernel", lambda: one)

    return taken


@pytest.mark.parametrize(
    "name",
    [
        "catenoid of 10 triangles",
        "catenoid coarsened",
        "saddle over a star, needles",
        "helicoid of 18 triangles",
        "thin annulus, sides of the start cross the hole",
        "graded 1 to 20 from 16 triangles",
    ],
)
@pytest.mark.few(3)
def test_meshes_are_those_of_numpy(name, compiled, switch) -> None:
    """The compiled remesher makes the meshes of the numpy one, to the last bit."""
    case: Case = CASES[name]()
    switch(None)
    wanted = case.run()
    switch(compiled)
    found = case.run()
    assert np.array_equal(found.faces, wanted.faces)
    assert found.points.tobytes() == wanted.points.tobytes()
    assert np.array_equal(found.loop, wanted.loop)
    assert found.parameter.tobytes() == wanted.parameter.tobytes()


@pytest.mark.parametrize("which", ["three faces at an edge", "faces that disagree"])
def test_faces_that_are_no_surface(which, compiled, switch) -> None:
    third = [0, 1, 4] if which == "three faces at an edge" else [0, 1, 2]
    faces = np.array([[0, 1, 2], third, [1, 0, 3]])
    for one in (None, compiled):
        switch(one)
        with pytest.raises(ValueError, match="oriented manifold"):
            topology.connect(faces, 5)


def test_library_of_another_source_is_not_taken(hook, tmp_path) -> None:
    (tmp_path / hook.SOURCE).parent.mkdir(parents=True)
    shutil.copy(ROOT / hook.SOURCE, tmp_path / hook.SOURCE)
    with (tmp_path / hook.SOURCE).open("a") as source:
        source.write("\n")
    library = tmp_path / kernel.LIBRARY
    assert hook.build(tmp_path, library) == ""
    with pytest.raises(OSError, match="another source"):
        kernel.Kernel(library)


def test_numpy_where_it_is_asked_for(monkeypatch) -> None:
    monkeypatch.setenv("LAMELLA_KERNEL", "numpy")
    kernel.kernel.cache_clear()
    try:
        assert kernel.kernel() is None
    finally:
        kernel.kernel.cache_clear()


def test_package_is_built_without_a_compiler(hook, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(hook, "commands", lambda *given: [])
    assert "compiler" in hook.build(ROOT, tmp_path / kernel.LIBRARY)
    assert not (tmp_path / kernel.LIBRARY).exists()

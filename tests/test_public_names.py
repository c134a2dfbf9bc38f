"""The public names: written once, in the type stub, and imported on first use."""

from __future__ import annotations

import subprocess
import sys

import pytest

import lamella


def test_every_name_of_the_stub_is_there() -> None:
    assert len(lamella.__all__) == len(set(lamella.__all__)) > 40
    for name in lamella.__all__:
        assert getattr(lamella, name) is not None
    assert dir(lamella) == sorted(lamella.__all__)
    scope: dict[str, object] = {}
    exec("from lamella import *", scope)
    assert scope["Catenoid"] is lamella.Catenoid


def test_what_is_not_there() -> None:
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = lamella.no_such_name  # type: ignore[attr-defined]


def test_importing_the_package_imports_nothing_else() -> None:
    code = "import sys, lamella; sys.exit({'numpy', 'scipy', 'ast'} & set(sys.modules) or None)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr

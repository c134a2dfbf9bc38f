"""Methods of results that lead on to a later module: the strips of a network, the picture of a surface.

Modules import those before them in the flow, never those after (`tests/test_rooms.py`). A result's method that starts
the next stage has to call a function that comes later all the same. It names that function by a string, which is
imported when the method is called: importing a module imports none after it, and this is the one place where the flow
is left. Signatures of such methods name later types below `if TYPE_CHECKING`, and the test lists them.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


def onward(home: str) -> Any:
    """A function of a later room, by its full name: "lamella.strip.lamellas.make_lamellas"."""
    module, _, name = home.rpartition(".")
    return getattr(import_module(module), name)

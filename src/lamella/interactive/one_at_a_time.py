"""One computation at a time in a process: of the page's design, of other designs, of programs at the door.

Solvers and meshers are libraries in C, which let other threads run meanwhile and are not all made for being called by
two at once; on the same cores two would not be sooner done either.
"""

from __future__ import annotations

import threading

computing = threading.Lock()
"""Held while something is computed."""

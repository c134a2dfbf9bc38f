"""The remesher's passes in C, where a compiler was there when the package was built: see `kernel.c`.

Remeshing makes many small passes over meshes of some thousand triangles; numpy spends most of its time in them between
its operations. The functions here do what the numpy code beside which they are called does, to the last bit: where
there is no library, or LAMELLA_KERNEL is "numpy", that code runs.
"""

from __future__ import annotations

import ctypes
import os
import sys
import zlib
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

SOURCE, LIBRARY = "kernel.c", "libkernel.dll" if sys.platform == "win32" else "libkernel.so"

# what the functions of `kernel.c` take: n, x numbers; i, f, b arrays of whole, real, truth values; capitals are written
_SIGNATURES = {
    "grouped": "ninII",
    "connect": "nniIIIIII",
    "face_shapes": "nnfixFFFF",
    "star_after": "nfifffiiiifFFF",
    "link_condition": "nffbiiiixiiiB",
    "disjoint": "nniinnBIIB",
    "apart": "nniniiinBIIIB",
    "flips": "nnfifbiiiifffffnnfIF",
    "ways": "nnfiffffxxFFFB",
    "guarded": "nnfiffxxFBB",
}
_NUMBERS: dict[str, Any] = {"n": ctypes.c_int64, "x": ctypes.c_double}
_ARRAYS: dict[str, DTypeLike] = {"i": np.int64, "f": np.float64, "b": np.bool_}


class Kernel:
    """The functions of a compiled library.

    Parameters
    ----------
    path : Path
        Of the library.

    Raises
    ------
    OSError
        It cannot be loaded, or was built from another source than the one beside this module.
    """

    def __init__(self, path: Path) -> None:
        library = ctypes.CDLL(str(path))
        library.lamella_source.restype = ctypes.c_int64
        if library.lamella_source() != zlib.crc32(Path(__file__).with_name(SOURCE).read_bytes()):
            raise OSError(f"{path.name} was built from another source")
        self._functions = {}
        for name, signature in _SIGNATURES.items():
            function = getattr(library, f"lamella_{name}")
            function.restype = ctypes.c_int64 if name in ("connect", "flips") else None
            function.argtypes = [_NUMBERS.get(kind, ctypes.c_void_p) for kind in signature]
            self._functions[name] = function

    def call(self, name: str, *arguments: NDArray[Any] | float) -> int:
        """Call a function; arrays that are written have to be contiguous and of its types."""
        # the arrays have to live until the function returns
        held = [
            np.ascontiguousarray(given, _ARRAYS[kind]) if kind in _ARRAYS else given
            for kind, given in zip(_SIGNATURES[name], arguments, strict=True)
        ]
        result = self._functions[name](*[a.ctypes.data if isinstance(a, np.ndarray) else a for a in held])
        return int(result or 0)


@lru_cache
def kernel() -> Kernel | None:
    """The compiled functions, where there are any."""
    path = Path(__file__).with_name(LIBRARY)
    if os.environ.get("LAMELLA_KERNEL") == "numpy" or not path.exists():
        return None
    try:
        return Kernel(path)
    except (OSError, AttributeError):
        # of another platform or of another source
        return None

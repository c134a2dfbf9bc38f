"""Other processors, by environment: which numerical kernels OpenBLAS and numpy take, and what a run then says.

OpenBLAS takes the kernels of the core it is given; numpy leaves out the instructions it is told to. Run as a program,
all examples (or those named) are computed under each setting, and their summaries and what docs/examples.md shows of
them compared with the machine's own; `python tests/examples/kernels.py --pytest ARGUMENTS` runs tests under each of the
others.
"""

from __future__ import annotations

import json
import os
import re
import runpy
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"

# what numpy can leave out: it warns of other names
_FEATURES: tuple[str, ...] = tuple(np._core._multiarray_umath.__cpu_dispatch__)
_WIDE = tuple(name for name in _FEATURES if name == "X86_V4" or name.startswith("AVX512"))
KERNELS = {
    "Haswell": {"OPENBLAS_CORETYPE": "Haswell", "NPY_DISABLE_CPU_FEATURES": " ".join(_WIDE)},
    "Nehalem": {"OPENBLAS_CORETYPE": "Nehalem", "NPY_DISABLE_CPU_FEATURES": " ".join(_FEATURES)},
}

# figures agree within this part of themselves, or of their scale where they are differences themselves
AGREES = 1e-4
ERRORS = re.compile(r"deviation|residual|off_cells|missed|jump|distance|planarity|point|volume")
NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w]|\.\d)")


def environment(kernel: str) -> dict[str, str]:
    """The environment of this process with another kernel, one thread each."""
    one = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS"), "1")
    return os.environ | one | KERNELS.get(kernel, {})


def summary_under(kernel: str, example: str) -> dict[str, Any]:
    """Summary of an example's run in a process of its own under a kernel."""
    program = (
        "import sys; from pathlib import Path; from lamella import compute, read_project; import orjson;"
        "p = Path(sys.argv[1]); summary = compute(read_project(p), folder=p.parent).summary;"
        "sys.stdout.buffer.write(orjson.dumps(summary, option=orjson.OPT_SERIALIZE_NUMPY))"
    )
    path = EXAMPLES / f"{example}.toml"
    run = subprocess.run(
        [sys.executable, "-c", program, str(path)], env=environment(kernel), stdout=subprocess.PIPE, check=True
    )
    found: dict[str, Any] = json.loads(run.stdout)
    return found


def scale_of(key: str, summary: dict[str, Any]) -> float:
    """What an error is measured in: the size of the surface, its curvature, a right angle, a cell."""
    surface = summary["surface"]
    size = float(np.linalg.norm(surface["size"]))
    if "volume" in key:
        return size**3
    if key.endswith("_deg"):
        return 90.0
    if "curvature_deviation_max" in key or "curvature_deviation_p95" in key:
        return float(surface.get("curvature_scale") or 1 / size)
    if re.search(r"point|distance|development", key):
        return size
    return 1.0


def differences(one: Any, other: Any, summary: dict[str, Any], key: str = "") -> Iterator[str]:
    """Where two summaries differ: counts and words at all, figures by more than `AGREES`; seconds do not count."""
    if isinstance(one, dict) and isinstance(other, dict):
        for name in sorted((one.keys() | other.keys()) - {"seconds"}):
            yield from differences(one.get(name), other.get(name), summary, f"{key}.{name}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for number, pair in enumerate(zip(one, other, strict=True)):
            yield from differences(*pair, summary, f"{key}[{number}]")
    elif isinstance(one, float) and isinstance(other, float):
        scale = scale_of(key, summary) if ERRORS.search(key) else max(abs(one), abs(other))
        if abs(one - other) > AGREES * scale:
            yield f"{key}: {one:.9g} or {other:.9g}"
    elif isinstance(one, str) and isinstance(other, str):
        if not same_text(one, other):
            yield f"{key}: {one!r} or {other!r}"
    elif one != other:
        yield f"{key}: {one} or {other}"


def same_text(one: str, other: str) -> bool:
    """Whether texts say the same: words and counts alike, other numbers within one unit of their last digit.

    Numbers that are nearly in the middle between two printed ones may be rounded to either.
    """
    if NUMBER.split(one) != NUMBER.split(other):
        return False
    for pair in zip(NUMBER.findall(one), NUMBER.findall(other), strict=True):
        a, b = (float(number.replace(",", "")) for number in pair)
        if a != b and (all(map(_whole, pair)) or abs(a - b) > 1.001 * max(map(_last_place, pair))):
            return False
    return True


def _whole(number: str) -> bool:
    return "." not in number and "e" not in number


def _last_place(number: str) -> float:
    digits, _, power = number.partition("e")
    return float(10.0 ** (int(power or 0) - len(digits.partition(".")[2])))


def main(arguments: list[str]) -> int:
    """Compare examples, or run tests, under every kernel; 1 if anything differs or fails."""
    bad = 0
    if arguments[:1] == ["--pytest"]:
        for kernel in KERNELS:
            print(f"{kernel}:", flush=True)
            run = subprocess.run([sys.executable, "-m", "pytest", *arguments[1:]], env=environment(kernel), cwd=ROOT)
            bad |= run.returncode
        return int(bool(bad))
    examples = arguments or sorted(path.stem for path in EXAMPLES.glob("*.toml"))
    shown = runpy.run_path(str(ROOT / "docs" / "build.py"))["figures"]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = {(e, kernel): pool.submit(summary_under, kernel, e) for e in examples for kernel in ("", *KERNELS)}
        for example in examples:
            own = runs[example, ""].result()
            for kernel in KERNELS:
                other = runs[example, kernel].result()
                found = list(differences(own, other, own))
                pairs = zip(shown(own), shown(other), strict=True)
                found += [f"{one} or {another}" for one, another in pairs if not same_text(one, another)]
                print(f"{example} under {kernel}: {'; '.join(found) or 'the same'}", flush=True)
                bad |= bool(found)
    return int(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""One name, one meaning: no two modules give a constant of the same name different numbers."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "src" / "lamella"


def constants(source: str) -> dict[str, float]:
    """Numbers under upper-case names at the top level of a module."""
    found = {}
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign):
            pairs = [pair for target in node.targets for pair in _pairs(target, node.value)]
        else:
            pairs = [(node.target, node.value)] if isinstance(node, ast.AnnAssign) and node.value else []
        for name, value in pairs:
            number = _number(value)
            if isinstance(name, ast.Name) and name.id.isupper() and isinstance(number, int | float):
                found[name.id] = float(number)
    return found


def _pairs(target: ast.expr, value: ast.expr) -> list[tuple[ast.expr, ast.expr]]:
    """Names and their values, of A, B = 1, 2 one by one."""
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        return list(zip(target.elts, value.elts, strict=True))
    return [(target, value)]


def _number(value: ast.expr) -> object:
    try:
        return ast.literal_eval(value)
    except ValueError:
        return None


def ambiguous(sources: dict[str, str]) -> dict[str, dict[str, float]]:
    """Names that stand for different numbers, with the modules in which they do."""
    values: dict[str, dict[str, float]] = defaultdict(dict)
    for module, source in sources.items():
        for name, number in constants(source).items():
            values[name][module] = number
    return {name: where for name, where in values.items() if len(set(where.values())) > 1}


def test_a_name_of_a_constant_means_one_thing() -> None:
    sources = {str(path.relative_to(PACKAGE)): path.read_text("utf-8") for path in sorted(PACKAGE.rglob("*.py"))}
    assert ambiguous(sources) == {}


def test_a_second_meaning_is_found() -> None:
    sources = {"one.py": "A, B = 1, 2.5\n", "other.py": "A = 1\nB: float = 3\nif A:\n    A = 4\n"}
    assert ambiguous(sources) == {"B": {"one.py": 2.5, "other.py": 3.0}}

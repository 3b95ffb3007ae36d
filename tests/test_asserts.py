"""An interlock is never an `assert`, which `python -O` leaves out: one only tells the type checker what is so."""

from __future__ import annotations

import ast
from pathlib import Path

import teleop

FILES = sorted(Path(teleop.__file__).parent.rglob("*.py"))


def only_narrows(test: ast.expr) -> bool:
    """`x is not None`, or `isinstance(x, T)`: whatever comes next fails anyway where that is not so."""
    match test:
        case ast.Compare(ops=[ast.IsNot()], comparators=[ast.Constant(value=None)]):
            return True
        case ast.Call(func=ast.Name(id="isinstance")):
            return True
    return False


def test_no_assert_guards_what_happens() -> None:
    guards = [
        f"{file.name}:{node.lineno}"
        for file in FILES
        for node in ast.walk(ast.parse(file.read_text()))
        if isinstance(node, ast.Assert) and not only_narrows(node.test)
    ]
    assert len(FILES) > 100
    assert guards == []

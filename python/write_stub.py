"""Writes the stub _rigcal.pyi next to the compiled module, from the signatures and docstrings that pybind11 gives it.

usage: write_stub.py PACKAGE-FOLDER
"""

from __future__ import annotations

import ast
import pathlib
import re
import sys
import textwrap
from typing import Any

HEAD = '''"""Types and docstrings of the compiled module. Written by python/write_stub.py; do not edit."""

from collections.abc import Callable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal, SupportsIndex, overload

import matplotlib.figure  # type: ignore[import]
import numpy as np
import pandas  # type: ignore[import]
from numpy.typing import NDArray

__version__: str
__revision__: str
'''
ARRAYS = {"bool": "NDArray[np.bool_]", "numpy.int32": "NDArray[np.int32]", "numpy.float64": "NDArray[np.float64]"}


def annotation(node: ast.expr, *, is_argument: bool) -> str:
    """Returns a type of a signature of pybind11 as in a stub.

    :param is_argument: whether it is the type of an argument, for which pybind11 accepts more than it returns
    :raises ValueError: if the type is unknown
    """
    text = ast.unparse(node)
    if isinstance(node, ast.Subscript):
        outer = ast.unparse(node.value)
        parts = node.slice.elts if isinstance(node.slice, (ast.Tuple, ast.List)) else [node.slice]
        if outer == "Literal":
            return text
        if outer == "numpy.ndarray":
            return ARRAYS[ast.unparse(node.slice)]
        if outer == "Callable":
            events = annotation(parts[0].elts[0], is_argument=False)  # type: ignore[attr-defined]
            return f"Callable[[{events}], object]"
        inner = [annotation(part, is_argument=is_argument) for part in parts]
        if outer == "Optional":
            return f"{inner[0].removesuffix(' | None')} | None"
        if outer == "Union":
            return " | ".join(inner)
        if outer in ("List", "list"):
            return f"{'Sequence' if is_argument else 'list'}[{inner[0]}]"
        if outer in ("Dict", "dict", "Tuple", "tuple"):
            return f"{outer.lower()}[{', '.join(inner)}]"
    if text == "os.PathLike":
        return "str | PathLike[str]" if is_argument else "Path"
    if text.startswith("rigcal._rigcal."):
        return text.removeprefix("rigcal._rigcal.")
    if text in ("Any", "None", "SupportsIndex", "bool", "float", "int", "matplotlib.figure.Figure", "pandas.DataFrame", "str"):
        return text
    raise ValueError(f"no type in the stub for {text}")


class Signature:
    """A signature that pybind11 wrote: "name(argument: type = default, ...) -> type"."""

    def __init__(self, text: str, enumerations: dict[str, list[str]]) -> None:
        for name, texts in enumerations.items():
            text = re.sub(rf"{name}\b", f"Literal{texts}", text)
        node = ast.parse(f"def {text}: ...").body[0]
        assert isinstance(node, ast.FunctionDef) and node.returns is not None
        self.name, self.arguments = node.name, node.args
        self.returns = annotation(node.returns, is_argument=False)

    def parameters(self) -> list[str]:
        given = self.arguments
        positional = [self._parameter(each, default) for each, default in zip(
            given.args, [None] * (len(given.args) - len(given.defaults)) + list(given.defaults))]
        keywords = [self._parameter(each, default) for each, default in zip(given.kwonlyargs, given.kw_defaults)]
        return positional + (["*", *keywords] if keywords else [])

    @staticmethod
    def _parameter(argument: ast.arg, default: ast.expr | None) -> str:
        assert argument.annotation is not None
        if argument.arg == "self":
            return "self"
        kind = annotation(argument.annotation, is_argument=True)
        return f"{argument.arg}: {kind}" + (f" = {ast.unparse(default)}" if default is not None else "")


def documented(head: str, doc: str) -> str:
    """Returns a definition with its docstring."""
    lines = doc.strip().replace("\\", "\\\\").splitlines()
    if len(lines) > 1 or len(lines[0]) > 100 or lines[0].endswith('"'):
        wrapped = textwrap.wrap(lines[0], 100) + lines[1:] + [""]
        body = textwrap.indent("\n".join(wrapped), "    ", lambda line: bool(line.strip()))
        return f'{head}\n    """{body.strip()}\n    """\n'
    return f'{head}\n    """{lines[0]}"""\n'


def function_text(function: Any, enumerations: dict[str, list[str]]) -> str:
    """Returns the definitions of a function or method: one for each overload."""
    first, _, rest = function.__doc__.partition("\n")
    overloads = re.split(r"^\d+\. (?=\w+\(.*\) -> .*$)", rest, flags=re.MULTILINE)[1:]
    text = ""
    for each in overloads or [function.__doc__]:
        line, _, doc = each.partition("\n")
        signature = Signature(line, enumerations)
        parameters = signature.parameters()
        inside = ", ".join(parameters)
        if len(inside) > 80:
            inside = "\n    " + ",\n    ".join(parameters) + ",\n"
        text += "@overload\n" if overloads else ""
        text += documented(f"def {signature.name}({inside}) -> {signature.returns}:", doc)
    return text


def property_text(name: str, member: property, enumerations: dict[str, list[str]]) -> str:
    """Returns the definition of a property."""
    assert member.fget is not None and member.fget.__doc__ and member.__doc__, name
    signature = Signature("get" + member.fget.__doc__.splitlines()[0], enumerations)
    return documented(f"@property\ndef {name}(self) -> {signature.returns}:", member.__doc__)


def stub(module: Any) -> str:
    """Returns the text of the stub."""
    texts = [HEAD]
    for name, what in sorted(vars(module).items()):
        if name.startswith("_"):
            continue
        if not isinstance(what, type):
            texts.append(function_text(what, module._enumerations))
            continue
        members = [property_text(key, member, module._enumerations) if isinstance(member, property)
                   else function_text(member, module._enumerations)
                   for key, member in vars(what).items() if not key.startswith("_")]
        texts.append(documented(f"class {name}:", what.__doc__ or "") + textwrap.indent("\n" + "\n".join(members), "    "))
    return "\n".join(texts)


def main() -> None:
    package = pathlib.Path(sys.argv[1])
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(package.parent))
    from rigcal import _rigcal

    text = stub(_rigcal)
    ast.parse(text)
    (package / "_rigcal.pyi").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()

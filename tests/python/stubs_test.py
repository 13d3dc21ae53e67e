"""Checks that the stubs match the module: names, arguments, defaults, types of returned values."""

from __future__ import annotations

import ast
import collections.abc
import pathlib
import subprocess
import sys
import types
import typing
from typing import Any

import numpy as np
import pytest

import rigcal
from rigcal import _rigcal

STUB = pathlib.Path(_rigcal.__file__).parent / "_rigcal.pyi"
TREE = ast.parse(STUB.read_text())
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}


def members(node: ast.ClassDef) -> dict[str, ast.FunctionDef]:
    """Returns the methods of a class; of several overloads, the one with the most defaults."""
    found: dict[str, ast.FunctionDef] = {}
    for each in node.body:
        if isinstance(each, ast.FunctionDef):
            known = found.setdefault(each.name, each)
            assert [row[:2] for row in arguments(known)] == [row[:2] for row in arguments(each)], each.name
            if len(each.args.defaults) > len(known.args.defaults):
                found[each.name] = each
    return found


def is_property(node: ast.FunctionDef) -> bool:
    return any(isinstance(each, ast.Name) and each.id == "property" for each in node.decorator_list)


def arguments(node: ast.FunctionDef) -> list[tuple[str, str, str | None]]:
    """Returns name, kind and default of each argument."""
    plain = node.args.args
    defaults: list[ast.expr | None] = [None] * (len(plain) - len(node.args.defaults)) + list(node.args.defaults)
    rows = [(each.arg, "positional", default) for each, default in zip(plain, defaults)]
    rows += [(each.arg, "keyword", default) for each, default in zip(node.args.kwonlyargs, node.args.kw_defaults)]
    return [(name, kind, ast.unparse(default) if default else None) for name, kind, default in rows]


def declared(function: Any) -> ast.FunctionDef:
    """Parses the signature that pybind11 writes into the first line of a docstring."""
    tree = ast.parse("def " + function.__doc__.splitlines()[0] + ": ...").body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


def public(owner: object) -> set[str]:
    return {name for name in vars(owner) if not name.startswith("_")}


def test_the_module_has_the_names_of_its_stub() -> None:
    assert public(_rigcal) == CLASSES.keys() | FUNCTIONS.keys()
    assert set(rigcal.__all__) >= public(_rigcal)
    assert all(hasattr(rigcal, name) for name in rigcal.__all__)


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_has_the_members_of_its_stub(name: str) -> None:
    stub = members(CLASSES[name])
    real = getattr(_rigcal, name)
    assert public(real) == stub.keys()
    for member, node in stub.items():
        assert isinstance(vars(real)[member], property) == is_property(node), member
        if not is_property(node):
            assert arguments(node) == arguments(declared(vars(real)[member])), member


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_takes_the_arguments_of_its_stub(name: str) -> None:
    assert arguments(FUNCTIONS[name]) == arguments(declared(getattr(_rigcal, name)))


@pytest.mark.parametrize("name", CLASSES)
def test_everything_has_a_docstring(name: str) -> None:
    real = getattr(_rigcal, name)
    assert real.__doc__
    for member in public(real):
        doc = vars(real)[member].__doc__
        assert doc and len(doc.strip()) > 2, f"{name}.{member}"


# ---- types of values. The stub cannot be imported, so its annotations are evaluated here.


def namespace() -> dict[str, Any]:
    names: dict[str, Any] = {name: getattr(_rigcal, name) for name in CLASSES}
    for node in TREE.body:
        if isinstance(node, (ast.Import, ast.ImportFrom, ast.Assign)):
            exec(compile(ast.Module([node], []), str(STUB), "exec"), names)  # noqa: S102: our own file
    return names


NAMES = namespace()


def assert_is(value: Any, annotation: Any, place: str) -> None:
    """Checks that a value has the annotated type, including all nested values."""
    origin, inner = typing.get_origin(annotation), typing.get_args(annotation)
    if annotation is Any:
        return
    if origin in (typing.Union, types.UnionType):
        failures = []
        for each in inner:
            try:
                assert_is(value, each, place)
                return
            except AssertionError as failure:
                failures.append(str(failure))
        raise AssertionError(f"{place}: {failures}")
    if origin is typing.Literal:
        assert value in inner, f"{place}: {value!r} is none of {inner}"
    elif origin is list:
        assert type(value) is list, place
        for i, each in enumerate(value):
            assert_is(each, inner[0], f"{place}[{i}]")
    elif origin is tuple:
        assert type(value) is tuple and len(value) == len(inner), place
        for each, kind in zip(value, inner):
            assert_is(each, kind, place)
    elif origin is dict:
        assert type(value) is dict, place
        for key, each in value.items():
            assert_is(key, inner[0], place)
            assert_is(each, inner[1], f"{place}[{key!r}]")
    elif origin is np.ndarray:
        assert isinstance(value, np.ndarray), place
        assert value.dtype == typing.get_args(inner[1])[0], f"{place}: {value.dtype}"
    elif annotation is None:
        assert value is None, place
    elif annotation is pathlib.Path:
        assert isinstance(value, pathlib.Path), place
    else:
        assert type(value) is (type(None) if annotation is type(None) else annotation), f"{place}: {type(value)}"
        if type(value).__name__ in CLASSES:
            assert_has_its_types(value, place)


def assert_has_its_types(value: Any, place: str) -> None:
    for name, node in members(CLASSES[type(value).__name__]).items():
        if is_property(node) and node.returns is not None:
            annotation = eval(ast.unparse(node.returns), NAMES)  # noqa: S307: our own file
            assert_is(getattr(value, name), annotation, f"{place}.{name}")


def seen_by(walk: collections.abc.Callable[[], None], monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Returns the names of the classes whose values the walk has checked."""
    seen: set[str] = set()
    original = assert_has_its_types

    def noting(value: Any, place: str) -> None:
        seen.add(type(value).__name__)
        original(value, place)

    monkeypatch.setitem(globals(), "assert_has_its_types", noting)
    walk()
    return seen


def test_values_have_the_types_of_the_stub(campaign: rigcal.Campaign, monkeypatch: pytest.MonkeyPatch) -> None:
    events: list[object] = []
    fit = campaign.fit(starts=2, bootstrap=20, profiles=True, posterior=100, progress=events.append)

    def walk() -> None:
        for what in (campaign, campaign.check(), fit, campaign.validate(fit), *events):
            assert_has_its_types(what, type(what).__name__)
        for simulation in campaign.simulate().values():
            assert_has_its_types(simulation, "Simulation")
        for record in campaign.average().values():
            assert_has_its_types(record, "Record")

        assert_has_its_types(campaign.plan(fit), "Result")

    seen = seen_by(walk, monkeypatch)
    # Not every build has a live page (see notebook_test.py). This campaign has no limits; those are
    # tested in demo_test.py.
    assert seen == CLASSES.keys() - {"LimitCheck", "Page"}


def test_the_check_of_types_notices_a_wrong_one() -> None:
    for value, annotation in ((1, float), (1.0, int), ("PASSED", typing.Literal["PASS"]), ([1], list[str]),
                              (np.zeros(2, np.float32), np.ndarray[Any, np.dtype[np.float64]]), (None, float),
                              ({"a": 1}, dict[str, str]), ((1.0,), tuple[float, float]), ("", pathlib.Path)):
        with pytest.raises(AssertionError):
            assert_is(value, annotation, "value")


def test_signatures_are_read() -> None:
    assert ("bootstrap", "keyword", "0") in arguments(declared(_rigcal.Campaign.fit))


def test_types_are_checked_by_mypy() -> None:
    pytest.importorskip("mypy")
    examples = pathlib.Path(__file__).resolve().parent.parent.parent / "python" / "examples"
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", "/dev/null", STUB.parent,
                           *examples.glob("*.py")], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr

"""Checks the stub that the build writes from the module: types, docstrings, and what mypy makes of it."""

from __future__ import annotations

import ast
import collections.abc
import contextlib
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

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent.parent / "python"))
import member_docs
import write_stub

STUB = pathlib.Path(_rigcal.__file__).parent / "_rigcal.pyi"
TREE = ast.parse(STUB.read_text())
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}


def members(node: ast.ClassDef) -> list[ast.FunctionDef]:
    return [each for each in node.body if isinstance(each, ast.FunctionDef)]


def is_property(node: ast.FunctionDef) -> bool:
    return any(isinstance(each, ast.Name) and each.id == "property" for each in node.decorator_list)


def public(owner: object) -> set[str]:
    return {name for name in vars(owner) if not name.startswith("_")}


def test_the_package_has_all_names_of_the_module() -> None:
    assert public(_rigcal) == CLASSES.keys() | FUNCTIONS.keys()
    assert set(rigcal.__all__) >= public(_rigcal)
    assert all(hasattr(rigcal, name) for name in rigcal.__all__)


def test_the_stub_is_that_of_the_module() -> None:
    assert STUB.read_text() == write_stub.stub(_rigcal)


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_has_all_members_in_its_stub(name: str) -> None:
    assert public(getattr(_rigcal, name)) == {each.name for each in members(CLASSES[name])}


def test_everything_has_a_type() -> None:
    """Only the contents of a JSON file are of any type."""
    functions = [(node.name, node) for node in FUNCTIONS.values()]
    functions += [(f"{name}.{node.name}", node) for name, owner in CLASSES.items() for node in members(owner)]
    for place, node in functions:
        given = [each for each in node.args.args + node.args.kwonlyargs if each.arg != "self"]
        for kind in (node.returns, *(each.annotation for each in given)):
            assert kind is not None, place
            names = {each.id for each in ast.walk(kind) if isinstance(each, ast.Name)}
            assert "object" not in names or "Callable" in names, place
            assert "Any" not in names or place.endswith(".json"), place


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
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            with contextlib.suppress(ImportError):  # pandas and matplotlib are optional
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
    for node in members(CLASSES[type(value).__name__]):
        if is_property(node) and node.returns is not None:
            annotation = eval(ast.unparse(node.returns), NAMES)  # noqa: S307: our own file
            assert_is(getattr(value, node.name), annotation, f"{place}.{node.name}")


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
    fit = campaign.fit(starts=2, bootstrap=20, profiles=True, posterior=100, cross_validate=True, progress=events.append)

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
    # tested in demo_test.py. Its residuals call for no effect, so that no model is refitted or averaged, its
    # simulations do not fail, and no leak is free.
    assert CLASSES.keys() - seen == {"AcceptanceLimit", "AveragedEstimate", "DrawnShare", "KeptLimit", "LimitCheck", "Page",
                                     "RefittedModel", "SimulationFailure"}


def test_the_check_of_types_notices_a_wrong_one() -> None:
    for value, annotation in ((1, float), (1.0, int), ("PASSED", typing.Literal["PASS"]), ([1], list[str]),
                              (np.zeros(2, np.float32), np.ndarray[Any, np.dtype[np.float64]]), (None, float),
                              ({"a": 1}, dict[str, str]), ((1.0,), tuple[float, float]), ("", pathlib.Path)):
        with pytest.raises(AssertionError):
            assert_is(value, annotation, "value")


# ---- what mypy makes of the stub

USER_SCRIPT = '''
import pathlib
import numpy as np
import rigcal

campaign = rigcal.load(pathlib.Path("campaign.toml"), set={"mass": "60 kg", "sensor_lag": 0.0}, free=("mass",))
fit = campaign.fit(starts=np.int64(3), progress=lambda event: None)
alone = campaign.simulate("sine").time_s.mean()
largest = max(each.position_m.max() for each in campaign.simulate(values={"mass": 61.0}).values())
mass = fit.parameter("mass")
if mass.ci95 is not None and mass.profile is not None:
    width: float = mass.ci95[1] - mass.ci95[0] + mass.profile.values.max()
if mass.budget is not None:
    sources: list[str] = [line.source for line in mass.budget.lines if line.kind == "effect"]
good = fit.verdict == "PASS" or fit.assessment.adequacy.state == "reservation"
files: list[pathlib.Path] = fit.write("out", force=True)
'''
WRONG_LINES = (
    'fit.parameter("mass").valeu',  # no such member
    'fit.verdict == "passed"',  # not one of the texts
    'campaign.plant == "single_chamber"',
    'low: float = fit.parameter("mass").ci95[0]',  # may be None
    'fit.parameters = []',  # read-only
    'campaign.fit(start=3)',  # no such argument
    'campaign.fit(starts="3")',
    'campaign.fit(3)',  # keyword only
    'campaign.simulate().time_s',  # a dict
    'rigcal.load("campaign.toml", set={"mass": None})',
    'campaign.fit(progress=lambda: None)',
    'n: int = campaign.simulate("sine").signals["position_m"]',
)


def mypy(*files: pathlib.Path) -> subprocess.CompletedProcess[str]:
    pytest.importorskip("mypy")
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", "/dev/null", STUB.parent, *files],
                          capture_output=True, text=True, check=False)


def test_mypy_accepts_the_examples_and_a_script_of_a_user(tmp_path: pathlib.Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(USER_SCRIPT)
    examples = pathlib.Path(write_stub.__file__).parent / "examples"
    done = mypy(script, *examples.glob("*.py"))
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy_finds_each_mistake_of_a_user(tmp_path: pathlib.Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(USER_SCRIPT + "\n".join(WRONG_LINES) + "\n")
    before = len(USER_SCRIPT.splitlines())
    done = mypy(script)
    found = {int(line.split(":")[1]) - before for line in done.stdout.splitlines() if "script.py" in line}
    assert found == set(range(1, len(WRONG_LINES) + 1)), done.stdout


# ---- how the stub and the docstrings are made


def translated(text: str, *, is_argument: bool = False) -> str:
    return write_stub.annotation(ast.parse(text, mode="eval").body, is_argument=is_argument)


def test_types_of_pybind11_become_those_of_python() -> None:
    assert translated("Optional[Union[rigcal._rigcal.Fit, os.PathLike]]", is_argument=True) == "Fit | str | PathLike[str] | None"
    assert translated("Tuple[os.PathLike, List[str]]") == "tuple[Path, list[str]]"
    assert translated("Dict[str, List[float]]", is_argument=True) == "dict[str, Sequence[float]]"
    assert translated("Dict[str, numpy.ndarray[numpy.float64]]") == "dict[str, NDArray[np.float64]]"
    assert translated("Callable[[Union[rigcal._rigcal.Pieces, str]], object]") == "Callable[[Pieces | str], object]"
    for unknown in ("object", "dict", "handle", "Set[str]"):
        with pytest.raises(ValueError, match="no type in the stub for"):
            translated(unknown)


def test_an_enumeration_without_texts_is_an_error() -> None:
    assert write_stub.Signature("get(arg0: int) -> rigcal::State", {"rigcal::State": ["on", "off"]}).returns == "Literal['on', 'off']"
    with pytest.raises(SyntaxError):
        write_stub.Signature("get(arg0: int) -> rigcal::Other", {"rigcal::State": ["on", "off"]})


def test_comments_in_headers_become_docstrings() -> None:
    docs = member_docs.comments("""
namespace rigcal::calib {
/// How a fit ended,
/// and where.
struct End {
  double cost = 0.0;  ///< half the sum
                      ///< of squares
  /// Where it is, SI.
  std::optional<std::pair<double, double>> place;
  int low, high;  ///< bounds
  int bare = 1;
  bool is_low() const { return low > 0; }
};
/// Returns it.
End end_of(int cost);
}  // namespace rigcal::calib
""")
    assert docs == {"rigcal::calib::End": "How a fit ended, and where.",
                    "rigcal::calib::End::cost": "Half the sum of squares.",
                    "rigcal::calib::End::place": "Where it is, SI.",
                    "rigcal::calib::End::low": "Bounds.",
                    "rigcal::calib::End::high": "Bounds."}


def test_members_of_a_base_keep_their_comments() -> None:
    header = """
namespace rigcal::calib {
/// A test.
struct Test : metrics::Judged {
  double p = 1.0;  ///< its p-value
};
}  // namespace rigcal::calib
"""
    docs = {"rigcal::metrics::Judged": "Judged.", "rigcal::metrics::Judged::outcome": "Outcome.", "rigcal::calib::Judged::other": "Other."}
    assert member_docs.inherited(header, docs) == {"rigcal::calib::Test::outcome": "Outcome."}

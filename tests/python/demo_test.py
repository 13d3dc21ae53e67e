"""Checks that the demo script for the module gives the same results as the commands of the demo."""

from __future__ import annotations

import json
import pathlib
import subprocess
import sys

import pytest
from conftest import SOURCE, command
from stubs_test import assert_has_its_types

import rigcal


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    return tmp_path_factory.mktemp("demo")


@pytest.fixture(scope="module")
def printed(folder: pathlib.Path) -> str:
    """Output of the script. Its results are in ours/, those of the commands are in theirs/."""
    done = subprocess.run([sys.executable, SOURCE / "python" / "examples" / "demo.py", folder / "ours"],
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    theirs = folder / "theirs"
    command("synthesize", SOURCE / "datasets" / "rigs" / "uis_shake_table" / "campaign.toml", "--seed", 1, "--out",
            theirs)
    command("average", theirs / "campaign.toml", "--out", theirs)
    command("fit", theirs / "campaign.toml", "--out", theirs)
    command("validate", theirs / "campaign.toml", "--fit", theirs / "fit.json", "--out", theirs / "validation")
    return done.stdout


def numbers(file: pathlib.Path) -> dict[str, object]:
    result = json.loads(file.read_text())
    for name in ("wall_seconds", "provenance"):
        del result[name]
    return result


def test_the_results_are_those_of_the_commands(printed: str, folder: pathlib.Path) -> None:
    ours, theirs = folder / "ours", folder / "theirs"
    for file in ("fit.json", "validation/validation.json"):
        assert numbers(ours / file) == numbers(theirs / file), file
    same = ["fitted.toml", "parameters.csv", "scorecard.csv", "repeatability.csv", "truth.json",
            *(str(file.relative_to(theirs)) for folder in ("averaged", "residuals", "records")
              for file in (theirs / folder).iterdir())]
    assert len(same) > 100
    for file in same:
        assert (ours / file).read_bytes() == (theirs / file).read_bytes(), file


def test_every_estimate_is_printed(printed: str, folder: pathlib.Path) -> None:
    fit = json.loads((folder / "theirs" / "fit.json").read_text())
    lines = printed.splitlines()
    fitted = [each for each in fit["parameters"] if each["fitted"]]
    assert len(fitted) == 7
    for parameter in fitted:
        start = f"{parameter['name']:24} {parameter['level'] or '':9} {parameter['value']:12.6g} "
        assert any(line.startswith(start) for line in lines), start
    for condition in json.loads((folder / "theirs" / "validation" / "validation.json").read_text())["conditions"]:
        ccc = condition["metrics"]["position"]["ccc"]
        start = f"{condition['id']}: {condition['use']}, {condition['verdict']}, ccc {ccc:.4f}, "
        assert any(line.startswith(start) for line in lines), start


def test_checks_of_limits_have_their_types(printed: str, folder: pathlib.Path) -> None:
    validation = rigcal.load(folder / "ours" / "campaign.toml").validate(folder / "ours" / "fit.json")
    theirs = json.loads((folder / "theirs" / "validation" / "validation.json").read_text())
    for condition in theirs["conditions"]:
        checks = validation.conditions[condition["id"]].checks
        for check, other in zip(checks, condition["limit_checks"], strict=True):
            assert_has_its_types(check, "LimitCheck")
            assert [getattr(check, name) for name in ("channel", "metric", "value", "limit", "warn", "verdict")] == [
                other[name] for name in ("channel", "metric", "value", "limit", "warn", "verdict")]
    assert sum(len(condition.checks) for condition in validation.conditions.values()) > 0

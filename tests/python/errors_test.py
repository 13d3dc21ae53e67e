"""Checks that bad input never causes a crash, but an exception that names the error and its place."""

from __future__ import annotations

import math
import os
import pathlib
import pickle
import shutil
from typing import Any

import numpy as np
import pytest

import rigcal


def changed(data: pathlib.Path, folder: pathlib.Path, old: str, new: str) -> pathlib.Path:
    """Writes a copy of the campaign with a changed text, without the records."""
    text = (data / "campaign.toml").read_text()
    assert old in text
    file = folder / "campaign.toml"
    file.write_text(text.replace(old, new, 1))
    return file


def test_a_missing_campaign(tmp_path: pathlib.Path) -> None:
    with pytest.raises(rigcal.InputError, match="no_such.toml") as caught:
        rigcal.load(tmp_path / "no_such.toml")
    assert caught.value.file == str(tmp_path / "no_such.toml")
    assert caught.value.line is None


def test_names_of_files_may_be_any_bytes(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    folder = tmp_path / os.fsdecode(b"\xff")
    with pytest.raises(rigcal.InputError) as caught:
        rigcal.load(folder / "campaign.toml")
    assert caught.value.file == str(folder / "campaign.toml")
    shutil.copytree(data, folder)
    fit = rigcal.load(folder / "campaign.toml").fit()
    fit.write(folder / "out")
    assert rigcal.load(folder / "campaign.toml").validate(folder / "out" / "fit.json").status == "converged"
    assert fit.json()["provenance"]["command"] == rf"rigcal.load('{tmp_path}/\udcff/campaign.toml').fit()"


def test_a_typo_in_a_key(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    file = changed(data, tmp_path, "bulk_modulus", "bulk_modulos")
    with pytest.raises(rigcal.InputError, match="bulk_modulus") as caught:  # the nearest known key
        rigcal.load(file, data)
    line = next(i for i, text in enumerate(file.read_text().splitlines(), 1) if "bulk_modulos" in text)
    assert (caught.value.file, caught.value.line) == (str(file), line)
    assert caught.value.column is not None
    assert str(caught.value).startswith(f"{file}:{line}:{caught.value.column}: ")


def test_an_error_survives_pickling(tmp_path: pathlib.Path) -> None:  # multiprocessing pickles errors
    with pytest.raises(rigcal.InputError) as caught:
        rigcal.load(tmp_path / "no_such.toml")
    copy = pickle.loads(pickle.dumps(caught.value))
    assert (str(copy), copy.file, copy.line) == (str(caught.value), caught.value.file, caught.value.line)


def test_a_missing_recording(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    campaign = rigcal.load(data / "campaign.toml", data=tmp_path)
    for call in (campaign.check, campaign.average, campaign.fit, campaign.validate):
        with pytest.raises(rigcal.InputError, match="records"):
            call()


def test_nothing_outside_of_root_is_read(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    assert rigcal.load(data / "campaign.toml", root=data).average()
    inside = tmp_path / "inside"
    inside.mkdir()
    (inside / "campaign.toml").write_text((data / "campaign.toml").read_text())
    (inside / "records").symlink_to(data / "records")
    with pytest.raises(rigcal.InputError, match="leads out of"):
        rigcal.load(inside / "campaign.toml", root=inside).average()
    with pytest.raises(rigcal.InputError, match="leads out of"):
        rigcal.load(data / "campaign.toml", root=inside)
    assert rigcal.load(inside / "campaign.toml").average()
    with pytest.raises(ValueError):
        rigcal.load(data / "campaign.toml", root="")


def test_a_damaged_recording(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    file = changed(data, tmp_path, "[rig]", "[rig]")
    (tmp_path / "records").mkdir()
    for record in (data / "records").iterdir():
        (tmp_path / "records" / record.name).write_text(record.read_text())
    damaged = sorted((tmp_path / "records").iterdir())[0]
    lines = damaged.read_text().splitlines()
    lines[10] = lines[10].replace(lines[10].split(",")[1], "abc")
    damaged.write_text("\n".join(lines))
    with pytest.raises(rigcal.InputError, match="abc") as caught:
        rigcal.load(file).average()
    assert (caught.value.file, caught.value.line) == (str(damaged), 11)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"set": {"mas": "60 kg"}}, "mass"),
        ({"set": {"mass": "60 m"}}, "mass"),
        ({"set": {"mass": 60.0}}, "mass"),
        ({"set": {"mass": math.nan}}, "mass"),
        ({"set": {"mass": "1e9 kg"}}, "mass"),
        ({"free": ["mas"]}, "mass"),
    ],
)
def test_values_that_do_not_fit_the_campaign(data: pathlib.Path, changes: dict[str, Any], told: str) -> None:
    with pytest.raises(rigcal.UsageError, match=told) as caught:
        rigcal.load(data / "campaign.toml", **changes)
    assert isinstance(caught.value, ValueError)
    assert not str(caught.value).startswith("-")  # names no command-line option


@pytest.mark.parametrize("changes", [{"set": {"mass": None}}, {"set": {1: "60 kg"}}, {"set": ["mass=60 kg"]},
                                     {"free": "mass"}, {"free": [1]}, {"data": 3}])
def test_arguments_of_another_type(data: pathlib.Path, changes: dict[str, Any]) -> None:
    with pytest.raises(TypeError):
        rigcal.load(data / "campaign.toml", **changes)


def test_empty_arguments(data: pathlib.Path) -> None:
    for arguments in ({"campaign": ""}, {"data": ""}, {"free": []}):
        with pytest.raises(ValueError, match=next(iter(arguments))):
            rigcal.load(**{"campaign": data / "campaign.toml", **arguments})
    campaign = rigcal.load(data / "campaign.toml")
    for method in (campaign.average, campaign.simulate):
        with pytest.raises(ValueError, match="out: found an empty path"):
            method(out="")


@pytest.mark.parametrize(
    ("name", "value"),
    [(name, value) for name, values in {
        "starts": [0, -1, 100_001, 2**70],
        "seed": [-1, 2**64],
        "bootstrap": [-1, 1_000_001],
        "max_time": [0.0, -1.0, math.nan, math.inf],
        "max_evaluations": [0, -1, 2**63],
        "threads": [0, -1, 1025],
    }.items() for value in values],
)
def test_an_argument_out_of_its_range(campaign: rigcal.Campaign, name: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"^{name}: found .*, expected"):
        campaign.fit(**{name: value})


@pytest.mark.parametrize("arguments", [{"starts": 1.5}, {"seed": "one"}, {"max_time": "soon"}, {"progress": 3},
                                       {"start": 2}])
def test_an_argument_of_another_type(campaign: rigcal.Campaign, arguments: dict[str, Any]) -> None:
    with pytest.raises(TypeError):
        campaign.fit(**arguments)


def test_numbers_of_numpy_are_whole_numbers(campaign: rigcal.Campaign) -> None:
    assert campaign.fit(starts=np.int64(1), threads=np.uint8(1)).status == "converged"


def test_nothing_is_free(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "campaign.toml"
    file.write_text((data / "campaign.toml").read_text().replace("fit = true", "fit = false"))
    with pytest.raises(rigcal.InputError):
        rigcal.load(file, data).fit()


def test_an_unknown_condition(campaign: rigcal.Campaign) -> None:
    known = campaign.conditions[0].id
    with pytest.raises(rigcal.UsageError, match=f"condition: .*{known}"):
        campaign.simulate(known + "x")


def test_a_validation_of_what_is_no_fit(campaign: rigcal.Campaign, data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    for file in (tmp_path / "no_such.json", data / "truth.json"):
        with pytest.raises(rigcal.InputError, match=file.name):
            campaign.validate(file)
    with pytest.raises(TypeError):
        campaign.validate(3)  # type: ignore[arg-type]
    with pytest.raises(rigcal.InputError, match="schema"):
        campaign.validate(campaign.validate())  # a validation has no estimates


def test_a_parameter_that_is_not_there(fit: rigcal.Fit) -> None:
    with pytest.raises(KeyError, match="mass"):
        fit.parameter("mas")
    with pytest.raises(KeyError, match="33 %"):
        fit.parameter("mass", "33 %")


def test_what_cannot_be_written(fit: rigcal.Fit, tmp_path: pathlib.Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(rigcal.WriteError, match="file"):
        fit.write(tmp_path / "file" / "out")
    with pytest.raises(ValueError, match="^out: "):
        fit.write("")


def test_a_result_never_replaces_what_it_was_made_from(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    campaign = rigcal.load(data / "campaign.toml")
    campaign.fit().write(tmp_path / "first")
    again = rigcal.load(tmp_path / "first" / "fitted.toml", free=["mass"]).fit()
    with pytest.raises(rigcal.UsageError, match="fitted.toml"):
        again.write(tmp_path / "first")


def test_synthesize_needs_a_known_rig(campaign: rigcal.Campaign, tmp_path: pathlib.Path) -> None:
    with pytest.raises(rigcal.InputError, match="synthetic"):
        campaign.synthesize(tmp_path / "out", seed=1)
    with pytest.raises(TypeError):
        campaign.synthesize(tmp_path / "out")  # type: ignore[call-arg]


def test_a_fit_that_fails_is_no_exception(campaign: rigcal.Campaign) -> None:
    stopped = campaign.fit(max_evaluations=1)
    assert stopped.status in ("stopped", "failed")
    assert stopped.message


def test_results_cannot_be_written_to(campaign: rigcal.Campaign, fit: rigcal.Fit) -> None:
    condition = campaign.conditions[0].id
    for array in (fit.conditions[condition].time_s, campaign.average()[condition].time_s,
                  campaign.simulate(condition).position_m):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    with pytest.raises(AttributeError):
        fit.status = "converged"  # type: ignore[misc]


def test_arrays_outlive_what_they_came_from(data: pathlib.Path) -> None:
    fit = rigcal.load(data / "campaign.toml").fit()
    expected = [fit.conditions[condition].channels["position"].measured.sum() for condition in fit.conditions]
    arrays = [score.channels["position"].measured for score in fit.conditions.values()]
    del fit
    garbage = [np.full(4001, np.nan) for _ in range(200)]
    assert [array.sum() for array in arrays] == expected
    assert len(garbage) == 200


def test_an_absent_folder_is_named(tmp_path: pathlib.Path) -> None:
    with pytest.raises(rigcal.InputError, match=os.fspath(tmp_path)):
        rigcal.load(tmp_path)

"""Checks that the module computes and writes exactly the same results as the command."""

from __future__ import annotations

import csv
import html
import json
import math
import pathlib
import re
from typing import Any

import numpy as np
import pytest
from conftest import SOURCE, command

import rigcal

# All options of a fit: for the command, for load(), for fit().
OPTIONS = ["--starts", 3, "--seed", 7, "--bootstrap", 20, "--profiles", "--posterior", 100, "--cross-validate", "--set", "mass=90 kg",
           "--free", "mass,bulk_modulus,damping"]
CHANGED = {"set": {"mass": "90 kg"}, "free": ["mass", "bulk_modulus", "damping"]}
ASKED = {"starts": 3, "seed": 7, "bootstrap": 20, "profiles": True, "posterior": 100, "cross_validate": True}


class Pair:
    """Runs command and module in the folders `theirs` and `ours`, with equal relative paths."""

    def __init__(self, folder: pathlib.Path, data: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.theirs, self.ours = folder / "theirs", folder / "ours"
        self.theirs.mkdir()
        self.ours.mkdir()
        (folder / "data").symlink_to(data)
        monkeypatch.chdir(self.ours)

    def command(self, *arguments: object) -> str:
        return command(*arguments, cwd=self.theirs)

    def assert_same_files(self, out: str) -> None:
        theirs, ours = files_in(self.theirs / out), files_in(self.ours / out)
        assert theirs.keys() == ours.keys()
        for name in theirs:
            assert ours[name] == theirs[name], name


def files_in(folder: pathlib.Path) -> dict[str, str]:
    """Returns the texts of all files, without call and run time, which differ between equal runs."""
    files = {str(file.relative_to(folder)): file.read_text() for file in folder.rglob("*") if file.is_file()}
    manifest = json.loads(files["rigcal-manifest.json"])  # its hashes differ for the same reasons
    files["rigcal-manifest.json"] = str([(each["path"], each["verb"]) for each in manifest["files"]])
    for name in ("fit.json", "validation.json", "average.json"):
        if name not in files:
            continue
        result = json.loads(files[name])
        call = result["provenance"]["command"]
        files[name] = without(files[name], f'"command": {json.dumps(call)}')
        page = html.unescape(files["report.html"])
        page = re.sub(r"(SHA-256 (?:of [a-z.]+ )?)[0-9a-f]{8,16}", r"\1", page)  # hashes of files that differ
        files["report.html"] = page = without(page, f"<pre><code>{call}</code></pre>")
        if name == "average.json":
            continue
        files[name] = without(files[name], f'"wall_seconds": {result["wall_seconds"]!r}')
        time = re.findall(r'<th scope="row">Time</th><td>[^<]* s</td>', page)
        assert len(time) == 1
        files["report.html"] = without(page, time[0])
    return files


def without(text: str, told: str) -> str:
    assert text.count(told) == 1, told
    return text.replace(told, "")


@pytest.fixture
def pair(tmp_path: pathlib.Path, data: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> Pair:
    return Pair(tmp_path, data, monkeypatch)


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory, data: pathlib.Path) -> tuple[Pair, rigcal.Fit]:
    """The fit with all that can be asked for, by command and module, each with its files in `out`. It takes most of the time of
    these tests, so that it is made once."""
    with pytest.MonkeyPatch.context() as patch:
        pair = Pair(tmp_path_factory.mktemp("everything"), data, patch)
        pair.command("fit", "../data/campaign.toml", "--out", "out", *OPTIONS)
        fit = rigcal.load("../data/campaign.toml", **CHANGED).fit(**ASKED)
        fit.write("out")
    return pair, fit


def test_files_of_a_fit(pair: Pair) -> None:
    pair.command("fit", "../data/campaign.toml", "--out", "out")
    written = rigcal.load("../data/campaign.toml").fit().write("out")
    pair.assert_same_files("out")
    results = files_in(pair.ours / "out").keys() - {"rigcal-manifest.json"}
    assert {str(path.relative_to("out")) for path in written} == results


def test_files_of_a_fit_with_all_that_can_be_asked_for(everything: tuple[Pair, rigcal.Fit]) -> None:
    pair, fit = everything
    pair.assert_same_files("out")
    assert fit.json()["provenance"]["command"] == (
        "rigcal.load('../data/campaign.toml', set={'mass': '90 kg'}, free=['mass', 'bulk_modulus', 'damping'])"
        ".fit(starts=3, seed=7, bootstrap=20, profiles=True, posterior=100, cross_validate=True)")


def test_files_of_a_validation(pair: Pair) -> None:
    pair.command("fit", "../data/campaign.toml", "--out", "out")
    # Both validate the same fit.json, since its hash is in the result.
    fit = pair.theirs / "out" / "fit.json"
    pair.command("validate", "../data/campaign.toml", "--fit", fit, "--out", "validated")
    rigcal.load("../data/campaign.toml").validate(fit).write("validated")
    pair.assert_same_files("validated")


def test_files_of_a_validation_of_the_campaigns_own_values(pair: Pair) -> None:
    pair.command("validate", "../data/campaign.toml", "--out", "validated")
    rigcal.load("../data/campaign.toml").validate().write("validated")
    pair.assert_same_files("validated")


def test_a_fit_in_memory_validates_as_its_file(campaign: rigcal.Campaign, fit: rigcal.Fit,
                                               tmp_path: pathlib.Path) -> None:
    fit.write(tmp_path)
    of_file, of_memory = campaign.validate(tmp_path / "fit.json").json(), campaign.validate(fit).json()
    for result in (of_file, of_memory):
        for run in (result, result["provenance"]):
            for key in ("wall_seconds", "command", "inputs"):
                run.pop(key, None)
    assert of_memory == of_file
    assert of_memory["parameters"] == json.loads(json.dumps(of_memory["parameters"]))


def test_files_of_average_and_simulate(pair: Pair) -> None:
    campaign = rigcal.load("../data/campaign.toml")
    pair.command("average", "../data/campaign.toml", "--out", "averaged")
    campaign.average(out="averaged")
    pair.assert_same_files("averaged")
    pair.command("simulate", "../data/campaign.toml", "--out", "simulated")
    campaign.simulate(out="simulated")
    pair.assert_same_files("simulated")


def test_files_of_synthesize(pair: Pair) -> None:
    known = SOURCE / "docs" / "tutorial" / "known_rig.toml"
    pair.command("synthesize", known, "--seed", 5, "--out", "made")
    assert rigcal.load(known).synthesize("made", seed=5) == pathlib.Path("made/campaign.toml")
    pair.assert_same_files("made")


def test_what_is_printed(pair: Pair) -> None:
    campaign = rigcal.load("../data/campaign.toml")
    assert str(campaign.check()) == pair.command("check", "../data/campaign.toml")
    printed = pair.command("fit", "../data/campaign.toml", "--out", "out").splitlines()
    assert str(campaign.fit()).splitlines() == [line for line in printed if not line.startswith("files: ")]


# ---- single numbers, compared with the files that the command writes


def same(ours: float | None, theirs: float | None) -> bool:
    """Whether two numbers are exactly equal. JSON has null for a number that is not finite."""
    if theirs is None:
        return ours is None or not math.isfinite(ours)
    return ours == theirs


def table(file: pathlib.Path) -> dict[str, np.ndarray[Any, Any]]:
    """Returns the columns of a CSV file, with NaN for empty fields."""
    with file.open(newline="") as lines:
        rows = list(csv.reader(line for line in lines if not line.startswith("#")))
    return {title: np.array([float(row[i]) if row[i] else math.nan for row in rows[1:]])
            for i, title in enumerate(rows[0])}


def assert_same_numbers(ours: rigcal.Fit, out: pathlib.Path, file: str) -> None:
    theirs = json.loads((out / file).read_text())
    for name in ("status", "message", "verdict", "warnings", "residual_count", "evaluations", "rank", "best_start",
                 "combinations", "interval_advice"):
        assert getattr(ours, name) == theirs[name], name
    for name in ("cost", "reduced_chi_square", "simulation_tolerance"):
        assert same(getattr(ours, name), theirs[name]), name
    assert ours.correlation_names == theirs["correlation"]["names"]
    assert ours.correlation.tolist() == theirs["correlation"]["matrix"]
    assert ours.singular_values.tolist() == theirs["singular_values"]
    for aspect, judged in theirs["assessment"].items():
        reasons = getattr(ours.assessment, aspect).reasons
        assert getattr(ours.assessment, aspect).state == judged["state"]
        assert [reason.words for reason in reasons] == [reason["words"] for reason in judged["reasons"]]
        for mine, other in zip(reasons, judged["reasons"]):
            assert all(same(mine.numbers[name], other["numbers"][name]) for name in other["numbers"])
    assert len(ours.parameters) == len(theirs["parameters"])
    for parameter, other in zip(ours.parameters, theirs["parameters"]):
        assert_same_parameter(parameter, other)
    for start, other in zip(ours.starts, theirs["starts"], strict=True):
        assert start.start_values == other["start_values"]
        assert start.end_values == other["end_values"]
        assert start.final_cost == other["final_cost"]
    assert list(ours.conditions) == [each["id"] for each in theirs["conditions"]]
    for other in theirs["conditions"]:
        assert_same_condition(ours.conditions[other["id"]], other, table(out / "residuals" / (other["id"] + ".csv")))


def assert_same_budget(ours: rigcal.UncertaintyBudget, theirs: dict[str, Any]) -> None:
    for name in ("combined", "degrees_of_freedom", "coverage_factor", "expanded", "shift"):
        assert same(getattr(ours, name), theirs[name]), name
    for line, other in zip(ours.lines, theirs["lines"], strict=True):
        assert (line.source, line.kind) == (other["source"], other["kind"])
        assert same(line.uncertainty, other["uncertainty"])
        assert line.sensitivity == other.get("sensitivity")
    for line, other in zip(ours.beside, theirs.get("beside", []), strict=True):
        assert line.kind == other["kind"]
        assert same(line.uncertainty, other["uncertainty"])


def assert_same_parameter(ours: rigcal.FittedParameter, theirs: dict[str, Any]) -> None:
    for name in ("key", "name", "symbol", "unit", "scope", "level", "fitted", "nuisance", "at_bound",
                 "identifiability", "ci95_from"):
        assert getattr(ours, name) == theirs[name], name
    for name in ("value", "start", "lower", "upper", "standard_error", "robust_standard_error"):
        assert same(getattr(ours, name), theirs[name]), f"{name} of {ours.key}"
    assert ours.ci95 == (tuple(theirs["ci95"]) if theirs["ci95"] else None)
    assert (ours.budget is not None) == ("budget" in theirs)
    if ours.budget:
        assert_same_budget(ours.budget, theirs["budget"])
    assert (ours.bootstrap is not None) == ("bootstrap" in theirs)
    if ours.bootstrap:
        assert list(ours.bootstrap.ci95) == theirs["bootstrap"]["ci95"]
        for name in ("standard_error", "bias", "freedom"):
            assert same(getattr(ours.bootstrap, name), theirs["bootstrap"][name]), name
    assert (ours.profile is not None) == ("profile" in theirs)
    if ours.profile:
        assert ours.profile.values.tolist() == theirs["profile"]["values"]
        assert ours.profile.rises.tolist() == theirs["profile"]["rises"]


def assert_same_condition(ours: rigcal.ScoredCondition, theirs: dict[str, Any],
                          columns: dict[str, np.ndarray[Any, Any]]) -> None:
    for name in ("id", "use", "verdict", "reasons", "warnings", "failure", "not_scored", "samples"):
        assert getattr(ours, name) == theirs[name], name
    assert np.array_equal(ours.time_s, columns["time_s"])
    assert np.array_equal(ours.in_window, columns["in_window"] == 1)
    drive = columns.get("reference_m", columns.get("command_v"))
    assert np.array_equal(ours.drive, drive)
    assert np.array_equal(ours.servo_flow_m3_per_s, columns["servo_flow_m3_per_s"])
    assert np.array_equal(ours.leakage_flow_m3_per_s, columns["leakage_flow_m3_per_s"])
    assert list(ours.channels) == list(theirs["metrics"])
    for key, channel in ours.channels.items():
        scores = theirs["metrics"][key]
        for name, value in channel.metrics.items():
            assert same(value, scores[name]), f"{name} of {key}"
        for name in ("gain_ratio", "phase_deg", "delay_s"):
            assert same(getattr(channel, name), scores[name]), f"{name} of {key}"
        assert channel.noise_floor == theirs["noise_floor"][key]
        assert channel.expanded_uncertainty == theirs["expanded_uncertainty"][key]
        assert channel.expanded_uncertainty is not None
        assert list(channel.budgets) == list(channel.metrics)
        for name, budget in channel.budgets.items():
            assert_same_budget(budget, theirs["score_budgets"][key][name])
            assert same(budget.expanded, theirs["two_sided_uncertainty"][key][name])
        of_channel = [title for title in columns if title.startswith(f"measured_{key}_")]
        assert len(of_channel) == 1
        column = of_channel[0].removeprefix("measured_")
        for what in ("measured", "simulated", "residual"):
            assert np.array_equal(getattr(channel, what), columns[f"{what}_{column}"]), f"{what} of {key}"


def test_every_number_of_a_fit(everything: tuple[Pair, rigcal.Fit]) -> None:
    pair, fit = everything
    assert any(parameter.profile for parameter in fit.parameters)
    assert any(parameter.bootstrap for parameter in fit.parameters)
    assert_same_numbers(fit, pair.theirs / "out", "fit.json")


def test_every_number_of_a_validation(pair: Pair, fit: rigcal.Fit) -> None:
    fit.write("earlier")
    pair.command("validate", "../data/campaign.toml", "--fit", pair.ours / "earlier" / "fit.json", "--out", "out")
    validation = rigcal.load("../data/campaign.toml").validate(fit)
    assert validation.kind == "validation"
    assert_same_numbers(validation, pair.theirs / "out", "validation.json")


def test_every_number_of_a_fit_of_several_leak_levels(tmp_path: pathlib.Path) -> None:
    rig = SOURCE / "datasets" / "rigs" / "uis_shake_table" / "campaign.toml"
    made = rigcal.load(rig).synthesize(tmp_path / "data", seed=1)
    command("fit", made, "--out", tmp_path / "out")
    fit = rigcal.load(made).fit()
    assert_same_numbers(fit, tmp_path / "out", "fit.json")
    levels = {parameter.level for parameter in fit.parameters if parameter.scope == "leak_level"}
    assert len(levels) == 4


def test_one_thread_or_many(campaign: rigcal.Campaign) -> None:
    one, many = (campaign.fit(starts=3, threads=threads).json() for threads in (1, 3))
    del one["wall_seconds"], many["wall_seconds"]
    assert one == many


def test_every_number_of_records_and_simulations(campaign: rigcal.Campaign, data: pathlib.Path,
                                                 tmp_path: pathlib.Path) -> None:
    command("average", data / "campaign.toml", "--out", tmp_path / "averaged")
    for condition, record in campaign.average().items():
        columns = table(tmp_path / "averaged" / "averaged" / f"{condition}.csv")
        assert np.array_equal(record.time_s, columns["time_s"])
        for key, channel in record.channels.items():
            names = [title for title in columns if re.fullmatch(f"{key}_[^_]+_mean", title)]
            assert len(names) == 1, key
            name = names[0].removesuffix("_mean")
            assert np.array_equal(channel.mean, columns[f"{name}_mean"])
            assert np.array_equal(channel.sd, columns[f"{name}_sd"], equal_nan=True)
            assert np.array_equal(channel.count, columns[f"{name}_count"])
    command("simulate", data / "campaign.toml", "--out", tmp_path / "simulated")
    for condition, simulation in campaign.simulate().items():
        columns = table(tmp_path / "simulated" / f"{condition}.csv")
        assert simulation.status == "ok"
        assert np.array_equal(simulation.time_s, columns["time_s"])
        assert np.array_equal(simulation.reference_m, columns["reference_m"])
        # A file omits the second mass if the rig has none.
        assert columns.keys() - {"time_s", "reference_m"} == simulation.signals.keys() - {"payload_acceleration_m_per_s2"}
        for name, signal in simulation.signals.items():
            assert np.array_equal(signal, columns[name]) if name in columns else not signal.any(), name
            assert np.array_equal(signal, getattr(simulation, name)), name

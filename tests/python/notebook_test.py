"""Tests the verbs other than fit and validate, and how a notebook displays results."""

from __future__ import annotations

import copy
import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import threading
import types
from typing import Any

import numpy as np
import pytest

import rigcal
from conftest import command
from rigcal import notebook


@pytest.fixture(scope="module")
def written(fit: rigcal.Fit, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    folder = tmp_path_factory.mktemp("written") / "fit"
    fit.write(folder)
    return folder


@pytest.fixture(scope="module")
def results(
    data: pathlib.Path, campaign: rigcal.Campaign, fit: rigcal.Fit, written: pathlib.Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> dict[str, rigcal.Result]:
    made = [
        campaign.diagnose(fit),
        campaign.parity(fit),
        campaign.leak_table(fit, targets=[10.0], signals=["sine@2Hz@5mm"]),
        campaign.plan(fit),
        rigcal.compare([written, _copied(written)]),
        rigcal.batch(_lab_of(data, tmp_path_factory.mktemp("batch")), tmp_path_factory.mktemp("of_batch") / "out"),
    ]
    return {each.kind: each for each in made}


def _lab_of(data: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    import shutil

    shutil.copytree(data, folder / "lab" / "bench")
    return folder / "lab"


def _copied(folder: pathlib.Path) -> pathlib.Path:
    import shutil

    other = folder.with_name("other")
    shutil.copytree(folder, other)
    return other


def test_results_are_those_of_the_command(
    data: pathlib.Path, written: pathlib.Path, results: dict[str, rigcal.Result], tmp_path: pathlib.Path
) -> None:
    file, fit = data / "campaign.toml", written / "fit.json"
    command("plan", file, "--fit", fit, "--out", tmp_path / "plan")
    command("leak-table", file, "--fit", fit, "--targets", "10", "--signals", "sine@2Hz@5mm", "--out", tmp_path / "leak_table")
    for kind, name in (("plan", "parameters"), ("leak_table", "entries")):
        by_command = json.loads((tmp_path / kind / f"{kind}.json").read_text())
        assert results[kind].json()[name] == by_command[name]
    assert results["leak_table"].files["leak_table.csv"] == (tmp_path / "leak_table" / "leak_table.csv").read_text()


def test_a_path_is_as_good_as_a_fit(campaign: rigcal.Campaign, written: pathlib.Path, results: dict[str, rigcal.Result]) -> None:
    by_path = campaign.plan(written / "fit.json").json()
    assert by_path["parameters"] == results["plan"].json()["parameters"]
    assert str(written / "fit.json") in [each["path"] for each in by_path["provenance"]["inputs"]]
    assert "fit()" in results["plan"].json()["provenance"]["command"]


def test_a_batch_is_that_of_the_command(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    lab = _lab_of(data, tmp_path)
    seen: list[object] = []
    result = rigcal.batch(lab, tmp_path / "here", diagnose=True, progress=seen.append)
    command("batch", lab, "--diagnose", "--out", tmp_path / "by_command")
    by_command = json.loads((tmp_path / "by_command" / "batch.json").read_text())
    assert json.loads((tmp_path / "here" / "batch.json").read_text()) == result.json()
    for (here, there) in zip(result.json()["rigs"], by_command["rigs"], strict=True):
        assert {**here, "seconds": 0} == {**there, "seconds": 0}
    assert (tmp_path / "here" / "bench" / "diagnosis.json").exists() and len(seen) == 1
    again = rigcal.batch(lab, tmp_path / "here", resume=True)
    assert [rig["unchanged"] for rig in again.json()["rigs"]] == [True]
    (lab / "bench" / "campaign.toml").write_text("nonsense")
    wrong = rigcal.batch(lab, tmp_path / "wrong")
    assert wrong.json()["exit_code"] == 2 and "campaign.toml" in wrong.json()["rigs"][0]["message"]
    with pytest.raises(rigcal.UsageError, match="found no campaign.toml"):
        rigcal.batch(tmp_path / "wrong", tmp_path / "nothing")


@pytest.mark.parametrize("kind", ["batch", "comparison", "diagnosis", "leak_table", "parity", "plan"])
def test_a_result_is_written_shown_and_pickled(kind: str, results: dict[str, rigcal.Result], tmp_path: pathlib.Path) -> None:
    result = results[kind]
    paths = result.write(tmp_path / kind)
    assert paths[-1].name == f"{kind}.json"
    assert json.loads(paths[-1].read_text()) == result.json()
    assert (tmp_path / kind / "report.html").read_text() == result.page
    assert result._repr_html_().startswith("<iframe") and len(result._repr_html_()) < 1_000_000
    assert str(result).split(":")[0] in result.page
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), copy.copy(result)):
        assert again.json() == result.json() and again.page == result.page and str(again) == str(result)


def test_a_fit_is_pickled_as_its_files(fit: rigcal.Fit, written: pathlib.Path, tmp_path: pathlib.Path) -> None:
    result = pickle.loads(pickle.dumps(fit))
    assert isinstance(result, rigcal.Result) and result.kind == "fit"
    result.write(tmp_path / "again")
    assert result.json()["parameters"] == fit.json()["parameters"]
    for name in ("scorecard.csv", "parameters.csv", "residual_tests.json"):
        assert (tmp_path / "again" / name).read_bytes() == (written / name).read_bytes(), name
    again = rigcal.load(tmp_path / "again" / "fitted.toml")  # finds its records from any folder
    assert again.check().records
    assert "Calibration of" in fit._repr_html_()


def test_a_campaign_is_pickled_by_its_file(data: pathlib.Path) -> None:
    campaign = rigcal.load(data / "campaign.toml", set={"mass": "61 kg"}, free=["mass"])
    again = pickle.loads(pickle.dumps(campaign))
    assert [(p.key, p.start, p.free) for p in again.parameters] == [(p.key, p.start, p.free) for p in campaign.parameters]


def test_frames(campaign: rigcal.Campaign, fit: rigcal.Fit, results: dict[str, rigcal.Result]) -> None:
    pandas = pytest.importorskip("pandas")
    frame = fit.to_frame()
    assert isinstance(frame, pandas.DataFrame)
    mass = frame[frame["key"] == "mass"].iloc[0]
    assert mass["value"] == fit.parameter("mass").value
    assert len(results["diagnosis"].to_frame("states")) == len(results["diagnosis"].json()["states"])
    with pytest.raises(KeyError, match='did you mean "states"'):
        results["diagnosis"].to_frame("state")
    simulation = campaign.simulate(campaign.conditions[0])
    assert list(simulation.to_frame()["position_m"]) == list(simulation.position_m)
    record = next(iter(campaign.average().values()))
    assert list(record.to_frame()["position"]) == list(record.channels["position"].mean)


def test_a_joint_is_drawn_by_its_angle() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    joint: Any = types.SimpleNamespace(
        condition="arm", time_s=[0.0, 1.0], signals={"position_m": [0.0, 0.1], "angle_rad": [0.0, 0.3]}
    )
    assert notebook._plot_simulation(joint, None).axes[0].get_ylabel() == "angle_rad"
    joint.signals.pop("angle_rad")
    assert notebook._plot_simulation(joint, None).axes[0].get_ylabel() == "position_m"


def test_figures(campaign: rigcal.Campaign, fit: rigcal.Fit, results: dict[str, rigcal.Result]) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    figure = fit.plot(next(iter(fit.conditions)))
    measured, model = figure.axes[0].lines[:2]
    assert len(measured.get_ydata()) == len(model.get_ydata()) > 0
    for result in (*results.values(), pickle.loads(pickle.dumps(fit)), campaign.simulate(campaign.conditions[0])):
        assert result.plot().axes, result
    assert next(iter(campaign.average().values())).plot().axes
    with pytest.raises(KeyError, match="did you mean"):
        fit.plot(next(iter(fit.conditions)) + "x")
    with pytest.raises(KeyError, match='did you mean "position_m"'):
        campaign.simulate(campaign.conditions[0]).plot(["position"])


def test_a_simulation_with_values_and_sensitivities(campaign: rigcal.Campaign) -> None:
    condition = campaign.conditions[0]
    gain = next(p.start for p in campaign.parameters if p.key == "valve_gain")
    step = 0.01 * gain
    run = campaign.simulate(condition, values={"valve_gain": gain}, sensitivities=["mass", "valve_gain"])
    up, down = (campaign.simulate(condition.id, values={"valve_gain": gain + sign * step}) for sign in (1, -1))
    slope = (up.position_m - down.position_m) / (2.0 * step)
    by_solver = run.sensitivities["valve_gain"]["position_m"]
    assert np.abs(slope - by_solver).max() <= 1e-3 * np.abs(by_solver).max()
    assert list(run.sensitivities) == ["mass", "valve_gain"]
    with pytest.raises(rigcal.UsageError, match="did you mean 'mass'"):
        campaign.simulate(condition, sensitivities=["mas"])
    with pytest.raises(ValueError, match="values: found nan"):
        campaign.simulate(condition, values={"mass": float("nan")})


def test_records_that_drive_the_model_are_read_once(data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    import shutil

    shutil.copytree(data, tmp_path / "rig")
    text = (tmp_path / "rig" / "campaign.toml").read_text()
    campaign = rigcal.load(tmp_path / "rig" / "campaign.toml")
    first = campaign.simulate(campaign.conditions[0])
    shutil.rmtree(tmp_path / "rig" / "records")
    assert "records" in text
    again = campaign.simulate(campaign.conditions[0])
    assert np.array_equal(first.position_m, again.position_m)


def test_the_live_page(campaign: rigcal.Campaign, fit: rigcal.Fit, tmp_path: pathlib.Path) -> None:
    try:
        page = fit.explore()
    except rigcal.UsageError as error:
        pytest.skip(str(error))
    assert page._repr_html_().startswith("<iframe")
    assert page.write(tmp_path / "live.html").read_text() == page.html
    mass = f"{fit.parameter('mass').value:.10g}"[:8]
    assert mass in page.html and mass not in campaign.explore().html


def test_an_fmu_and_a_draft(campaign: rigcal.Campaign, fit: rigcal.Fit, data: pathlib.Path, tmp_path: pathlib.Path) -> None:
    level = next((c.leak_level for c in campaign.conditions if c.leak_level), None)
    path, warnings = campaign.export_fmu(tmp_path, fit=fit, level=level)
    assert path.suffix == ".fmu" and path.stat().st_size > 0
    assert not [each for each in warnings if "not calibrated" in each]
    draft, left_out = rigcal.init(sorted((data / "records").rglob("*.csv"))[:2], tmp_path / "draft")
    assert "[[condition]]" in draft.read_text() and left_out == []
    with pytest.raises(ValueError, match="files: found none"):
        rigcal.init([], tmp_path / "none")


def test_ctrl_c_ends_a_diagnosis(campaign: rigcal.Campaign, fit: rigcal.Fit) -> None:
    def told(event: rigcal.Pieces) -> None:
        if event.done == 1:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        campaign.diagnose(fit, progress=told)
    threading.Event().wait(0.01)  # the interrupt has no later effect
    assert campaign.plan(fit).kind == "plan"


def test_an_exception_of_progress_is_raised(campaign: rigcal.Campaign, fit: rigcal.Fit) -> None:
    def told(event: rigcal.Pieces) -> None:
        raise LookupError(event.work)

    with pytest.raises(LookupError, match="records"):
        campaign.diagnose(fit, progress=told)


def test_the_wheel(tmp_path: pathlib.Path) -> None:
    source = pathlib.Path(__file__).resolve().parent.parent.parent
    build = pathlib.Path(rigcal.__file__).resolve().parent.parent.parent
    script = "import sys; sys.path.insert(0, 'python'); import wheel_backend; print(wheel_backend.build_wheel(sys.argv[1]))"
    done = subprocess.run([sys.executable, "-c", script, tmp_path], cwd=source, capture_output=True, text=True, check=True,
                          env=os.environ | {"RIGCAL_BUILD": str(build)})
    name = done.stdout.split()[-1]
    assert name.startswith(f"rigcal-{rigcal.__version__}-cp3") and name.endswith(".whl")
    pip = [sys.executable, "-m", "pip"]
    if subprocess.run([*pip, "--version"], capture_output=True, check=False).returncode == 0:
        subprocess.run([*pip, "install", "-q", "--no-deps", "--no-index", "--target", tmp_path / "site", tmp_path / name], check=True)
    else:
        import zipfile

        zipfile.ZipFile(tmp_path / name).extractall(tmp_path / "site")
    told = subprocess.run([sys.executable, "-c", "import rigcal; print(rigcal.__file__, rigcal.__revision__)"], check=True,
                          capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(tmp_path / "site")}).stdout
    assert told.split() == [str(tmp_path / "site" / "rigcal" / "__init__.py"), rigcal.__revision__]


def test_a_python_that_the_wheel_cannot_be_made_for_is_named(tmp_path: pathlib.Path) -> None:
    source = pathlib.Path(__file__).resolve().parent.parent.parent
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path / "other"], check=True)
    other = tmp_path / "other" / "bin" / "python3"  # has no NumPy
    script = "import sys; sys.path.insert(0, 'python'); import wheel_backend; wheel_backend.build_wheel('.')"
    done = subprocess.run([other, "-c", script], cwd=source, capture_output=True, text=True, check=False,
                          env={key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "RIGCAL_BUILD")})
    assert done.returncode != 0
    assert f"no module for {other}" in " ".join(done.stderr.split())
    assert "scripts/setup --dev" in done.stderr

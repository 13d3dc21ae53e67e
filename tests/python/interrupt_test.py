"""Checks that a fit lets other threads run, reports progress, and keeps its best result on Ctrl-C."""

from __future__ import annotations

import _thread
import pathlib
import signal
import subprocess
import sys
import threading
import time

import pytest

import rigcal

LONG = {"bootstrap": 200_000}  # takes minutes


def test_progress_tells_of_iterations_and_of_what_is_beside(campaign: rigcal.Campaign) -> None:
    told: list[rigcal.Iteration | rigcal.Pieces] = []
    fit = campaign.fit(starts=2, bootstrap=8, progress=told.append, threads=2)
    iterations = [each for each in told if isinstance(each, rigcal.Iteration)]
    assert {each.start for each in iterations} == {1, 2}
    assert any(0.0 < each.relative_change <= 1.0 for each in iterations)
    pieces = [each for each in told if isinstance(each, rigcal.Pieces)]
    assert {each.all for each in pieces if "bootstrap" in each.work} == {8}
    assert max(each.done for each in pieces) == 8
    without = campaign.fit(starts=2, bootstrap=8).json()
    assert without["parameters"] == fit.json()["parameters"]


def test_what_progress_raises_ends_the_fit(campaign: rigcal.Campaign) -> None:
    class Enough(Exception):
        pass

    calls = []

    def progress(_: object) -> None:
        calls.append(1)
        raise Enough("of it")

    with pytest.raises(Enough, match="of it"):
        campaign.fit(progress=progress, **LONG)
    assert len(calls) == 1


def test_ctrl_c_keeps_what_was_found(campaign: rigcal.Campaign, tmp_path: pathlib.Path) -> None:
    def interrupt(event: rigcal.Iteration | rigcal.Pieces) -> None:
        if isinstance(event, rigcal.Pieces) and event.done == 1:
            _thread.interrupt_main()

    with pytest.raises(rigcal.Interrupted) as caught:
        campaign.fit(progress=interrupt, **LONG)
    assert isinstance(caught.value, KeyboardInterrupt)
    fit = caught.value.fit
    assert fit.status == "stopped"
    assert fit.parameter("mass").value == pytest.approx(85.0, abs=1.0)  # the search had ended before
    fit.write(tmp_path)
    assert "stopped" in (tmp_path / "fit.json").read_text()
    assert campaign.fit().status == "converged"  # the interrupt has no later effect


def test_a_signal_of_the_system_ends_a_script(data: pathlib.Path) -> None:
    script = ("import rigcal, sys\n"
              f"campaign = rigcal.load({str(data / 'campaign.toml')!r})\n"
              "def told(event):\n"
              "    if isinstance(event, rigcal.Pieces) and event.done == 1: print('begun', flush=True)\n"
              "try:\n"
              "    campaign.fit(bootstrap=200_000, progress=told)\n"
              "except rigcal.Interrupted as stopped:\n"
              "    print(stopped.fit.status)\n"
              "    sys.exit(4)\n")
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGINT)
        rest = process.stdout.read()
        assert process.wait(60) == 4
    assert rest.splitlines()[-1] == "stopped"


def test_an_exception_of_a_handler_is_passed_on(campaign: rigcal.Campaign) -> None:
    class Alarm(Exception):
        pass

    def on_alarm(*_: object) -> None:
        raise Alarm

    before = signal.signal(signal.SIGALRM, on_alarm)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with pytest.raises(Alarm):
            campaign.fit(**LONG)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def test_other_threads_run_meanwhile(campaign: rigcal.Campaign) -> None:
    ended = threading.Event()
    turns = 0

    def count() -> None:
        nonlocal turns
        while not ended.is_set():
            turns += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    during = campaign.fit(bootstrap=100, threads=1)
    seen = turns
    ended.set()
    thread.join()
    assert during.status == "converged"
    assert seen > 10


def test_fits_in_several_threads(campaign: rigcal.Campaign) -> None:
    results: list[rigcal.Fit] = []
    threads = [threading.Thread(target=lambda: results.append(campaign.fit(threads=1))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 4
    assert len({result.parameter("mass").value for result in results}) == 1

"""Sends SIGINT and SIGTERM at any moment of every verb. It must end with exit code 4 and leave
nothing half-written."""
import shutil
import signal
import time

from runs import DEMO, SMALL_RIG, Count, finish, left_behind, must, run, start

WITHIN_S = 1.0


def verbs(source, twin, fit):
    campaign = twin / "campaign.toml"
    by_fit = ["--fit", fit / "fit.json"]
    return [
        ["synthesize", source, "--seed", "2"],
        ["check", campaign],
        ["average", campaign],
        ["simulate", campaign],
        ["fit", campaign, "--starts", "4", "--bootstrap", "20", "--profiles", "--cross-validate"],
        ["validate", campaign, *by_fit],
        ["diagnose", campaign, *by_fit],
        ["parity", campaign, *by_fit],
        ["leak-table", campaign],
        ["plan", campaign, *by_fit],
        ["report", fit, "--figures"],
        ["compare", fit, fit.parent / "validation"],
        ["init", *sorted((twin / "records").glob("*.csv"))],
    ]


def study(rigcal, folder, size):
    """Returns a row for each verb. The small study waits longer, as other processes may slow it down."""
    limit_s = 20.0 if size == "small" else WITHIN_S
    twin, fit = folder / "twin", folder / "fit"
    source = SMALL_RIG if size == "small" else DEMO
    must(rigcal, ["synthesize", source, "--seed", "1", "--out", twin, "--quiet"])
    must(rigcal, ["fit", twin / "campaign.toml", "--out", fit, "--quiet"])
    must(rigcal, ["validate", twin / "campaign.toml", "--fit", fit / "fit.json", "--out", folder / "validation",
                  "--quiet"])
    rows = []
    for arguments in verbs(source, twin, fit):
        row = Count(f"signals: {arguments[0]}")
        has_out = arguments[0] not in ("check", "report")
        out = folder / "out"
        command = arguments + (["--out", out / "new"] if has_out else [])
        began = time.monotonic()
        code, _, err = run(rigcal, command, 600.0)
        whole_s = time.monotonic() - began
        if code is None or code < 0 or code > 4:
            row.is_wrong(f"without a signal exit {code}: {err.decode()[-200:]}")
        moments = 3 if size == "small" else 20
        slowest_s = 0.0
        for k in range(moments):
            shutil.rmtree(out, ignore_errors=True)
            process = start(rigcal, command)
            time.sleep((k + 0.5) / moments * whole_s)
            sent = time.monotonic()
            sent_signal = (signal.SIGINT, signal.SIGTERM)[k % 2]
            process.send_signal(sent_signal)
            code, _, err = finish(process, 30.0)
            if code == -sent_signal:
                code = 4  # the signal arrived before the program had started
            waited_s = time.monotonic() - sent
            slowest_s = max(slowest_s, waited_s)
            where = f"{arguments[0]} after {(k + 0.5) / moments:.0%} of {whole_s:.1f} s"
            row.ended(code, where)
            if code is not None and waited_s > limit_s:
                row.hung += 1
                row.remarks.append(f"{waited_s:.1f} s to the end: {where}")
            if code in (1, 2, 3, 5):
                row.is_wrong(f"exit {code}: {where}: {err.decode()[-200:]}")
            for each in left_behind(folder):
                row.is_wrong(f"left {each}: {where}")
            if out.is_dir() and not any(path.is_file() for path in out.rglob("*")):
                row.is_wrong(f"left an empty folder: {where}")
        row.remarks.append(f"slowest end {slowest_s:.2f} s")
        rows.append(row)
    return rows

"""Kills a fit again and again, during its starts, bootstrap, profiles and cross-validation, and
resumes it each time. The result must have the same bits as without kills. Also checks that
`report` refuses files from different runs."""
import json
import random
import signal
import shutil
import time

from runs import SMALL_RIG, Count, comparable, finish, left_behind, must, run, start

WORK = ["--starts", "12", "--bootstrap", "60", "--profiles", "--cross-validate", "--quiet"]


def killed_fits(rigcal, folder, kills):
    row = Count("kills: fit, resumed after each")
    fit = ["fit", folder / "twin" / "campaign.toml", *WORK]
    began = time.monotonic()
    must(rigcal, [*fit, "--out", folder / "whole"])
    whole_s = time.monotonic() - began
    parts = folder / "parts"
    for _ in range(kills):
        process = start(rigcal, [*fit, "--out", parts, "--resume"])
        time.sleep(random.uniform(0.0, whole_s))
        process.kill()
        code, _, err = finish(process)
        row.ended(None if code is None else abs(code) % 9, "a killed fit")  # SIGKILL is expected, so it does not count as a crash
        if code not in (0, -signal.SIGKILL):
            row.is_wrong(f"exit {code}: {err.decode()[-200:]}")
        if code == 0:  # it ended before it was killed, so start again
            shutil.rmtree(parts)
    must(rigcal, [*fit, "--out", parts, "--resume"])
    if comparable(parts / "fit.json") != comparable(folder / "whole" / "fit.json"):
        row.is_wrong("another fit.json than that of the fit that was not killed")
    for each in left_behind(folder):
        # The next run in the folder removes the files that a killed process left.
        row.is_wrong(f"left {each}")
    return row


def is_same(forged, text):
    try:
        return json.loads(forged) == json.loads(text)
    except ValueError:
        return False


def foreign_checkpoints(rigcal, folder):
    row = Count("checkpoints: forged, or of another fit")
    fit = ["fit", folder / "twin" / "campaign.toml", "--starts", "5", "--quiet", "--out", folder / "forged"]
    code, _, _ = run(rigcal, [*fit, "--max-evaluations", "20"])
    checkpoint = folder / "forged" / "checkpoint.json"
    if code != 4 or not checkpoint.is_file():
        row.is_wrong(f"no checkpoint to forge (exit {code})")
        return row
    text = checkpoint.read_text()
    digits = [i for i, c in enumerate(text) if c.isdigit()]
    tried = [text[:i] + str((int(text[i]) + 1) % 10) + text[i + 1:] for i in digits[:: max(1, len(digits) // 40)]]
    # A change of the seventeenth digit does not always change the number.
    tried = [forged for forged in tried if not is_same(forged, text)]
    for forged in [*tried, "", "{}", text[: len(text) // 2]]:
        checkpoint.write_text(forged)
        code, _, err = run(rigcal, [*fit, "--resume"])
        row.ended(code, "a forged checkpoint")
        if code != 2 or b"checkpoint.json" not in err:
            row.is_wrong(f"exit {code}: {err.decode()[-200:]}")
            if code == 0:
                break  # the run removed the checkpoint
    checkpoint.write_text(text)
    for change in (["--seed", "2"], ["--starts", "6"]):
        code, _, _ = run(rigcal, [*fit, *change, "--resume"])
        row.ended(code, "the checkpoint of another fit")
        if code != 2:
            row.is_wrong(f"{change}: exit {code}")
    return row


def mixed_results(rigcal, folder):
    row = Count("results: files of different runs, mixed")
    one, other = folder / "one", folder / "other"
    for out, mass in ((one, "60 kg"), (other, "61 kg")):
        must(rigcal, ["fit", folder / "twin" / "campaign.toml", "--set", f"mass={mass}", "--out", out, "--quiet"])
    for path in sorted((*one.rglob("*.csv"), one / "residual_tests.json")):
        name = path.relative_to(one)
        if str(name) in ("scorecard.csv", "parameters.csv"):
            continue  # these files are never read back
        mixed = folder / "mixed"
        shutil.rmtree(mixed, ignore_errors=True)
        shutil.copytree(one, mixed)
        shutil.copy(other / name, mixed / name)
        code, _, err = run(rigcal, ["report", mixed])
        row.ended(code, str(name))
        if code != 2 or str(name).encode() not in err:
            row.is_wrong(f"{name} of another run: exit {code}: {err.decode()[-200:]}")
    code, _, err = run(rigcal, ["report", one])
    row.ended(code, "files of one run")
    if code != 0:
        row.is_wrong(f"files of one run: exit {code}: {err.decode()[-200:]}")
    return row


def study(rigcal, folder, size):
    random.seed(1)
    must(rigcal, ["synthesize", SMALL_RIG, "--seed", "1", "--out", folder / "twin", "--quiet"])
    return [killed_fits(rigcal, folder, 3 if size == "small" else 20), foreign_checkpoints(rigcal, folder),
            mixed_results(rigcal, folder)]

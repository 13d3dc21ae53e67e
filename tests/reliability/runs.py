"""Functions that the parts of scripts/reliability share: they run the program and count how it
ends."""
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SMALL_RIG = ROOT / "tests" / "golden" / "resume_study.toml"
DEMO = ROOT / "datasets" / "rigs" / "uis_shake_table" / "campaign.toml"
HANGS_S = 60.0
DOCUMENTED = (1, 2, 3, 4, 5)  # exit codes of a refusal (docs/command-line.md)


class Count:
    """One row of the table."""

    def __init__(self, name):
        self.name, self.tried, self.refused, self.crashed, self.hung, self.wrong = name, 0, 0, 0, 0, 0
        self.remarks = []

    def ended(self, code, text):
        """Counts how one run ended; None if it did not end."""
        self.tried += 1
        if code is None:
            self.hung += 1
            self.remarks.append(f"hung: {text}")
        elif code < 0 or code > 5:
            self.crashed += 1
            self.remarks.append(f"crashed ({code}): {text}")
        elif code in DOCUMENTED:
            self.refused += 1

    def is_wrong(self, text):
        self.wrong += 1
        self.remarks.append(f"wrong: {text}")

    def bad(self):
        return self.crashed + self.hung + self.wrong


def start(rigcal, arguments, **more):
    return subprocess.Popen([rigcal, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            **{"start_new_session": True, **more})


def finish(process, limit_s=HANGS_S):
    """Waits for a process. Returns (exit code or None, stdout, stderr)."""
    try:
        out, err = process.communicate(timeout=limit_s)
        return process.returncode, out, err
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
        return None, out, err


def run(rigcal, arguments, limit_s=HANGS_S, **more):
    return finish(start(rigcal, arguments, **more), limit_s)


def must(rigcal, arguments):
    code, _, err = run(rigcal, arguments, 600.0)
    if code != 0:
        raise SystemExit(f"reliability: rigcal {' '.join(map(str, arguments))}: exit {code}: {err.decode()}")


def comparable(file):
    """Returns a result in JSON without the parts that may differ between two equal runs."""
    result = json.loads(file.read_text())
    for key in ("wall_seconds", "provenance"):
        result.pop(key, None)
    return result


def content(folder):
    """Returns the hashes of all files in a folder, by name."""
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def left_behind(folder):
    """Returns what no run may leave behind: temporary files, and results that are not valid
    JSON."""
    found = []
    for path in folder.rglob("*"):
        if path.name.endswith(".tmp") or path.name == ".rigcal-probe":
            found.append(str(path.relative_to(folder)))
        elif path.suffix == ".json":
            try:
                json.loads(path.read_text())
            except ValueError:
                found.append(f"{path.relative_to(folder)} is no JSON")
    return found

"""What the scripts of docs/ share: they read the result files of `rigcal` and print tables in Markdown."""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys

SIGNALS = {"position": "x", "pressure_a": "p_A", "pressure_b": "p_B", "load_pressure": "P_L", "force": "F",
           "acceleration": "a", "payload_acceleration": "a₂", "angle": "theta", "torque": "M"}
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


def rows_of(path):
    """The rows of a CSV file as dictionaries; comments are left out."""
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def scorecard(folder):
    return rows_of(pathlib.Path(folder) / "scorecard.csv")


def residuals(folder, condition):
    """The columns of a condition's residual file; an empty field is nan."""
    import numpy as np  # only who reads residuals needs it

    rows = rows_of(pathlib.Path(folder) / "residuals" / f"{condition}.csv")
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def read_json(folder, *names):
    """The first of these files that the folder has."""
    for name in names:
        path = pathlib.Path(folder) / name
        if path.is_file():
            return json.loads(path.read_text(encoding="utf-8"))
    sys.exit(f"{folder}: no {' or '.join(names)}")


def fitted_parameters(folder):
    """What a fit estimated, apart from the offsets and the like of single conditions."""
    every = read_json(folder, "fit.json")["parameters"]
    return [each for each in every if each["fitted"] and not each["nuisance"]]


def fit(rigcal, campaign, data, out, *options):
    """Fits a campaign. A broken limit (exit code 1) is a result like any other."""
    command = [rigcal, "fit", campaign, "--data", data, "--out", out, "--quiet", *options]
    code = subprocess.run(command, stdout=subprocess.DEVNULL, check=False).returncode
    if code > 1:
        sys.exit(f"exit code {code}: {' '.join(map(str, command))}")


def written(unit):
    """A unit of a result file as one prints it: m³/Pa."""
    return re.sub(r"(?<=[a-z])[23]\b", lambda power: {"2": "²", "3": "³"}[power[0]], unit)


def scaled(value, unit):
    """The factor, and the unit with its prefix, with which a value is read with ease. A unit that begins with a power
    or a kilogram takes no prefix."""
    if unit == "1":
        return 1.0, ""
    if value == 0.0 or unit.startswith(("kg", "m2", "m3", "1")):
        return 1.0, written(unit)
    exponent = 3 * math.floor(math.log10(abs(value)) / 3)
    exponent = min(max(exponent, min(PREFIXES)), max(PREFIXES))
    return 10.0 ** -exponent, PREFIXES[exponent] + written(unit)


def in_steps_of(uncertainty, *values):
    """Values in the digits that two digits of an uncertainty leave, two of their own at least; all with the exponent of
    the largest, but for those that are far smaller."""
    power = math.floor(math.log10(max(abs(value) for value in values)))
    power = 0 if power >= -3 else power
    decimals = 1 - math.floor(math.log10(uncertainty)) + power
    suffix = f"e{power}" if power else ""

    def text(value):
        scaled_value = value / 10.0 ** power
        own = decimals if value == 0.0 else max(decimals, 1 - math.floor(math.log10(abs(scaled_value))))
        if own > decimals + 3:
            return f"{value:.1e}"
        return f"{round(scaled_value, own) + 0.0:.{max(own, 0)}f}{suffix}"

    return [text(value) for value in values]


def print_table(header, rows):
    """A table in Markdown; every field is text."""
    print("| " + " | ".join(header) + " |")
    print("| --- " * len(header) + "|")
    for row in rows:
        print("| " + " | ".join(row) + " |", flush=True)

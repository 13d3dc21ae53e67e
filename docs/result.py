#!/usr/bin/python3
"""Tables of a result folder of `rigcal fit` or `rigcal validate`.

    docs/result.py scores RESULT_DIR [CONDITION...]    agreement by condition and signal
    docs/result.py outcome RESULT_DIR...               verdict and what it rests on
    docs/result.py verdict RESULT_DIR...               of that the first line
    docs/result.py parameters RESULT_DIR...            estimates; several folders are side by side
"""
import pathlib
import re
import sys

from result_files import SIGNALS, fitted_parameters, in_steps_of, print_table, read_json, scaled, scorecard


RESULTS = ("fit.json", "validation.json")


def agreement(fraction):
    """In percent, the finer the closer to 100: two digits of what is missing."""
    if not fraction:
        return "-"
    missing = 1.0 - float(fraction)
    return f"{100.0 * float(fraction):.{2 if missing > 1e-3 else 3 if missing > 1e-4 else 4}f}"


def scores(folder, *conditions):
    rows = [[f"`{row['condition']}`", row["use"], SIGNALS.get(row["channel"], row["channel"]), agreement(row["rho2"]),
             agreement(row["ccc"]), f"{float(row['absolute_error_percent']):.3f}",
             agreement(row["noise_floor_rho2"]), row["verdict"] or "-"]
            for row in scorecard(folder) if not conditions or row["condition"] in conditions]
    print_table(["condition", "use", "signal", "rho2 %", "CCC %", "error %", "noise floor of rho2 %", "limits"], rows)


def verdict_of(result):
    return {"WARN": "WARN (passed with reservations)", None: "none"}.get(result["verdict"], result["verdict"])


def message_of(result):
    """Without the number of iterations, which the last bits may change."""
    message = re.sub(r" after \d+ iterations?", "", result["message"])
    return re.sub(r"\b[a-z0-9]+(?:_[a-z0-9]+)+\b", r"`\g<0>`", message)


def reason_text(reason):
    numbers = ", ".join(f"{name.replace('_', ' ')} {value:.3g}" for name, value in reason["numbers"].items() if name != "p")
    words = [f"`{reason['code']}`", *([f"`{reason['subject']}`"] if reason["subject"] else [])]
    return " of ".join(words) + (f": {numbers}" if numbers else "")


def outcome(*folders):
    for folder in folders:
        result = read_json(folder, *RESULTS)
        rows = [["**verdict**", f"**{verdict_of(result)}**", message_of(result)]]
        rows += [[aspect, reason["state"].replace("_", " "), reason_text(reason)]
                 for aspect, judged in result["assessment"].items() for reason in judged["reasons"]]
        print_table(["", "", ""], rows)


def verdict(*folders):
    for folder in folders:
        result = read_json(folder, *RESULTS)
        states = "; ".join(f"{aspect}: {judged['state'].replace('_', ' ')}" for aspect, judged in result["assessment"].items())
        print(f"**{verdict_of(result)}**, {message_of(result)} ({states}).")


def estimate(parameter):
    """Value with its unit, interval, and what is to be said of them."""
    (low, high), value = parameter["ci95"], parameter["value"]
    factor, unit = scaled(max(abs(low), abs(high)), parameter["unit"])
    numbers = in_steps_of((high - low) * factor / 4.0, value * factor, low * factor, high * factor)
    grade = parameter["identifiability"].replace("_", " ") + (", at a bound" if parameter["at_bound"] else "")
    return [f"{numbers[0]} {unit}".strip(), f"{numbers[1]} to {numbers[2]}", grade]


def parameters(*folders):
    found = [{(each["key"], each["level"]): each for each in fitted_parameters(folder)} for folder in folders]
    names = [f"`{pathlib.Path(folder).name}`" for folder in folders]
    several = len(folders) > 1
    rows = [[f"`{key}`" + (f", {level}" if level else "")] + ([where] if several else []) + estimate(each)
            for key, level in dict.fromkeys(name for fit in found for name in fit)
            for where, fit in zip(names, found) if (each := fit.get((key, level)))]
    print_table(["parameter"] + (["fit"] if several else []) + ["estimate", "95 % interval", "identifiability"], rows)


if __name__ == "__main__":
    tables = {"scores": scores, "outcome": outcome, "verdict": verdict, "parameters": parameters}
    if len(sys.argv) < 3 or sys.argv[1] not in tables:
        sys.exit(__doc__)
    tables[sys.argv[1]](*sys.argv[2:])

#!/usr/bin/python3
"""Compares the held-out scores of a fit with those of models without physics, on the same records and split.

    bench/held_out.py RESULT_DIR [--taps N]     (a result folder of `rigcal fit`; needs python3-numpy)

Prints rho2 = 1 - var(e) / var(y) for every compared channel of every condition that was not fitted. The models are:

    rigcal     the calibrated model
    null       a + b drive, or only a constant in an open loop
    black box  a finite impulse response of the drive with N taps (default 24) and a constant, for the channel or for its
               rate, whichever fits the fitted conditions better; with a rate, the channel's first value is assumed to be known

The last two are fitted by least squares to the fitted conditions. A channel that a loop controls has a second score, "tracking
error", for the reference minus the channel, because the reference alone predicts the channel almost completely.
"""
import argparse
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
from result_files import print_table, read_json, residuals  # noqa: E402

CHANNELS = {"position_m": "position", "force_n": "force", "load_pressure_pa": "load pressure", "pressure_a_pa": "pressure A",
            "pressure_b_pa": "pressure B", "acceleration_m_per_s2": "acceleration",
            "payload_acceleration_m_per_s2": "payload acceleration"}


def drive_of(table):
    return next(name for name in table if name == "command_v" or "reference_" in name)


def lagged(drive, taps):
    """Returns columns with the drive delayed by 0 to taps - 1 samples. Before the record it is assumed to equal its first sample."""
    padded = np.r_[np.full(taps - 1, drive[0]), drive]
    rows = [padded[taps - 1 - k:len(padded) - k] for k in range(taps)]
    return np.c_[np.array(rows).T, np.ones(len(drive))]


def rho2(measured, simulated, counts):
    counts = counts & np.isfinite(measured)
    return 1.0 - np.var((measured - simulated)[counts]) / np.var(measured[counts])


class Linear:
    """Least-squares fit of a channel, or of its rate, to columns made from the drive."""

    def __init__(self, tables, channel, columns_of, rate):
        self.columns_of, self.rate = columns_of, rate
        design, target = [], []
        for table in tables:
            y = channel(table)
            counts = table["in_window"] > 0.5
            columns = columns_of(table)
            if rate:
                y, columns, counts = np.diff(y), columns[1:], counts[1:]
            design.append(columns[counts])
            target.append(y[counts])
        self.weights = np.linalg.lstsq(np.concatenate(design), np.concatenate(target), rcond=None)[0]
        self.score = np.mean([self.rho2(table, channel) for table in tables])

    def rho2(self, table, channel):
        y = channel(table)
        counts = table["in_window"] > 0.5
        simulated = self.columns_of(table) @ self.weights
        if self.rate:
            first = np.flatnonzero(counts)[0]
            simulated = y[first] + np.cumsum(simulated) - np.cumsum(simulated)[first]
        return rho2(y, simulated, counts)


def channels_of(table):
    """Returns (words, measured, simulated) for each compared channel, and for the tracking error of a controlled channel."""
    drive = drive_of(table)
    found = []
    for name, words in CHANNELS.items():
        if "measured_" + name not in table:
            continue
        measured, simulated = "measured_" + name, "simulated_" + name
        found.append((words, lambda t, n=measured: t[n], lambda t, n=simulated: t[n]))
        key, unit = (name.rsplit("_m_per_s2", 1)[0], "m_per_s2") if name.endswith("_m_per_s2") else name.rsplit("_", 1)
        if drive == (f"reference_{unit}" if key == "position" else f"{key}_reference_{unit}"):
            found.append((f"tracking error of {words}", lambda t, n=measured: t[drive] - t[n],
                          lambda t, n=simulated: t[drive] - t[n]))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path, metavar="RESULT_DIR")
    parser.add_argument("--taps", type=int, default=24)
    options = parser.parse_args()
    conditions = read_json(options.results, "fit.json")["conditions"]
    tables = {c["id"]: residuals(options.results, c["id"]) for c in conditions}
    fitted = [tables[c["id"]] for c in conditions if c["use"] == "fit"]
    drive = drive_of(fitted[0])

    def straight(table):
        ones = np.ones(len(table[drive]))
        return np.c_[ones] if drive == "command_v" else np.c_[table[drive], ones]

    def response(table):
        return lagged(table[drive], options.taps)

    rows = []
    for condition in conditions:
        if condition["use"] != "validate":
            continue
        table = tables[condition["id"]]
        for words, measured, simulated in channels_of(table):
            null = Linear(fitted, measured, straight, False)
            box = max((Linear(fitted, measured, response, rate) for rate in (False, True)), key=lambda each: each.score)
            own = rho2(measured(table), simulated(table), table["in_window"] > 0.5)
            scores = [own, null.rho2(table, measured), box.rho2(table, measured)]
            rows.append([f"`{condition['id']}`", words, *(f"{score:.4f}" for score in scores)])
    print_table(["condition", "channel", "rigcal", "null", "black box"], rows)


if __name__ == "__main__":
    main()

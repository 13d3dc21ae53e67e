#!/usr/bin/python3
"""Compares the held-out scores of a fit with those of models without physics, on the same records and split.

    bench/held_out.py RESULT_DIR... [--taps N] [--below HZ... | --leave-one-out]
                                    (result folders of `rigcal fit` or `rigcal validate`; needs python3-numpy)

Prints rho2 = 1 - var(e) / var(y) for every compared channel of every condition that was not fitted. The models are:

    rigcal     the calibrated model
    null       a + b drive, or only a constant in an open loop
    black box  a finite impulse response of the drive with N taps (default 24) and a constant, for the channel or for its
               rate, whichever fits the fitted conditions better; with a rate, the channel's first value is assumed to be known

The last two are fitted by least squares to the fitted conditions. A channel that a loop controls has a second score, "tracking
error", for the reference minus the channel, because the reference alone predicts the channel almost completely.

--below scores both series after a low-pass filter without phase, for each of the frequencies. The models are those fitted to
the whole band. "fraction" is that of the measured variance which the filter leaves.

--leave-one-out is for campaigns that fit every condition. It predicts each of them without a model of rigcal, whose fit has
seen it, by two that have not:

    copy       the record of the next condition (for the last one, of the condition before), moved to the same command
    black box  as above, fitted to the other conditions
"""
import argparse
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "docs"))
from result_files import print_table, read_json, residuals  # noqa: E402

CHANNELS = {"position_m": "position", "force_n": "force", "load_pressure_pa": "load pressure", "pressure_a_pa": "pressure A",
            "pressure_b_pa": "pressure B", "acceleration_m_per_s2": "acceleration",
            "payload_acceleration_m_per_s2": "payload acceleration", "angle_rad": "angle"}
OPEN_LOOP_DRIVES = ("command_v", "pilot_pressure_pa")
FILTER_ORDER = 4  # Butterworth, applied forwards and backwards: 48 dB per octave


def drive_of(table):
    return next(name for name in table if name in OPEN_LOOP_DRIVES or "reference_" in name)


def lagged(drive, taps):
    """Returns columns with the drive delayed by 0 to taps - 1 samples. Before the record it is assumed to equal its first sample."""
    padded = np.r_[np.full(taps - 1, drive[0]), drive]
    rows = [padded[taps - 1 - k:len(padded) - k] for k in range(taps)]
    return np.c_[np.array(rows).T, np.ones(len(drive))]


def low_passed(values, step_s, below_hz):
    """Returns values, shape (n,), after a Butterworth filter without phase. Beyond its ends the series is mirrored about its
    first and last value, so that the filter starts without a jump. At below_hz half of the amplitude is left."""
    mirrored = np.r_[2.0 * values[0] - values[:0:-1], values, 2.0 * values[-1] - values[-2::-1]]
    frequency_hz = np.fft.rfftfreq(len(mirrored), step_s)
    gain = 1.0 / (1.0 + (frequency_hz / below_hz) ** (2 * FILTER_ORDER))
    return np.fft.irfft(np.fft.rfft(mirrored) * gain, len(mirrored))[len(values) - 1:2 * len(values) - 1]


def counted(table, series, below_hz=None):
    """Returns series, of which the first is the measured one, at the samples that count; with below_hz after the filter."""
    counts = (table["in_window"] > 0.5) & np.isfinite(series[0])
    series = [values[counts] for values in series]
    if below_hz is None:
        return series
    if np.any(np.diff(np.flatnonzero(counts)) != 1):
        sys.exit("--below needs conditions whose samples count without a gap")
    step_s = np.median(np.diff(table["time_s"]))
    return [low_passed(values, step_s, below_hz) for values in series]


def rho2(table, measured, simulated, below_hz=None):
    measured, simulated = counted(table, [measured, simulated], below_hz)
    return 1.0 - np.var(measured - simulated) / np.var(measured)


def fraction_below(table, measured, below_hz):
    """Returns the fraction of the variance that the filter leaves."""
    return np.var(counted(table, [measured], below_hz)[0]) / np.var(counted(table, [measured])[0])


class Linear:
    """Least-squares fit of a channel, or of its rate, to columns made from the drive."""

    def __init__(self, tables, channel, columns_of, rate):
        self.channel, self.columns_of, self.rate = channel, columns_of, rate
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
        self.score = np.mean([rho2(table, channel(table), self.simulated(table)) for table in tables])

    def simulated(self, table):
        simulated = self.columns_of(table) @ self.weights
        if self.rate:
            first = np.flatnonzero(table["in_window"] > 0.5)[0]
            simulated = self.channel(table)[first] + np.cumsum(simulated) - np.cumsum(simulated)[first]
        return simulated


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


def copy_of(source, table, channel):
    """Returns the channel of another condition, moved in time so that both drives begin to change at the same sample. Before
    and after the other record its first and last value continue."""

    def step_at(each):
        change = np.abs(each[drive_of(each)] - each[drive_of(each)][0])
        return np.argmax(change > 0.1 * change.max())  # a tenth is above the noise, and before drives of other size part

    values = channel(source)
    at = np.arange(len(table["time_s"])) + step_at(source) - step_at(table)
    return values[np.clip(at, 0, len(values) - 1)]


def black_box(tables, channel, taps):
    def response(table):
        return lagged(table[drive_of(table)], taps)

    return max((Linear(tables, channel, response, rate) for rate in (False, True)), key=lambda each: each.score)


def null_model(tables, channel):
    def straight(table):
        drive = drive_of(table)
        ones = np.ones(len(table[drive]))
        return np.c_[ones] if drive in OPEN_LOOP_DRIVES else np.c_[table[drive], ones]

    return Linear(tables, channel, straight, False)


def written(score):
    return f"{score:.4f}"


def held_out_rows(tables, uses, options):
    fitted = [tables[name] for name, use in uses.items() if use == "fit"]
    for name, use in uses.items():
        if use != "validate":
            continue
        table = tables[name]
        for words, measured, simulated in channels_of(table):
            models = [simulated(table), null_model(fitted, measured).simulated(table),
                      black_box(fitted, measured, options.taps).simulated(table)]
            for below_hz in options.below or [None]:
                band = [f"{below_hz:g} Hz", written(fraction_below(table, measured(table), below_hz))] if below_hz else []
                scores = [rho2(table, measured(table), each, below_hz) for each in models]
                yield [f"`{name}`", words, *band, *map(written, scores)]


def left_out_rows(tables, uses, options):
    fitted = [name for name, use in uses.items() if use == "fit"]
    for k, name in enumerate(fitted):
        table = tables[name]
        others = [tables[each] for each in fitted if each != name]
        neighbour = tables[fitted[k + 1] if k + 1 < len(fitted) else fitted[k - 1]]
        copies, boxes = [], []
        for _, measured, _ in channels_of(table):
            copies.append(rho2(table, measured(table), copy_of(neighbour, table, measured)))
            box = black_box(others, measured, options.taps)
            boxes.append(rho2(table, measured(table), box.simulated(table)))
        yield [f"`{name}`", *map(written, copies + boxes)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path, nargs="+", metavar="RESULT_DIR")
    parser.add_argument("--taps", type=int, default=24)
    modes = parser.add_mutually_exclusive_group()
    modes.add_argument("--below", type=float, nargs="+", metavar="HZ", default=[])
    modes.add_argument("--leave-one-out", action="store_true")
    options = parser.parse_args()
    rows = []
    for folder in options.results:
        uses = {each["id"]: each["use"] for each in read_json(folder, "fit.json", "validation.json")["conditions"]}
        tables = {name: residuals(folder, name) for name in uses}
        rows += (left_out_rows if options.leave_one_out else held_out_rows)(tables, uses, options)
    if options.leave_one_out:
        channels = [words for words, _, _ in channels_of(next(iter(tables.values())))]
        header = ["condition", *(f"{model}: {words}" for model in ("copy", "black box") for words in channels)]
    else:
        header = ["condition", "channel", *(["below", "fraction"] if options.below else []), "rigcal", "null", "black box"]
    print_table(header, rows)


if __name__ == "__main__":
    main()

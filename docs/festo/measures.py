#!/usr/bin/python3
"""Speeds, ringing and leakage of the Festo records, measured and simulated.

    docs/festo/measures.py RESULT_DIR DATA_DIR [RECORD...]     (needs python3-numpy; RESULT_DIR from `rigcal fit`)

Of the single repeats in DATA_DIR, the first peak and the ring of p_A. RECORD: steps_2V and the like; all three, if
none is named.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import print_table, residuals  # noqa: E402

RECORDS = ("steps_1V", "steps_2V", "steps_4V")
HEADER = ["record", "", "out mm/s", "back mm/s", "first peak of p_A bar", "ring of p_A Hz", "p_A at closed valve bar/s"]
FORMATS = (".1f", ".1f", ".2f", ".1f", ".1f")


def speed(t, x, begin, end):
    """Slope between 60 and 160 mm of the first passage [mm/s]."""
    inside = (t >= begin) & (t < end) & (x > 0.06) & (x < 0.16)
    return 1e3 * np.polyfit(t[inside], x[inside], 1)[0]


def ring(t, p, begin):
    """First peak of a pressure after a step [bar], and frequency of what follows it [Hz]: from the first peak to
    the second, each the highest within 8 ms, likewise the valley between them, so that no drift is taken for one.
    The top of a peak is that of the parabola through its three samples: one of 1 ms would be 3 % of the period."""
    w = (t >= begin) & (t < begin + 0.3)
    t, p = t[w], 1e-5 * p[w]
    smooth = np.convolve(p, np.ones(3) / 3, "same")
    k = int(np.argmax(smooth[5:80])) + 5

    def next_extremum(y, first):
        return next(i for i in range(first + 5, len(y) - 8) if y[i] == y[i - 8:i + 9].max())

    def top(i):
        before, at, after = smooth[i - 1:i + 2]
        bend = before - 2.0 * at + after
        return t[i] + 0.5 * (before - after) / bend * (t[i + 1] - t[i]) if bend < 0.0 else t[i]

    second = next_extremum(smooth, next_extremum(-smooth, k))
    return smooth[k], 1.0 / (top(second) - top(k))


def steps(r):
    """Voltage of a record, and when it is stepped out, ended and stepped back [s]."""
    t = r["time_s"]
    u = r["drive_v"] if "drive_v" in r else r["command_v"]
    volts = round(u.max())  # another voltage's file may stand under this name
    first = np.flatnonzero(u > 0.9 * volts)
    second = np.flatnonzero(u < -0.9 * volts)
    return volts, t[first[0]], t[first[-1]], t[second[0]]


def rings_of_repeats(path, begin):
    """First peaks [bar] and frequencies [Hz] of the single repeats, whose noise asks for a mean over 5 ms."""
    names = open(path).readline().strip().split(",")
    table = np.genfromtxt(path, delimiter=",", skip_header=1)
    repeats = [i for i, name in enumerate(names) if name.startswith("pA_bar_")]
    rings = [ring(table[:, 0], 1e5 * np.convolve(table[:, i], np.ones(5) / 5, "same"), begin) for i in repeats]
    return np.array(rings).T


def measures(r, kind):
    """Speeds out and back, first peak, ring, rate at closed valve: in the units of HEADER."""
    t, x, p = r["time_s"], r[f"{kind}_position_m"], r[f"{kind}_pressure_a_pa"]
    _, out, stop, back = steps(r)
    closed = (t > stop + 0.01) & (t < back - 0.002)
    peak, hertz = ring(t, p, out)
    return np.array([speed(t, x, out, stop), speed(t, x, back, t[-1]), peak, hertz,
                     1e-5 * np.polyfit(t[closed], p[closed], 1)[0]])


def rows_of_record(folder, data, name):
    r = residuals(folder, name)
    volts, out, _, _ = steps(r)
    measured, simulated = measures(r, "measured"), measures(r, "simulated")
    peaks, rings = rings_of_repeats(f"{data}/{name}_1kHz.csv", out)
    for kind, values in (("measured", measured), ("simulated", simulated)):
        yield [f"{volts} V", kind, *(f"{value:{digits}}" for value, digits in zip(values, FORMATS))]
    yield [f"{volts} V", "simulated to measured", *(f"{100 * ratio - 100:+.1f} %" for ratio in simulated / measured)]
    yield [f"{volts} V", "single repeats", "", "", f"{peaks.min():.2f} to {peaks.max():.2f}",
           f"{rings.min():.1f} to {rings.max():.1f}, median {np.median(rings):.1f}", ""]
    yield [f"{volts} V", "simulated to median", "", "", f"{100 * simulated[2] / np.median(peaks) - 100:+.1f} %",
           f"{100 * simulated[3] / np.median(rings) - 100:+.1f} %", ""]


def main(folder, data, *names):
    print_table(HEADER, (row for name in names or RECORDS for row in rows_of_record(folder, data, name)))


if __name__ == "__main__":
    main(*sys.argv[1:])

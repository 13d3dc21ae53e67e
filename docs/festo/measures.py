#!/usr/bin/env python3
"""Speeds, ringing and leakage of the Festo records, measured and simulated.

    docs/festo/measures.py RESULT_DIR [DATA_DIR]     (needs python3-numpy; RESULT_DIR from `rigcal fit`;
                                                      with DATA_DIR the ring of every repeat too)
"""
import sys

import numpy as np


def residuals(path):
    lines = [line for line in open(path) if not line.startswith("#")]
    names = lines[0].strip().split(",")
    table = np.genfromtxt(lines[1:], delimiter=",")
    return {name: table[:, i] for i, name in enumerate(names)}


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


def taken_up(t, x, p, back, end):
    """What chamber A takes up per pressure [m3/Pa] on its way down, around 33 and 16 bar, the piston at rest:
    flow of the orifice that the steady way back gauges, over the rate of the pressure."""
    area_m2, tank_pa = 2.011e-4, 1.15e5
    steady = (t >= back) & (t < end) & (x > 0.06) & (x < 0.16)
    gauge = area_m2 * abs(np.polyfit(t[steady], x[steady], 1)[0]) / np.sqrt(p[steady].mean() - tank_pa)
    result = []
    first = np.searchsorted(t, back)
    for high, low in ((36e5, 30e5), (17.5e5, 14.5e5)):
        begin, stop = (first + int(np.argmax(p[first:] < level)) for level in (high, low))
        crossed = [t[i - 1] + (p[i - 1] - level) / (p[i - 1] - p[i]) * (t[i] - t[i - 1])
                   for i, level in ((begin, high), (stop, low))]
        rate = (high - low) / (crossed[1] - crossed[0])
        result.append(gauge * np.sqrt(0.5 * (high + low) - tank_pa) / rate)
    return result


def main(folder, data=None):
    for name in ("steps_1V", "steps_2V", "steps_4V"):
        r = residuals(f"{folder}/residuals/{name}.csv")
        t = r["time_s"]
        volts, out, stop, back = steps(r)
        closed = (t > stop + 0.01) & (t < back - 0.002)
        for kind in ("measured", "simulated"):
            x, a = r[f"{kind}_position_m"], r[f"{kind}_pressure_a_pa"]
            peak, hertz = ring(t, a, out)
            fall = 1e-5 * np.polyfit(t[closed], a[closed], 1)[0]
            print(f"{volts} V {kind:9}: out {speed(t, x, out, stop):6.1f}, back {speed(t, x, back, t[-1]):6.1f} mm/s; "
                  f"p_A first peak {peak:5.2f} bar, ring {hertz:4.1f} Hz; p_A at closed valve {fall:6.1f} bar/s")
            if kind == "measured":
                high, low = taken_up(t, x, a, back, t[-1])
                print(f"{volts} V measured : chamber A takes up {1e13 * high:.2f}e-13 m3/Pa near 33 bar, "
                      f"{1e13 * low:.2f}e-13 near 16 bar")
        if data:
            peaks, hertz = rings_of_repeats(f"{data}/{name}_1kHz.csv", out)
            print(f"{volts} V repeats  : p_A first peak {peaks.min():.2f} to {peaks.max():.2f} bar, ring "
                  f"{hertz.min():.1f} to {hertz.max():.1f} Hz, median {np.median(hertz):.1f} Hz")


if __name__ == "__main__":
    main(*sys.argv[1:])

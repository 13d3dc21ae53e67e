#!/usr/bin/python3
"""What chamber A of the Festo cylinder takes up per pressure while the piston stands, from the records alone.

    docs/festo/hoses.py RESULT_DIR     (needs python3-numpy; RESULT_DIR from `rigcal fit`)
"""
import sys

import numpy as np

from measures import RECORDS, print_table, residuals, steps


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


def main(folder):
    rows = []
    for name in RECORDS:
        r = residuals(folder, name)
        volts, _, _, back = steps(r)
        t = r["time_s"]
        taken = taken_up(t, r["measured_position_m"], r["measured_pressure_a_pa"], back, t[-1])
        rows.append([f"{volts} V", *(f"{1e13 * each:.2f}" for each in taken), f"{taken[0] / taken[1]:.2f}"])
    print_table(["record", "near 33 bar, 1e-13 m³/Pa", "near 16 bar, 1e-13 m³/Pa", "ratio"], rows)


if __name__ == "__main__":
    main(*sys.argv[1:])

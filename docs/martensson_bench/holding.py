#!/usr/bin/python3
"""What the staircase of Martensson's bench tells without a model.

    holding.py DIR

DIR holds the records of martensson_hydraulic_bench. Prints the controller, the command at which the
piston holds its load on every stair, and the speed by command. Needs numpy.
"""
import pathlib
import sys

import numpy as np


def main():
    file = pathlib.Path(sys.argv[1]) / "hanging_load_with_cross_port_orifice.csv"
    t, r, y, u = np.loadtxt(file, delimiter=",", skiprows=1).T

    terms = np.column_stack([r - y, np.ones_like(r)])
    (gain, offset), *_ = np.linalg.lstsq(terms, u, rcond=None)
    left = np.std(u - terms @ (gain, offset))
    print(f"controller: u = {gain:.4f} (r - y) {offset:+.4f} V, rms {1e3 * left:.0f} mV")

    print("holding: last second of each stair of 4 s or more, y - r and u in V")
    edges = np.concatenate([[0], np.nonzero(np.diff(r))[0] + 1, [len(t)]])
    held = {"up": [], "down": []}
    before = r[0]
    for first, end in zip(edges[:-1], edges[1:]):
        if end - first < 200:
            continue
        step, before = r[first] - before, r[first]
        if abs(step) < 0.5:
            continue
        rest = slice(end - 50, end)
        sense = "up" if step > 0 else "down"
        if abs(y[end - 1] - y[end - 100]) > 0.02:
            continue
        held[sense].append(u[rest].mean())
        print(f"  {t[first]:6.1f} s {sense:4s} r {r[first]:5.2f}: {np.mean(y[rest] - r[rest]):+.3f} "
              f"{u[rest].mean():+.3f}")
    for sense, values in held.items():
        print(f"  after a step {sense}: u from {min(values):+.3f} to {max(values):+.3f} V")

    print("speed by command, V/s of y (means over half a second):")
    window = np.ones(25) / 25
    speed = np.convolve(np.gradient(y, t), window, "same")
    command = np.convolve(u, window, "same")
    for middle in (-1.4, -1.0, -0.8, -0.6, -0.4, -0.2, 0.2, 0.4, 0.6, 0.8, 1.0):
        part = np.abs(command - middle) < 0.05
        print(f"  {middle:+.1f} V: {speed[part].mean():+.3f} ({part.sum()} samples)")


main()

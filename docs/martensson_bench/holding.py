#!/usr/bin/python3
"""What the staircase of Martensson's bench tells without a model.

    docs/martensson_bench/holding.py DATA_DIR     (needs python3-numpy)

Prints the controller, the command at which the piston holds its load on the stairs, and the speed by command.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import print_table  # noqa: E402

COMMANDS_V = (-1.4, -1.0, -0.8, -0.6, -0.4, -0.2, 0.2, 0.4, 0.6, 0.8, 1.0)


def held_on_stairs(t, r, y, u):
    """By the sense of the step: y - r and u [V], means of the last second of each stair of 4 s or more that has come to
    rest."""
    edges = np.concatenate([[0], np.nonzero(np.diff(r))[0] + 1, [len(t)]])
    held = {"up": [], "down": []}
    before = r[0]
    for first, end in zip(edges[:-1], edges[1:]):
        if end - first < 200:
            continue
        step, before = r[first] - before, r[first]
        if abs(step) < 0.5 or abs(y[end - 1] - y[end - 100]) > 0.02:
            continue
        last = slice(end - 50, end)
        held["up" if step > 0 else "down"].append((np.mean(y[last] - r[last]), u[last].mean()))
    return {sense: np.array(values).T for sense, values in held.items()}


def main(data):
    file = pathlib.Path(data) / "hanging_load_with_cross_port_orifice.csv"
    t, r, y, u = np.loadtxt(file, delimiter=",", skiprows=1).T

    terms = np.column_stack([r - y, np.ones_like(r)])
    found = np.linalg.lstsq(terms, u, rcond=None)[0]
    left = np.std(u - terms @ found)
    print(f"Controller: u = {found[0]:.4f} (r - y) {found[1]:+.4f} V, rms {1e3 * left:.0f} mV.\n")

    print_table(["step", "stairs", "y - r, V", "u at rest, V"],
                [[sense, f"{errors.size}", f"{errors.min():+.3f} to {errors.max():+.3f}",
                  f"{commands.min():+.3f} to {commands.max():+.3f}"]
                 for sense, (errors, commands) in held_on_stairs(t, r, y, u).items()])
    print()
    window = np.ones(25) / 25
    speed = np.convolve(np.gradient(y, t), window, "same")
    command = np.convolve(u, window, "same")
    parts = [np.abs(command - middle) < 0.05 for middle in COMMANDS_V]
    print_table(["command, V (means over half a second)", *(f"{middle:+.1f}" for middle in COMMANDS_V)],
                [["speed of y, V/s", *(f"{speed[part].mean():+.3f}" for part in parts)],
                 ["samples", *(f"{part.sum()}" for part in parts)]])


if __name__ == "__main__":
    main(*sys.argv[1:])

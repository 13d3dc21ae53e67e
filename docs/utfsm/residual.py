#!/usr/bin/python3
"""What is left of the UTFSM records after the fit.

    docs/utfsm/residual.py bands DATA_DIR RESULT_DIR    residual by frequency, in % of the variance of x
    docs/utfsm/residual.py rest DATA_DIR                what the channels show before anything moves
    docs/utfsm/residual.py force DATA_DIR               law of the damper between position and force

(needs python3-numpy; RESULT_DIR from `rigcal fit`)
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import print_table, residuals  # noqa: E402

BANDS_HZ = {"< 1 Hz": (0, 1), "1 to 5": (1, 5), "5 to 20": (5, 20), "20 to 50": (20, 50), "> 50 Hz": (50, np.inf)}
AT_REST_S = {"chirp_0A": 6.0, "sweep_15Hz_0A": 1.5}
RATE_HZ = 1000.0


def record(data, name):
    """Time [s], command and position [mm], force [N]."""
    return np.loadtxt(f"{data}/{name}_1kHz.csv", delimiter=",", skiprows=1).T


def band_shares(residual, variance):
    """Of each band, in % of a variance."""
    power = np.abs(np.fft.rfft(residual - residual.mean())) ** 2 * 2 / len(residual) ** 2
    frequency = np.fft.rfftfreq(len(residual), 1 / RATE_HZ)
    return [100 * power[(frequency >= low) & (frequency < high)].sum() / variance for low, high in BANDS_HZ.values()]


def bands(data, results):
    rows = []
    for name in AT_REST_S:
        x = record(data, name)[2]
        residual = 1e3 * residuals(results, name)["residual_position_m"]
        shares = band_shares(residual, x.var()) + [100 * residual.var() / x.var()]
        rows.append([f"`{name}`", *(f"{share:.3f}" for share in shares)])
    print_table(["residual in % of var(x), by band", *BANDS_HZ, "all"], rows)


def rest(data):
    rows = []
    for name, rest_s in AT_REST_S.items():
        t, command, x, force = record(data, name)
        still = t < rest_s
        c, p, f = (channel[still] - channel[still].mean() for channel in (command, x, force))
        both = np.column_stack([c, f])
        left = p - both @ np.linalg.lstsq(both, p, rcond=None)[0]
        correlations = [np.corrcoef(a, b)[0, 1] for a, b in ((c, p), (f, p), (c, f))]
        rows.append([f"`{name}`", f"first {rest_s} s", f"{100 * p.var() / x.var():.4f} %",
                     *(f"{each:.3f}" for each in correlations), f"{100 * (1 - left.var() / p.var()):.0f} %"])
    print_table(["record", "at rest", "var of x, of the whole record's", "correlation command, x", "force, x",
                 "command, force", "of x explained by command and force"], rows)


def force(data):
    """Least squares of force = mean + c v + F sign(v) + k x, with the sign as a steep tanh."""
    rows = []
    for name in AT_REST_S:
        _, _, x, measured = record(data, name)
        v = np.gradient(np.convolve(x, np.ones(15) / 15, "same"), 1 / RATE_HZ)
        terms = np.column_stack([np.ones(len(x)), v, np.tanh(v / 3), x])
        found = np.linalg.lstsq(terms, measured, rcond=None)[0]
        rows.append([f"`{name}`", *(f"{value:.{digits}f}" for value, digits in zip(found, (0, 2, 0, 1)))])
    print_table(["record", "constant N", "times speed N s/mm", "friction N", "times position N/mm"], rows)


if __name__ == "__main__":
    tables = {"bands": bands, "rest": rest, "force": force}
    if len(sys.argv) < 3 or sys.argv[1] not in tables:
        sys.exit(__doc__)
    tables[sys.argv[1]](*sys.argv[2:])

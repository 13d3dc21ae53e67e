#!/usr/bin/env python3
"""What is left of the UTFSM records after the fit: bands, interference, harmonics.

    docs/utfsm/residual.py DATA_DIR RESULT_DIR     (needs python3-numpy; RESULT_DIR from `rigcal fit`)
"""
import sys

import numpy as np

BANDS = [(0, 1), (1, 5), (5, 20), (20, 50), (50, 501)]
RECORDS = [("chirp_0A", "chirp_0A_1kHz.csv", 6.0), ("sweep_15Hz_0A", "sweep_15Hz_0A_1kHz.csv", 1.5)]


def band_shares(residual, variance, rate_hz=1000.0):
    power = np.abs(np.fft.rfft(residual - residual.mean())) ** 2 * 2 / len(residual) ** 2
    frequency = np.fft.rfftfreq(len(residual), 1 / rate_hz)
    return [100 * power[(frequency >= a) & (frequency < b)].sum() / variance for a, b in BANDS]


def correlation(a, b):
    return np.corrcoef(a, b)[0, 1]


def main(data_dir, result_dir):
    for name, file, rest_s in RECORDS:
        t, command, x, force = np.loadtxt(f"{data_dir}/{file}", delimiter=",", skiprows=1).T
        residual = 1e3 * np.loadtxt(f"{result_dir}/residuals/{name}.csv", delimiter=",", skiprows=1)[:, 3]
        shares = band_shares(residual, x.var())
        print(f"{name}: residual in % of var(x), by band in Hz")
        for (a, b), share in zip(BANDS, shares):
            print(f"  {a:>3} .. {b if b < 500 else 500:<3}  {share:.4f}")
        print(f"  all         {100 * residual.var() / x.var():.4f}")
        rest = t < rest_s
        noise = [v[rest] - v[rest].mean() for v in (command, x, force)]
        print(f"  at rest (first {rest_s} s): var {x[rest].var():.2e} mm2 = {100 * x[rest].var() / x.var():.4f} % of var(x)")
        print(f"  at rest, correlation: command-x {correlation(noise[0], noise[1]):.3f}, "
              f"force-x {correlation(noise[2], noise[1]):.3f}, command-force {correlation(noise[0], noise[2]):.3f}")
        both = np.c_[noise[0], noise[2]]
        fitted = both @ np.linalg.lstsq(both, noise[1], rcond=None)[0]
        print(f"  at rest, explained by command and force together: {100 * (1 - (noise[1] - fitted).var() / noise[1].var()):.1f} %")
        velocity = np.gradient(np.convolve(x, np.ones(15) / 15, "same"), 1e-3)
        regressors = np.c_[np.ones(len(x)), velocity, np.tanh(velocity / 3), x]
        found = np.linalg.lstsq(regressors, force, rcond=None)[0]
        print(f"  force ~ {found[0]:.0f} N + {found[1]:.2f} N s/mm v + {found[2]:.0f} N sign(v) + {found[3]:.1f} N/mm x")
        print(f"  mean of x less command: {(x - command).mean():.4f} mm")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])

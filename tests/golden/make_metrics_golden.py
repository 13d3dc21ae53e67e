#!/usr/bin/env python3
"""Writes metrics.txt next to this file: signals and their metrics, computed in exact rational arithmetic.

Every double is a fraction, so sums, variances and quotients are exact. Only square roots are rounded, to
80 digits. Run this again after changing a case:  python3 make_metrics_golden.py
"""

import decimal
import fractions
import math
import pathlib
import random

decimal.getcontext().prec = 80
decimal.getcontext().Emax = decimal.MAX_EMAX
decimal.getcontext().Emin = decimal.MIN_EMIN


def mean(values):
    return sum(values, fractions.Fraction(0)) / len(values)


def covariance(a, b):
    mean_a, mean_b = mean(a), mean(b)
    return mean([(x - mean_a) * (z - mean_b) for x, z in zip(a, b)])


def decimal_of(fraction):
    return decimal.Decimal(fraction.numerator) / decimal.Decimal(fraction.denominator)


def metrics(measured, simulated):
    y = [fractions.Fraction(v) for v in measured]
    s = [fractions.Fraction(v) for v in simulated]
    e = [a - b for a, b in zip(y, s)]
    var_y, var_s, var_e = covariance(y, y), covariance(s, s), covariance(e, e)
    square_e = mean([v * v for v in e])
    absolute_e = [abs(v) for v in e]
    return {
        "rho2": decimal_of(1 - var_e / var_y),
        "unexplained_variance": decimal_of(var_e / var_y),
        "r": decimal_of(covariance(y, s)) / decimal_of(var_y * var_s).sqrt(),
        # Eq. 17 as printed
        "ccc": decimal_of((var_s + var_y - var_e) / (var_s + var_y + mean(e) ** 2)),
        "absolute_error_percent": decimal_of(100 * mean(absolute_e) / (max(y) - min(y))),
        "rmse": decimal_of(square_e).sqrt(),
        "nrmse_fit_percent": 100 * (1 - decimal_of(square_e / var_y).sqrt()),
        "maximum_error": decimal_of(max(absolute_e)),
    }


def wave(n, noise, generator):
    return [math.sin(0.37 * i) + noise * generator.gauss(0.0, 1.0) for i in range(n)]


def cases():
    generator = random.Random(20260301)
    yield "five_samples", [1.0, 2.0, 3.0, 4.0, 5.0], [1.1, 1.9, 3.3, 4.2, 4.4]
    yield "length_two", [1.0, 2.0], [1.5, 1.25]
    yield "length_two_offset_1e9", [1e9, 1e9 + 0.25], [1e9 + 0.125, 1e9 + 0.5]
    yield "random", wave(24, 1.0, generator), wave(24, 1.0, generator)
    base = wave(24, 0.1, generator)
    other = [v + 0.01 * generator.gauss(0.0, 1.0) for v in base]
    yield "offset_1e9", [1e9 + v for v in base], [1e9 + v for v in other]
    yield "offset_1e9_simulated_only", base, [1e9 + v for v in other]
    last_bit = 2.0**-23
    yield (
        "offset_1e9_last_bit",
        [1e9 + last_bit * (i % 3) for i in range(10)],
        [1e9 + last_bit * (i % 4) for i in range(10)],
    )
    yield "near_perfect", base, [v + 1e-6 * generator.gauss(0.0, 0.7) for v in base]
    yield "near_perfect_offset_1e9", [1e9 + v for v in base], [1e9 + v * (1 + 1e-6) for v in base]
    yield "scale_1e-150", [1e-150 * v for v in base], [1e-150 * v for v in other]
    yield "scale_1e150", [1e150 * v for v in base], [1e150 * v for v in other]
    larger = [1e-140 * v for v in other[8:16]]
    yield "scale_1e-150_and_1e-140", [1e-150 * v for v in base[:8]], larger
    yield "scale_1e300", [1e300 * v for v in base[:8]], [1e300 * v for v in base[8:16]]
    yield "outlier", [1.0, 1.5, 1e12, 0.5, 0.75], [1.25, 1.0, 1e12 + 4.0, 0.5, 0.25]
    yield "wrong_sign", base[:8], [-v for v in base[:8]]


def main():
    path = pathlib.Path(__file__).with_name("metrics.txt")
    with path.open("w", encoding="ascii") as out:
        out.write("# made by make_metrics_golden.py in exact arithmetic\n")
        for name, measured, simulated in cases():
            out.write(f"case {name} {len(measured)}\n")
            for label, values in (("measured", measured), ("simulated", simulated)):
                out.write(" ".join([label] + [repr(float(v)) for v in values]) + "\n")
            for label, value in metrics(measured, simulated).items():
                out.write(f"{label} {value:.20e}\n")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Prints the comparison with what one would use instead, from the tables that scripts/performance and scripts/coverage-study
have printed into docs/quality.md and docs/uncertainty.md. usage: comparison.py"""
import pathlib
import re
import sys

DOCS = pathlib.Path(__file__).resolve().parent
PARAMETERS = "`mass`, `damping`, `bulk_modulus`, `valve_gain`, `leakage_coefficient`"
NOISES = {
    "white noise of 0.05 mm": "white noise of 0.05 mm",
    "AR(1) noise of 0.02 mm": "autocorrelated noise of 0.02 mm",
    "trigger jitter of 0.1 ms": "triggers that jitter by 0.1 ms",
    "supply pressure differs by 1 %": "supply pressure that differs by 1 % between repeats",
}


def row(document, name):
    """Cells of the row of a table that begins with `name`."""
    for line in (DOCS / document).read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and cells[0] == name:
            return cells[1:]
    sys.exit(f"docs/{document} has no row {name}")


def main():
    quality = (DOCS / "quality.md").read_text(encoding="utf-8")
    uncertainty = (DOCS / "uncertainty.md").read_text(encoding="utf-8")
    if f"includes the truth, % ({PARAMETERS}) | warned, %" not in uncertainty:
        sys.exit("docs/uncertainty.md: the columns of the coverage study are others")
    distance = re.search(r"^Distance from the optimum .*: baseline ([\d.]+), rigcal ([\d.]+);", quality, re.M)
    baseline, rigcal, *_ = row("quality.md", "fit")
    print("| | rigcal | instead | printed by |")
    print("| --- | ---: | ---: | --- |")
    print(f"| fit of six signals, 86 006 samples: CPU time | {rigcal} ms | {baseline} ms | `scripts/performance` |")
    print(f"| its distance from the optimum, in standard errors | {distance[2]} | {distance[1]} | `scripts/performance` |")
    for name, words in NOISES.items():
        cells = row("uncertainty.md", name)
        held, plain = (sorted(map(float, cell.split())) for cell in (cells[0], cells[3]))
        print(f"| 95 % intervals that cover the truth: {words} | {held[0]:.0f} to {held[-1]:.0f} % | {plain[0]:.0f} to {plain[-1]:.0f} % "
              "| `scripts/coverage-study` |")


if __name__ == "__main__":
    main()

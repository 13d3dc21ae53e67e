#!/usr/bin/python3
"""What the figures of `scripts/paper-figures` show, in numbers.

    docs/paper/figures.py OUT_DIR     (writes the figures' CSV files there)
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import print_table, rows_of  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def columns(folder, figure):
    rows = rows_of(f"{folder}/figure{figure}.csv")
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def peak(values):
    return max(abs(value) for value in values)


def mean(values):
    return sum(abs(value) for value in values) / len(values)


def flows(figure, servo, leakage, work):
    return [figure, f"peaks: servo {peak(servo):.2f}, leakage {peak(leakage):.2f}, work {peak(work):.2f} L/min; "
                    f"leakage {100 * mean(leakage) / mean(servo):.1f} % of the servo flow, "
                    f"{100 * mean(leakage) / mean(work):.1f} % of the work flow"]


def main(folder):
    subprocess.run([ROOT / "scripts" / "paper-figures", "--csv", folder], check=True, stdout=subprocess.DEVNULL)
    five, eight, nine, ten, eleven = (columns(folder, figure) for figure in (5, 8, 9, 10, 11))
    rows = [["5", f"peaks: reference {peak(five['reference_mm']):.1f}, healthy {peak(five['healthy_mm']):.1f}, leaking "
                  f"{peak(five['leaking_mm']):.1f}, residual {peak(five['residual_mm']):.1f} mm"],
            ["8", "peaks: " + ", ".join(f"{level} {peak(eight[level + '_mm']):.1f}"
                                        for level in ("none", "slight", "medium", "critical")) + " mm"],
            flows("9", *(nine[f"{flow}_l_per_min"] for flow in ("servo", "leakage", "work"))),
            ["10", "peaks: " + ", ".join(f"{level} {peak(ten[level + '_percent']):.1f}"
                                         for level in ("normal", "slight", "medium", "critical", "super")) + " %"]]
    rows += [flows(f"11, {share} %", *(eleven[f"{flow}_{share}"] for flow in ("servo", "leakage", "work")))
             for share in (10, 20, 30)]
    print_table(["figure", "what it shows"], rows)


if __name__ == "__main__":
    main(*sys.argv[1:])

#!/usr/bin/python3
"""The mass that the ring of p_A asks for, by the two records that are fitted alone.

    docs/festo/mass.py RIGCAL DATA_DIR OUT_DIR     (run at the project's root; needs python3-numpy; two fits)

The rule: the mass with which the fitted model rings at both voltages as the repeats do, in the geometric mean of
both; of the repeats, the median. The record that is predicted is not looked at.
"""
import sys

import numpy as np

from measures import print_table, residuals, ring, rings_of_repeats, steps
from result_files import fit

CAMPAIGN = "datasets/rigs/festo_tp511/campaign.toml"
MASSES_KG = (7.5, 8.5)
FITTED = ("steps_1V", "steps_4V")


def main(rigcal, data, out):
    simulated = []
    for mass_kg in MASSES_KG:
        folder = f"{out}/{mass_kg}"
        fit(rigcal, CAMPAIGN, data, folder, "--set", f"mass={mass_kg} kg")
        records = [residuals(folder, name) for name in FITTED]
        starts = [steps(r)[1] for r in records]
        simulated.append([ring(r["time_s"], r["simulated_pressure_a_pa"], start)[1] for r, start in zip(records, starts)])
    measured = [np.median(rings_of_repeats(f"{data}/{name}_1kHz.csv", start)[1]) for name, start in zip(FITTED, starts)]
    # The ring slows down as the mass grows: np.interp() wants it the other way round.
    means = np.sqrt(np.prod(simulated, axis=1))
    asked_kg = np.interp(-np.sqrt(np.prod(measured)), -means, MASSES_KG, left=np.nan, right=np.nan)  # nan: beyond these
    rows = [(f"simulated, {mass_kg} kg", hertz) for mass_kg, hertz in zip(MASSES_KG, simulated)]
    print_table(["", *(f"{name} Hz" for name in FITTED), "mean Hz"],
                [[label, *(f"{f:.1f}" for f in hertz), f"{np.sqrt(np.prod(hertz)):.1f}"]
                 for label, hertz in (("median of the repeats", measured), *rows)])
    print(f"\nThe mass asked for, linearly between: **{asked_kg:.1f} kg**.")


if __name__ == "__main__":
    main(*sys.argv[1:])

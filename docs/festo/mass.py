#!/usr/bin/env python3
"""The mass that the ring of p_A asks for, by the two records that are fitted alone.

    docs/festo/mass.py RIGCAL DATA_DIR OUT_DIR     (run at the project's root; needs python3-numpy; two fits)

The rule: the mass with which the fitted model rings at both voltages as the repeats do, in the geometric mean of
both; of the repeats, the median. The record that is predicted is not looked at.
"""
import subprocess
import sys

import numpy as np

from measures import residuals, ring, rings_of_repeats, steps

CAMPAIGN = "datasets/festo_tp511/campaign.toml"
MASSES_KG = (7.5, 8.5)
FITTED = ("steps_1V", "steps_4V")


def main(rigcal, data, out):
    simulated = []
    for mass_kg in MASSES_KG:
        folder = f"{out}/{mass_kg}"
        subprocess.run([rigcal, "fit", CAMPAIGN, "--data", data, "--out", folder, "--quiet", "--set", f"mass={mass_kg} kg"],
                       stdout=subprocess.DEVNULL, check=False)  # a failed prediction is none of a failed fit
        records = [residuals(f"{folder}/residuals/{name}.csv") for name in FITTED]
        starts = [steps(r)[1] for r in records]
        simulated.append([ring(r["time_s"], r["simulated_pressure_a_pa"], start)[1] for r, start in zip(records, starts)])
    measured = [np.median(rings_of_repeats(f"{data}/{name}_1kHz.csv", start)[1]) for name, start in zip(FITTED, starts)]
    print("| mass kg | " + " | ".join(f"{name} Hz" for name in FITTED) + " | mean Hz |\n" + "| --- " * 4 + "|")
    for label, hertz in zip(("measured", *MASSES_KG), (measured, *simulated)):
        print(f"| {label} | " + " | ".join(f"{f:.1f}" for f in hertz) + f" | {np.sqrt(np.prod(hertz)):.1f} |")
    # The ring slows down as the mass grows: np.interp() wants it the other way round.
    means = np.sqrt(np.prod(simulated, axis=1))
    asked_kg = np.interp(-np.sqrt(np.prod(measured)), -means, MASSES_KG, left=np.nan, right=np.nan)  # nan: beyond these
    print(f"mass: {asked_kg:.1f} kg")


if __name__ == "__main__":
    main(*sys.argv[1:])

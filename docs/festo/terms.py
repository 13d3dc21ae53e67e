#!/usr/bin/env python3
"""What each term of the Festo campaign is worth: fits without one at a time.

    docs/festo/terms.py RIGCAL DATA_DIR OUT_DIR [TERM...]     (run at the project's root)
"""
import csv
import json
import subprocess
import sys

CAMPAIGN = "datasets/festo_tp511/campaign.toml"
# term: values that leave it out
TERMS = {
    "none": [],
    "lines": ["valve_line_opening=10000 V"],
    "hose_a": ["hose_capacity_a=0 m3/Pa"],
    "hose_b": ["hose_capacity_b=0 m3/Pa"],
    "edges": ["gain_supply_to_b=1", "gain_a_to_tank=1", "gain_b_to_tank=1"],
    "leaks": ["valve_null_leakage=0 m3/(s Pa)", "external_leakage_a=0 m3/(s Pa)", "external_leakage_b=0 m3/(s Pa)"],
    "dead_band": ["valve_dead_band=0 V"],
    "offset_force": ["external_force=0 N"],
}
FREE = ("coulomb_friction external_force stroke hose_capacity_a hose_capacity_b supply_pressure tank_pressure valve_gain "
        "valve_dead_band gain_supply_to_b gain_a_to_tank gain_b_to_tank").split()


def fit(rigcal, data, out, term):
    fixed = [setting.split("=")[0] for setting in TERMS[term]]
    command = [rigcal, "fit", CAMPAIGN, "--data", data, "--out", f"{out}/{term}", "--quiet",
               "--free", ",".join(name for name in FREE if name not in fixed)]
    for setting in TERMS[term]:
        command += ["--set", setting]
    subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
    cost = json.load(open(f"{out}/{term}/fit.json"))["cost"]
    score = {}
    for row in csv.DictReader(line for line in open(f"{out}/{term}/scorecard.csv") if line[0] != "#"):
        score[row["condition"], row["channel"]] = 100 * float(row["rho2"])
        if row["condition"] == "steps_2V" and row["channel"] == "position":
            error = float(row["absolute_error_percent"])
    print(f"| {term} | {cost:.0f} | {score['steps_2V', 'position']:.3f} | {error:.3f} | "
          + " | ".join(f"{score[c, p]:.2f}" for c in ("steps_2V", "steps_2V_moving") for p in ("pressure_a", "pressure_b"))
          + " |", flush=True)


def main(rigcal, data, out, *terms):
    print("| without | cost | x rho2 % | x error % | p_A % | p_B % | p_A moving % | p_B moving % |\n" + "| --- " * 8 + "|")
    for term in terms or TERMS:
        fit(rigcal, data, out, term)


if __name__ == "__main__":
    main(*sys.argv[1:])

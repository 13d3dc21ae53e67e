#!/usr/bin/python3
"""What each term of the Festo campaign is worth: fits without one at a time.

    docs/festo/terms.py RIGCAL DATA_DIR OUT_DIR [TERM...]     (run at the project's root)
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import fit, print_table, read_json, scorecard  # noqa: E402

CAMPAIGN = "datasets/rigs/festo_tp511/campaign.toml"
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


def without(term, rigcal, data, out):
    """The cost, and the fields of a row that follow it."""
    fixed = [setting.split("=")[0] for setting in TERMS[term]]
    options = [option for setting in TERMS[term] for option in ("--set", setting)]
    fit(rigcal, CAMPAIGN, data, f"{out}/{term}", "--free", ",".join(name for name in FREE if name not in fixed), *options)
    result = read_json(f"{out}/{term}", "fit.json")
    score = {(row["condition"], row["channel"]): row for row in scorecard(f"{out}/{term}")}
    position = score["steps_2V", "position"]
    pressures = [score[condition, channel] for condition in ("steps_2V", "steps_2V_moving")
                 for channel in ("pressure_a", "pressure_b")]
    return result["cost"], [result["status"], f"{100 * float(position['rho2']):.3f}",
                            f"{float(position['absolute_error_percent']):.3f}",
                            *(f"{100 * float(row['rho2']):.2f}" for row in pressures)]


def main(rigcal, data, out, *terms):
    """The first row is the campaign as it is, whose cost is the unit of the others'."""
    whole, fields = without("none", rigcal, data, out)
    rows = [["none", "1", *fields]]
    for term in terms or [each for each in TERMS if each != "none"]:
        cost, fields = without(term, rigcal, data, out)
        rows.append([f"`{term}`", f"{cost / whole:.4f}", *fields])
    print_table(["without", "cost", "fit", "x rho2 %", "x error %", "p_A %", "p_B %", "p_A moving %", "p_B moving %"], rows)


if __name__ == "__main__":
    main(*sys.argv[1:])

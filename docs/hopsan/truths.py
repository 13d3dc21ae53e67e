#!/usr/bin/python3
"""Do the intervals of fits to another simulator's records include the values that it used?

    docs/hopsan/truths.py RESULT_DIR...
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import fitted_parameters, in_steps_of, print_table, scaled  # noqa: E402

# As the description of the records has them; of a leak its level says it: "turbulent 0.30", "laminar 1e-12".
TRUTH = {"mass": 85.0, "damping": 1000.0, "bulk_modulus": 689e6, "valve_gain": 0.0406e-3, "valve_frequency": 2000.0}


def main(*folders):
    rows = []
    held = 0
    for folder in folders:
        for each in fitted_parameters(folder):
            low, high = each["ci95"]
            truth = TRUTH[each["key"]] if each["level"] is None else float(each["level"].split()[-1])
            inside = low <= truth <= high
            held += inside
            factor, unit = scaled(high, each["unit"])
            texts = in_steps_of(factor * (high - low) / 4.0, *(factor * x for x in (each["value"], low, high)))
            rows.append([f"`{pathlib.Path(folder).name}`", f"`{each['key']}`", f"{factor * truth:g} {unit}".strip(), texts[0],
                         f"{texts[1]} to {texts[2]}", "yes" if inside else "no"])
    print_table(["fit", "parameter", "truth", "estimate", "95 % interval", "includes the truth"], rows)
    print(f"\n{held} of {len(rows)} intervals include the truth.")


if __name__ == "__main__":
    main(*sys.argv[1:])

#!/usr/bin/python3
"""Tables of docs/paper.md from a result folder of `rigcal leak-table` or `rigcal fit-tables`.

    docs/paper/tables.py combinations RESULT_DIR    what the shares depend on
    docs/paper/tables.py coefficients RESULT_DIR    Table 3 beside the published coefficients
    docs/paper/tables.py normal RESULT_DIR          Table 3's row without a fault
    docs/paper/tables.py classes RESULT_DIR         which class its coefficients are in, by the limits
    docs/paper/tables.py features RESULT_DIR        Table 4 beside the published numbers
    docs/paper/tables.py peaks RESULT_DIR           flows of Table 4's levels over a period
    docs/paper/tables.py fitted RESULT_DIR          what `fit-tables` estimates
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import fitted_parameters, in_steps_of, print_table, read_json, rows_of, scaled, written  # noqa: E402

FLOWS_AND_FEATURES = {"servo_flow_l_per_min": "servo flow L/min", "leak_flow_l_per_min": "leak flow L/min",
                      "mean": "mean", "rms": "rms", "std": "std"}


def name_of(signal):
    return f"{signal['waveform']} {signal['frequency_hz']:g} Hz"


def combinations(folder):
    print_table(["combination", "value"], [[f"`{each['formula']}`", f"{each['value']:.4g} {written(each['unit'])}"]
                                           for each in read_json(folder, "leak_table.json")["fixed_combinations"]])


def coefficient_field(entry):
    computed = ", ".join(f"{each:.3f}" for each in entry["coefficients"]) or "none"
    if entry["published_coefficient"] is None:
        return computed
    return f"{computed} / {entry['published_coefficient']:g} ({entry['relative_error_percent']:+.0f} %)"


def coefficients(folder):
    table = read_json(folder, "leak_table.json")
    signals = list(dict.fromkeys(map(name_of, table["entries"])))
    targets = list(dict.fromkeys(entry["target_percent"] for entry in table["entries"]))
    fields = {(entry["target_percent"], name_of(entry)): coefficient_field(entry) for entry in table["entries"]}
    print_table(["share", *signals],
                [[f"{target:g} %", *(fields[target, signal] for signal in signals)] for target in targets])
    summary = table["summary"]
    if summary["published"]:
        print(f"\n{summary['within_10_percent']} of {summary['published']} coefficients within 10 %, "
              f"{summary['within_16_percent']} within 16 %. At the published coefficients the shares are off by "
              f"{summary['share_rms_percent']:.1f} % rms (logarithms of share over target).")


def normal(folder):
    print_table(["signal", "C published", "share at it"],
                [[name_of(each), f"{each['published_coefficient']:g}", f"{each['share_at_published_percent']:.2f} %"]
                 for each in read_json(folder, "leak_table.json")["normal"]])


PAPER_CLASSES = {10.0: "slight", 20.0: "medium", 30.0: "critical", 50.0: "supercritical"}
CLASSES = ["normal", *PAPER_CLASSES.values()]
READINGS = {"upper ends: 1, 10, 20, 30 % (default)": (1.0, 10.0, 20.0, 30.0),
            "centres: 5, 15, 25, 40 %": (5.0, 15.0, 25.0, 40.0)}
ON_LIMIT = 0.05  # as diagnosis::nearest_limit


def classes(folder):
    table = read_json(folder, "leak_table.json")
    shares = [(PAPER_CLASSES[each["target_percent"]], each["share_at_published_percent"]) for each in table["entries"]]
    shares += [("normal", each["share_at_published_percent"]) for each in table["normal"]]
    rows = []
    for reading, limits in READINGS.items():
        as_named = [CLASSES[sum(share >= limit for limit in limits)] == name for name, share in shares]
        on_limit = [any(abs(share - limit) <= ON_LIMIT * limit for limit in limits) for _, share in shares]
        others = sum(limit and not named for limit, named in zip(on_limit, as_named))
        rows.append([reading, f"{sum(as_named)} of {len(shares)}", str(others)])
    print_table(["rows as", "named as in the paper", "others that are said to be on a limit"], rows)


def feature_field(row, name):
    computed, published = row[name], row[f"published_{name}"]
    ratio = computed / published
    off = f"x{ratio:.1f}" if ratio > 3 else f"{100 * ratio - 100:+.1f} %"
    left_out = " *" if name.replace("_l_per_min", "") in row["left_out_of_fit"] else ""
    return f"{computed:.4f} / {published:.4f} ({off}){left_out}"


def features(folder):
    rows = read_json(folder, "leak_table.json")["features"]
    print_table(["level", "C", *FLOWS_AND_FEATURES.values()],
                [[row["level"], f"{row['coefficient']:g}", *(feature_field(row, name) for name in FLOWS_AND_FEATURES)]
                 for row in rows])
    for row in rows:
        if row["coefficients_for_published_leak_flow"] and "leak_flow" in row["left_out_of_fit"]:
            found = ", ".join(f"{each:.2g}" for each in row["coefficients_for_published_leak_flow"])
            print(f"\n{row['level']}: the published leak flow comes at C = {found}; "
                  f"published mean / rms = {row['published_mean'] / row['published_rms']:.3f}.")


def peaks(folder):
    rows = []
    for level in read_json(folder, "leak_table.json")["features"]:
        period = rows_of(pathlib.Path(folder) / "levels" / f"{level['level']}.csv")
        servo, leak, work = ([abs(float(row[f"{flow}_flow_m3_per_s"])) for row in period]
                             for flow in ("servo", "leakage", "work"))
        rows.append([level["level"], f"{level['coefficient']:g}", f"{60e3 * max(servo):.2f}",
                     f"{100 * sum(leak) / sum(servo):.1f} %", f"{100 * sum(leak) / sum(work):.1f} %"])
    print_table(["level", "C", "peak of the servo flow L/min", "leak, of the servo flow", "of the work flow"], rows)


def fitted(folder):
    result = read_json(folder, "fit.json")
    rows = []
    for each in fitted_parameters(folder):
        low, high = each["ci95"]
        factor, unit = scaled(high, each["unit"])
        value, low, high = in_steps_of(factor * each["standard_error"], *(factor * x for x in (each["value"], low, high)))
        rows.append([f"`{each['key']}`", f"{value} {unit}", f"{low} to {high}", f"{each['start']:.4g} {written(each['unit'])}"])
    print_table(["value", "estimate", "95 % interval", "start"], rows)
    names, matrix = result["correlation"]["names"], result["correlation"]["matrix"]
    strength, first, second = max((abs(matrix[i][j]), names[j], names[i]) for i in range(len(names)) for j in range(i))
    gain = read_json(folder, "leak_table.json")["fixed_combinations"][0]
    print(f"\n{result['residual_count']} published numbers; weighted logarithms off by {100 * result['rms']:.1f} % rms. "
          f"Loop gain: {gain['value']:.3f} {gain['unit']}. Strongest correlation: {strength:.2f} "
          f"(`{first}`, `{second}`).")


if __name__ == "__main__":
    tables = {"combinations": combinations, "coefficients": coefficients, "normal": normal, "classes": classes, "features": features,
              "peaks": peaks, "fitted": fitted}
    if len(sys.argv) != 3 or sys.argv[1] not in tables:
        sys.exit(__doc__)
    tables[sys.argv[1]](sys.argv[2])

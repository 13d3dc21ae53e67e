#!/usr/bin/python3
"""Compares the estimates of the shipped rigs with those of an older program.

    bench/old_and_new.py OLD NEW --data DIR --rigs RIGS [--demo DEMO]

OLD and NEW are two programs `rigcal`, DIR is the folder with the recordings, and RIGS is `datasets/rigs` of the old version,
which both can read. DEMO is a folder that `rigcal synthesize` wrote. OLD fits each campaign as it is, and NEW fits a copy with
`considered = false`, which OLD does not know. Both make one start on one thread.

For each rig it prints the user CPU time and the evaluations of both, and the largest change of an estimate in standard errors:
in those that the intervals use, and in those of independent residuals.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import tempfile

FITS = {
    "Martensson": ("martensson_bench/campaign.toml", "martensson_hydraulic_bench"),
    "UTFSM": ("utfsm_mts/campaign.toml", "utfsm_mts_servohydraulic_chirp"),
    "Hopsan": ("hopsan_leaky_servo/fit_turbulent.toml", "sim_hopsan_leaky_servo"),
    "Hopsan, two chambers": ("hopsan_leaky_servo/two_chamber_fit.toml", "sim_hopsan_leaky_servo"),
    "Festo": ("festo_tp511/campaign.toml", "festo_tp511_servo_cylinder"),
}


def without_effects(campaign, folder):
    """Writes a copy of a campaign without considered effects, and returns its path."""
    lines = campaign.read_text(encoding="utf-8").split("\n")
    lines.insert(next(i for i, line in enumerate(lines) if line.startswith("name = ")), "considered = false")
    copy = pathlib.Path(folder) / "campaign.toml"
    copy.write_text("\n".join(lines), encoding="utf-8")
    return copy


def fitted(program, campaign, data, out):
    """Returns the result of a fit, and the user CPU time that it took in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run([program, "fit", campaign, "--data", data, "--starts", "1", "--threads", "1", "--quiet", "--out", out],
                          check=False)
    if done.returncode not in (0, 1):  # 1: a limit in the campaign is not met
        raise SystemExit(f"{program} fit {campaign} ended with {done.returncode}")
    taken_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return json.loads((pathlib.Path(out) / "fit.json").read_text(encoding="utf-8")), taken_s


def largest_change(old, new, error):
    """Returns the largest change of an estimate in units of a standard error, and the name of its parameter."""
    now = {(each["name"], each["level"]): each["value"] for each in new["parameters"]}
    changes = [(abs(now[each["name"], each["level"]] - each["value"]) / each[error], each["name"])
               for each in old["parameters"] if each["fitted"] and each.get(error)]
    return max(changes, default=(0.0, "-"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", help="the older program")
    parser.add_argument("new", help="the program of today")
    parser.add_argument("--data", type=pathlib.Path, required=True, help="folder of the recordings")
    parser.add_argument("--rigs", type=pathlib.Path, required=True, help="datasets/rigs of the old version")
    parser.add_argument("--demo", type=pathlib.Path, help="folder that rigcal synthesize wrote")
    choices = parser.parse_args()
    fits = {name: (choices.rigs / campaign, choices.data / data) for name, (campaign, data) in FITS.items()}
    if choices.demo:
        fits["demo"] = (choices.demo / "campaign.toml", choices.demo)
    print("| rig | CPU s, old | new | evaluations, old | new | largest change in standard errors | of independent residuals |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for name, (campaign, data) in fits.items():
        with tempfile.TemporaryDirectory() as folder:
            old, old_s = fitted(choices.old, campaign, data, f"{folder}/old")
            new, new_s = fitted(choices.new, without_effects(campaign, folder), data, f"{folder}/new")
        robust, plain = (largest_change(old, new, error) for error in ("robust_standard_error", "standard_error"))
        print(f"| {name} | {old_s:.2f} | {new_s:.2f} | {old['evaluations']} | {new['evaluations']} "
              f"| {robust[0]:.4f} ({robust[1]}) | {plain[0]:.4f} ({plain[1]}) |")


if __name__ == "__main__":
    main()

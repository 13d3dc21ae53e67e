#!/usr/bin/python3
"""Which terms matter on the UTFSM records: fits the chirp with terms left out or added, and scores the sweep with the
same parameters.

    docs/utfsm/variants.py RIGCAL DATA_DIR OUT_DIR     (run at the project's root; twelve fits)
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import fit, print_table, scorecard  # noqa: E402

CAMPAIGN = "datasets/rigs/utfsm_mts/campaign.toml"
BASE = "valve_gain,transport_delay,position_offset"
NO_LOAD, NO_FRICTION, NO_DAMPING = "external_force=0 N", "coulomb_friction=1 N", "damping=1000 N s/m"
AS_INPUT = 'role = "input"'
# name: what is free (None: as in the campaign), values, and how the force channel is read
VARIANTS = {
    "loop gain, dead time": (BASE, [NO_LOAD, NO_FRICTION, NO_DAMPING], None),
    "loop gain, dead time, damping": (f"{BASE},damping", [NO_LOAD, NO_FRICTION], None),
    "loop gain, dead time, Coulomb friction": (f"{BASE},coulomb_friction", [NO_LOAD, NO_DAMPING], None),
    "loop gain, dead time, constant load": (f"{BASE},external_force", [NO_FRICTION, NO_DAMPING], None),
    "loop gain, dead time, load, friction": (f"{BASE},external_force,coulomb_friction", [NO_DAMPING], None),
    "loop gain, dead time, load, damping": (f"{BASE},external_force,damping", [NO_FRICTION], None),
    "all of them: the campaign": (None, [], None),
    "the campaign without laminar leakage": (None, ["laminar_leakage=0 m3/(s Pa)"], None),
    "the campaign with leakage 5e-11": (None, ["laminar_leakage=5e-11 m3/(s Pa)"], None),
    "the campaign, a valve lag in place of the dead time":
        ("valve_gain,position_offset,external_force,coulomb_friction,damping,valve_time_constant",
         ["valve_time_constant=3 ms", "transport_delay=0.1 ms"], None),
    "the campaign, recorded force as load": (None, [], AS_INPUT),
    "the campaign, recorded force as load, sign reversed": (None, [], f"gain = -1, {AS_INPUT}"),
}


def campaign_with(force, out):
    """Returns a copy of the campaign. It considers no small effects: they take most of the time, and do not change scores."""
    text = pathlib.Path(CAMPAIGN).read_text(encoding="utf-8").replace("\n[rig]\n", "\nconsidered = false\n[rig]\n", 1)
    ignored = 'unit = "N", role = "ignore"'
    if text.count(ignored) != 1 or "considered = false" not in text:
        sys.exit(f"{CAMPAIGN}: not one channel with {ignored}, or no [rig]")
    path = out / "variant.toml"
    path.write_text(text.replace(ignored, f'unit = "N", {force}') if force else text, encoding="utf-8")
    return path


def scores(rigcal, data, out, free, values, force):
    out.mkdir(parents=True, exist_ok=True)
    options = ["--starts", "1", *(["--free", free] if free else [])]
    for value in values:
        options += ["--set", value]
    fit(rigcal, campaign_with(force, out), data, out, *options)
    rows = {row["condition"]: row for row in scorecard(out)}
    return [f"{100 * float(rows[name]['rho2']):.3f} / {float(rows[name]['absolute_error_percent']):.3f}"
            for name in ("chirp_0A", "sweep_15Hz_0A")]


def main(rigcal, data, out):
    out = pathlib.Path(out)
    print_table(["free beside the offsets", "chirp (fitted): rho2 / error, %", "sweep: rho2 / error, %"],
                ([name, *scores(rigcal, data, out / str(number), *variant)]
                 for number, (name, variant) in enumerate(VARIANTS.items())))


if __name__ == "__main__":
    main(*sys.argv[1:])

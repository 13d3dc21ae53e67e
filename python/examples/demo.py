#!/usr/bin/python3
"""Does what scripts/demo does, with the Python module: synthesizes records, averages them, fits a model and validates it.

    PYTHONPATH=build/release/python python/examples/demo.py [FOLDER]

Results go to FOLDER (default: demo). Cells begin with "# %%", which notebook editors recognise.
"""

# %% [markdown]
# The rig is the shake table of the source paper: 6 signals at 4 openings of the leak valve, 5 repeats each, sampled at
# 1 kHz. Its parameters are known, so that the estimates can be compared with the true values.

# %%
import json
import pathlib
import sys

import numpy as np

import rigcal

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "demo")

# %% Records of the known rig
known_rig = rigcal.load(SOURCE / "datasets" / "rigs" / "uis_shake_table" / "campaign.toml")
campaign = rigcal.load(known_rig.synthesize(out, seed=1))
print(f"{campaign.name}: {len(campaign.conditions)} conditions")

# %% Average five repeats into one record with a mean and a standard deviation for each sample
records = campaign.average(out=out)
for condition, record in records.items():
    position = record.channels["position"]
    offsets_ms = [1e3 * repeat.offset_s for repeat in record.repeat_reports]
    print(
        f"{condition}: {record.time_s.size} samples, {record.repeats} repeats {np.ptp(offsets_ms):.2f} ms apart, "
        f"position {1e6 * (position.pooled_sd or np.nan):.1f} um from repeat to repeat"
    )

# %% The fit: mass, bulk modulus, valve gain, and a leakage coefficient for each opening
fit = campaign.fit()
fit.write(out)
print(f"{fit.status}, verdict {fit.verdict}: {fit.message}")

# %% Compare the estimates with the true values
truth = {
    (row["name"], row["level"]): row["value"] for row in json.loads((out / "truth.json").read_text())["parameters"]
}
print(f"{'parameter':24} {'level':9} {'estimate':>12} {'95 % interval':>27} {'truth':>12}  unit")
for parameter in fit.parameters:
    if not parameter.fitted:
        continue
    low, high = parameter.ci95 or (np.nan, np.nan)
    print(
        f"{parameter.name:24} {parameter.level or '':9} {parameter.value:12.6g} "
        f"{f'{low:.6g} .. {high:.6g}':>27} {truth[parameter.name, parameter.level]:12.6g}  {parameter.unit}"
    )

# %% Correlation between the estimates
strongest = np.abs(fit.correlation - np.eye(len(fit.correlation_names)))
i, j = np.unravel_index(np.argmax(strongest), strongest.shape)
print(f"strongest correlation: {fit.correlation[i, j]:.3f}, {fit.correlation_names[i]} and {fit.correlation_names[j]}")

# %% Validate the fitted parameters with conditions that the fit did not use
validation = campaign.validate(out / "fit.json")
validation.write(out / "validation")
print(f"verdict {validation.verdict}")
for condition, score in validation.conditions.items():
    channel = score.channels["position"]
    print(
        f"{condition}: {score.use}, {score.verdict}, ccc {channel.metrics['ccc']:.4f}, "
        f"largest error {1e3 * np.max(np.abs(channel.residual)):.3f} mm"
    )

# %% Simulate all signals and flows of one condition with the start values of the campaign
simulation = campaign.simulate(campaign.conditions[0].id)
litres_per_minute = 6e4 * np.max(np.abs(simulation.servo_flow_m3_per_s))
print(f"{simulation.condition}: the valve gives up to {litres_per_minute:.2f} l/min")

#!/usr/bin/python3
"""Starting values for a rig from slow sweeps of its servo-valve.

    docs/servovalve_static/starting_values.py measured DATA_DIR    what the sweeps show
    docs/servovalve_static/starting_values.py values DATA_DIR      the lines of [rig.parameters] that follow

(needs python3-numpy)
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from result_files import print_table  # noqa: E402

LPM = 1e-3 / 60  # m3/s
BAR = 1e5  # Pa
PSI = 6894.757  # Pa
FLOW_GAIN_DROP_PA = 1000 * PSI  # total drop of the flow-gain test
PRESSURE_GAIN_SUPPLY_PA = 3000 * PSI  # supply of the pressure-gain and leakage tests
DENSITY = 850.0  # kg/m3, nominal
DISCHARGE_COEFFICIENT = 0.61  # nominal
AREA_GRADIENT = 0.01  # m, nominal: with C_d and the density it only scales the valve gain


def columns(folder, name):
    data = np.loadtxt(folder / f"{name}.csv", delimiter=",", skiprows=1)
    return data[:, 1], data[:, 2]


def slope(x, y):
    """Slope, its value at zero, and the rms of what is left."""
    a, b = np.polyfit(x, y, 1)
    return a, b, np.std(y - a * x - b)


def flow_gains(folder):
    """L/min per mA by the range of the current: one slope for both directions, each side of null with a height of its
    own."""
    current, flow = columns(folder, "flow_gain")
    gains = {}
    for low, high in ((1, 5), (1, 10), (2, 15), (2, 20)):
        part = (np.abs(current) > low) & (np.abs(current) < high)
        terms = np.column_stack([current[part], np.sign(current[part]), np.ones(part.sum())])
        gains[low, high] = abs(np.linalg.lstsq(terms, flow[part], rcond=None)[0][0])
    return gains


def exponents(folder):
    """Of the flow over the pressure drop [bar]: exponent and rms of ln flow that is left."""
    drop, flow = columns(folder, "performance_flow_vs_pressure")
    found = {}
    for low, high in ((14, 214), (14, 60), (60, 214)):
        part = (drop > low) & (drop < high)
        exponent, _, left = slope(np.log(drop[part]), np.log(flow[part]))
        found[low, high] = exponent, left
    return found


def pressure_gain(folder):
    """Bar per mA within 40 % of the supply, the current at zero pressure by that line, and the crossings of zero [mA]."""
    current, pressure = columns(folder, "pressure_gain")
    part = np.abs(pressure) < 0.4 * PRESSURE_GAIN_SUPPLY_PA / BAR
    gain, at_zero, _ = slope(current[part], pressure[part])
    return gain, -at_zero / gain, current[np.nonzero(np.diff(np.sign(pressure)))[0]]


def leakage(folder):
    """Peak, its current [mA], and median far from null [L/min]."""
    current, leak = columns(folder, "leakage_full_range")
    return leak.max(), current[leak.argmax()], np.median(leak[np.abs(current) > 10])


def measured(folder):
    gains = flow_gains(folder)
    rows = [[f"flow gain at 1000 psi total drop, {low} to {high} mA", f"{gain:.3f} L/min per mA"]
            for (low, high), gain in gains.items()]
    rows += [[f"exponent of flow over pressure drop, {low} to {high} bar", f"{exponent:.3f} (rms {100 * left:.1f} %)"]
             for (low, high), (exponent, left) in exponents(folder).items()]
    gain, null_ma, crossings = pressure_gain(folder)
    rows += [["pressure gain within 40 % of the supply", f"{gain:.1f} bar per mA"],
             ["null, by that line", f"{null_ma:+.2f} mA"],
             ["crossings of zero load pressure", f"{crossings.min():+.2f} to {crossings.max():+.2f} mA"]]
    peak, at_ma, far = leakage(folder)
    full_flow = np.abs(columns(folder, "flow_gain")[1]).max()
    rows += [["leakage at 3000 psi, largest", f"{peak:.2f} L/min at {at_ma:+.2f} mA"],
             ["leakage at 3000 psi, far from null (pilot)", f"{far:.2f} L/min"],
             ["leakage across null over flow at full current", f"{100 * (peak - far) / full_flow:.1f} %"]]
    for period in (20, 50, 100, 200, 500):
        _, leak = columns(folder, f"leakage_pm5mA_period{period}")
        rows.append([f"leakage at 3000 psi, largest, sweep of {period} s", f"{leak.max():.2f} L/min"])
    print_table(["quantity", "value"], rows)


def values(folder):
    # Q = C_d w k i sqrt(drop / rho) in the load-pressure plant (eq. 4 with eq. 6).
    per_amp = flow_gains(folder)[1, 10] * LPM / 1e-3
    valve_gain = per_amp / (DISCHARGE_COEFFICIENT * AREA_GRADIENT * np.sqrt(FLOW_GAIN_DROP_PA / DENSITY))
    # Blocked ports: the flow that the current opens leaks across null, so K_c = K_q / K_p.
    gain, null_ma, _ = pressure_gain(folder)
    gain_at_supply = per_amp * np.sqrt(PRESSURE_GAIN_SUPPLY_PA / FLOW_GAIN_DROP_PA)
    null_leakage = gain_at_supply / (gain * BAR / 1e-3)
    print(f"discharge_coefficient = {DISCHARGE_COEFFICIENT}            # nominal, with the next one\n"
          f'area_gradient = "{AREA_GRADIENT} m"\n'
          f'valve_gain = "{valve_gain:.2e} m/V"        # the current in A in place of the command in V\n'
          f'valve_null_leakage = "{null_leakage:.1e} m3/(s Pa)"\n'
          f'valve_offset = "{-1e-3 * null_ma:.0e} V"')


if __name__ == "__main__":
    tables = {"measured": measured, "values": values}
    if len(sys.argv) != 3 or sys.argv[1] not in tables:
        sys.exit(__doc__)
    tables[sys.argv[1]](pathlib.Path(sys.argv[2]))

#!/usr/bin/python3
"""Starting values for a rig from slow sweeps of its servo-valve.

    starting_values.py DIR

DIR holds the records of servovalve_static_test. Prints what docs/servovalve-static.md quotes, and
the lines of [rig.parameters] that follow from it. Needs numpy.
"""
import pathlib
import sys

import numpy as np

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


def main():
    folder = pathlib.Path(sys.argv[1])

    current, flow = columns(folder, "flow_gain")
    print("flow gain, l/min per mA at 1000 psi total drop, by the range of the current:")
    gains = []
    for low, high in ((1, 5), (1, 10), (2, 15), (2, 20)):
        part = (np.abs(current) > low) & (np.abs(current) < high)
        # One slope for both directions; each side of null has a height of its own.
        side = np.sign(current[part])
        terms = np.column_stack([current[part], side, np.ones(part.sum())])
        fitted = np.linalg.lstsq(terms, flow[part], rcond=None)[0]
        gains.append(abs(fitted[0]))
        print(f"  {low:2d} to {high:2d} mA: {abs(fitted[0]):.4f}")
    flow_gain = gains[1]
    spread = max(gains) - min(gains)
    print(f"  taken: {flow_gain:.4f}, which the ranges leave uncertain by {spread:.4f}")

    drop, flow = columns(folder, "performance_flow_vs_pressure")
    print("exponent of the flow over the pressure drop (orifice: 0.5):")
    for low, high in ((14, 214), (14, 60), (60, 214)):
        part = (drop > low) & (drop < high)
        exponent, _, left = slope(np.log(drop[part]), np.log(flow[part]))
        print(f"  {low:3d} to {high:3d} bar: {exponent:.3f} (rms {100 * left:.1f} %)")

    current, pressure = columns(folder, "pressure_gain")
    part = np.abs(pressure) < 0.4 * PRESSURE_GAIN_SUPPLY_PA / BAR
    pressure_gain, at_zero, _ = slope(current[part], pressure[part])
    crossings = current[np.nonzero(np.diff(np.sign(pressure)))[0]]
    null_ma = -at_zero / pressure_gain
    print(f"pressure gain within 40 % of the supply: {pressure_gain:.1f} bar per mA, "
          f"null at {null_ma:+.3f} mA, crossings {crossings.min():+.2f} to {crossings.max():+.2f} mA")

    current, leak = columns(folder, "leakage_full_range")
    tare = np.median(leak[np.abs(current) > 10])
    print(f"leakage at 3000 psi: {leak.max():.2f} l/min at {current[leak.argmax()]:+.2f} mA, "
          f"{tare:.2f} l/min far from null (pilot)")
    print("  peak by sweep period, l/min:", end="")
    for period in (20, 50, 100, 200, 500):
        _, slow = columns(folder, f"leakage_pm5mA_period{period}")
        print(f" {period}: {slow.max():.2f}", end="")
    print()

    # Q = C_d w k i sqrt(drop / rho) in the load-pressure plant (eq. 4 with eq. 6).
    per_amp = flow_gain * LPM / 1e-3
    valve_gain = per_amp / (DISCHARGE_COEFFICIENT * AREA_GRADIENT
                            * np.sqrt(FLOW_GAIN_DROP_PA / DENSITY))
    # Blocked ports: the flow that the current opens leaks across null, so K_c = K_q / K_p.
    gain_at_supply = per_amp * np.sqrt(PRESSURE_GAIN_SUPPLY_PA / FLOW_GAIN_DROP_PA)
    null_leakage = gain_at_supply / (pressure_gain * BAR / 1e-3)
    print("starting values, with the current in A in place of the command in V:")
    print(f"  discharge_coefficient = {DISCHARGE_COEFFICIENT}  # nominal, with the next one")
    print(f'  area_gradient = "{AREA_GRADIENT} m"')
    print(f'  valve_gain = "{valve_gain:.3e} m/V"')
    print(f'  valve_null_leakage = "{null_leakage:.2e} m3/(s Pa)"')
    print(f'  valve_offset = "{-1e-3 * null_ma:.1e} V"')
    print(f"  null leakage over flow at full current: "
          f"{100 * (leak.max() - tare) / np.abs(columns(folder, 'flow_gain')[1]).max():.1f} %")


main()

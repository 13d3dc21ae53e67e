#!/usr/bin/env python3
"""Compares the estimates of two fits of the same records by different compilers. They may differ by 1e-6 of the value, or by
0.002 standard errors, the precision of the search. usage: same_estimates.py FIT.JSON FIT.JSON
"""
import json
import sys


def fitted(path):
    with open(path, encoding="utf-8") as file:
        return {(each["name"], each["level"]): each for each in json.load(file)["parameters"] if each["fitted"]}


def main():
    one, other = fitted(sys.argv[1]), fitted(sys.argv[2])
    if not one or one.keys() != other.keys():
        sys.exit(f"same_estimates: {sorted(map(str, one))} are not {sorted(map(str, other))}")
    apart = 0
    for name, each in one.items():
        difference = abs(each["value"] - other[name]["value"])
        agrees = difference <= max(1e-6 * abs(each["value"]), 2e-3 * (each["standard_error"] or 0.0))
        apart += not agrees
        print(f"{each['name']} {each['level'] or ''}: {each['value']:.9g} {other[name]['value']:.9g}, "
              f"{difference / abs(each['value']) if each['value'] else difference:.1e} apart{'' if agrees else ': too far'}")
    return 1 if apart else 0


if __name__ == "__main__":
    sys.exit(main())

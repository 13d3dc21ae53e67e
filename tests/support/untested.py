#!/usr/bin/env python3
"""Prints the tests of a build that another build of the same sources has not passed in full, as a pattern for `ctest -R`.

A test has passed in full if ctest counts it as passed and its output names nothing that was skipped. Tests with a label of
ALWAYS depend on what a build found on its machine, so they always count as not passed. usage: untested.py BUILD OTHER
BUILD, OTHER: folders of the builds; ctest has run in OTHER. Exit code 1 if no test passed there.
"""
import json
import pathlib
import re
import subprocess
import sys

ALWAYS = {"python", "docs", "package"}
PART = re.compile(r'^\d+/\d+ Testing: (?P<name>[^\n]*)\n(?P<output>.*?)^"(?P=name)" end time:', re.DOTALL | re.MULTILINE)
OMITTED = re.compile(r"skipped|not tried", re.IGNORECASE)
SPECIAL = re.compile(r"[][.()*+?^$|\\]")


def passed_in_full(log, costs):
    """Returns the names of the tests that passed and skipped nothing. `log`: text of LastTest.log, in which ctest writes the
    output of each test. `costs`: text of CTestCostData.txt, with how often each test passed, for which one that was skipped
    does not count."""
    rows = [line.rsplit(" ", 2) for line in costs.partition("\n---")[0].splitlines()]
    passed = {row[0] for row in rows if len(row) == 3 and int(row[1]) > 0}
    return {part["name"] for part in PART.finditer(log) if part["name"] in passed and not OMITTED.search(part["output"])}


def tests_of(build):
    """Returns the names of the tests of a build, each with its labels."""
    listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], capture_output=True, text=True, check=True)
    return {test["name"]: {label for each in test.get("properties", []) if each["name"] == "LABELS" for label in each["value"]}
            for test in json.loads(listed.stdout)["tests"]}


def untested(tests, passed):
    """Returns the names that are not in `passed`, or have a label of ALWAYS."""
    return [name for name, labels in tests.items() if name not in passed or labels & ALWAYS]


def pattern_of(names):
    """Returns a regular expression of CMake that matches exactly these names."""
    return "^(" + "|".join(SPECIAL.sub(r"\\\g<0>", name) for name in names) + ")$"


def main():
    build, other = map(pathlib.Path, sys.argv[1:])
    log, costs = (other / "Testing" / "Temporary" / name for name in ("LastTest.log", "CTestCostData.txt"))
    passed = passed_in_full(*(file.read_text(encoding="utf-8", errors="replace") for file in (log, costs)))
    if not passed:
        sys.exit(f"untested: no test passed in {other}")
    print(pattern_of(untested(tests_of(build), passed)))


if __name__ == "__main__":
    main()

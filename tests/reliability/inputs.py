"""Damages files: changes a byte, cuts off the end, inserts bytes, replaces a value of a result. The program must read each file
or refuse it by name. A result lists the hashes of its files; they are corrected, so that the parsers see the damage."""
import hashlib
import json
import random
import shutil

from runs import ROOT, SMALL_RIG, Count, must, run


def damaged(data, rounds):
    """Yields damaged versions of a file; the damage is spread evenly over its length."""
    random.seed(len(data))
    for k in range(rounds):
        at = (2 * k + 1) * len(data) // (2 * rounds)
        yield f"byte {at} changed", data[:at] + bytes([random.randrange(256)]) + data[at + 1:]
        yield f"cut at byte {at}", data[:at]
        yield f"more at byte {at}", data[:at] + random.choice([b"\0", b"\xff\xfe", b"1e999", b"[[", b"{", b",,", b"\n\n",
                                                              b"nan", b'"']) + data[at:]


ODD = [None, True, "", "text", [], {}, [1.0], [None, None], 0, -1, 1, 0.5, 1e6, 2147483648, 1e149, -1e149, 1e-308, 1e308]


def values_of(node, place=()):
    """Yields the places of all values of a JSON text."""
    yield place
    children = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, child in children:
        yield from values_of(child, (*place, key))


def replaced(data, rounds):
    """Yields texts of a JSON with one value replaced or removed, evenly over its values."""
    random.seed(len(data))
    places = [place for place in values_of(json.loads(data)) if place]
    for k in range(rounds):
        place = places[(2 * k + 1) * len(places) // (2 * rounds)]
        text = json.loads(data)
        above = text
        for key in place[:-1]:
            above = above[key]
        at = ".".join(map(str, place))
        if k % 4 == 0:
            del above[place[-1]]
            yield f"{at} gone", json.dumps(text).encode()
            continue
        number = isinstance(above[place[-1]], float) and k % 2 == 0
        value = above[place[-1]] * random.choice([-1.0, 1e6, 1e100, 1e300]) if number else random.choice(ODD)
        above[place[-1]] = max(-1e308, min(1e308, value)) if number else value
        yield f"{at} = {str(above[place[-1]])[:40]}", json.dumps(text).encode()


def cells_replaced(data, rounds):
    """Yields texts of a table with one cell emptied or replaced."""
    random.seed(len(data))
    rows = data.split(b"\n")
    for k in range(rounds):
        row = 1 + (2 * k + 1) * (len(rows) - 2) // (2 * rounds)
        cells = rows[row].split(b",")
        column = k % len(cells)
        cell = random.choice([b"", b"nan", b"inf", b"0", b"-1", b"1e300", b"-1e300", b"1e-300", b"x", b"1,2"])
        changed = b",".join([*cells[:column], cell, *cells[column + 1:]])
        yield f"row {row}, column {column}: {cell.decode()}", b"\n".join([*rows[:row], changed, *rows[row + 1:]])


def make_right(result, file):
    """Corrects the hash of a result file in fit.json."""
    fit = json.loads((result / "fit.json").read_text())
    for each in fit["provenance"]["files"]:
        if result / each["path"] == file:
            each["sha256"] = hashlib.sha256(file.read_bytes()).hexdigest()
    (result / "fit.json").write_text(json.dumps(fit))


def behind_hashes(rigcal, folder, fit, rounds):
    """Damages the files that fit.json lists, and the values of fit.json."""
    other = folder / "other"
    shutil.copytree(fit, other)
    diagnose = ["diagnose", folder / "twin" / "campaign.toml", "--fit", fit / "fit.json", "--out", folder / "diagnosis",
                "--quiet"]
    rows = []
    for name, file, change, arguments in (
            ("fit.json by value, report", fit / "fit.json", replaced, ["report", fit]),
            ("fit.json by value, diagnose", fit / "fit.json", replaced, diagnose),
            ("fit.json by value, compare", fit / "fit.json", replaced,
             ["compare", fit, other, "--out", folder / "compared", "--quiet"]),
            ("`residual_tests.json`, hash made right", fit / "residual_tests.json", replaced, ["report", fit]),
            ("`residual_tests.json` by byte, hash made right", fit / "residual_tests.json", damaged, ["report", fit]),
            ("residuals/*.csv, hash made right", sorted((fit / "residuals").glob("*.csv"))[0], cells_replaced,
             ["report", fit])):
        row = Count(f"inputs: {name}")
        before = {path: path.read_bytes() for path in (file, fit / "fit.json")}
        for what, data in change(before[file], rounds):
            file.write_bytes(data)
            if file.name != "fit.json":
                make_right(fit, file)
            code, _, err = run(rigcal, arguments)
            row.ended(code, what)
            if code == 5 or b"bug" in err:
                row.is_wrong(f"{what}: exit {code}: {err.decode(errors='replace')[-200:]}")
        for path, data in before.items():
            path.write_bytes(data)
        rows.append(row)
    return rows


def study(rigcal, folder, size):
    rounds = 3 if size == "small" else 150
    twin = folder / "twin"
    must(rigcal, ["synthesize", SMALL_RIG, "--seed", "1", "--out", twin, "--quiet"])
    campaign = twin / "campaign.toml"
    fit = folder / "fit"
    must(rigcal, ["fit", campaign, "--out", fit, "--quiet"])
    record = sorted((twin / "records").glob("*.csv"))[0]
    mat = {kind: folder / f"{kind}.mat" for kind in ("compressed", "uncompressed")}
    for kind, file in mat.items():
        shutil.copy(ROOT / "tests" / "fuzz" / "corpus" / "mat" / f"{kind}.mat", file)
    validate = ["validate", campaign, "--fit", fit / "fit.json", "--out", folder / "out", "--quiet"]
    rows = []
    for name, file, arguments in (
            ("campaign file", campaign, ["check", campaign]),
            ("fitted.toml", fit / "fitted.toml", ["check", fit / "fitted.toml"]),
            ("CSV record", record, ["average", campaign, "--out", folder / "out", "--quiet"]),
            *((f"MAT record, {kind}", file, ["init", file, "--out", folder / "new"]) for kind, file in mat.items()),
            ("fit.json, validate", fit / "fit.json", validate),
            ("fit.json, report", fit / "fit.json", ["report", fit]),
            ("`residual_tests.json`", fit / "residual_tests.json", ["report", fit])):
        row = Count(f"inputs: {name}, damaged")
        whole = file.read_bytes()
        for what, data in damaged(whole, rounds):
            file.write_bytes(data)
            code, _, err = run(rigcal, arguments)
            row.ended(code, what)
            if code == 5 or b"bug" in err:
                row.is_wrong(f"{what}: exit {code}: {err.decode(errors='replace')[-200:]}")
        file.write_bytes(whole)
        rows.append(row)
    return rows + behind_hashes(rigcal, folder, fit, 3 * rounds)

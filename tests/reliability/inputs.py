"""Files that are damaged: a byte changed, the end cut off, something put in. Each is read, or refused with its name."""
import random
import shutil

from runs import ROOT, SMALL_RIG, Count, must, run


def damaged(data, rounds):
    """Contents of a file that was damaged, evenly over its length."""
    random.seed(len(data))
    for k in range(rounds):
        at = (2 * k + 1) * len(data) // (2 * rounds)
        yield f"byte {at} changed", data[:at] + bytes([random.randrange(256)]) + data[at + 1:]
        yield f"cut at byte {at}", data[:at]
        yield f"more at byte {at}", data[:at] + random.choice([b"\0", b"\xff\xfe", b"1e999", b"[[", b"{", b",,", b"\n\n",
                                                              b"nan", b'"']) + data[at:]


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
            ("residual_tests.json", fit / "residual_tests.json", ["report", fit])):
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
    return rows

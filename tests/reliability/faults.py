"""Makes every allocation and every write fail once, in turn. The program must either end with
exit code 5 and leave the earlier results unchanged, or recover and write the same results."""
import os
import shutil

from runs import SMALL_RIG, Count, comparable, content, left_behind, must, run

# What fails, in the order in which fail_nth.cpp counts it, and the name of its row.
KINDS = {
    "memory": "faults: {}, allocations",
    "malloc": "malloc: {}, calls by Eigen and libraries in C",
    "files": "faults: {}, calls that write",
}


def places(count, most):
    """Chooses which of `count` calls fail: all, or the first and last ones and others at even
    intervals in between. The last ones move the files into place."""
    if most is None or count <= most:
        return list(range(1, count + 1))
    ends = most // 3
    between = most - 2 * ends
    return [*range(1, ends + 1), *(ends + 1 + k * (count - 2 * ends) // between for k in range(between)), *range(count - ends + 1, count + 1)]


def repeatable(folder):
    """Returns the hashes of the files that are equal in two runs. Other files contain the time
    that a fit took, or its hash."""
    return {path: hash_ for path, hash_ in content(folder).items()
            if path not in ("fit.json", "report.html", "rigcal-manifest.json")}


def study(rigcal, folder, size, kinds=("memory", "files")):
    library = rigcal.parent / "tests" / "libfail_nth.so"
    if not library.is_file():
        raise SystemExit(f"reliability: {library} is missing; expected a program in a build of the tests")
    must(rigcal, ["synthesize", SMALL_RIG, "--seed", "1", "--out", folder / "twin", "--quiet"])
    campaign = folder / "twin" / "campaign.toml"
    must(rigcal, ["fit", campaign, "--out", folder / "earlier", "--seed", "2", "--quiet"])
    rows = []
    for verb, most in (("fit", {"small": 30, "usual": 3000, "every": None}[size]),
                       ("report", {"small": 15, "usual": 1500, "every": None}[size])):
        out = folder / "out"

        def attempt(fault):
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(folder / "earlier", out)
            arguments = ["fit", campaign, "--out", out] if verb == "fit" else ["report", out]
            counts = folder / "counts"
            environment = {**os.environ, "LD_PRELOAD": str(library), "RIGCAL_FAIL": fault, "RIGCAL_COUNT": str(counts)}
            code, _, err = run(rigcal, [*arguments, "--threads", "1", "--quiet"][:None if verb == "fit" else 2],
                               env=environment)
            return code, err.decode(errors="replace"), counts

        code, err, counts = attempt("memory:0")
        if code != 0:
            raise SystemExit(f"reliability: {verb} under {library}: exit {code}: {err}")
        whole = repeatable(out)
        result = comparable(out / "fit.json")
        before = content(folder / "earlier")
        for kind, count in zip(KINDS, map(int, counts.read_text().split())):
            if kind not in kinds:
                continue
            row = Count(KINDS[kind].format(verb))
            chosen = places(count, most)
            for n in chosen:
                code, err, _ = attempt(f"{kind}:{n}")
                where = f"{kind} {n} of {count}"
                row.ended(code, where)
                is_new = repeatable(out) == whole and comparable(out / "fit.json") == result
                if code == 0 and not is_new:
                    row.is_wrong(f"exit 0 with other results: {where}")
                elif code == 5:
                    # The new results are already in place if memory runs out during printing.
                    if not is_new and content(out) != before:
                        row.is_wrong(f"neither the results of the earlier run nor the new ones: {where}")
                    if "bug" in err:
                        row.is_wrong(f"called a bug: {where}: {err.strip()[-200:]}")
                elif code is not None and code > 0:
                    row.is_wrong(f"exit {code}: {where}: {err.strip()[-200:]}")
                for each in left_behind(out):
                    row.is_wrong(f"left {each}: {where}")
            row.remarks.append(f"{len(chosen)} of {count} places")
            rows.append(row)
    return rows

"""Checks that results do not depend on the environment: another language, no home, no folder for
temporary files, a clock that jumps. If results cannot be written, a message must say so, and
the earlier results must remain."""
import os
import resource
import shutil
import subprocess
import time

from runs import SMALL_RIG, Count, comparable, content, left_behind, must, run

NOBODY = 65534
NO_LOCKS = "file system without locks"


def work(campaign, earlier):
    """Returns every verb that writes, with the compared parts of its files."""
    by_fit = ["--fit", earlier / "fit" / "fit.json"]
    return {
        "synthesize": (["synthesize", SMALL_RIG, "--seed", "1", "--quiet"], None),
        "average": (["average", campaign, "--quiet"], None),
        "fit": (["fit", campaign, "--quiet", "--max-time", "600"], "fit.json"),
        "validate": (["validate", campaign, *by_fit, "--quiet"], "validation.json"),
        "leak-table": (["leak-table", campaign, "--targets", "5,10", "--signals", "sine@2Hz@5mm", "--quiet"],
                       "leak_table.json"),
        "report": (["report", earlier / "fit"], None),
    }


def csv_files(folder):
    """Returns the hashes of the CSV files, which a decimal comma would change."""
    return {name: hash_ for name, hash_ in content(folder).items() if name.endswith(".csv")}


def decimal_comma(folder):
    """Compiles a locale with a decimal comma. Returns its variables, or None and the reason."""
    place = folder / "locales"
    place.mkdir()
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", place / "de_DE.UTF-8"], capture_output=True,
                          check=False)
    if not (place / "de_DE.UTF-8" / "LC_NUMERIC").is_file():
        return None, made.stderr.decode().strip()
    return {"LOCPATH": str(place), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}, ""


def surroundings(rigcal, folder):
    """Yields (name, environment variables or None, reason if None)."""
    plain = {key: value for key, value in os.environ.items() if key not in ("HOME", "XDG_CACHE_HOME")}
    comma, reason = decimal_comma(folder)
    yield "decimal comma", comma and {**os.environ, **comma}, reason
    yield "no HOME", plain, ""
    yield "no folder for temporary files", {**os.environ, "TMPDIR": str(folder / "missing")}, ""
    yield "empty environment", {}, ""
    library = rigcal.parent / "tests" / "libclock_jumps.so"
    jumps = {**os.environ, "LD_PRELOAD": str(library)} if library.is_file() else None
    yield "clock that jumps by hours", jumps, f"{library} is missing"
    library = rigcal.parent / "tests" / "libfail_nth.so"
    unlocked = {**os.environ, "LD_PRELOAD": str(library), "RIGCAL_FAIL": "locks"} if library.is_file() else None
    yield NO_LOCKS, unlocked, f"{library} is missing"


def same_results(rigcal, folder, campaign, earlier):
    reference = folder / "reference"
    for verb, (arguments, _) in work(campaign, earlier).items():
        must(rigcal, [*arguments, "--out", reference / verb] if verb != "report" else arguments)
    rows = []
    for name, variables, reason in surroundings(rigcal, folder):
        row = Count(f"surroundings: {name}")
        rows.append(row)
        if variables is None:
            row.remarks.append(f"not tried: {reason}")
            continue
        for verb, (arguments, file) in work(campaign, earlier).items():
            out = folder / "out" / verb
            shutil.rmtree(out, ignore_errors=True)
            began = time.monotonic()
            code, _, err = run(rigcal, [*arguments, "--out", out] if verb != "report" else arguments, env=variables)
            row.ended(code, f"{verb}, {time.monotonic() - began:.0f} s")
            if code != 0:
                row.is_wrong(f"{verb}: exit {code}: {err.decode(errors='replace')[-200:]}")
                continue
            if verb == "report":
                if name == NO_LOCKS and b"cannot be locked" not in err:
                    row.is_wrong("no word about it")
                continue
            if csv_files(out) != csv_files(reference / verb):
                row.is_wrong(f"{verb}: other tables")
            if file and comparable(out / file) != comparable(reference / verb / file):
                row.is_wrong(f"{verb}: another {file}")
    return rows


def small_files(limit):
    return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))}


def as_nobody(out):
    """Returns options to run as another user if this is root, who can write anywhere."""
    if os.geteuid() != 0:
        return {}
    for path in (out, *out.rglob("*")):
        os.chown(path, NOBODY, NOBODY)
    return {"user": NOBODY, "group": NOBODY}


def unwritable(rigcal, folder, campaign, earlier):
    rows = []
    for verb, (arguments, _) in work(campaign, earlier).items():
        if verb in ("report", "synthesize"):
            continue
        before = folder / "before" / verb
        must(rigcal, [*arguments, "--out", before])
        row = Count(f"places: {verb}, no larger files")
        for limit in (0, 1, 100, 2000):
            out = folder / "limited" / verb
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(before, out)
            code, _, err = run(rigcal, [*arguments, "--out", out], **small_files(limit))
            row.ended(code, f"{limit} bytes")
            if code != 5:
                row.is_wrong(f"{limit} bytes: exit {code}: {err.decode()[-200:]}")
            if content(out) != content(before):
                row.is_wrong(f"{limit} bytes: the earlier results are not as they were")
        rows.append(row)
        rows.append(read_only(rigcal, folder, arguments, verb, before))
        rows.append(full_disk(rigcal, folder, arguments, verb, before))
    return [row for row in rows if row]


def read_only(rigcal, folder, arguments, verb, before):
    row = Count(f"places: {verb}, read-only folder")
    out = folder / "read_only" / verb
    shutil.copytree(before, out)
    user = as_nobody(out)
    for path in (out, *(each for each in out.rglob("*") if each.is_dir())):
        path.chmod(0o555)
    for above in (folder, folder / "read_only"):
        above.chmod(0o755)
    code, _, err = run(rigcal, [*arguments, "--out", out], **user)
    row.ended(code, "read-only folder")
    if code != 5 or str(out) not in err.decode():
        row.is_wrong(f"exit {code}: {err.decode()[-200:]}")
    if content(out) != content(before):
        row.is_wrong("the earlier results are not as they were")
    for path in (out, *(each for each in out.rglob("*") if each.is_dir())):
        path.chmod(0o755)
    return row


def full_disk(rigcal, folder, arguments, verb, before):
    """Tries a file system with no bytes left, then one with no inodes left. Only root can mount
    one."""
    row = Count(f"places: {verb}, full disk")
    size = sum(path.stat().st_size for path in before.rglob("*") if path.is_file())
    files = sum(1 for _ in before.rglob("*"))
    for options in (f"size={size + 65536 + 4096 * files}", f"size=1g,nr_inodes={files + 4}"):
        disk = folder / "disk"
        disk.mkdir(exist_ok=True)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", disk], capture_output=True, check=False)
        if mounted.returncode != 0:
            row.remarks.append("not tried: " + mounted.stderr.decode().strip())
            return row
        try:
            out = disk / "out"
            shutil.copytree(before, out)
            fill(disk)
            code, _, err = run(rigcal, [*arguments, "--out", out])
            row.ended(code, options)
            if code != 5:
                row.is_wrong(f"{options}: exit {code}: {err.decode()[-200:]}")
            if content(out) != content(before):
                row.is_wrong(f"{options}: the earlier results are not as they were")
            for each in left_behind(out):
                row.is_wrong(f"{options}: left {each}")
        finally:
            subprocess.run(["umount", disk], check=True)
    return row


def fill(disk):
    """Writes until there is no space left, or creates files until there are no inodes left."""
    try:
        with (disk / "filler").open("wb") as filler:
            while True:
                filler.write(bytes(4096))
                filler.flush()
                if os.statvfs(disk).f_bavail > 1 << 16:
                    break  # there is space left, so inodes are scarce
    except OSError:
        return
    k = 0
    try:
        while True:
            (disk / f"filler{k}").touch()
            k += 1
    except OSError:
        return


def study(rigcal, folder, _):
    must(rigcal, ["synthesize", SMALL_RIG, "--seed", "1", "--out", folder / "twin", "--quiet"])
    campaign = folder / "twin" / "campaign.toml"
    earlier = folder / "earlier"
    must(rigcal, ["fit", campaign, "--out", earlier / "fit", "--quiet"])
    rows = same_results(rigcal, folder, campaign, earlier)
    return rows + unwritable(rigcal, folder, campaign, earlier)

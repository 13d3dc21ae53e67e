#!/usr/bin/env python3
"""Compares the model in a page with the command, in headless Chromium. usage: live_test.py RIGCAL SOURCES
Exit code 77: there is no browser, or the program was built without the model for pages."""

import base64
import csv
import gzip
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from browser import Browser, chromium

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from runs import RUNS, Absent, Runs  # noqa: E402

# A rig with every feature of the shipped rigs: two chambers, hoses, second-order valve,
# friction, delay, lag, sampled loop.
TWO_CHAMBER = """schema = "rigcal.campaign/1"
name = "</script><b>rig</b> & \\"more\\""
[rig]
model = "two_chamber"
[rig.parameters]
supply_pressure = "20 MPa"
tank_pressure = "0.2 MPa"
mass = { start = "60 kg", lower = "10 kg", upper = "500 kg", fit = true }
damping = "900 N s/m"
stiffness = "0 N/m"
area_a = "1200 mm2"
area_b = "800 mm2"
stroke = "300 mm"
dead_volume_a = "60 cm3"
dead_volume_b = "60 cm3"
density = "850 kg/m3"
bulk_modulus = "900 MPa"
discharge_coefficient = 0.6
area_gradient = "20 mm"
valve_gain = "3e-5 m/V"
leakage_coefficient = 0.3
leakage_area = "1 mm2"
valve_frequency = "60 Hz"
valve_damping_ratio = 0.8
coulomb_friction = "60 N"
transport_delay = "4 ms"
position_lag = "3 ms"
position_offset = "1 mm"
[rig.controller]
type = "pid"
kp = "60 V/m"
ki = "20 V/(m s)"
sample_time = "2 ms"
output_limit = "10 V"
[simulation]
tolerance = 1e-9
[leak_level."half"]
parameters = { leakage_coefficient = 0.5 }
[recording.channels]
time = { column = "t", unit = "s" }
position = { column = "x", unit = "mm" }
[[condition]]
id = "chirp"
waveform = "chirp"
frequency = "0.5 Hz"
end_frequency = "5 Hz"
amplitude = "20 mm"
duration = "3 s"
sample_rate = "1 kHz"
use = "diagnose"
leak_level = "half"
[[condition]]
id = "square"
waveform = "square"
frequency = "1 Hz"
amplitude = "20 mm"
duration = "3 s"
sample_rate = "1 kHz"
use = "diagnose"
leak_level = "half"
"""


def check(holds, what):
    if not holds:
        raise AssertionError(what)


def run(rigcal, *arguments, cwd, code=0):
    done = subprocess.run([rigcal, *arguments], cwd=cwd, capture_output=True, text=True, check=False)
    check(done.returncode == code, f"rigcal {' '.join(map(str, arguments))}: exit {done.returncode}: {done.stderr}")
    return done


def simulated(browser):
    browser.wait_for("window.rigcalLive !== undefined", "no simulation")
    return browser.run("window.rigcalLive.drawn")


def moved(browser, script):
    """Runs a script that changes a value and waits for the curves."""
    was = simulated(browser)
    browser.run(script)
    browser.wait_for(f"window.rigcalLive.drawn > {was}", f"no curve follows {script}")


def type_in(label, value):
    return (f"(() => {{ const field = document.getElementById('live-of-{label}'); field.value = {value};"
            " field.dispatchEvent(new Event('input')); })()")


def compare(browser, rigcal, campaign, what, limit=1e-6):
    """Runs the `simulate` command that the page shows; every output must agree to this fraction of its peak.
    An acceleration, a small difference of large forces, may differ ten times as much."""
    text = browser.run("document.getElementById('live-text').textContent")
    condition, _, command = text.rpartition("# Then:\n")  # a recorded drive needs no condition of its own
    name = re.search(r"--condition (\S+)", command)[1].strip("'")
    live = campaign.with_name("live.toml")
    live.write_text(campaign.read_text() + "\n" + condition)
    out = campaign.parent / "out"
    line = command.strip().replace(f"rigcal simulate {campaign.name}", f"'{rigcal}' simulate live.toml") + f" --out {out} --force --quiet"
    done = subprocess.run(["bash", "-c", line], cwd=campaign.parent, capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"{what}: {line}: {done.stderr}")
    with open(out / f"{name}.csv", encoding="utf-8") as file:
        lines = [row for row in file if not row.startswith("#")]
    native = {name: [float(row[name]) for row in csv.DictReader(lines)] for name in next(csv.reader(lines[:1])) if name}
    page = browser.run("""(() => { const {request, answer, rig} = window.rigcalLive;
        return JSON.stringify({times: [...request.times], outputs: Object.fromEntries(rig.outputs.map((name, i) => [name, [...answer.outputs[i]]]))}); })()""")
    page = json.loads(page)
    check(len(page["times"]) == len(native["time_s"]), f"{what}: {len(page['times'])} samples, {len(native['time_s'])} of the command")
    worst = 0.0
    for name, live_values in page["outputs"].items():
        if name not in native:  # the rig does not have this output
            check(not any(live_values), f"{what}: {name}, which the command does not write")
            continue
        peak = max(map(abs, native[name])) or 1.0
        error = max(abs(a - b) for a, b in zip(native[name], live_values)) / peak
        worst = max(worst, error)
        check(error < (10 * limit if name.startswith("acceleration") else limit), f"{what}: {name} differs by {error:.2e} of its peak")
    print(f"{what}: within {worst:.1e} of the peaks, {browser.run('window.rigcalLive.answer.milliseconds'):.0f} ms")


def table_of_levels(browser, rigcal, campaign):
    """Checks that the live table of leak levels has the numbers from `leak-table`, and follows values and drive."""
    run(rigcal, "leak-table", campaign.name, "--out", "table", "--quiet", cwd=campaign.parent)
    rows = json.loads((campaign.parent / "table" / "leak_table.json").read_text())["features"]
    browser.wait_for("window.rigcalLive.levels !== undefined", "no numbers of the leak levels")
    live = browser.run("window.rigcalLive.levels")
    check([each["name"] for each in live] == [row["level"] for row in rows], f"levels {live}")
    for each, row in zip(live, rows):
        for name, value, native in (("servo flow", each["servo"] * 60e3, row["servo_flow_l_per_min"]),
                                    ("leak flow", each["leak"] * 60e3, row["leak_flow_l_per_min"]),
                                    *((name, each[name], row[name]) for name in ("mean", "rms", "std"))):
            check(abs(value - native) < 1e-3 * native, f"{name} of {row['level']}: {value}, leak-table has {native}")
    shown = "[...document.querySelectorAll('#live-table tbody tr')].map((row) => row.innerText)"
    printed = browser.run(shown)
    check("2.07" in printed[1] and "2.0887" in printed[1] and "9.77 %" in printed[1] and "0.022 *" in printed[1], printed)
    # A click selects a level, a changed value updates the table, and another drive has no published numbers.
    moved(browser, "document.querySelector('#live-table [data-level=\"3\"]').click()")
    check(browser.run("document.getElementById('live-of-leakage_coefficient').value") == "0.6", "the level of a row")
    check(browser.run("document.querySelector('#live-table tr.chosen button').textContent") == "Critical", "the chosen row")
    moved(browser, type_in("kp", 60))
    browser.wait_for(f"{shown}[1].includes('9.77') === false", "the table does not follow the gain")
    moved(browser, type_in("frequency", 0.2))
    browser.wait_for(f"!{shown}[1].includes('2.0887')", "published numbers of another drive")
    peaks = ("(() => { const chart = [...document.querySelectorAll('figure.made')].filter((each) => /each leak level/.test(each.textContent));"
             " return chart.length; })()")
    check(browser.run(peaks) == 2, "figures of the levels")
    moved(browser, "document.getElementById('live-reset').click()")


def the_papers_rig(rigcal, sources, folder):
    campaign = folder / "campaign.toml"
    campaign.write_text((sources / "datasets/rigs/uis_shake_table/campaign.toml").read_text())
    run(rigcal, "explore", "campaign.toml", "--out", "page", "--quiet", cwd=folder)
    page = folder / "page" / "explore.html"
    text = page.read_text()
    module = base64.b64decode(re.search(r'id="live-module">([^<]*)<', text)[1])
    check(len(module) < 300_000 and gzip.decompress(module).startswith(b"\0asm"), f"the module: {len(module)} bytes")
    with Browser(1440, 1000) as browser:
        browser.open(page)
        simulated(browser)
        table_of_levels(browser, rigcal, campaign)
        moved(browser, "location.hash = '#duration=10&frequency=1'")
        milliseconds = []
        for mass in (80, 85, 90, 95, 100):
            browser.run("""(() => { const {drawn} = window.rigcalLive; const start = performance.now(); window.waited = undefined;
                const look = () => { if (window.rigcalLive.drawn > drawn) window.waited = performance.now() - start; else setTimeout(look); };
                look(); })()""")
            moved(browser, type_in("mass", mass))
            browser.wait_for("window.waited !== undefined", "nothing is drawn")
            milliseconds.append(browser.run("window.waited"))
        print(f"10 s of the paper's rig are drawn after {sorted(milliseconds)[2]:.0f} ms, the median of {len(milliseconds)} masses")
        moved(browser, "document.getElementById('live-reset').click()")
        # The address contains the tolerance, like every other difference.
        browser.run("location.hash = '#tolerance=1e-9&duration=10&frequency=1'")
        browser.wait_for("window.rigcalLive.request.tolerance === 1e-9", "the address changes nothing")
        campaign.write_text(campaign.read_text() + "\n[simulation]\ntolerance = 1e-9\n")
        compare(browser, rigcal, campaign, "a sine")
        moved(browser, "document.querySelectorAll('#live-presets button')[3].click()")
        check(browser.run("document.querySelector('#live-presets button[aria-pressed=true]').textContent") == "Critical", "the button of a level")
        moved(browser, type_in("mass", 120))
        moved(browser, type_in("kp", 60))
        compare(browser, rigcal, campaign, "mass, gain and leak")
        moved(browser, "(() => { const s = document.getElementById('live-waveform'); s.value = 'square'; s.dispatchEvent(new Event('change')); })()")
        compare(browser, rigcal, campaign, "a square")
        browser.wait_for("location.hash.includes('mass=120')", "the mass in the address")
        # A fraction sets the coefficient, and that coefficient gives the fraction.
        moved(browser, "(() => { const f = document.getElementById('live-fraction'); f.value = 20; f.dispatchEvent(new Event('change')); })()")
        browser.wait_for("Math.abs(window.rigcalLive.answer.flows.fraction - 0.2) < 1e-4", "20 % of the servo flow")
        # The page reports a rig that cannot be simulated; the next valid value recovers it.
        browser.run(type_in("mass", -1))
        check(browser.run("document.getElementById('live-of-mass').checkValidity()") is False, "a negative mass is taken")
        moved(browser, "document.getElementById('live-reset').click()")
        check(browser.run("document.getElementById('live-problem').hidden"), "a problem is left")
        # Every field has a label, and assistive technology gets the numbers.
        unnamed = browser.run("[...document.querySelectorAll('#live input, #live select')].filter((n) => !n.labels.length && !n.getAttribute('aria-label')).length")
        check(unnamed == 0, f"{unnamed} fields without a name")
        browser.wait_for("document.getElementById('live-said').textContent.includes('Servo flow')", "nothing is said")
        check(browser.run("document.documentElement.scrollWidth <= innerWidth"), "wider than the window")
        browser.size(400)
        browser.wait_for("innerWidth === 400 && document.documentElement.scrollWidth <= 400", "as narrow as a telephone")
        check(not browser.problems, browser.problems)
        asked = [url for url in browser.requests if not url.startswith(("file:", "blob:", "data:"))]
        check(not asked, f"asks for {asked}")
    still = re.findall(r'<figure class="plot still">.*?<svg', text, re.DOTALL)
    check(len(still) == 2, f"{len(still)} still pictures")


def a_rig_with_everything(rigcal, folder):
    campaign = folder / "two.toml"
    campaign.write_text(TWO_CHAMBER)
    run(rigcal, "explore", "two.toml", "--out", "two", "--quiet", cwd=folder)
    with Browser(1280, 900) as browser:
        browser.open(folder / "two" / "explore.html")
        simulated(browser)
        check(browser.run("document.querySelector('h1').textContent") == '</script><b>rig</b> & "more"', "the name")
        compare(browser, rigcal, campaign, "two chambers, chirp")
        moved(browser, "(() => { const s = document.getElementById('live-case'); s.value = 'square'; s.dispatchEvent(new Event('change')); })()")
        compare(browser, rigcal, campaign, "two chambers, square")
        check(not browser.problems, browser.problems)


def exact(campaign, folder, recordings):
    """Returns a copy of the campaign beside links to its recordings. Simulates at a tolerance of 1e-9."""
    text = re.sub(r"(?m)^tolerance *=.*$", "", campaign.read_text())
    text = text.replace("[simulation]", "[simulation]\ntolerance = 1e-9") if "[simulation]" in text else text + "\n[simulation]\ntolerance = 1e-9\n"
    folder.mkdir(parents=True)
    copy = folder / "campaign.toml"
    copy.write_text(text)
    for path in recordings.iterdir() if recordings else []:
        if not (folder / path.name).exists():
            (folder / path.name).symlink_to(path)
    return copy


def a_rig_that_is_shaken(rigcal, folder):
    """Checks recorded inputs beside the drive: the acceleration of the base and the temperature of the oil."""
    rows = ["t,u,x,a,T"]
    for i in range(601):
        t = i / 200
        rows.append(f"{t},{2 * math.sin(6 * t):.6f},0,{3 * math.sin(25 * t):.6f},{30 + 8 * t:.4f}")
    (folder / "shaken.csv").write_text("\n".join(rows) + "\n")
    text = TWO_CHAMBER.split("[[condition]]")[0].replace('"x", unit = "mm" }', """"x", unit = "mm" }
command = { column = "u", unit = "V" }
base_acceleration = { column = "a", unit = "m/s2" }
temperature = { column = "T", unit = "degC", role = "input" }""")
    text = re.sub(r"\[rig.controller\].*?(?=\[simulation\])", '[rig.controller]\ntype = "none"\n', text, flags=re.DOTALL)
    text = text.replace('mass = {', """reference_temperature = "40 degC"
viscosity_decay = "0.03 1/K"
thermal_expansion = "7e-4 1/K"
bulk_modulus_decay = "5.5e-3 1/K"
laminar_leakage = "1e-11 m3/(s Pa)"
mass = {""")
    campaign = folder / "shaken.toml"
    campaign.write_text(text + """[[condition]]
id = "shaken"
waveform = "recorded"
use = "diagnose"
leak_level = "half"
repeats = ["shaken.csv"]
""")
    run(rigcal, "explore", "shaken.toml", "--out", "shaken", "--quiet", cwd=folder)
    with Browser(1280, 900) as browser:
        browser.open(folder / "shaken" / "explore.html")
        simulated(browser)
        for name in ("base", "temperature"):
            check(browser.run(f"window.rigcalLive.request.{name}?.values.length") == 601, f"no {name} among the inputs")
        compare(browser, rigcal, campaign, "a base that moves, oil that warms", 1e-5)
        check(not browser.problems, browser.problems)


def shipped_rigs(rigcal, sources, folder):
    """Checks every shipped rig whose recordings are here. What sliders change is checked with other rigs."""
    with Browser() as browser:
        for file in sorted((sources / "datasets/rigs").glob("*/*.toml")):
            rig = f"{file.parent.name}/{file.stem}"
            copy = folder / "shipped" / rig
            recordings = next((path for path in (sources.parent / "shared/data").glob("*") if path.name.startswith(file.parent.name.split("_")[0])), None)
            campaign = exact(file, copy, recordings)
            made = subprocess.run([rigcal, "explore", "campaign.toml", "--out", "page", "--quiet"], cwd=copy, capture_output=True, text=True, check=False)
            if made.returncode == 2 and ("no file matches" in made.stderr or "of the rig is unknown" in made.stderr):
                print(f"{rig}: skipped: {made.stderr.strip()[-120:]}")
                continue
            check(made.returncode == 0, f"{rig}: {made.stderr}")
            browser.open(copy / "page" / "explore.html")
            simulated(browser)
            # Processors differ in their steps. On one of them errors reach 7e-7.
            compare(browser, rigcal, campaign, rig, 1e-5)
            check(not browser.problems, f"{rig}: {browser.problems}")


def scores_agree(browser, result, what):
    """Checks that the curves of every condition have the scores of the result. Returns how many were compared, their largest
    difference, and the scores of the last condition with its name."""
    scored = {each["id"]: each["metrics"] for each in result["conditions"] if each["metrics"]}
    worst, compared, names = 0.0, 0, browser.run("window.rigcalLive.rig.cases.map((each) => each.name)")
    check(set(names) == set(scored), f"{what}: cases {names}, scored {list(scored)}")
    for name in names:
        if len(names) > 1:
            browser.run(f"location.hash = '#live&case=' + encodeURIComponent({json.dumps(name)})")
        browser.wait_for(f"window.rigcalLive.of === {json.dumps(name)}", f"{what}: no curves of {name}")
        every = browser.run(f"window.rigcalLive.rig.cases.find((each) => each.name === {json.dumps(name)}).every")
        scores = browser.run("window.rigcalLive.scores")
        check(scores, f"{what}: no scores of {name}")
        for channel, metrics in scores.items():
            if every > 1:
                check("approximate" in browser.run("document.getElementById('live-scores').textContent"), f"{what}: {name} is thinned in silence")
                continue
            for metric, unit in (("rho2", 1), ("r", 1), ("ccc", 1), ("absolute_error_percent", 100)):
                error = abs(metrics[metric] - scored[name][channel][metric]) / unit
                worst = max(worst, error)
                compared += 1
                check(error < 1e-6, f"{what}: {metric} of {channel} of {name} differs by {error:.1e}")
    check(compared > 0, f"{what}: nothing was compared")
    return compared, worst, scores, name


def the_fitted_rig(rigcal, campaign, folder, what, recordings):
    """Checks the page of the fit in folder/fit: at the estimates its curves have the scores in fit.json and are those that
    `simulate` writes, and they follow a slider."""
    fit_folder = folder / "fit"
    fit = json.loads((fit_folder / "fit.json").read_text())
    with Browser(1440, 1000) as browser:
        browser.open(fit_folder / "report.html")
        check(browser.run("window.rigcalLive === undefined"), f"{what}: the model runs before it is looked at")
        browser.run("document.getElementById('try').scrollIntoView()")
        simulated(browser)
        compared, worst, scores, name = scores_agree(browser, fit, what)
        first = next(p for p in fit["parameters"] if p["fitted"] and not p["nuisance"] and p["ci95"] and p["scope"] == "rig")
        check(browser.run("document.querySelectorAll('#live .interval').length") > 0, f"{what}: no interval of an estimate")
        moved(browser, f"""(() => {{ const field = document.getElementById('live-of-{first["key"]}'); field.value = 0.5 * (+field.value + +field.min);
            field.dispatchEvent(new Event('input')); }})()""")
        changed = browser.run("window.rigcalLive.scores")
        check(changed != scores, f"{what}: the scores do not follow {first['key']}")
        moved(browser, "document.getElementById('live-reset').click()")
        check(browser.run("window.rigcalLive.scores") == scores, f"{what}: a reset does not lead back")
        milliseconds = browser.run("window.rigcalLive.answer.milliseconds")
        browser.run(f"location.hash = '#live&tolerance=1e-9&case=' + encodeURIComponent({json.dumps(name)})")
        browser.wait_for("window.rigcalLive.request.tolerance === 1e-9", f"{what}: the address changes nothing")
        compare(browser, rigcal, exact(campaign, folder / "exact", recordings), f"{what}, {name}, at the estimates")
        browser.size(400)
        browser.wait_for("innerWidth === 400 && document.documentElement.scrollWidth <= 400", f"{what}: as narrow as a telephone")
        check(not browser.problems, browser.problems)
        asked = [url for url in browser.requests if not url.startswith(("file:", "blob:", "data:"))]
        check(not asked, f"asks for {asked}")
    print(f"{what}: {compared} scores within {worst:.1e}, {milliseconds:.0f} ms")


def fitted_rigs(rigcal, sources, folder):
    data = folder / "known"
    run(rigcal, "synthesize", sources / "docs/tutorial/known_rig.toml", "--seed", "1", "--out", data, "--quiet", cwd=folder)
    run(rigcal, "fit", data / "campaign.toml", "--out", folder / "known" / "fit", "--quiet", "--force", cwd=folder)
    the_fitted_rig(rigcal, data / "campaign.toml", folder / "known", "the tutorial's rig", data)
    fit = folder / "known" / "fit"
    validation = folder / "known" / "validation"
    run(rigcal, "validate", data / "campaign.toml", "--fit", fit / "fit.json", "--out", validation, "--quiet", cwd=folder)
    with Browser() as browser:
        browser.open(validation / "report.html")
        browser.run("document.getElementById('try').scrollIntoView()")
        simulated(browser)
        scores_agree(browser, json.loads((validation / "validation.json").read_text()), "the validated rig")
    text, result = (fit / "report.html").read_text(), json.loads((fit / "fit.json").read_text())

    def replace_live(content):
        """Replaces the content of live.json, and its hash."""
        (fit / "live.json").write_text(content)
        named = next(each for each in result["provenance"]["files"] if each["path"] == "live.json")
        named["sha256"] = hashlib.sha256(content.encode()).hexdigest()
        (fit / "fit.json").write_text(json.dumps(result))

    hostile = json.loads((fit / "live.json").read_text())
    hostile["name"] = "</script><script>window.injected = true</script>"
    replace_live(json.dumps(hostile))
    run(rigcal, "report", fit, "--force", "--quiet", cwd=folder)
    check(text.count("<script") == (fit / "report.html").read_text().count("<script"), "a name in live.json is markup")
    replace_live("{")
    done = run(rigcal, "report", fit, "--force", cwd=folder, code=2)
    check("live.json" in done.stderr, done.stderr)
    (fit / "live.json").write_text("{}")  # from another run
    done = run(rigcal, "report", fit, "--force", cwd=folder, code=2)
    check("live.json" in done.stderr, done.stderr)
    runs = Runs()
    for name, rig in (("utfsm", "utfsm_mts"), ("festo", "festo_tp511")):
        try:
            shutil.copytree(runs.make(name), folder / name / "fit")
        except Absent as reason:
            print(f"skipped: {reason}")
            continue
        the_fitted_rig(rigcal, sources / "datasets" / "rigs" / rig / "campaign.toml", folder / name, rig, runs.recordings(RUNS[name]))


def leaking_rigs(rigcal, sources, folder):
    """Checks the pages of a diagnosis and a leak table: the rig starts at the leak found, or the smallest published."""
    made = folder / "leaks"
    run(rigcal, "synthesize", sources / "datasets/rigs/uis_shake_table/diagnosis.toml", "--seed", "1", "--out", made, "--quiet", cwd=folder)
    campaign = made / "campaign.toml"
    run(rigcal, "fit", campaign, "--out", made / "fit", "--quiet", cwd=folder)
    run(rigcal, "diagnose", campaign, "--fit", made / "fit" / "fit.json", "--out", made / "diagnosis", "--quiet", cwd=folder)
    records = json.loads((made / "diagnosis" / "diagnosis.json").read_text())["records"]
    largest = max((each for each in records if each["repeat"] is None and not each["is_reference"]), key=lambda each: each["leakage_coefficient"])
    campaign.write_text(campaign.read_text() + "\n[simulation]\ntolerance = 1e-9\n")
    run(rigcal, "leak-table", campaign, "--fit", made / "fit" / "fit.json", "--out", made / "table", "--quiet", cwd=folder)
    for what, leak in (("diagnosis", largest["leakage_coefficient"]), ("table", None)):
        with Browser() as browser:
            browser.open(made / what / "report.html")
            browser.run("document.getElementById('try').scrollIntoView()")
            simulated(browser)
            if leak is not None:
                shown = float(browser.run("document.getElementById('live-of-leakage_coefficient').value"))
                check(abs(shown - leak) < 1e-5 * leak, f"{what}: the leak {shown} of the page, {leak} of the result")
                check(largest["condition"] in browser.run("document.getElementById('try').innerText"), f"{what}: the largest leak is first")
                rho2 = browser.run("window.rigcalLive.scores.position.rho2")
                check(rho2 > 0.999, f"{what}: the leak explains its record, rho2 {rho2}")
            else:
                compare(browser, rigcal, campaign, "the page of a leak table")
            check(not browser.problems, f"{what}: {browser.problems}")


def wrong_input(rigcal, folder):
    broken = folder / "broken.toml"
    broken.write_text(TWO_CHAMBER.replace('mass = { start = "60 kg", lower = "10 kg", upper = "500 kg", fit = true }\n', ""))
    done = run(rigcal, "explore", "broken.toml", "--out", "none", cwd=folder, code=2)
    check("mass" in done.stderr and "broken.toml:" in done.stderr, done.stderr)
    check(not (folder / "none").exists(), "a folder is left")
    stuck = folder / "stuck.toml"
    stuck.write_text(TWO_CHAMBER.replace("tolerance = 1e-9", 'tolerance = 1e-9\nmax_seconds = "1 us"'))
    done = subprocess.run([rigcal, "explore", "stuck.toml", "--out", "none"], cwd=folder, capture_output=True, text=True, check=False)
    check(done.returncode == 2 and "stuck.toml" in done.stderr, done.stderr)


def main():
    rigcal, sources = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    os.environ["RIGCAL"] = str(rigcal)  # for Runs
    if "no live pages" in subprocess.run([rigcal, "--version"], capture_output=True, text=True, check=True).stdout:
        print("skipped: this program was built without the model for pages")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        wrong_input(rigcal, folder)
        if chromium() is None:
            print("skipped: no browser")
            return 77
        the_papers_rig(rigcal, sources, folder)
        a_rig_with_everything(rigcal, folder)
        a_rig_that_is_shaken(rigcal, folder)
        shipped_rigs(rigcal, sources, folder)
        fitted_rigs(rigcal, sources, folder)
        leaking_rigs(rigcal, sources, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())

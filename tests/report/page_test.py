#!/usr/bin/env python3
"""Opens reports in headless Chromium as a reader would. usage: page_test.py RIGCAL SOURCES
Exit code 77: there is no browser."""

import collections
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from browser import Browser, chromium

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from runs import Absent, Runs  # noqa: E402

SECTIONS = ["verdict", "assessment", "matrix", "parameters", "conditions", "identifiability", "starts", "warnings", "provenance",
            "formulas"]

AXE = pathlib.Path(__file__).resolve().parents[2] / "node_modules" / "axe-core" / "axe.min.js"

# Names that would do harm if a page interpreted them as anything but text.
NAME = "<script>alert(1)</script> \"quoted\" 'rig' & \u00fcber \u2192\nnext {{line}}"
LEVEL = "<img src=x onerror=alert(2)>"

CAMPAIGN = f"""schema = "rigcal.campaign/1"
name = {json.dumps(NAME)}
[rig]
model = "load_pressure"
[rig.parameters]
supply_pressure = "6.2 MPa"
mass = "60 kg"
damping = {{ start = "2000 N s/m", lower = "10 N s/m", upper = "1e5 N s/m", fit = true }}
valve_gain = {{ start = "2e-5 m/V", lower = "1e-6 m/V", upper = "1e-3 m/V", fit = true }}
leakage_coefficient = 0.3
stiffness = "0 N/m"
piston_area = "633 mm2"
total_volume = "468 cm3"
density = "850 kg/m3"
bulk_modulus = "689 MPa"
discharge_coefficient = 0.6
area_gradient = "20 mm"
leakage_area = "1 mm2"
[rig.controller]
type = "pid"
kp = "1000 V/m"
[leak_level.{json.dumps(LEVEL)}]
[recording.channels]
time = {{ column = "t_s", unit = "s" }}
reference = {{ column = "ref_mm", unit = "mm" }}
position = {{ column = "x_mm", unit = "mm" }}
load_pressure = {{ column = "pl_bar", unit = "bar" }}
[report]
number = "2026-7"
issued = 2026-03-02
operator = "O. Perator"
approver = "A. Head"
[acceptance]
rho2 = 0.9
warn_rho2 = 0.95
not_judged = ["load_pressure"]
[[condition]]
id = "sine"
waveform = "sine"
frequency = "2 Hz"
amplitude = "5 mm"
leak_level = {json.dumps(LEVEL)}
use = "fit"
repeats = ["records/sine_*.csv"]
[[condition]]
id = "square"
waveform = "square"
frequency = "1 Hz"
amplitude = "4 mm"
leak_level = {json.dumps(LEVEL)}
use = "validate"
repeats = ["records/square_*.csv"]
[synthetic]
parameters = {{ damping = "1000 N s/m", valve_gain = "3e-5 m/V" }}
repeats = 3
duration = "2 s"
sample_rate = "200 Hz"
noise = {{ position = "0.01 mm", load_pressure = "0.05 bar" }}
"""


def check(holds, what):
    if not holds:
        raise AssertionError(what)


def rigcal(binary, folder, *arguments):
    return subprocess.run([binary, *arguments, "--quiet"], cwd=folder, check=False).returncode


def values(page, selector):
    """Returns the exact numbers that the page contains beside the shown text."""
    return page.run(f"[...document.querySelectorAll({json.dumps(selector)})].map(d => d.value)")


def check_sections(page, sections=SECTIONS):
    found = page.run("[...document.querySelectorAll('main > section:not(#try)')].map(s => s.id)")
    check(found == sections, f"sections in their order: {found}")
    check(page.run("document.querySelectorAll('main h1, main > section:not(#verdict):not(#try) > h2').length") == len(sections),
          "a title each")
    lost = page.run("[...document.querySelectorAll('a[href^=\"#\"]')].map(a => a.getAttribute('href').slice(1))"
                    ".filter(id => !id.startsWith('live&') && !document.getElementById(id))")
    check(not lost, f"links that lead nowhere: {lost}")
    check_access(page)


def check_access(page):
    """Checks the data for screen readers: captions, scopes, names of pictures and of focusable elements."""
    missing = page.run("""[
      ...[...document.querySelectorAll('table')].filter(t => !t.closest('.uplot') && !t.caption?.textContent.trim()),
      ...[...document.querySelectorAll('th')].filter(h => !h.closest('.uplot') && !h.scope),
      ...[...document.querySelectorAll('svg')].filter(s => s.getAttribute('role') !== 'img'
                                                           || !s.querySelector('title')?.textContent),
      ...[...document.querySelectorAll('[tabindex]')].filter(e => !e.getAttribute('aria-label')),
    ].map(e => e.outerHTML.slice(0, 100))""")
    check(not missing, f"nothing to tell a screen reader: {missing}")
    check_axe(page)


def check_axe(page):
    """Checks that axe-core finds no violation of WCAG 2.2 AA, light and dark, with everything unfolded and drawn."""
    closed = "document.querySelectorAll('details:not([open])')"
    page.run(f"window.were_closed = [...{closed}]; were_closed.forEach(d => {{ d.open = true; }})")
    page.run(AXE.read_text() + "; 1")
    for dark in (False, True):
        page.dark(dark)
        page.run("""window.violations = null;
          axe.run(document, {runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa'], resultTypes: ['violations']})
             .then(({violations}) => { window.violations = violations.map(v => [v.id, v.nodes.length, v.nodes[0].html.slice(0, 200)]); })
             .catch(error => { window.violations = [String(error)]; })""")
        page.wait_for("window.violations !== null", "axe-core ends")
        violations = page.run("window.violations")
        check(not violations, f"{'dark' if dark else 'light'}: axe-core finds {violations}")
    page.dark(False)
    page.run("were_closed.forEach(d => { d.open = false; })")


def check_widths(page):
    for width in (1280, 400):
        page.size(width)
        page.wait_for(f"document.documentElement.scrollWidth <= {width}", f"no sideways scroll at {width}")
    check_paper(page)


def check_paper(page):
    """Checks that nothing is cut off at the right edge of an A4 sheet: the words of every table are printed, but for those that
    would fill sheets of their own and are meant for the screen."""
    if shutil.which("pdftotext") is None:
        return
    margin = 595.28 - 14 / 25.4 * 72 + 0.5  # in points; half a point for digits, whose boxes are wider than their ink
    # pdftotext adds the advances of a word's letters without kerning, which says up to 2 % too much.
    unkerned = 0.03
    with tempfile.NamedTemporaryFile(suffix=".pdf") as sheet:
        page.pdf(sheet.name)
        boxes = subprocess.run(["pdftotext", "-bbox", sheet.name, "-"], capture_output=True, check=True).stdout.decode()
    words = re.findall(r'<word [^>]*xMin="([0-9.]+)"[^>]*xMax="([0-9.]+)"[^>]*>([^<]*)<', boxes)
    check(words, "there are words on paper")
    beyond = [word for left, right, word in words if float(right) - unkerned * (float(right) - float(left)) > margin]
    check(not beyond, f"beyond the margin: {beyond[:5]}")
    printed = collections.Counter(word for *_, word in words)
    page.run("document.querySelectorAll('details').forEach(d => { d.open = true; })")
    rows = page.run("[...document.querySelectorAll('main tbody')].filter(b => !b.closest('.uplot, #try, .screen'))"
                    ".map(b => b.innerText).join(' ')")
    symbols = page.run("[...document.querySelectorAll('main tbody var')].map(v => v.textContent)")  # letter and subscript are two words
    # Only plain words, because longer texts may be broken across lines.
    shown = collections.Counter(word for word in rows.split() if re.fullmatch("[a-z]{4,12}", word) and word not in symbols)
    lost = {word: count for word, count in shown.items() if printed[word] < count}
    check(not lost, f"in tables, but not on paper: {lost}")


def check_narrow(page):
    """Checks that a phone shows every estimate with its interval and its grade, without scrolling sideways."""
    page.size(400)
    page.wait_for("innerWidth === 400", "400 px")
    rows = page.run("""[...document.querySelectorAll('.parameters tbody tr:not(.note)')].map(row => {
      const label = name => row.querySelector(`td[data-label="${name}"]`);
      return ['Value', '95 % interval', 'Identified?'].map(name => {
        const box = label(name).getBoundingClientRect();
        return [box.width > 0 && box.height > 0 && box.left >= 0 && box.right <= 400, label(name).innerText.trim()];
      });
    })""")
    check(rows, "estimates")
    for row in rows:
        check(all(there and text for there, text in row), f"at 400 px: {row}")
    hidden = page.run("[...document.querySelectorAll('.parameters')].filter(t => t.closest('.scroll').scrollWidth > "
                      "t.closest('.scroll').clientWidth).length")
    check(hidden == 0, "nothing of the parameters is beside the screen")
    page.size(1280)


def check_agreement(page, channels):
    """Checks the folded figures: parity, histogram and, for a sine and a square, gain and phase."""
    page.run("document.querySelectorAll('details.agreement').forEach(d => { d.open = true; })")
    titles = page.run("[...document.querySelectorAll('details.agreement svg title')].map(t => t.textContent)")
    for what in ("model against measured", "histogram and normal density", "gain of ", "phase of "):
        count = sum(what in title for title in titles)
        check(count == channels, f"{what}: {count} of {channels} figures")
    drawn = page.run("[...document.querySelectorAll('details.agreement svg')].every(s => "
                     "s.getBoundingClientRect().width > 200 && s.querySelectorAll('path').length > 3)")
    check(drawn, "every figure is drawn")
    page.run("document.querySelectorAll('details.agreement').forEach(d => { d.open = false; })")


def printed(page, folder):
    """Returns the text of the printed page, or None if nothing can read it."""
    if shutil.which("pdftotext") is None:
        return None
    page.pdf(folder / "page.pdf")
    return subprocess.run(["pdftotext", "-layout", folder / "page.pdf", "-"], capture_output=True, check=True).stdout.decode()


def check_printed(page, folder, words):
    """Checks that the printed page contains these words, whatever the screen shows."""
    text = printed(page, folder)
    for word in words if text is not None else []:
        check(word in text, f"on paper: {word}")


def check_first_sheet(page, folder):
    """Checks that the signed part is on the first page and that the foot of every page names the report."""
    text = printed(page, folder)
    if text is None:
        return
    sheets = text.split("\f")[:-1]
    for word in ("PASS", "expanded uncertainty U", "Measured − model", "Why this verdict", "Decision rule", "SHA-256",
                 "Approved by A. Head", "Date"):
        check(re.sub(r"\s+", " ", word).lower() in re.sub(r"\s+", " ", sheets[0]).lower(), f"on the first sheet: {word}")
    for number, sheet in enumerate(sheets, 1):
        foot = " ".join(sheet.split("\n")[-4:])
        for word in ("2026-7", "PASS", "issued 2026-03-02", "SHA-256 of fit.json", f"page {number} of {len(sheets)}"):
            check(word in foot, f"at the foot of sheet {number}: {word} ({foot})")


def check_numbers(page, result):
    shown = [float(v) for v in values(page, ".parameters td[data-label=Value] data")]
    fitted = [p["value"] for p in result["parameters"] if p["fitted"]]
    check(shown == fitted, f"parameters {shown} are those of fit.json {fitted}")
    channels = {channel for condition in result["conditions"] for channel in condition["metrics"]}
    check("position" in channels, f"channels {channels}")
    for channel in sorted(channels):
        shown = sorted(float(v) for v in values(page, f"#matrix [aria-label='Scores of {channel}'] .cell > data"))
        stored = sorted(c["metrics"][channel]["rho2"] for c in result["conditions"] if channel in c["metrics"])
        check(shown == stored, f"rho2 of {channel}: {shown}, {stored}")


def check_cells(page):
    """Checks that a cell of the matrix links to its condition."""
    page.run("document.querySelector('a.cell[title=square]').click()")
    page.wait_for("location.hash === '#condition-square'", "the cell's address")
    page.wait_for("(r => r.top > -5 && r.top < innerHeight)(document.getElementById('condition-square')"
                  ".getBoundingClientRect())", "the condition is in view")


def check_zoom(page):
    """Checks that dragging across a plot, or the keyboard, zooms it and the plots beside it; 0 shows everything."""
    figure = "document.querySelector('#condition-sine figure.plot')"
    page.run(f"{figure}.scrollIntoView()")
    page.wait_for("document.querySelectorAll('#condition-sine figure.live').length >= 2", "two plots are live")
    axis = "[...document.querySelectorAll('#condition-sine .u-legend tr:first-child .u-value')]"
    check(page.run(f"{axis}.length") >= 2, "legends")
    box = page.run(f"(r => [r.x, r.y, r.width, r.height])({figure}.querySelector('.u-over').getBoundingClientRect())")
    span = ("[...%s.querySelector('canvas').toDataURL()].reduce((s, c) => (s * 31 + c.charCodeAt()) | 0, 7)")
    before = page.run(span % figure)
    second = "document.querySelectorAll('#condition-sine figure.plot')[1]"
    before_second = page.run(span % second)
    page.drag(box[0] + 0.3 * box[2], box[0] + 0.6 * box[2], box[1] + 0.5 * box[3])
    page.wait_for(f"{span % figure} !== {before}", "a drag zooms")
    page.wait_for(f"{span % second} !== {before_second}", "the plot beside it follows")
    page.run(f"{figure}.focus()")
    zoomed = page.run(span % figure)
    page.key("+")
    page.wait_for(f"{span % figure} !== {zoomed}", "plus zooms further")
    page.key("0")
    page.wait_for(f"{span % second} === {before_second}", "0 shows all again")


def check_quiet(page, path):
    check(not page.problems, f"the browser complains: {page.problems}")
    outside = [u for u in page.requests if not u.startswith(("data:", "blob:")) and not u.endswith(path.name)]
    check(not outside, f"the page asks for {outside}")
    check(len([u for u in page.requests if u.endswith(path.name)]) >= 1, "the page itself was seen")


def check_good(binary, work):
    check(rigcal(binary, work, "fit", "twin/campaign.toml", "--out", "good") == 0, "the fit is good")
    path = work / "good" / "report.html"
    result = json.loads((work / "good" / "fit.json").read_text())
    with Browser() as page:
        page.open(path)
        check(page.run("document.querySelector('.verdict .word').textContent").split()[-1] == "PASS", "PASS")
        check(page.run("document.querySelector('h1').textContent") == "Calibration of " + result["campaign"],
              "the name is text")
        check(NAME in result["campaign"], "the name is whole")
        check(page.run("document.querySelectorAll('main img').length") == 0, "a level is text")
        check_sections(page)
        check_numbers(page, result)
        check_cells(page)
        check_zoom(page)
        check_agreement(page, sum(len(c["metrics"]) for c in result["conditions"]))
        check_narrow(page)
        check_widths(page)
        # Content that is folded on a screen is unfolded on paper, and its text can be found.
        page.run("document.querySelectorAll('details').forEach(d => { d.open = false; })")
        check_printed(page, work, ["PASS", "Known values", "Residual tests", "How each number is computed",
                                   "model = measured", "measured [mm]", "95 % prediction", "phase [°]"])
        check_first_sheet(page, work)
        check_quiet(page, path)


def check_many(binary, work):
    """Checks that only the worst of many conditions are shown in full. Others are drawn when opened, here by a link."""
    campaign = (work / "twin" / "campaign.toml").read_text()
    head, sine, square = campaign.split("[[condition]]\n")
    copies = [sine.replace('id = "sine"', f'id = "s{i}"') for i in range(90)]
    (work / "twin" / "many.toml").write_text("[[condition]]\n".join([head, *copies, square]))
    check(rigcal(binary, work, "fit", "twin/many.toml", "--out", "many") == 0, "the fit of many is good")
    path = work / "many" / "report.html"
    with Browser() as page:
        page.open(path)
        check_sections(page)
        check(page.run("[document.querySelectorAll('article.condition').length, document.querySelectorAll('.sketch').length]") == [20, 71],
              "twenty are shown in full, the others in one line each")
        # The last condition is in the second compressed stream.
        last = page.run("[...document.querySelectorAll('.sketch')].pop().id")
        page.run(f"location.hash = '#{last}'")
        line = f"document.getElementById('{last}')"
        page.wait_for(f"{line}.querySelectorAll('figure.live').length === 4", "its two channels and their residuals are drawn")
        check(last.removeprefix("condition-") in page.run(f"{line}.textContent"), "it names its file")
        check(page.run(f"{line}.querySelector('.plot').ariaLabel").startswith("position, measured and model: largest"), "its label")
        page.run(f"{line}.open = false")
        page.run(f"{line}.open = true")
        check(page.run(f"{line}.querySelectorAll('figure').length") == 4, "it is drawn once")
        check_printed(page, work, ["The other 71 conditions", last.removeprefix("condition-")])
        check_widths(page)
        check_quiet(page, path)


def check_sheets(binary, work, sources):
    """Checks that a page of 24 conditions prints on at most 15 sheets, with four conditions on one."""
    rig = sources / "datasets" / "rigs" / "uis_shake_table" / "campaign.toml"
    check(rigcal(binary, work, "synthesize", str(rig), "--seed", "1", "--out", "six_signals") == 0, "six signals at four leaks")
    check(rigcal(binary, work, "fit", "six_signals/campaign.toml", "--out", "sheets") == 0, "their fit is good")
    with Browser() as page:
        page.open(work / "sheets" / "report.html")
        text = printed(page, work)
        if text is None:
            return
        sheets = text.split("\f")[:-1]
        conditions = [sheet.count("Residual tests: position") for sheet in sheets]
        check(sum(conditions) == 24 and max(conditions) == 4, f"four conditions on a sheet: {conditions}")
        check(len(sheets) <= 15, f"24 conditions on {len(sheets)} sheets")


def check_bad(binary, work):
    """Checks that a failed and a poor result are marked as such at the top."""
    campaign = (work / "twin" / "campaign.toml").read_text()
    (work / "twin" / "hopeless.toml").write_text(campaign + "\n[simulation]\nmax_seconds = 1e-6\n")
    check(rigcal(binary, work, "fit", "twin/hopeless.toml", "--out", "failed") == 3, "the fit fails")
    wrong = ["--set", "valve_gain=1e-6 m/V", "--set", "damping=90000 N s/m"]
    check(rigcal(binary, work, "validate", "twin/campaign.toml", "--out", "poor", *wrong) == 1, "the model is wrong")
    unjudged = campaign.replace("[acceptance]", "").replace("warn_rho2 = 0.95", "").replace("rho2 = 0.9", "").replace('not_judged = ["load_pressure"]', "")
    (work / "twin" / "unjudged.toml").write_text(unjudged)
    check(rigcal(binary, work, "validate", "twin/unjudged.toml", "--out", "unjudged", *wrong) == 0, "not judged")
    for folder, word in (("failed", "FAILED"), ("poor", "FAIL"), ("unjudged", "POOR")):
        path = work / folder / "report.html"
        with Browser() as page:
            page.open(path)
            check(page.run("document.title").startswith(word + " "), f"{folder}: title")
            check(page.run("document.querySelector('.verdict .word').textContent").split()[-1] == word, folder)
            check(page.run("document.body.className") == "bad", f"{folder}: the page is marked")
            check_sections(page, SECTIONS)
            check_printed(page, work, [word])
            check_widths(page)
            check_quiet(page, path)


def check_leak_table(binary, work, sources):
    """Checks the table from the paper: every coefficient in leak_table.json is on the page, with its grade."""
    campaign = sources / "datasets" / "rigs" / "uis_shake_table" / "campaign.toml"
    check(rigcal(binary, work, "leak-table", campaign, "--out", "leaks") == 0, "leak table")
    path = work / "leaks" / "report.html"
    entries = json.loads((work / "leaks" / "leak_table.json").read_text())["entries"]
    with Browser() as page:
        page.open(path)
        check_sections(page, ["verdict", "leak-table", "provenance", "formulas"])
        shown = [float(v) for v in values(page, ".leaks .cell > data")]
        check(shown == [c for e in entries for c in e["coefficients"]], "the coefficients are those of the file")
        grades = page.run("[...document.querySelectorAll('.leaks .mark')].map(m => m.getAttribute('aria-label'))")
        check(grades == [e["grade"] for e in entries], f"grades: {grades}")
        check_widths(page)
        check_quiet(page, path)


def check_diagnosis(binary, work):
    """Checks that an existing leak is found, and that the numbers agree with diagnosis.json."""
    leaking = (CAMPAIGN.replace("[acceptance]", "[leak_level.leaking]\n[acceptance]")
               .replace("leakage_coefficient = 0.3", "leakage_coefficient = 0")
               .replace('use = "validate"', 'use = "diagnose"\nparameters = { leakage_coefficient = 0.3 }')
               .replace('waveform = "square"\nfrequency = "1 Hz"\namplitude = "4 mm"\nleak_level = ' + json.dumps(LEVEL),
                        'waveform = "sine"\nfrequency = "2 Hz"\namplitude = "5 mm"\nleak_level = "leaking"'))
    (work / "leaking.toml").write_text(leaking)
    check(rigcal(binary, work, "synthesize", "leaking.toml", "--seed", "4", "--out", "leaking") == 0, "synthesize")
    check(rigcal(binary, work, "fit", "leaking/campaign.toml", "--out", "healthy") == 0, "fit of the healthy records")
    check(rigcal(binary, work, "diagnose", "leaking/campaign.toml", "--fit", "healthy/fit.json", "--out", "found") == 0,
          "diagnose")
    path = work / "found" / "report.html"
    records = json.loads((work / "found" / "diagnosis.json").read_text())["records"]
    with Browser() as page:
        page.open(path)
        check_sections(page, ["verdict", "diagnosis", "provenance", "formulas"])
        check(page.run("document.title").startswith("LEAK "), "the leak is said at the top")
        shown = [float(v) for v in values(page, ".diagnosis td:nth-child(4) > data")]
        check(shown == [r["leak_share_percent"] for r in records if r["repeat"] is None], f"shares: {shown}")
        check_widths(page)
        check_quiet(page, path)


def check_models(page, compared):
    """Checks the likelihood-ratio table: a row for each result after the first, with the numbers in comparison.json."""
    check(page.run("document.querySelector('.models caption').textContent").startswith("AIC"), "its caption is to be seen")
    shown = page.run("[...document.querySelectorAll('.models tbody tr')].map(r => [...r.cells].slice(1, 4)"
                     ".map(c => c.querySelector('data')?.value ?? ''))")
    stored = [["" if m[key] is None else m[key] for key in ("delta_aic", "delta_bic", "likelihood_ratio")]
              for m in compared["models"][1:]]
    check([[float(v) if v else "" for v in row] for row in shown] == stored, f"models: {shown}, {stored}")
    return stored


def check_average(binary, work):
    """Checks the repeats: numbers in average.json and a picture of every mean, at every width and on paper."""
    check(rigcal(binary, work, "average", "twin/campaign.toml", "--out", "mean") == 0, "average")
    path = work / "mean" / "report.html"
    records = json.loads((work / "mean" / "average.json").read_text())["records"]
    with Browser() as page:
        page.open(path)
        check_sections(page, ["verdict", "repeatability", "means", "provenance", "formulas"])
        shown = [float(v) for v in values(page, ".repeatability td[data-label='sd of one'] data")]
        stored = [c["pooled_sd"] for r in records for name, c in r["channels"].items() if name != "reference"]
        check(shown == stored, f"scatter of the repeats: {shown}, {stored}")
        check(page.run("document.querySelectorAll('#means figure svg').length") >= 2 * len(stored), "pictures")
        check_widths(page)
        check_printed(page, work, ["Repeatability", "sd of repeats", "offset [ms]"])
        check_quiet(page, path)


def check_plan(binary, work):
    """Checks the information in each record against plan.json."""
    check(rigcal(binary, work, "plan", "twin/campaign.toml", "--out", "planned") == 0, "plan")
    path = work / "planned" / "report.html"
    plan = json.loads((work / "planned" / "plan.json").read_text())
    with Browser() as page:
        page.open(path)
        check_sections(page, ["verdict", "plan", "provenance", "formulas"])
        shown = [float(v) for v in values(page, ".totals td[data-label='sd, with planned records'] data")]
        check(shown == [p["sd_all"] for p in plan["parameters"]], f"standard deviations: {shown}")
        check_widths(page)
        check_quiet(page, path)


def check_model_choice(binary, work):
    """Checks the comparison of two nested fits to the same records."""
    check(rigcal(binary, work, "fit", "twin/campaign.toml", "--free", "valve_gain", "--out", "smaller") in (0, 1),
          "the smaller model")
    check(rigcal(binary, work, "compare", "smaller", "good", "--out", "choice") == 0, "compare")
    compared = json.loads((work / "choice" / "comparison.json").read_text())
    check(compared["models"][1]["freedom"] == 1, "one parameter more")
    with Browser() as page:
        page.open(work / "choice" / "report.html")
        check(all(value != "" for value in check_models(page, compared)[0]), "every number is there")
        check_access(page)
        check_widths(page)
        check_quiet(page, work / "choice" / "report.html")


def check_comparison(binary, work):
    """Checks that the estimates of both fits are side by side, and that the results of one folder share a page."""
    check(rigcal(binary, work, "compare", "good", "healthy", "--out", "both") == 0, "compare")
    path = work / "both" / "report.html"
    compared = json.loads((work / "both" / "comparison.json").read_text())
    with Browser() as page:
        page.open(path)
        check_sections(page, ["verdict", "results", "estimates", "models", "scores", "curves", "records", "provenance",
                              "formulas"])
        shown = {float(v) for v in values(page, ".estimates td > data")}
        for parameter in compared["parameters"]:
            for estimate in parameter["estimates"]:
                if estimate and estimate["fitted"]:
                    check(estimate["value"] in shown, f"{parameter['key']} is shown")
        check_models(page, compared)
        check(page.run("document.querySelectorAll('#curves svg .measured').length") >= 1, "what was measured")
        check(page.run("document.querySelectorAll('#curves svg path.model.line').length") >= 1, "the first model")
        check(page.run("document.querySelectorAll('#curves svg path.residual.line').length") >= 1, "the second model")
        check_widths(page)
        check_quiet(page, path)
    shutil.copy(work / "found" / "diagnosis.json", work / "good")
    check(rigcal(binary, work, "report", "good") == 0, "draw again")
    with Browser() as page:
        page.open(work / "good" / "report.html")
        check_sections(page, SECTIONS[:-2] + ["diagnosis"] + SECTIONS[-2:])
        check(page.run("document.querySelector('#verdict > ul').textContent").count("Diagnosis") == 1, "named at the top")


def check_names(binary, work):
    """Checks that file and folder names are shown as text, and that the command on the page reproduces the result."""
    shutil.copytree(work / "twin", work / "odd")
    odd = "<b>bold \"q\" 'a' $(id) \n\u00fc \u2192.csv"
    campaign = work / "odd" / "campaign.toml"
    text = campaign.read_text()
    for record in sorted((work / "odd" / "records").glob("sine_*.csv")):
        name = record.stem + odd
        text, count = re.subn(f"""["']records/{record.name}["']""", lambda _: json.dumps("records/" + name), text)
        check(count == 1, f"{record.name} is in the campaign")
        record.rename(record.with_name(name))
    campaign.write_text(text)
    folder = "out <i>put \"q\" 'a' \u00fc"
    check(rigcal(binary, work, "validate", "odd/campaign.toml", "--out", folder) in (0, 1), "any name can be written")
    path = work / folder / "report.html"
    result = json.loads((work / folder / "validation.json").read_text())
    with Browser() as page:
        page.open(path)
        check(page.run("document.querySelectorAll('main b, main i').length") == 0, "names are text")
        check(odd in page.run("document.querySelector('#provenance').textContent"), "the file is named")
        command = page.run("document.querySelector('#provenance code').textContent")
        check(command == result["provenance"]["command"], "the command is whole")
        check(not page.problems, f"the browser complains: {page.problems}")
    before = path.read_bytes()
    check(rigcal(binary, work, "report", folder) == 0, "draw again")
    check(path.read_bytes() == before, "the same bytes")
    shutil.rmtree(work / folder)
    again = command.replace("rigcal", shlex.quote(binary), 1)
    check(subprocess.run(["sh", "-c", again], cwd=work, check=False).returncode in (0, 1), "the command runs")
    repeated = json.loads((work / folder / "validation.json").read_text())
    for each in (result, repeated):
        del each["wall_seconds"]
        del each["provenance"]["command"]
    check(repeated == result, "the command makes the result again")


def recordings(sources, name):
    """Returns the folder with recordings of a real machine. If there is none, prints a message and returns None."""
    data = sources.parent / "shared" / "data" / name
    if data.is_dir():
        return data
    print(f"skipped: no recordings at {data}")
    return None


def check_recorded(folder, file, sections):
    """Checks the page for a real machine."""
    path = folder / "report.html"
    result = json.loads((folder / file).read_text())
    with Browser() as page:
        page.open(path)
        check_sections(page, sections)
        check_numbers(page, result)
        cells = page.run("[...document.querySelectorAll('a.cell')].map(a => a.getAttribute('href').slice(1))")
        shown = page.run("[...document.querySelectorAll('article.condition')].map(a => a.id)")
        check(set(cells) == set(shown), f"every condition has a cell: {cells}, {shown}")
        check_widths(page)
        check_quiet(page, path)


def check_utfsm(work):
    try:
        made = Runs().make("utfsm")
    except Absent as reason:
        print(f"skipped: {reason}")
        return
    shutil.copytree(made, work / "utfsm")
    check_recorded(work / "utfsm", "fit.json", SECTIONS)


def check_festo(binary, work, sources):
    data = recordings(sources, "festo_tp511_servo_cylinder")
    if data is None:
        return
    campaign = sources / "datasets" / "rigs" / "festo_tp511" / "campaign.toml"
    # This tests only the page, for which the start values of the campaign are enough; a fit would take longer.
    check(rigcal(binary, work, "validate", campaign, "--data", data, "--out", "festo") in (0, 1), "Festo's machine")
    check_recorded(work / "festo", "validation.json", SECTIONS)


def main():
    if chromium() is None:
        print("skipped: no chromium (scripts/setup --dev installs it)")
        return 77
    binary = os.environ["RIGCAL"] = str(pathlib.Path(sys.argv[1]).resolve())  # for Runs, too
    sources = pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "truth.toml").write_text(CAMPAIGN)
        check(rigcal(binary, work, "synthesize", "truth.toml", "--seed", "3", "--out", "twin") == 0, "synthesize")
        check_good(binary, work)
        check_many(binary, work)
        check_sheets(binary, work, sources)
        check_bad(binary, work)
        check_leak_table(binary, work, sources)
        check_diagnosis(binary, work)
        check_comparison(binary, work)
        check_model_choice(binary, work)
        check_average(binary, work)
        check_plan(binary, work)
        check_names(binary, work)
        check_utfsm(work)
        check_festo(binary, work, sources)
    print("reports open, zoom, print their numbers, and ask for nothing")
    return 0


if __name__ == "__main__":
    sys.exit(main())

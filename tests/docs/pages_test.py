#!/usr/bin/env python3
"""Builds the documentation site and checks it in headless Chromium. usage: pages_test.py RIGCAL
Exit code 77: no MkDocs with its theme, no Doxygen, no browser, or a program without the model for
pages."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tests" / "report"))
from browser import Browser, chromium  # noqa: E402

# Reports that take only seconds. Those that need recordings are made only if these are available.
NAMES = ["uis_leak_table", "martensson", "moog", "karpenko"]
PAGES = ["index.html", "gallery.html", "tutorial.html", "paper.html", "campaign-file.html", "campaign-records.html",
         "reference/python.html", "reference/cpp-calib.html", "decisions/index.html"]


def check(holds, what):
    if not holds:
        raise AssertionError(what)


def missing(rigcal):
    """Returns what this test needs but does not find; None if nothing is missing."""
    for program, package in (("mkdocs", "mkdocs-material"), ("doxygen", "doxygen")):
        if not shutil.which(program):
            return f"no {package}"
    themes = subprocess.run(["mkdocs", "build", "--help"], capture_output=True, text=True, check=True).stdout
    if "material" not in themes:
        return "no mkdocs-material"
    if chromium() is None:
        return "no browser"
    if "no live pages" in subprocess.run([rigcal, "--version"], capture_output=True, text=True, check=True).stdout:
        return "this program was built without the model for pages"
    return None


def run(rigcal, *arguments):
    done = subprocess.run(arguments, capture_output=True, text=True, check=False, env={**os.environ, "RIGCAL": str(rigcal)})
    check(done.returncode == 0, f"{arguments}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    print(done.stderr, end="")
    return done.stdout


def make_site(rigcal, folder):
    run(rigcal, ROOT / "scripts" / "gallery", "--out", folder / "gallery", *NAMES)
    made = [each["name"] for each in json.loads((folder / "gallery" / "gallery.json").read_text())]
    check({"uis_leak_table", "karpenko"} <= set(made), f"the gallery has {made}")
    stamp = folder / "gallery" / "karpenko" / "explore.html"
    before = stamp.stat().st_mtime_ns
    run(rigcal, ROOT / "scripts" / "gallery", "--out", folder / "gallery", *NAMES)
    check(stamp.stat().st_mtime_ns == before, "what is as it was is made again")
    printed = run(rigcal, ROOT / "scripts" / "docs", "--site", folder / "site", "--gallery", folder / "gallery")
    check(printed.endswith(", 0 problems\n"), printed)
    return made


def quiet(browser, what):
    check(not browser.problems, f"{what}: {browser.problems}")
    asked = [url for url in browser.requests if not url.startswith(("file:", "blob:", "data:", "about:"))]
    check(not asked, f"{what} asks for {asked}")


def fits(browser, width, what):
    browser.size(width)
    browser.wait_for(f"innerWidth === {width}", f"{what}: {width} px")
    browser.wait_for(f"document.documentElement.scrollWidth <= {width}", f"{what} is wider than {width} px")


SCHEME = "document.body.getAttribute('data-md-color-scheme')"
TOGGLE = "[...document.querySelectorAll('[data-md-component=palette] label')].find((each) => !each.hidden).click()"
DARK = "matchMedia('(prefers-color-scheme: dark)').matches"


def front_page(site):
    with Browser(1440, 1000) as browser:
        browser.size(1440, 1000)
        browser.open(site / "index.html")
        # The live rig is directly below the title and the introduction.
        browser.wait_for("window.rigcalLive?.levels !== undefined", "the live rig", frame="paper-rig.html")
        levels = browser.run("window.rigcalLive.levels.map(({name}) => name)", frame="paper-rig.html")
        check(levels == ["Normal", "Slight", "Medium", "Critical", "Super"], levels)
        check(browser.run("document.querySelector('iframe.live-rig').getBoundingClientRect().top") < 500, "the rig is not at the top")
        before = browser.run("document.querySelector('article').innerText.indexOf('From recordings')")
        check(0 < before < 900, "the rig is not the first thing")
        inside = browser.run("document.body.scrollHeight", frame="paper-rig.html")
        browser.wait_for(f"Math.abs(document.querySelector('iframe.live-rig').clientHeight - {inside}) < 4", "the frame is as high as the rig")
        check(browser.run("document.querySelectorAll('figure.drawing svg').length") == 2, "two drawings")
        check(browser.run("[...document.images].every((each) => each.complete || each.loading === 'lazy')"), "an image is not there")
        # The colour scheme that the reader chooses also applies to the rig and the drawings.
        check(browser.run(SCHEME) == "default" and not browser.run(DARK, frame="paper-rig.html"), "light at first")
        ink = "getComputedStyle(document.querySelector('svg.drawing text')).fill"
        light = browser.run(ink)
        browser.run(TOGGLE)
        browser.wait_for(SCHEME + " === 'slate'", "the dark scheme")
        browser.wait_for(DARK, "a dark rig in a dark page", frame="paper-rig.html")
        check(browser.run(ink) != light, "the drawing has the ink of light pages")
        browser.open(site / "tutorial.html")
        check(browser.run(SCHEME) == "slate", "the next page has forgotten it")
        quiet(browser, "the front page")
    with Browser(1440, 1000) as browser:
        browser.dark()
        browser.open(site / "index.html")
        browser.wait_for(SCHEME + " === 'slate'", "dark where the system is")
        quiet(browser, "the front page, dark")


def search(site):
    with Browser(1440, 1000) as browser:
        for page in ("tutorial.html", "reference/python.html"):
            browser.open(site / page)
            browser.call("Emulation.setFocusEmulationEnabled", enabled=True)
            browser.run("document.querySelector('[data-md-component=search-query]').focus()")
            browser.call("Input.insertText", text="noise floo")
            browser.key("r")
            found = "[...document.querySelectorAll('.md-search-result__link')].map((each) => each.href)"
            browser.wait_for(found + ".length > 0", f"{page}: nothing is found")
            links = browser.run(found)
            check(any("glossary.html" in link for link in links), f"{page}: found {links}")
            check(all(link.startswith(site.as_uri()) for link in links), f"{page}: leads to {links}")
        quiet(browser, "the search")


def code(site):
    with Browser(1440, 1000) as browser:
        browser.open(site / "tutorial.html")
        # The theme copies text by means of a temporary text area.
        browser.run("window.copied = []; document.execCommand = () => { copied.push(document.querySelector('body > textarea').value); return true; }")
        button = ("[...document.querySelectorAll('[data-clipboard-target]')].find((each) => "
                  "document.querySelector(each.dataset.clipboardTarget).textContent.includes('synthesize'))")
        browser.wait_for(f"{button} !== undefined", "a copy button")
        browser.run(f"{button}.click()")
        browser.wait_for("copied.length > 0", "a button that copies")
        copied = browser.run("copied[0]")
        check(copied.startswith("rigcal synthesize ") and "\nmv made/records records" in copied, f"copied: {copied!r}")
        check("$ " not in copied and "sine_1Hz_r1.csv" not in copied, f"prompt or output is copied: {copied!r}")
        colours = "new Set([...document.querySelectorAll('.highlight span[class]')].map((each) => getComputedStyle(each).color)).size"
        for page in ("tutorial.html", "campaign-file.html", "python.html", "install.html", "reference/cpp-calib.html"):
            browser.open(site / page)
            check(browser.run(colours) > 2, f"{page}: {browser.run(colours)} colours")


def gallery(site, made):
    with Browser(1440, 1000) as browser:
        browser.size(1440, 1000)
        browser.open(site / "gallery.html")
        browser.run("document.querySelectorAll('.cards img').forEach((each) => { each.loading = 'eager'; })")
        browser.wait_for(f"[...document.querySelectorAll('.cards img')].filter((each) => each.naturalWidth > 0).length === {len(made)}",
                         f"pictures of {made}")
        tops = browser.run("[...document.querySelectorAll('.cards li')].map((each) => each.getBoundingClientRect().top)")
        check(len(tops) == len(made) and tops[0] == tops[1], f"cards side by side: {tops}")
        links = browser.run("[...document.querySelectorAll('.cards .shot')].map((each) => each.getAttribute('href'))")
        check(links == [f"gallery/{name}.html" for name in made], links)
        quiet(browser, "the gallery")
        for link in links:
            browser.open(site / link)
            check(browser.run("document.querySelector('h1').textContent.length > 0"), f"{link} has no title")
            quiet(browser, link)


def pages(site):
    with Browser(1440, 1000) as browser:
        for page in PAGES:
            browser.size(1440, 1000)
            browser.open(site / page)
            check(browser.run("document.querySelectorAll('h1').length") == 1, f"{page}: one title")
            for width in (1440, 400):
                fits(browser, width, page)
            quiet(browser, page)
        browser.open(site / "index.html")
        decisions = "[...document.querySelectorAll('.md-nav--primary a, .md-tabs a')].filter((each) => /decisions.[0-9]/.test(each.href)).length"
        check(browser.run(decisions) == 0, "decisions are in the menu")
        browser.open(site / "decisions" / "index.html")
        count = len(list((ROOT / "docs" / "decisions").glob("[0-9]*.md")))
        check(browser.run("document.querySelectorAll('article li a').length") == count, "a decision is not listed")


def references(site):
    """Checks that every public name in the sources is on its reference page."""
    python = (site / "reference" / "python.html").read_text(encoding="utf-8")
    for name in ("id=\"campaignfit\"", "id=\"rigcalerror\"", "Estimates the free parameters", "parameters"):
        check(name in python, f"the reference of Python lacks {name}")
    cpp = (site / "reference" / "cpp-calib.html").read_text(encoding="utf-8")
    check("calib/fit.hpp" in cpp and "A fit that fails is reported in" in cpp, "the reference of C++ lacks fit()")
    headers = sum(path.read_text(encoding="utf-8").count('class="include"') for path in (site / "reference").glob("cpp-*.html"))
    check(headers > 60, f"{headers} headers")


def main():
    rigcal = pathlib.Path(sys.argv[1]).resolve()
    reason = missing(rigcal)
    if reason:
        print(f"skipped: {reason}")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made = make_site(rigcal, folder)
        site = folder / "site"
        references(site)
        front_page(site)
        search(site)
        code(site)
        gallery(site, made)
        pages(site)
    return 0


if __name__ == "__main__":
    sys.exit(main())

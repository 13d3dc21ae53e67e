#!/usr/bin/env python3
"""Measures how long a report takes to open in headless Chromium, with the clock of the browser.
usage: opening_time.py REPORT [--sheets]

Prints two medians of five runs: the time until everything is loaded and laid out, and the time until the first plots
can be zoomed. With --sheets it also prints the number of A4 sheets.
"""

import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

from browser import Browser, chromium

LOADED = "performance.getEntriesByType('navigation')[0].loadEventEnd"
# The first plot is on the screen two frames after it has been drawn.
LIVE = """new Promise((done) => {
  const wait = () => document.querySelector('figure.live') ? requestAnimationFrame(() => requestAnimationFrame(
    () => done(performance.now()))) : requestAnimationFrame(wait);
  document.querySelector('#conditions').scrollIntoView();
  wait();
})"""


def opened(path):
    """Returns the seconds until the page is loaded, and from jumping to the first condition to live plots."""
    with Browser() as page:
        page.open(path)
        page.wait_for(f"{LOADED} > 0", "loaded")
        loaded = page.run(LOADED)
        begin = page.run("performance.now()")
        return loaded / 1e3, (page.run(LIVE) - begin) / 1e3


def sheets_of(path):
    with Browser() as page, tempfile.NamedTemporaryFile(suffix=".pdf") as sheet:
        page.open(path)
        page.wait_for(f"{LOADED} > 0", "loaded")
        page.pdf(sheet.name)
        told = subprocess.run(["pdfinfo", sheet.name], capture_output=True, text=True, check=True).stdout
    return int(re.search(r"Pages: +(\d+)", told)[1])


def main():
    if chromium() is None:
        print("opens: not measured, no chromium (scripts/setup --dev installs it)")
        return 0
    loaded, live = zip(*(opened(pathlib.Path(sys.argv[1])) for _ in range(5)))
    sheets = f"; on paper it has {sheets_of(pathlib.Path(sys.argv[1]))} sheets" if "--sheets" in sys.argv else ""
    print(f"opens in {statistics.median(loaded):.2f} s, its first plots are drawn in {statistics.median(live):.2f} s more{sheets}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

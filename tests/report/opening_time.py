#!/usr/bin/env python3
"""How long a report takes to open in headless Chromium, by the browser's own clock: opening_time.py REPORT.

Prints the medians of five: until all is loaded and laid out, and until the first plots can be zoomed.
"""

import pathlib
import statistics
import sys

from browser import Browser, chromium

LOADED = "performance.getEntriesByType('navigation')[0].loadEventEnd"
# Two frames after the first plot has been drawn it is on the screen.
LIVE = """new Promise((done) => {
  const wait = () => document.querySelector('figure.live') ? requestAnimationFrame(() => requestAnimationFrame(
    () => done(performance.now()))) : requestAnimationFrame(wait);
  document.querySelector('#conditions').scrollIntoView();
  wait();
})"""


def opened(path):
    """Seconds until the page is loaded, and from the jump to the first condition until its plots are live."""
    with Browser() as page:
        page.open(path)
        page.wait_for(f"{LOADED} > 0", "loaded")
        loaded = page.run(LOADED)
        begin = page.run("performance.now()")
        return loaded / 1e3, (page.run(LIVE) - begin) / 1e3


def main():
    if chromium() is None:
        print("opens: not measured, no chromium (scripts/setup --dev installs it)")
        return 0
    loaded, live = zip(*(opened(pathlib.Path(sys.argv[1])) for _ in range(5)))
    print(f"opens in {statistics.median(loaded):.2f} s, its first plots are drawn in {statistics.median(live):.2f} s more")
    return 0


if __name__ == "__main__":
    sys.exit(main())

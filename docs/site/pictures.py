"""Pictures of pages, by headless Chromium."""
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "tests" / "report"))
from browser import Browser, chromium  # noqa: E402

SETTLES_S = 1.0
# A live page is finished when its model has run, and its leak levels, where it has any.
FINISHED = """!document.getElementById("live-levels") ||
  (window.rigcalLive && (document.getElementById("live-levels").hidden || window.rigcalLive.levels !== undefined))"""


def available():
    return chromium() is not None


def take(page, picture, width, height):
    """The top of a page, as PNG."""
    with Browser(width, height) as browser:
        browser.size(width, height)
        browser.open(page)
        browser.wait_for(FINISHED, f"{page} runs")
        time.sleep(SETTLES_S)
        browser.screenshot(picture)

"""Drives headless Chromium over its DevTools pipe, using only the standard library."""

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time


def chromium():
    """Returns the path of the browser, or None if there is none."""
    return next((p for name in ("chromium", "chromium-browser", "google-chrome") if (p := shutil.which(name))), None)


class Browser:
    """A page. Records its errors (`problems`) and every address that it requests (`requests`)."""

    FLAGS = [
        "--headless", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
        "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--remote-debugging-pipe",
    ]

    def __init__(self, width=1280, height=900):
        self.profile = tempfile.mkdtemp(prefix="rigcal-browser-")
        to_read, self.to = os.pipe()
        self.back, from_write = os.pipe()
        flags = self.FLAGS + ([] if os.getuid() else ["--no-sandbox"])

        def place():
            # The browser reads commands from descriptor 3 and answers on 4. Free both before they are assigned.
            read, write = os.dup(to_read), os.dup(from_write)
            os.dup2(read, 3)
            os.dup2(write, 4)

        # Use descriptors above 4, so that place() does not close one that it still needs.
        to_read, from_write = (os.dup2(fd, free) for fd, free in ((to_read, 60), (from_write, 61)))
        self.process = subprocess.Popen(
            [chromium(), *flags, f"--user-data-dir={self.profile}", f"--window-size={width},{height}", "about:blank"],
            close_fds=False, preexec_fn=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(to_read)
        os.close(from_write)
        self.buffer = b""
        self.number = 0
        self.problems = []
        self.requests = []
        self.contexts = {}  # script contexts by frame
        self.loaded = False
        target = next(t for t in self.call("Target.getTargets")["targetInfos"] if t["type"] == "page")
        self.session = self.call("Target.attachToTarget", targetId=target["targetId"], flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    session = None

    def _receive(self):
        parts = [self.buffer]  # joined once: an answer can have many MB, of which a pipe passes 64 kB at a time
        while b"\0" not in parts[-1]:
            parts.append(os.read(self.back, 1 << 20))
            if not parts[-1]:
                raise RuntimeError("the browser ended")
        message, self.buffer = b"".join(parts).split(b"\0", 1)
        return json.loads(message)

    def _note(self, message):
        method, params = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and params["type"] in ("error", "warning", "assert"):
            self.problems.append(str(params["args"]))
        elif method == "Log.entryAdded" and params["entry"]["level"] in ("error", "warning"):
            self.problems.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        elif method == "Runtime.executionContextCreated":
            about = params["context"].get("auxData", {})
            if about.get("isDefault"):
                self.contexts[about["frameId"]] = params["context"]["id"]
        elif method == "Page.loadEventFired":
            self.loaded = True

    def call(self, method, **params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self._note(answer)

    def open(self, path):
        self.loaded = False
        self.call("Page.navigate", url="file://" + os.path.abspath(path))
        while not self.loaded:
            self._note(self._receive())

    def run(self, script, frame=None):
        """Returns the value of a JavaScript expression, awaiting promises. `frame`: part of the address of a frame."""
        where = {}
        if frame:
            frames = self.call("Page.getFrameTree")["frameTree"].get("childFrames", [])
            found = next(each["frame"]["id"] for each in frames if frame in each["frame"]["url"])
            where = {"contextId": self.contexts[found]}
        result = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True, userGesture=True, **where)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", script))
        return result["result"].get("value")

    def wait_for(self, script, what, frame=None):
        for _ in range(2400):  # two minutes; a busy machine needs half a minute for the longest record
            if self.run(script, frame):
                return
            time.sleep(0.05)
        raise AssertionError(f"never: {what}")

    def size(self, width, height=900):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def dark(self, on=True):
        self.call("Emulation.setEmulatedMedia",
                  features=[{"name": "prefers-color-scheme", "value": "dark" if on else "light"}])

    def drag(self, x0, x1, y):
        def mouse(kind, x, buttons):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=buttons, clickCount=1)
        mouse("mouseMoved", x0, 0)
        mouse("mousePressed", x0, 1)
        for i in range(1, 6):
            mouse("mouseMoved", x0 + (x1 - x0) * i / 5, 1)
        mouse("mouseReleased", x1, 0)

    def key(self, key):
        for kind in ("keyDown", "keyUp"):
            self.call("Input.dispatchKeyEvent", type=kind, key=key, text=key if len(key) == 1 and kind == "keyDown" else "")

    def screenshot(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.captureScreenshot")["data"]))

    def pdf(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"]))

    def close(self):
        try:
            self.session = None
            self.call("Browser.close")
        except (RuntimeError, OSError):
            pass
        self.process.wait(timeout=30)
        for end in (self.to, self.back):
            os.close(end)
        shutil.rmtree(self.profile, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

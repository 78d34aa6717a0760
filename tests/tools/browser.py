"""Chromium without a window, driven over its DevTools protocol: what the test of the report page looks with.

    with Browser() as browser:
        page = browser.open(path, width=1280, height=900)
        page.evaluate("document.title")
        pixels = page.picture("screenshot.png")

The protocol runs over two pipes (JSON texts with a null byte after each), so that no library and no port are needed.
Source: Chromium's `--remote-debugging-pipe`; https://chromedevtools.github.io/devtools-protocol/
"""

import base64
import io
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import matplotlib.image

LOCAL = ("file:", "data:", "blob:")  # addresses without a network
# Of dygraphs 2.2: what a logarithmic axis with a floor, or a zoom, leaves out.
BEYOND_RANGE = re.compile(r"\d+ points out of [XY] bounds")
NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")
FLAGS = (
    "--headless=new", "--remote-debugging-pipe", "--no-first-run", "--disable-gpu", "--disable-dev-shm-usage",
    "--hide-scrollbars", "--disable-extensions", "--disable-background-networking", "--disable-component-update",
    "--force-color-profile=srgb", "--font-render-hinting=none",
)  # fmt: skip


def find_browser():
    """The browser's program. FileNotFoundError, saying how to get it, if there is none."""
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    raise FileNotFoundError(f"none of {', '.join(NAMES)} found: install one with tools/setup --for-tests")


class Browser:
    """A running browser; ended, and its profile removed, at the end of the with block."""

    def __enter__(self):
        self.profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self.sending = os.pipe()
        self.receiving, from_browser = os.pipe()
        self.log = open(Path(self.profile.name) / "log", "w+", encoding="utf-8", errors="replace")
        command = [find_browser(), *FLAGS, f"--user-data-dir={self.profile.name}"]
        if os.geteuid() == 0:
            command.append("--no-sandbox")  # which root cannot have

        def give_pipes():  # the protocol's file descriptors are 3 and 4
            reading, writing = os.dup(to_browser), os.dup(from_browser)
            os.dup2(reading, 3)
            os.dup2(writing, 4)

        self.process = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=self.log,
            preexec_fn=give_pipes, pass_fds=(3, 4), env={**os.environ, "HOME": self.profile.name},
        )  # fmt: skip
        os.close(to_browser)
        os.close(from_browser)
        self.received = b""
        self.count = 0
        self.events = []
        self.call("Browser.getVersion")  # that it runs at all
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        os.close(self.sending)
        os.close(self.receiving)
        self.log.close()
        self.profile.cleanup()

    def call(self, method, session=None, **parameters):
        """Has the browser do something. Returns its answer; RuntimeError if it is an error."""
        self.count += 1
        message = {"id": self.count, "method": method, "params": parameters}
        text = json.dumps(message | ({"sessionId": session} if session else {})).encode() + b"\0"
        try:
            while text:
                text = text[os.write(self.sending, text) :]
        except BrokenPipeError as error:
            raise self._ended() from error
        while True:
            answer = self._receive()
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, method, session):
        """Takes events until this one has come, which may have been before."""
        while not any(one.get("method") == method and one.get("sessionId") == session for one in self.events):
            self.events.append(self._receive())

    def save_downloads(self, folder):
        """Has the browser save what pages offer for saving in a folder, without asking."""
        self.call("Browser.setDownloadBehavior", behavior="allow", downloadPath=str(folder), eventsEnabled=True)

    def _receive(self):
        while b"\0" not in self.received:
            part = os.read(self.receiving, 1 << 20)
            if not part:
                raise self._ended()
            self.received += part
        text, _, self.received = self.received.partition(b"\0")
        return json.loads(text)

    def _ended(self):
        code = self.process.wait()
        self.log.seek(0)
        said = "".join(self.log.readlines()[-5:])
        return RuntimeError(f"{find_browser()} has ended (exit code {code}):\n{said}")

    def open(self, path, width=1280, height=900, dark=False, touch=False):
        """Opens a file of this computer with no network, in a window of this size. Returns the Page when it is
        loaded."""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        page = Page(self, self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"])
        for domain in ("Page", "Runtime", "Log", "Network"):
            page.call(f"{domain}.enable")
        page.call("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        page.resize(width, height, touch)
        page.set_media(dark)
        answer = page.call("Page.navigate", url=Path(path).resolve().as_uri())
        if "errorText" in answer:
            raise RuntimeError(f"{path}: {answer['errorText']}")
        self.wait_for("Page.loadEventFired", page.session)
        page.settle()
        return page


class Page:
    """A page in the browser."""

    def __init__(self, browser, session):
        self.browser, self.session = browser, session

    def close(self):
        self.call("Page.close")

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def resize(self, width, height, touch=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=touch)
        self.call("Emulation.setTouchEmulationEnabled", enabled=touch)

    def evaluate(self, script):
        """The value of a JavaScript expression, waited for if it is a promise. RuntimeError if it throws."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"].get("exception", {}).get("description", str(answer)))
        return answer["result"].get("value")

    def settle(self):
        """Lets the page draw two frames, so that all that was asked for is on the screen."""
        self.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def box(self, selector):
        """Where an element is on the whole page: x, y, width, height in pixels."""
        return self.evaluate(
            f"(() => {{ const r = document.querySelector({json.dumps(selector)}).getBoundingClientRect();"
            "return [r.x + scrollX, r.y + scrollY, r.width, r.height]; })()"
        )

    def picture(self, keep=None, selector=None):
        """The whole page, or one element of it, as [rows×columns×3] from 0 to 1; also kept as a PNG file if asked.

        An element must fit in the window: a picture of more than the window resizes it, whereupon pages draw anew.
        """
        if selector is None:
            size = self.call("Page.getLayoutMetrics")["cssContentSize"]
            box = (0, 0, size["width"], size["height"])
        else:
            self.evaluate(
                f"document.querySelector({json.dumps(selector)})"
                ".scrollIntoView({block: 'center', behavior: 'instant'})"
            )
            self.settle()
            box = self.box(selector)
        clip = dict(zip(("x", "y", "width", "height"), box)) | {"scale": 1}
        answer = self.call("Page.captureScreenshot", clip=clip, captureBeyondViewport=selector is None)
        data = base64.b64decode(answer["data"])
        if keep is not None:
            Path(keep).write_bytes(data)
        return matplotlib.image.imread(io.BytesIO(data))[:, :, :3]

    def press(self, key, code):
        """A key, down and up, for the element that has the focus."""
        text = {"text": key} if len(key) == 1 else {}
        names = {
            "key": key,
            "code": code,
            "windowsVirtualKeyCode": {"ArrowRight": 39, "ArrowLeft": 37, "ArrowDown": 40, " ": 32}.get(key, 0),
        }
        self.call("Input.dispatchKeyEvent", type="keyDown", **names, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", **names)

    def drag(self, start, end, shift=False):
        """The left mouse button from one place in the window to another, with the shift key held if asked."""
        keys = 8 if shift else 0
        for kind, (x, y) in (
            ("mouseMoved", start),
            ("mousePressed", start),
            ("mouseMoved", end),
            ("mouseReleased", end),
        ):
            held = {} if kind == "mouseMoved" and (x, y) == start else {"button": "left", "buttons": 1, "clickCount": 1}
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, modifiers=keys, **held)

    def find(self, selector, share=(0.5, 0.5)):
        """Where a share of an element's width and height is in the window, after scrolling it there."""
        self.evaluate(
            f"document.querySelector({json.dumps(selector)}).scrollIntoView({{block: 'center', behavior: 'instant'}})"
        )
        self.wait_until_still(selector)
        x, y, width, height = self.box(selector)
        return x + share[0] * width - self.evaluate("scrollX"), y + share[1] * height - self.evaluate("scrollY")

    def wait_until_still(self, selector):
        """Waits until an element has stood in its place for some frames: diagrams are redrawn after a choice."""
        self.evaluate(
            "new Promise((done) => { let last = '', still = 0; const look = () => {"
            f"const box = JSON.stringify(document.querySelector({json.dumps(selector)}).getBoundingClientRect());"
            "still = box === last ? still + 1 : 0; last = box;"
            "if (still >= 5) done(true); else requestAnimationFrame(look); }; look(); })"
        )

    def click(self, selector, share=(0.5, 0.5), times=1):
        """Clicks an element with the mouse, once or several times in a row."""
        x, y = self.find(selector, share)
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        for count in range(1, times + 1):
            for kind in ("mousePressed", "mouseReleased"):
                self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=count)
        self.settle()

    def wait_until(self, condition):
        """Waits frame by frame until a JavaScript expression is true. RuntimeError after a great many frames."""
        self.evaluate(
            "new Promise((done, fail) => { let frames = 0; const look = () => {"
            f"if ({condition}) done(true); else if (++frames > 20000) fail(new Error({json.dumps(condition)}));"
            "else requestAnimationFrame(look); }; look(); })"
        )

    def wait_for_download(self):
        """Waits frame by frame until a file is saved. RuntimeError after a great many frames."""
        for _ in range(3000):
            for place, event in enumerate(self.browser.events):
                if event.get("method") == "Browser.downloadProgress" and event["params"]["state"] != "inProgress":
                    del self.browser.events[place]
                    if event["params"]["state"] != "completed":
                        raise RuntimeError("a file was not saved")
                    return
            self.settle()
        raise RuntimeError("no file was saved")

    def prefer(self, dark):
        """Switches the system's colour scheme while the page is open."""
        self.set_media(dark)
        self.settle()

    def set_media(self, dark):
        """A colour scheme, and no smooth scrolling, during which a click would miss."""
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call(
            "Emulation.setEmulatedMedia", features=[scheme, {"name": "prefers-reduced-motion", "value": "reduce"}]
        )

    def problems(self):
        """What the page logged as errors or warnings, threw, or asked of the network: texts."""
        found = []
        for event in self.browser.events:
            if event.get("sessionId") != self.session:
                continue
            method, what = event["method"], event["params"]
            if method == "Runtime.exceptionThrown":
                found.append(what["exceptionDetails"].get("exception", {}).get("description", "exception"))
            elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
                text = " ".join(str(one.get("value", one.get("description"))) for one in what["args"])
                if not BEYOND_RANGE.match(text):
                    found.append(text)
            elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
                found.append(what["entry"]["text"])
            elif method == "Network.requestWillBeSent" and not what["request"]["url"].startswith(LOCAL):
                found.append(f"asked the network for {what['request']['url']}")
        return found

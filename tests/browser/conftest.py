"""Pages in a real browser: Debian's Chromium, without a window, driven by Playwright. `.ci/browser` installs both and runs

    pytest tests/browser

CPLAN names the program (default target/debug/cplan), CPLAN_PAGE the page with the program inside (target/page/index.html),
CPLAN_BROWSER the browser (chromium-headless-shell, or chromium), CPLAN_SCREENSHOTS a folder for screenshots (target/browser).
"""

import functools
import http.server
import json
import os
import shutil
import subprocess
import threading
import time
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("CPLAN", ROOT / "target/debug/cplan"))
PAGE = Path(os.environ.get("CPLAN_PAGE", ROOT / "target/page/index.html"))
SCREENSHOTS = Path(os.environ.get("CPLAN_SCREENSHOTS", ROOT / "target/browser"))


class Program:
    """The program cplan, run in its own folder."""

    def __init__(self, folder):
        self.folder = folder

    def run(self, *words, code=0):
        """Runs it and returns its output; the exit code must be the given one."""
        done = subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, text=True, timeout=120)
        assert done.returncode == code, done.stderr
        return done.stdout

    def attempt(self, *words):
        """Runs it, whatever its exit code is."""
        subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, timeout=120)

    def plan(self, robot, world, *words, code=0):
        """Plans a shipped workspace; returns its page and the result."""
        name = world.replace("/", "_") + "-".join(words).replace("--", "")
        page = self.folder / f"{name}.html"
        files = [ROOT / f"robots/{robot}.urdf", ROOT / f"workspaces/{world}.toml"]
        result = self.run(*files, *words, "--json", "--picture", page, code=code)
        return page, json.loads(result)


@pytest.fixture(scope="session")
def program(tmp_path_factory):
    return Program(tmp_path_factory.mktemp("pages"))


@pytest.fixture(scope="session")
def browser():
    asked = os.environ.get("CPLAN_BROWSER")
    names = [asked] if asked else ["chromium-headless-shell", "chromium"]
    path = next(filter(None, map(shutil.which, names)), None)
    assert path, f"there is no {' or '.join(names)}: install Debian's package, or set CPLAN_BROWSER"
    with sync_playwright() as playwright:
        # Containers run as root, and Chromium's sandbox does not work there.
        launched = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield launched
        launched.close()


class Seen:
    """A page, with its error messages."""

    def __init__(self, page):
        self.page = page
        self.complaints = []
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("console", lambda message: message.type == "error" and self.complaints.append(message.text))

    def shoot(self, name):
        SCREENSHOTS.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=SCREENSHOTS / f"{name}.png", full_page=True)

    def do(self, code, argument=None):
        return self.page.evaluate(code, argument)

    def until(self, code, seconds=60):
        """Waits until the expression is true. (The page's policy does not allow the browser to evaluate strings.)"""
        deadline = time.monotonic() + seconds
        while not self.do(code):
            assert time.monotonic() < deadline, f"{code} is not true after {seconds} s"
            self.page.wait_for_timeout(20)


@pytest.fixture
def show(browser):
    """Opens an address in a new window. At the end, the page must have reported no error."""
    opened = []

    def open_(address, width=1400, height=1000, **options):
        context = browser.new_context(viewport={"width": width, "height": height}, accept_downloads=True, **options)
        seen = Seen(context.new_page())
        opened.append((context, seen))
        seen.page.goto(address)
        return seen

    yield open_
    for context, seen in opened:
        context.close()
        assert seen.complaints == []


@pytest.fixture
def show_file(show):
    """Opens a page in a file, which must not request anything else."""

    def open_(path, **options):
        asked = []
        seen = show("about:blank", **options)
        seen.page.on("request", lambda request: asked.append(request.url))
        seen.page.goto(path.as_uri())
        assert asked == [path.as_uri()], "a page by itself asks for nothing"
        if not options.get("java_script_enabled", True):
            return seen  # Without scripts there are no promises to wait for, either.
        # Names are placed again when the bundled font is there, which is wider than others.
        seen.page.evaluate(
            "Promise.all([400, 600].map((weight) => document.fonts.load(`${weight} 13px Inter`)))"
            ".then(() => document.fonts.ready).then(() => new Promise(requestAnimationFrame)).then(() => true)"
        )
        return seen

    return open_


@pytest.fixture
def serve(show):
    """Serves files and opens the page; returns it, with its server, when a plan is visible."""
    from live import Server, settled

    running, opened = [], []

    def start(*words, **options):
        server = Server(words)
        running.append(server)
        seen = show(server.address, **options)
        opened.append(seen)
        seen.server = server
        settled(seen)
        return seen

    yield start
    # A page that is still open would complain that its server is gone.
    for seen in opened:
        seen.page.close()
    for server in running:
        server.end()


class Files(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture(scope="session")
def host(tmp_path_factory):
    """Serves the live page with the program inside, below a path of a file server."""
    if not PAGE.exists():
        pytest.skip("the page without a server is not built (.ci/page): is the target wasm32-unknown-unknown installed?")
    root = tmp_path_factory.mktemp("host")
    folder = root / "some/where"
    folder.mkdir(parents=True)
    (folder / "index.html").write_bytes(PAGE.read_bytes())
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Files, directory=root))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/some/where/"
    server.shutdown()


@pytest.fixture
def alone(show, host):
    """Opens that page, and returns it when a plan is visible."""
    from live import settled

    def open_(fragment="", **options):
        seen = show(host + fragment, **options)
        settled(seen)
        return seen

    return open_


@pytest.fixture(params=["server", "page"])
def either(request, show):
    """Opens the live page, from a server or with the program inside, and returns it when a plan is visible."""
    from live import PLANAR, Server, settled

    server = Server(PLANAR) if request.param == "server" else None
    address = server.address if server else request.getfixturevalue("host")
    opened = []

    def open_(fragment="", **options):
        seen = show(address + fragment, **options)
        opened.append(seen)
        settled(seen)
        return seen

    yield open_
    for seen in opened:
        seen.page.close()
    if server:
        server.end()

"""The wheel in Pyodide, in a worker of a page in Chromium, as in JupyterLite. `.ci/wheel` provides CPLAN_WHEEL and CPLAN_PYODIDE, the
folder of the npm package, and runs it where `.ci/browser` has installed a browser.
"""

import functools
import http.server
import os
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[3]
NAMES = ["chromium-headless-shell", "chromium"]
BROWSER = os.environ.get("CPLAN_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)

WORKER = """
import { loadPyodide } from './pyodide/pyodide.mjs';

const begun = performance.now();
const bytes = async (name) => new Uint8Array(await (await fetch(name)).arrayBuffer());
const pyodide = await loadPyodide();
const packages = pyodide.runPython('import site; site.getsitepackages()[0]');
pyodide.unpackArchive(await bytes('cplan.whl'), 'wheel', { extractDir: packages });
for (const name of ['arm.urdf', 'world.toml']) pyodide.FS.writeFile(name, await bytes(name));
const answer = pyodide.runPython(`
import json
import cplan
plan = cplan.plan(cplan.Arm.from_urdf("arm.urdf"), cplan.World.from_toml("world.toml"))
json.dumps({"status": plan.status, "length": plan.length, "svg": plan.svg(), "page": plan._repr_html_()})
`);
self.postMessage({ ...JSON.parse(answer), seconds: (performance.now() - begun) / 1000 });
"""
PAGE = """<!doctype html><title>cplan</title><body><script>
new Worker('worker.mjs', { type: 'module' }).onmessage = ({ data }) => {
  document.body.innerHTML = data.svg + data.page;
  window.answer = data;
};
</script>"""


class Files(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".mjs": "text/javascript", ".wasm": "application/wasm"}

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    """Serves the page."""
    (tmp_path / "index.html").write_text(PAGE)
    (tmp_path / "worker.mjs").write_text(WORKER)
    (tmp_path / "pyodide").symlink_to(Path(os.environ["CPLAN_PYODIDE"]).resolve())
    shutil.copy(os.environ["CPLAN_WHEEL"], tmp_path / "cplan.whl")
    shutil.copy(ROOT / "robots/planar_2r.urdf", tmp_path / "arm.urdf")
    shutil.copy(ROOT / "workspaces/shelf.toml", tmp_path / "world.toml")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Files, directory=tmp_path))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@pytest.mark.skipif(BROWSER is None, reason=f"there is no {' or '.join(NAMES)}")
def test_a_plan_and_its_page_are_shown(address: str) -> None:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        page = browser.new_page()
        errors: list[str] = []
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(address)
        page.wait_for_function("window.answer", timeout=240_000)
        answer = page.evaluate("({ status: answer.status, length: answer.length, seconds: answer.seconds })")
        print(f"first plan after {answer['seconds']:.1f} s, Pyodide's own start included")
        assert answer["status"] == "found" and answer["length"] == pytest.approx(4.4920, abs=1e-4)
        assert page.locator("body > svg").is_visible()
        # The page in its frame runs its scripts.
        frame = page.frame_locator("iframe")
        frame.locator("svg, canvas").first.wait_for(timeout=60_000)
        assert "4.49" in frame.locator("body").inner_text() and not errors
        browser.close()

"""The live page with the program inside: from a file server, below a path, or without any server."""

import itertools
import json
import re

import pytest
from conftest import PAGE, ROOT
from live import drag, path, settled

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="the page without a server is not built (.ci/page): is the target wasm32-unknown-unknown installed?")


def test_it_plans_what_is_dragged_and_asks_for_nothing(show, host):
    asked = []
    seen = show("about:blank")
    seen.page.on("request", lambda request: asked.append(request.url))
    seen.page.goto(host)
    first = settled(seen)
    assert first["verdict"] == "found" and first["certified"]
    before = path(seen)
    drag(seen, "workspace", [0.7, -1.5], [1.15, -0.75])
    after = settled(seen)
    assert after["final"] and after["certified"] and path(seen) != before
    assert after["figures"]["length"] > first["figures"]["length"], "it was in the way"
    seen.page.get_by_label("undo").click()
    settled(seen)
    assert path(seen) == before
    assert [url for url in asked if not url.startswith("blob:")] == [host]
    seen.shoot("alone")


def test_a_file_by_itself_plans(show):
    seen = show(PAGE.as_uri())
    assert settled(seen)["certified"]


def test_something_newer_ends_what_takes_long(alone):
    seen = alone("#crowd")
    # A field that takes long to relax: the next plan does not wait for it.
    seen.do("cplan.choose('harmonic --cells 1024')")
    seen.page.wait_for_timeout(300)
    assert seen.do("Boolean(cplan.link.awaited)")
    seen.do("cplan.choose('shortest')")
    answer = settled(seen, 10)
    assert answer["certified"] and seen.do("cplan.words") == "shortest"
    # The edits are still there.
    assert seen.do("cplan.world.base") == 1


def test_what_takes_too_long_is_shown_without_a_plan(alone):
    seen = alone("#crowd")
    seen.do("cplan.gallery.seconds = 0.5; cplan.gallery.open()")
    seen.until("cplan.isCurrent")
    seen.do("cplan.choose('harmonic --cells 1024')")
    answer = settled(seen, 30)
    assert answer["verdict"] == "unknown" and "not decided within 0.5 s" in seen.page.locator(".figures").inner_text()
    assert seen.do("cplan.view.world.c_obstacles.length") > 0, "what there is to see is shown"
    seen.do("cplan.choose('shortest')")
    assert settled(seen)["certified"], "another instance goes on"


# Requests, and the member that differs between the answers of two engines: their time.
WORDS = ["shortest", "visibility --gap 0.001", "trapezoid", "voronoi", "wavefront", "harmonic --cells 64", "prm", "subdivision", "fastest"]

TALK = """async (requests) => {
  const socket = cplan.gallery.openSocket();
  socket.binaryType = 'arraybuffer';
  const messages = [];
  let heard = () => {};
  socket.onmessage = ({ data }) => { messages.push(typeof data === 'string' ? data : new TextDecoder().decode(data)); heard(); };
  await new Promise((open) => { socket.onopen = open; });
  const isOver = (text) => text[0] !== '{' || /^.{0,80}"done":true|^{"kind":"failed"/.test(text);
  const wait = async (until) => { while (!until()) await new Promise((next) => { heard = next; }); };
  socket.send(JSON.stringify({ do: 'open', id: 1, files: cplan.gallery.files }));
  await wait(() => messages.length === 1);
  const answers = [];
  for (const request of requests) {
    const before = messages.length;
    socket.send(JSON.stringify(request));
    await wait(() => messages.slice(before).some(isOver));
    answers.push(messages.slice(before));
  }
  socket.onclose = () => {};
  socket.close();
  return [messages[0], answers];
}"""


NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def told(seen, requests):
    """Returns all messages in order, without times, drawings, and the planner's own counts."""
    world, answers = seen.do(TALK, requests)
    for message in [world, *itertools.chain(*answers)]:
        if message.startswith("{"):
            message = json.loads(message)
            for key in ("milliseconds", "size"):
                message.get("figures", {}).pop(key, None)
            message["view"] = bool(message.pop("view", None))
            message = json.dumps(message)
        yield message


@pytest.mark.parametrize("robot, world", [("planar_2r", "shelf"), ("planar_2r_continuous", "no_path"), ("scara", "scara_cell"), ("planar_2r_continuous", "torus_open"), ("rail_arm", "slot_closed")])
def test_both_engines_give_the_same_answers(serve, alone, robot, world):
    files = [ROOT / f"robots/{robot}.urdf", ROOT / f"workspaces/{world}.toml"]
    text = files[1].read_text()
    requests = []
    for i, words in enumerate(WORDS, 2):
        ask = {"id": i, "base": 1, "final": True, "state": None, "options": words}
        requests.append({"do": "plan", **ask})
    requests.append({"do": "load", "id": 100, "text": text.replace('name = "', 'name = "again '), "options": "shortest"})
    requests.append({"do": "load", "id": 101, "text": "obstacle = 3", "options": "shortest"})
    for i, format_ in enumerate(["toml", "csv"], 102):
        ask = {"id": i, "base": 2, "final": True, "state": None, "options": "shortest"}
        requests.append({"do": "download", "ask": ask, "format": format_})
    here, there = serve(*files, "--time-limit", "600"), alone()
    there.do("(files) => Object.assign(cplan.gallery, { files, seconds: 600 })", {"urdf": files[0].read_text(), "world": text, "options": "shortest"})
    for ours, theirs in zip(told(there, requests), told(here, requests), strict=True):
        theirs = theirs.replace(str(files[1]), "world.toml")
        # The last digits of sines and cosines depend on the platform.
        assert NUMBER.split(ours) == NUMBER.split(theirs)
        numbers = ([float(number) for number in NUMBER.findall(text)] for text in (ours, theirs))
        assert all(a == pytest.approx(b, rel=1e-9, abs=1e-9) for a, b in zip(*numbers))

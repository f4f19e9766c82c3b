"""A server whose page is tested, and the actions of a user on it."""

import signal
import subprocess
import time

from conftest import PROGRAM, ROOT

PLANAR = [ROOT / "robots/planar_2r.urdf", ROOT / "workspaces/shelf.toml"]


class Server:
    """A running `cplan serve`, which can be ended and started again at the same address."""

    def __init__(self, words):
        self.words = words
        self.start(0)

    def start(self, port):
        command = [PROGRAM, "serve", *self.words, "--port", str(port)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://127.0.0.1:"), "loopback alone"

    def stop(self):
        self.process.kill()
        self.process.wait(timeout=60)

    def start_again(self, *words):
        """Starts it again at the same address, with other files if some are given."""
        self.words = words or self.words
        self.start(int(self.address.rstrip("/").rsplit(":", 1)[1]))

    def pause(self):
        self.process.send_signal(signal.SIGSTOP)

    def go_on(self):
        self.process.send_signal(signal.SIGCONT)

    def end(self):
        """Ends it as the user does; it must have been running."""
        assert self.process.poll() is None, "nothing ends the server"
        self.process.terminate()
        assert self.process.wait(timeout=60) == 0


def settled(seen, seconds=90):
    """Waits until the page shows the answer to its last request."""
    seen.until("cplan.view && !cplan.link.awaited && !cplan.link.next && cplan.answered.id === cplan.link.id", seconds)
    return seen.do("cplan.answered")


def spot(seen, panel, place):
    """Returns the place on the screen for a place in a panel."""
    name = {"workspace": "Workspace", "cspace": "Configuration space"}[panel]
    canvas = seen.page.locator(f"canvas[aria-label='{name}']")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    x, y = seen.do("([panel, place]) => cplan.view.panels[panel].at(place)", [panel, place])
    return box["x"] + x, box["y"] + y


def drag(seen, panel, from_, to, steps=12):
    mouse = seen.page.mouse
    mouse.move(*spot(seen, panel, from_))
    mouse.down()
    for i in range(1, steps + 1):
        mouse.move(*spot(seen, panel, [a + (b - a) * i / steps for a, b in zip(from_, to)]))
    mouse.up()


def path(seen):
    return seen.do("cplan.view.model.paths[0]?.points ?? null")


def badge(seen):
    return seen.page.locator("p.status").inner_text()


def notices(seen):
    """Returns the visible error messages by place."""
    return {place: seen.page.locator(f".notice.{place}").inner_text() for place in ("picture", "options", "text", "files") if seen.page.locator(f".notice.{place}").is_visible()}

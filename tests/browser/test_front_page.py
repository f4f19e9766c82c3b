"""The pictures of pages on the front pages of the repository and of the book: they show the pages as they are.

CPLAN_WRITE_PICTURES=1 takes them again, into docs/pictures.
"""

import base64
import os

import pytest
from conftest import ROOT

# Share of the pixels that may differ: letters and curves whose edges are drawn with other grey levels.
TOLERATED_SHARE = 0.01

# The share of a picture's pixels that differ by more than 24 of 255 in one channel; 1 if the sizes differ.
DIFFERENCE = """async ([stored, fresh]) => {
    const pixels = async (data) => {
        const image = new Image();
        image.src = `data:image/png;base64,${data}`;
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d");
        canvas.drawImage(image, 0, 0);
        return canvas.getImageData(0, 0, image.width, image.height);
    };
    const [a, b] = [await pixels(stored), await pixels(fresh)];
    if (a.width !== b.width || a.height !== b.height) return 1;
    let count = 0;
    for (let k = 0; k < a.data.length; k += 4)
        count += [0, 1, 2].some((channel) => Math.abs(a.data[k + channel] - b.data[k + channel]) > 24);
    return count / (a.width * a.height);
}"""


@pytest.mark.parametrize(
    "name, robot, world, options, share, height",
    [
        ("page", "planar_2r", "shelf", ["--clearance", "0.02"], 0.45, 720),
        ("task_page", "scara", "tasks/kitting_cell", ["--clearance", "0.002"], 0.62, 860),
    ],
)
def test_a_front_page_shows_the_page_as_it_is(program, show_file, show, name, robot, world, options, share, height):
    page, _ = program.plan(robot, world, *options)
    seen = show_file(page, width=1200, height=height, reduced_motion="reduce")
    seen.do("(share) => cplan.seek(share * cplan.duration)", share)
    seen.do("new Promise(requestAnimationFrame).then(() => true)")
    fresh = seen.page.screenshot()
    stored = ROOT / f"docs/pictures/{name}.png"
    if os.environ.get("CPLAN_WRITE_PICTURES"):
        stored.write_bytes(fresh)
    encoded = [base64.b64encode(data).decode() for data in (stored.read_bytes(), fresh)]
    # A page's own policy refuses pictures that it does not hold.
    share = show("about:blank").do(DIFFERENCE, encoded)
    assert share <= TOLERATED_SHARE, f"{share:.1%} of {stored.name} is out of date: CPLAN_WRITE_PICTURES=1 takes it again"

"""Work per picture of the screen while something is dragged on the live page."""

from live import PLANAR, drag, settled, spot

COUNT = """() => { window.counts = { moves: 0, updates: 0, follows: 0, draws: 0 };
  const count = (owner, name, key) => { const act = owner[name].bind(owner); owner[name] = (...given) => { counts[key] += 1; return act(...given); }; };
  count(cplan.editor, 'moveHeldTo', 'moves');
  count(cplan.view, 'update', 'updates');
  count(cplan, 'follow', 'follows');
  count(cplan.view.panels.cspace, 'draw', 'draws'); }"""

MOVES = """([from, to]) => new Promise((done) => {
  const { canvas } = cplan.view.panels.workspace;
  const send = (kind, part) => canvas.dispatchEvent(new PointerEvent(kind, {
    bubbles: true, pointerType: 'mouse', pointerId: 1, buttons: 1, clientX: from[0] + part * (to[0] - from[0]), clientY: from[1] + part * (to[1] - from[1]),
  }));
  requestAnimationFrame(() => {
    for (let i = 1; i <= 8; i += 1) send('pointermove', i / 10);
    const early = counts.moves;
    requestAnimationFrame(() => done([early, counts.moves]));
  });
})"""


def test_several_places_of_the_pointer_make_one_move_per_picture(serve):
    seen = serve(*PLANAR)
    ends = [list(spot(seen, "workspace", place)) for place in ([0.65, -1.45], [0.95, -1.25])]
    seen.page.mouse.move(*ends[0])
    seen.page.mouse.down()
    seen.do(COUNT)
    assert seen.do(MOVES, ends) == [0, 1]
    # The place where the button is released counts, without waiting for a picture.
    seen.do("([x, y]) => cplan.view.panels.workspace.canvas.dispatchEvent(new PointerEvent('pointermove', { bubbles: true, pointerType: 'mouse', pointerId: 1, clientX: x, clientY: y }))", ends[1])
    seen.page.mouse.move(*ends[1])
    seen.page.mouse.up()
    assert settled(seen)["final"]
    corner = seen.do("cplan.scene.obstacles[1].shape.polygon[0]")
    assert abs(corner[0] - 0.8) < 0.02 and abs(corner[1] + 1.4) < 0.02


def test_a_cancelled_touch_leaves_things_at_their_last_place(serve):
    seen = serve(*PLANAR)
    ends = [list(spot(seen, "workspace", place)) for place in ([0.65, -1.45], [0.75, -1.35])]
    seen.do(
        """([from, to]) => {
          const { canvas } = cplan.view.panels.workspace;
          canvas.setPointerCapture = () => {};
          const send = (kind, [x, y]) => canvas.dispatchEvent(new PointerEvent(kind, { bubbles: true, pointerType: 'touch', pointerId: 1, clientX: x, clientY: y }));
          send('pointerdown', from);
          send('pointermove', to);
          send('pointercancel', [0, 0]);
        }""",
        ends,
    )
    assert settled(seen)["final"]
    corner = seen.do("cplan.scene.obstacles[1].shape.polygon[0]")
    assert abs(corner[0] - 0.6) < 0.02 and abs(corner[1] + 1.5) < 0.02


def test_answers_during_a_drag_draw_the_panels_and_build_no_elements(serve):
    seen = serve(*PLANAR)
    seen.do(COUNT)
    drag(seen, "workspace", [0.65, -1.45], [0.8, -1.3], steps=60)
    settled(seen)
    counts = seen.do("counts")
    assert counts["follows"] > counts["updates"] > 0, counts
    # The final answer is shown completely.
    assert seen.do("cplan.view.light") is False and seen.do("getComputedStyle(document.querySelector('.facts')).visibility") == "visible"
    assert seen.do("cplan.view.model.facts.length") > 0

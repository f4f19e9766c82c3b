// Keys that act on the page.
'use strict';

/** Directions of arrow keys. */
const DIRECTIONS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
/** Distance by which an arrow key moves a magnified picture, in pixels. */
const PAN = 40;

class Keys {
  /** @param {View} view */
  constructor(view) {
    this.view = view;
    document.addEventListener('keydown', (event) => this.key(event));
  }

  key(event) {
    const { view } = this;
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.matches?.('input:not([type=checkbox]):not([type=range]), textarea, select')) return;
    const panel = Object.values(view.panels).find(({ canvas }) => event.target === canvas);
    if (panel && (this.zooms(panel, event) || (panel === view.panels.cspace ? this.nudge(event) : this.nudgeTip(event)))) return;
    // After a choice of the mode, its button has the focus. Choosing the current mode again does nothing, so keys act on the page.
    const isCurrentMode = event.target.matches?.('[data-mode][aria-pressed=true]');
    const control = !isCurrentMode && event.target.matches?.('button, input, a, summary');
    const step = event.shiftKey ? 0.5 : 0.05;
    const isSlider = event.target === view.parts.scrubber;
    // In the replay, arrow keys go from phase to phase.
    if (view.drawn === 'think' && ['ArrowRight', 'ArrowLeft'].includes(event.key) && (isSlider || !control)) {
      view.stepPhase(event.key === 'ArrowRight' ? 1 : -1);
      event.preventDefault();
      return;
    }
    const keys = {
      ' ': () => !control && view.toggle(),
      k: () => view.toggle(),
      ArrowRight: () => !control && view.seek(view.time + step),
      ArrowLeft: () => !control && view.seek(view.time - step),
      Home: () => !control && view.seek(0),
      End: () => !control && view.seek(view.duration),
      t: () => view.switchTo(view.mode === 'think' ? 'move' : 'think'),
      l: () => view.switchTo(view.mode === 'learn' ? 'move' : 'learn'),
      '+': () => view.setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, SPEEDS.indexOf(view.speed) + 1)]),
      '-': () => view.setSpeed(SPEEDS[Math.max(0, SPEEDS.indexOf(view.speed) - 1)]),
      0: () => Object.values(view.panels).forEach((panel) => panel.reset()),
      Escape: () => view.examine(null),
    };
    if (/^[^ ]$/u.test(event.key) && !Settings.hasShortcuts) return;
    const done = keys[event.key]?.();
    if (done !== undefined && done !== false) event.preventDefault();
    else if (keys[event.key] && !control) event.preventDefault();
  }

  /**
   * Handles keys that magnify a panel or move the magnified part. In the configuration space, the visible part follows
   * the cross.
   */
  zooms(panel, event) {
    const direction = DIRECTIONS[event.key];
    const magnify = (factor) => Zoom.magnify(panel, factor, this.view.zoomSpot(panel));
    const keys = { '+': () => magnify(Zoom.FACTOR), '=': () => magnify(Zoom.FACTOR), '-': () => magnify(1 / Zoom.FACTOR), 0: () => panel.reset() };
    const pans = direction && event.shiftKey && panel.times > 1 && panel === this.view.panels.workspace;
    if (pans) panel.move(-PAN * direction[0], PAN * direction[1]);
    else if (keys[event.key]) keys[event.key]();
    else return false;
    event.preventDefault();
    return true;
  }

  /** Handles arrow keys, which move the cross in the configuration space; by smaller steps if it is magnified. */
  nudge(event) {
    const direction = DIRECTIONS[event.key];
    if (!direction) return false;
    const { view } = this;
    const from = view.probe?.q ?? view.q;
    const { joints } = view.model.arm;
    const step = (joint) => (joint.unit === 'rad' ? Math.PI / 180 : (joint.domain[1] - joint.domain[0]) / 200) * (event.shiftKey ? 10 : 1) / view.panels.cspace.times;
    view.place(joints.map((joint, k) => from[k] + direction[k] * step(joint)));
    view.panels.cspace.reveal(view.probe.q);
    event.preventDefault();
    return true;
  }

  /** Handles Enter in the workspace, which takes the arm, and then arrow keys, which move its tip. */
  nudgeTip(event) {
    const { view } = this;
    const direction = DIRECTIONS[event.key];
    if (view.drawn === 'slice' || !(direction ? view.probe : event.key === 'Enter')) return false;
    const { arm } = view.model;
    if (!direction) view.place(view.q);
    else {
      const step = ((view.model.frame[0][1] - view.model.frame[0][0]) / 200) * (event.shiftKey ? 10 : 1);
      view.dragTip(Geometry.tipAt(arm, view.probe.q).map((x, k) => x + direction[k] * step));
    }
    event.preventDefault();
    return true;
  }
}

/** Returns the part of the page that explains keys and pointer. */
function help(view) {
  const rows = [
    ...view.pointerHelp,
    ['Space or k', 'play, pause'],
    ['arrow keys elsewhere', 'back and forth in time (with Shift further); while the planner is replayed, from phase to phase'],
    ['Home, End', 'to the start, to the end'],
    ...(view.hasModes ? [['t', 'the motion, or how it was found'], ['l', 'the course: short lessons, each with a question']] : []),
    ['+, \u2212', 'faster, slower; after a click into a panel: zoom'],
    ['wheel, two fingers, then drag', 'zoom at the pointer, and move the visible part'],
    ['Shift and arrow keys in a magnified workspace', 'move the visible part'],
    ['0, double click', 'shows all again'],
    ['Escape', 'removes the examined arm'],
  ];
  const list = element('dl', {}, ...rows.flatMap(([keys, effect]) => [element('dt', {}, keys), element('dd', {}, effect)]));
  const box = element('input', { type: 'checkbox', checked: Settings.hasShortcuts, onchange: (event) => (Settings.hasShortcuts = event.target.checked) });
  const choice = element('p', {}, element('label', {}, box, ' Keys of a single character (k, t, l, +, \u2212, 0) act on the page'));
  const tour = element('button', { type: 'button', class: 'button', onclick: () => view.tour.start() }, 'Show the tour');
  return element('details', { class: 'help' }, element('summary', {}, 'Keys and pointer'), list, choice, tour);
}

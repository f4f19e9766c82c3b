// The strip below the pictures of a motion among moving obstacles: progress along the motion against time. Regions that
// obstacles block have the colours of the obstacles; the motion passes between them.
'use strict';

const Strip = (() => {
  /** Points of a name's box, across and down, at which it is looked whether the box covers a region. */
  const SAMPLES = [5, 3];
  /** Least height of a region, in pixels. */
  const LEAST_HEIGHT = 10;

  /**
   * Returns the wait of the motion at a time, or `null`.
   * @param {Model} model
   * @param {number} time in seconds
   * @returns {WaitModel | null}
   */
  function waitAt(model, time) {
    return model.strip?.waits.find(({ from, to }) => time >= from && time < to) ?? null;
  }

  /**
   * Returns the outline of the regions that an obstacle blocks, in pixels. A region that is too low to be seen is drawn
   * higher, on the side where the motion does not pass.
   * @param {Panel} panel
   * @param {{ regions: Chain[] }} obstacle
   * @param {StripModel} strip
   * @returns {Path2D}
   */
  function outline(panel, { regions }, strip) {
    const path = new Path2D();
    for (const region of regions) {
      const spots = [...Geometry.pointsOf(region)].map((point) => panel.at(point));
      const [low, high] = [Math.max(...spots.map(([, y]) => y)), Math.min(...spots.map(([, y]) => y))];
      const missing = Math.max(0, LEAST_HEIGHT - (low - high));
      const begin = Math.min(...[...Geometry.pointsOf(region)].map(([time]) => time));
      // The motion only advances: if it is beyond the region when this begins, it is beyond all that lies below.
      const isBelow = panel.at([begin, Timeline.valueAt(strip.motion, begin)])[1] < high;
      const middle = (low + high) / 2;
      const shifted = ([x, y]) => (isBelow ? [x, y > middle ? y + missing : y] : [x, y < middle ? y - missing : y]);
      spots.map(shifted).forEach(([x, y], index) => (index ? path.lineTo(x, y) : path.moveTo(x, y)));
      path.closePath();
    }
    return path;
  }

  /**
   * Returns a function that computes the share of a box that lies on regions.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {Path2D[]} outlines
   * @returns {(box: Rect) => number}
   */
  function covering(context, panel, outlines) {
    const [across, down] = SAMPLES;
    const isRegion = (x, y) => outlines.some((path) => context.isPointInPath(path, x * panel.ratio, y * panel.ratio));
    return ({ x, y, width, height }) => {
      let count = 0;
      for (let i = 0; i < across; i += 1) {
        for (let j = 0; j < down; j += 1) count += Number(isRegion(x + (width * (i + 0.5)) / across, y + (height * (j + 0.5)) / down));
      }
      return count / (across * down);
    };
  }

  /**
   * Draws the regions, the motion and its waits.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {StripModel} strip
   */
  function draw(context, panel, strip) {
    const { obstacles, motion, waits } = strip;
    const { theme } = panel;
    const outlines = obstacles.map((obstacle) => outline(panel, obstacle, strip));
    obstacles.forEach(({ color }, index) => {
      const { fill, line: edge } = theme.obstacle(color);
      [context.fillStyle, context.strokeStyle, context.lineWidth] = [fill, edge, 1.2];
      context.fill(outlines[index]);
      context.stroke(outlines[index]);
    });
    const spots = [...Geometry.pointsOf(motion)].map((point) => panel.at(point));
    for (const [width, color] of [[5, theme.paper], [2.4, theme.ink]]) {
      [context.lineWidth, context.strokeStyle] = [width, color];
      line(context, spots);
    }
    // The buttons below the strip say for what.
    const names = waits.map(({ from, to, at }) => {
      const [[left, y], [right]] = [panel.at([from, at]), panel.at([to, at])];
      [context.lineWidth, context.strokeStyle] = [4, theme.accent];
      line(context, [[left, y], [right, y]]);
      return ['waits', { rect: { x: left, y: y - 2, width: right - left, height: 4 } }];
    });
    Labels.blockLine(panel, spots);
    Labels.besideAmong(context, panel, names, covering(context, panel, outlines));
    Labels.onRegions(context, panel, obstacles.map(({ name }, index) => ({ text: `${name} blocks`, paint: (painter) => painter.fill(outlines[index]) })), true);
  }

  /**
   * Creates the strip of a view.
   * @param {View} view
   * @returns {{ root: HTMLElement, panel: Panel, fit: () => void, show: () => void, follow: () => void }}
   */
  function mount(view) {
    const canvas = element('canvas', { role: 'img', 'aria-label': 'Progress of the motion against time' });
    const waits = element('ul', { class: 'waits', 'aria-label': 'Waits' });
    const root = element('figure', { class: 'strip', hidden: true }, element('figcaption', {}, 'Times at which moving obstacles block the motion'), canvas, waits);
    const panel = new Panel(canvas, {
      x: [0, 1],
      y: [0, 1],
      titles: ['time (s)', 'progress'],
      percent: [false, true],
      margins: [58, 12, 6, 40],
      still: (context, panel) => view.model.strip && draw(context, panel, view.model.strip),
      moving: (context, panel) => view.model.strip && Timeline.dot(context, panel, view, view.model.strip.motion),
    });
    Timeline.scrub(canvas, panel, view);

    /** Shows the strip of the current model. */
    function fit() {
      const { strip } = view.model;
      show();
      if (!strip) return;
      panel.x = [0, Math.max(strip.duration, 1e-6)];
      const texts = strip.waits.map(({ from, to, text }) => `${text}, from ${from.toFixed(2)} to ${to.toFixed(2)} s`);
      const known = strip.obstacles.length ? `Blocked by ${strip.obstacles.map(({ name }) => name).join(', ')}.` : 'No moving obstacle comes near the motion.';
      canvas.setAttribute('aria-label', `Progress of the motion against time. ${known} ${texts.map((text) => `The arm ${text}.`).join(' ')}`.trim());
      waits.replaceChildren(...strip.waits.map(({ from, text }) => {
        const button = element('button', { type: 'button', class: 'button', onclick: () => view.seek(from) }, text, element('span', { class: 'at' }, `from ${Numbers.seconds(from)}`));
        return element('li', {}, button);
      }));
      waits.hidden = !strip.waits.length;
      panel.layout();
      panel.dirty = true;
    }

    /** Hides the strip unless the motion is played. */
    function show() {
      root.hidden = !view.model.strip || view.mode !== 'move';
    }

    /** Marks the current wait. */
    function follow() {
      const current = waitAt(view.model, view.time);
      [...waits.children].forEach((item, index) => {
        const isCurrent = view.model.strip.waits[index] === current;
        if (isCurrent) item.firstChild.setAttribute('aria-current', 'time');
        else item.firstChild.removeAttribute('aria-current');
      });
    }

    return { root, panel, fit, show, follow };
  }

  return { mount, waitAt };
})();

// The time bar of an exploration: the curve of the coverage over the length of the path, with a playhead.
'use strict';

/** Rows of the chart's frame around the plotting area, in pixels: left, right, top, bottom. */
const COVERAGE_MARGINS = [52, 14, 10, 40];
/** Height of the tick of a reading, in pixels, and readings per pixel from which ticks are paler. */
const [READING_TICK, CROWDED_TICKS] = [7, 0.25];
/** Room at both ends of the curve for the playhead, as a fraction of the path length. */
const EDGE = 0.01;
/** Number of readings that the keys Page Up and Page Down pass. */
const PAGE_OF_READINGS = 10;

/**
 * A reading of the sensor.
 * @typedef {{ length: number, seen: number, decision?: number }} CoveragePoint
 * `length`: path length so far; `seen`: fraction of the map that has been seen; `decision`: time of the decision that
 * led there, in milliseconds.
 */

class Coverage {
  /**
   * @param {CoveragePoint[]} points the readings in order
   * @param {{ title: string, describe: (index: number) => string, seek: (index: number) => void }} options
   * title of the length axis, and functions that describe a reading and show it
   */
  constructor(points, { title, describe, seek }) {
    this.points = points;
    this.describe = describe;
    this.seek = seek;
    this.index = points.length - 1;
    this.canvas = element('canvas', {
      class: 'coverage', tabindex: '0', role: 'slider', 'aria-label': 'Reading', 'aria-valuemin': '1', 'aria-valuemax': String(points.length),
      onkeydown: (event) => this.key(event),
      onpointerdown: (event) => this.hold(event),
      onpointermove: (event) => event.buttons && this.canvas.hasPointerCapture(event.pointerId) && this.point(event),
    });
    this.panel = new Panel(this.canvas, {
      x: [-EDGE, 1 + EDGE].map((part) => part * points[this.index].length), y: [0, 100], titles: [title, 'seen (%)'], margins: COVERAGE_MARGINS,
      still: (context, panel) => this.drawCurve(context, panel),
      moving: (context, panel) => this.drawPlayhead(context, panel),
    });
  }

  /**
   * Moves the playhead to a reading.
   * @param {number} index
   */
  show(index) {
    this.index = index;
    this.canvas.setAttribute('aria-valuenow', String(index + 1));
    this.canvas.setAttribute('aria-valuetext', this.describe(index));
    this.panel.draw();
  }

  /** Begins a drag of the playhead. */
  hold(event) {
    if (event.button !== 0) return;
    this.canvas.setPointerCapture(event.pointerId);
    this.point(event);
  }

  /** Chooses the reading that is nearest to the pointer along the path. */
  point(event) {
    const [length] = this.panel.value(this.panel.spot(event));
    this.seek(this.nearest(length));
  }

  /**
   * Returns the reading whose path length is nearest; the last of several at the same place.
   * @param {number} length
   * @returns {number}
   */
  nearest(length) {
    const distance = (index) => Math.abs(this.points[index].length - length);
    return this.points.reduce((best, _, index) => (distance(index) <= distance(best) ? index : best), 0);
  }

  /** Handles keys, as a slider does. */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const last = this.points.length - 1;
    const page = event.shiftKey ? PAGE_OF_READINGS : 1;
    const places = {
      ArrowRight: this.index + page, ArrowUp: this.index + page, ArrowLeft: this.index - page, ArrowDown: this.index - page,
      PageUp: this.index + PAGE_OF_READINGS, PageDown: this.index - PAGE_OF_READINGS, Home: 0, End: last,
    };
    const place = places[event.key];
    if (place === undefined) return;
    this.seek(Math.min(last, Math.max(0, place)));
    event.preventDefault();
    // The page also has keys for the time.
    event.stopPropagation();
  }

  /**
   * Returns the corners of the curve up to a reading, in pixels. The coverage changes only with a reading.
   * @param {Panel} panel
   * @param {number} last
   * @returns {number[][]}
   */
  corners(panel, last) {
    const at = ({ length, seen }) => panel.at([length, 100 * seen]);
    const spots = this.points.slice(0, last + 1).map(at);
    return spots.flatMap(([x, y], k) => (k ? [[x, spots[k - 1][1]], [x, y]] : [[x, y]]));
  }

  /** Draws the whole curve, the readings as ticks, and the times of decisions as dots. */
  drawCurve(context, panel) {
    const { theme, rect } = panel;
    const bottom = rect.y + rect.height;
    context.strokeStyle = theme.grey;
    context.lineWidth = 1;
    context.globalAlpha = this.points.length > CROWDED_TICKS * rect.width ? 0.4 : 0.9;
    context.beginPath();
    for (const { length } of this.points) {
      const [x] = panel.at([length, 0]);
      context.moveTo(x, bottom);
      context.lineTo(x, bottom - READING_TICK);
    }
    context.stroke();
    context.globalAlpha = 1;
    const slowest = Math.max(...this.points.map(({ decision = 0 }) => decision));
    context.fillStyle = theme.grey;
    for (const { length, decision } of this.points) {
      if (decision === undefined) continue;
      const [x, y] = panel.at([length, (100 * decision) / (slowest || 1)]);
      context.fillRect(x - 1.5, y - 1.5, 3, 3);
    }
    context.strokeStyle = theme.grey;
    context.lineWidth = 1.4;
    line(context, this.corners(panel, this.points.length - 1));
  }

  /** Draws the part of the curve so far, and the playhead. */
  drawPlayhead(context, panel) {
    const { theme, rect } = panel;
    const bottom = rect.y + rect.height;
    const corners = this.corners(panel, this.index);
    const [x, y] = corners[corners.length - 1];
    context.globalAlpha = 0.16;
    context.fillStyle = theme.accent;
    context.beginPath();
    [[corners[0][0], bottom], ...corners, [x, bottom]].forEach((spot, k) => (k ? context.lineTo(...spot) : context.moveTo(...spot)));
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = theme.accent;
    context.lineWidth = 2.4;
    line(context, corners);
    context.lineWidth = 1.6;
    line(context, [[x, rect.y], [x, bottom]]);
    for (const [radius, color] of [[8, theme.paper], [6, theme.accent]]) {
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fillStyle = color;
      context.fill();
    }
  }
}

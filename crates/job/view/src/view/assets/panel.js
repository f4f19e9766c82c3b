// A canvas with axes: it converts values to pixels and back, and uses the colours of the page.
'use strict';

/** The colours of the page's style sheet, for light and dark mode. */
class Theme {
  constructor(root) {
    const style = getComputedStyle(root);
    const value = (name) => style.getPropertyValue(`--${name}`).trim();
    for (const name of ROLES) this[name] = value(name);
    this.dark = value('dark') === '1';
    /** Size of text on canvases, in pixels. It follows the reader's text size, as the text around the canvases does. */
    this.text = parseFloat(style.fontSize) * parseFloat(value('type-small'));
    this.family = value('font');
  }

  /** Returns the font of text on canvases. `scale` is relative to the usual size. */
  font(weight = 400, scale = 1) {
    return `${weight} ${scale * this.text}px ${this.family}`;
  }

  /** Returns a colour with some of another mixed in; both as #rrggbb. */
  static mixed(color, other, part) {
    const channel = (text, k) => parseInt(text.slice(1 + 2 * k, 3 + 2 * k), 16);
    const mix = (k) => Math.round(channel(color, k) + (channel(other, k) - channel(color, k)) * part);
    return `#${[0, 1, 2].map((k) => mix(k).toString(16).padStart(2, '0')).join('')}`;
  }

  /** Returns a colour that is given by its name or as #rrggbb. */
  tint(color) {
    return this[color] ?? color;
  }

  /** Returns the colour of a line that is given by its name or as #rrggbb. Colours of objects are lighter on a dark ground. */
  stroke(color) {
    return this[color] ?? (this.dark ? Theme.mixed(color, '#ffffff', 0.5) : color);
  }

  /** Returns the surface and the outline of an obstacle. */
  obstacle(color) {
    if (this.dark) return { fill: Theme.mixed(color, this.paper, 0.35), line: Theme.mixed(color, '#ffffff', 0.35) };
    return { fill: Theme.mixed(color, this.paper, 0.3), line: Theme.mixed(color, '#000000', 0.28) };
  }

  /** Returns a colour of the scale from 0 to 1, which is read by its lightness. */
  scale(part) {
    const at = Math.min(1, Math.max(0, this.dark ? 1 - part : part)) * (SCALE_STOPS.length - 1);
    const below = Math.min(Math.floor(at), SCALE_STOPS.length - 2);
    return Theme.mixed(SCALE_STOPS[below], SCALE_STOPS[below + 1], at - below);
  }
}

/**
 * Returns ticks of an axis from `low` to `high` that is `room` pixels long, at least about `spacing` pixels apart.
 * `degrees` is true for an axis in radians, or 'plain' to leave out the degree sign.
 */
function ticks(low, high, degrees, room, spacing) {
  const unit = degrees ? Math.PI / 180 : 1;
  const wanted = ((high - low) / unit / Math.max(2, room / spacing)) || 1;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const steps = degrees && wanted > 4 && wanted <= 720 ? [5, 10, 15, 30, 45, 90, 180, 360, 720] : [1, 2, 5, 10].map((k) => k * power);
  const step = steps.find((s) => s >= wanted * 0.999) ?? steps[steps.length - 1];
  const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const found = [];
  for (let k = Math.ceil(low / unit / step - 1e-9); k * step * unit <= high + 1e-9 * (high - low); k += 1) {
    const text = (k * step).toFixed(digits).replace('-', '\u2212');
    found.push({ value: k * step * unit, text: degrees === true ? `${text}\u00b0` : text });
  }
  return found;
}

/** Largest magnification of a panel: numbers of a view have five digits. */
const MOST_TIMES = 2000;

/** Room for the frame of the focus to the left of the title of the upright axis, in pixels. */
const FOCUS_ROOM = 4;

class Panel {
  /** Text size for which margins and distances are given, in pixels. */
  static TEXT = 13;

  /**
   * @param {HTMLCanvasElement} canvas the canvas to draw on
   * @param {{ x: Point, y: Point, degrees?: (boolean | string)[], percent?: boolean[], titles?: string[], scale?: string, still?: Drawing, moving?: Drawing, beside?: Drawing, shape?: ?number, margins?: number[] }} options `x`, `y`: ranges; `degrees`, `percent`: for both axes; `titles`; `scale`: 'fill' (one scale, may show more than
   * the ranges), 'fit' (one scale, exactly the ranges) or 'free'; `still` and `moving`: functions that draw the fixed
   * and the moving content; `shape`: ratio of width to height, or `null` for all the room; `beside`: one that draws fixed content outside the sides; `margins`
   */
  constructor(canvas, { x, y, degrees = [false, false], percent = [false, false], titles = ['', ''], scale = 'free', still = null, moving = null, beside = null, shape = null, margins = undefined }) {
    this.canvas = canvas;
    this.x = x;
    this.y = y;
    this.degrees = degrees;
    this.percent = percent;
    /** True for each axis whose ends are the same position of the joint. */
    this.seams = [false, false];
    this.titles = titles;
    this.scale = scale;
    this.still = still;
    this.moving = moving;
    this.beside = beside;
    this.shape = shape;
    this.margins = margins;
    /** @type {?Theme} */
    this.theme = null;
    this.overlays = [];
    /** Magnification, and the part of the ranges that is then in the middle. */
    this.times = 1;
    this.middle = [0, 0];
    this.back = document.createElement('canvas');
    this.scratch = document.createElement('canvas');
    this.dirty = true;
    /** Items that names avoid: those of the fixed content, and all. */
    this.fixed = this.blocked = Labels.nothing();
    /** Last place of each name, by its number among the possible places. */
    this.placed = new Map();
    new ResizeObserver(() => this.resize()).observe(canvas);
    // The first picture may be drawn before the page's font is ready.
    document.fonts.addEventListener('loadingdone', () => this.resize());
    this.resize();
  }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    for (const canvas of [this.canvas, this.back, this.scratch]) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    this.ratio = ratio;
    this.size = [width, height];
    this.layout();
    this.dirty = true;
    this.draw();
  }

  /** Fits ranges to pixels. */
  layout() {
    if (!this.size) return;
    const [narrow, right, top, bottom] = (this.margins ?? [48, 10, 8, 40]).map((margin) => margin * this.zoom);
    const left = narrow + this.digits + FOCUS_ROOM * this.zoom;
    const rect = { x: left, y: top, width: Math.max(1, this.size[0] - left - right), height: Math.max(1, this.size[1] - top - bottom) };
    // On a broad canvas, such as on a phone, that would waste too much room.
    if (this.shape && rect.width < 1.7 * rect.height) {
      const [width, height] = [Math.min(rect.width, rect.height * this.shape), Math.min(rect.height, rect.width / this.shape)];
      Object.assign(rect, { x: rect.x + (rect.width - width) / 2, width, height });
    }
    let [x, y] = [this.x.slice(), this.y.slice()];
    for (const range of [x, y]) if (!(range[1] > range[0])) [range[0], range[1]] = [range[0] - 0.5, range[0] + 0.5];
    if (this.scale !== 'free') {
      const scale = Math.min(rect.width / (x[1] - x[0]), rect.height / (y[1] - y[0]));
      const [width, height] = [(x[1] - x[0]) * scale, (y[1] - y[0]) * scale];
      if (this.scale === 'fit') {
        Object.assign(rect, { x: rect.x + (rect.width - width) / 2, width, height });
      } else {
        const about = (/** @type {Point} */ [a, b], length) => [(a + b - length) / 2, (a + b + length) / 2];
        [x, y] = [about(x, rect.width / scale), about(y, rect.height / scale)];
      }
    }
    this.rect = rect;
    this.whole = [x, y];
    this.shown = this.whole.map(([low, high], k) => {
      const half = (high - low) / 2 / this.times;
      this.middle[k] = this.times > 1 ? Math.min(high - half, Math.max(low + half, this.middle[k])) : (low + high) / 2;
      return [this.middle[k] - half, this.middle[k] + half];
    });
  }

  /** Returns the size of text relative to the usual one. */
  get zoom() {
    return (this.theme?.text ?? Panel.TEXT) / Panel.TEXT;
  }

  /** Returns the room for the additional digits of values in a magnified panel, in pixels. */
  get digits() {
    return 7 * this.zoom * Math.max(0, Math.ceil(Math.log10(this.times) - 0.3));
  }

  /** Magnifies by a factor; the value at a spot stays there as far as possible. */
  magnify(factor, spot) {
    const value = this.value(spot);
    this.times = Math.min(MOST_TIMES, Math.max(1, this.times * factor));
    if (this.times < 1.001) this.times = 1;
    this.layout();
    const now = this.value(spot);
    this.middle = this.middle.map((x, k) => x + value[k] - now[k]);
    this.layout();
    this.redraw();
  }

  /** Moves the magnified part by this many pixels. */
  move(dx, dy) {
    const [from, to] = [this.value([0, 0]), this.value([dx, dy])];
    this.middle = this.middle.map((x, k) => x - (to[k] - from[k]));
    this.layout();
    this.redraw();
  }

  /** Moves the magnified part so that a value is visible. */
  reveal(value) {
    const isSeen = value.every((x, k) => x >= this.shown[k][0] && x <= this.shown[k][1]);
    if (isSeen || this.times === 1) return;
    this.middle = value.slice();
    this.layout();
    this.redraw();
  }

  /** Shows the whole ranges again. */
  reset() {
    this.times = 1;
    this.layout();
    this.redraw();
  }

  /** Draws everything with the next picture of the screen. */
  redraw() {
    this.dirty = true;
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.draw();
    });
  }

  /**
   * Returns the spot of a value, in pixels.
   * @param {Point} value
   * @returns {Point}
   */
  at([x, y]) {
    const { rect, shown } = this;
    return [
      rect.x + ((x - shown[0][0]) / (shown[0][1] - shown[0][0])) * rect.width,
      rect.y + rect.height - ((y - shown[1][0]) / (shown[1][1] - shown[1][0])) * rect.height,
    ];
  }

  /**
   * Returns the value at a spot.
   * @param {Point} spot in pixels
   * @returns {Point}
   */
  value([px, py]) {
    const { rect, shown } = this;
    return [
      shown[0][0] + ((px - rect.x) / rect.width) * (shown[0][1] - shown[0][0]),
      shown[1][0] + ((rect.y + rect.height - py) / rect.height) * (shown[1][1] - shown[1][0]),
    ];
  }

  /** Returns pixels per metre (or radian) along the first axis. */
  get pixels() {
    return this.rect.width / (this.shown[0][1] - this.shown[0][0]);
  }

  /** Returns the place of a pointer, in pixels within the canvas. */
  spot(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {Point} spot */
  contains([px, py]) {
    const { rect } = this;
    return px >= rect.x && px <= rect.x + rect.width && py >= rect.y && py <= rect.y + rect.height;
  }

  draw() {
    if (!this.size || !this.theme) return;
    if (this.dirty) {
      this.dirty = false;
      this.blocked = Labels.nothing();
      const context = this.begin(this.back);
      this.axes(context);
      this.within(context, () => this.still?.(context, this));
      this.border(context);
      this.beside?.(context, this);
      this.fixed = this.blocked;
    }
    this.blocked = Labels.copy(this.fixed);
    const context = this.begin(this.canvas);
    context.drawImage(this.back, 0, 0, this.size[0], this.size[1]);
    this.within(context, () => {
      this.moving?.(context, this);
      for (const overlay of this.overlays) overlay(context, this);
    });
  }

  begin(canvas) {
    const context = canvas.getContext('2d');
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.clearRect(0, 0, this.size[0], this.size[1]);
    context.lineJoin = 'round';
    return context;
  }

  /** Draws something as a whole, with opacity `alpha`. */
  faded(context, alpha, draw) {
    if (alpha >= 1) {
      draw(context);
      return;
    }
    draw(this.begin(this.scratch));
    context.save();
    context.globalAlpha = alpha;
    context.drawImage(this.scratch, 0, 0, this.size[0], this.size[1]);
    context.restore();
  }

  within(context, draw) {
    const { rect } = this;
    context.save();
    context.beginPath();
    context.rect(rect.x, rect.y, rect.width, rect.height);
    context.clip();
    draw();
    context.restore();
  }

  axes(context) {
    const { rect, shown, theme, zoom } = this;
    context.fillStyle = theme.paper;
    context.fillRect(rect.x, rect.y, rect.width, rect.height);
    context.font = theme.font();
    context.fillStyle = theme.grey;
    context.strokeStyle = theme.faint;
    context.lineWidth = 1;
    const [across, up] = [0, 1].map((k) => ticks(...shown[k], this.degrees[k], [rect.width, rect.height][k], [56 * zoom + 1.4 * this.digits, 34 * zoom][k]));
    context.textAlign = 'center';
    context.textBaseline = 'top';
    for (const { value, text } of across) {
      const [x] = this.at([value, shown[1][0]]);
      line(context, [[x, rect.y], [x, rect.y + rect.height]]);
      // The last number, with its degree sign, stays within the canvas.
      context.fillText(text, Math.min(x, this.size[0] - context.measureText(text).width / 2 - 1), rect.y + rect.height + 5 * zoom);
    }
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    for (const { value, text } of up) {
      const [, y] = this.at([shown[0][0], value]);
      line(context, [[rect.x, y], [rect.x + rect.width, y]]);
      context.fillText(this.percent[1] ? `${Math.round(100 * value)} %` : text, rect.x - 6 * zoom, y);
    }
    context.fillStyle = theme.ink;
    context.textAlign = 'center';
    context.textBaseline = 'bottom';
    context.fillText(this.titles[0], rect.x + rect.width / 2, rect.y + rect.height + 37 * zoom);
    context.save();
    context.translate(rect.x - Math.max(35, (this.margins?.[0] ?? 48) - 13) * zoom - this.digits, rect.y + rect.height / 2);
    context.rotate(-Math.PI / 2);
    context.fillText(this.titles[1], 0, 0);
    context.restore();
  }

  /** Draws the border. Seams are dashed in the accent colour: a path that leaves there comes back on the other side. */
  border(context) {
    const { rect, theme } = this;
    const sides = [
      [[rect.x, rect.y], [rect.x, rect.y + rect.height], this.seams[0]],
      [[rect.x + rect.width, rect.y], [rect.x + rect.width, rect.y + rect.height], this.seams[0]],
      [[rect.x, rect.y], [rect.x + rect.width, rect.y], this.seams[1]],
      [[rect.x, rect.y + rect.height], [rect.x + rect.width, rect.y + rect.height], this.seams[1]],
    ];
    for (const [a, b, seam] of sides) {
      context.strokeStyle = seam ? theme.accent : theme.grey;
      context.lineWidth = seam ? 2 : 1;
      context.setLineDash(seam ? [7, 5] : []);
      line(context, [a, b]);
    }
    context.setLineDash([]);
  }
}

/** Strokes a polyline of pixels. */
function line(context, spots) {
  context.beginPath();
  spots.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
}

/** Adds a polyline of values, given as a flat list of coordinates, to the current outline; shifted by `by`. */
function trace(context, panel, flat, closed, by = [0, 0]) {
  for (let i = 0; i + 1 < flat.length; i += 2) {
    const [x, y] = panel.at([flat[i] + by[0], flat[i + 1] + by[1]]);
    if (i) context.lineTo(x, y);
    else context.moveTo(x, y);
  }
  if (closed) context.closePath();
}

/** Draws a cross with a light ground: the place where the arm gets stuck. */
function cross(context, theme, [x, y]) {
  for (const [r, width, color] of [[7.5, 6, theme.paper], [6, 2.6, theme.infeasible]]) {
    [context.lineWidth, context.strokeStyle] = [width, color];
    for (const side of [1, -1]) line(context, [[x - r, y - r * side], [x + r, y + r * side]]);
  }
}

/** Horizontal distance between neighbouring lines of a hatch, in pixels. */
const HATCH = 7;

/** Draws lines that rise to the right, within the current outline. */
function hatch(context, rect, color) {
  context.save();
  context.clip();
  context.beginPath();
  const last = rect.x + rect.width + rect.y + rect.height;
  for (let sum = HATCH * Math.ceil((rect.x + rect.y) / HATCH); sum <= last; sum += HATCH) {
    context.moveTo(rect.x, sum - rect.x);
    context.lineTo(sum - rect.y, rect.y);
  }
  context.lineWidth = 1.6;
  context.strokeStyle = color;
  context.stroke();
  context.restore();
}

/** Adds the outline of a rounded convex shape: its sides moved outwards, joined by arcs. */
function rounded(context, panel, { core, radius }) {
  const n = core.length / 2;
  const r = radius * panel.pixels;
  if (n === 1) {
    const [x, y] = panel.at(core);
    context.moveTo(x + r, y);
    // In the same orientation as the other outlines, because the non-zero rule unites them.
    context.arc(x, y, r, 0, 2 * Math.PI, true);
    return;
  }
  let [first, last] = [null, null];
  for (let i = 0; i < n; i += 1) {
    const j = (i + 1) % n;
    const [a, b] = [panel.at([core[2 * i], core[2 * i + 1]]), panel.at([core[2 * j], core[2 * j + 1]])];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length === 0) continue;
    // Corners run counter-clockwise in the plane, but clockwise in pixels, which count downwards.
    const [nx, ny] = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
    const angle = Math.atan2(ny, nx);
    if (first === null) {
      first = angle;
      context.moveTo(a[0] + nx * r, a[1] + ny * r);
    } else if (r > 0) context.arc(a[0], a[1], r, last, angle, true);
    else context.lineTo(a[0], a[1]);
    context.lineTo(b[0] + nx * r, b[1] + ny * r);
    last = angle;
  }
  if (r > 0 && first !== null) {
    const [x, y] = panel.at([core[0], core[1]]);
    context.arc(x, y, r, last, first, true);
  }
  context.closePath();
}

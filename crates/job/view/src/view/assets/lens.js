// A lens on the tube of the tolerance around a line, and on the path of the tip in it.
'use strict';

/** The lens: a canvas without axes on which the line, the tube of the tolerance and the path of the tip are true to scale. */
class Lens {
  /** Points between two samples, and the greatest number of points on each side of the place. */
  static POINTS = 8;
  static MOST = 4000;
  /** Chords that draw the part of a curve. */
  static CHORDS = 32;

  /** @param {FollowedLine} followed */
  constructor(followed) {
    this.followed = followed;
    this.canvas = element('canvas', { role: 'img', 'aria-label': 'Path of the tip and tube of the tolerance, magnified' });
    this.theme = null;
    this.dirty = true;
    /** True while the lens stays where the tip is farthest from the line. */
    this.stays = true;
    new ResizeObserver(() => this.draw()).observe(this.canvas);
  }

  layout() {}

  get time() {
    return this.stays ? this.followed.motion.farthest[0] : this.followed.view.time;
  }

  draw() {
    const { canvas, theme, followed } = this;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (!theme || !width || !followed.motion) return;
    const ratio = window.devicePixelRatio || 1;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const context = canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.lineJoin = 'round';
    context.fillStyle = theme.paper;
    context.fillRect(0, 0, width, height);
    const { lens, tolerance, curves = [] } = followed.line;
    const center = followed.tipAt(this.time);
    const scale = Math.min(width, height) / (2 * lens);
    const far = Math.hypot(width, height) / scale;
    const at = ([x, y]) => [width / 2 + (x - center[0]) * scale, height / 2 - (y - center[1]) * scale];
    const parts = curves.map((curve) => Lens.near(curve, center, far)).filter(Boolean);
    context.lineCap = 'round';
    [context.lineWidth, context.strokeStyle] = [2 * tolerance * scale, theme.ghost];
    for (const part of parts) line(context, part.points.map(at));
    context.lineCap = 'butt';
    [context.lineWidth, context.strokeStyle] = [1.2, theme.grey];
    context.setLineDash([6, 4]);
    for (const part of parts) line(context, part.points.map(at));
    context.setLineDash([]);
    const path = this.path(center, far).map(at);
    for (const [thick, color] of [[4.6, theme.paper], [2.2, theme.ink]]) {
      [context.lineWidth, context.strokeStyle] = [thick, color];
      line(context, path);
    }
    context.beginPath();
    context.arc(width / 2, height / 2, 5, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [theme.accent, theme.paper, 1.5];
    context.fill();
    context.stroke();
    Lens.bar(context, theme, scale, width, height);
    const off = Math.min(...parts.map((part) => part.off));
    followed.say(this.time, Number.isFinite(off) ? off : null);
  }

  /** Draws a bar of a round length. */
  static bar(context, theme, scale, width, height) {
    const room = (0.4 * width) / scale;
    const power = 10 ** Math.floor(Math.log10(room));
    const size = [5, 2, 1].map((k) => k * power).find((length) => length <= room) ?? power;
    const [x, y] = [10, height - 10];
    [context.lineWidth, context.strokeStyle] = [1.5, theme.ink];
    line(context, [[x, y - 4], [x, y], [x + size * scale, y], [x + size * scale, y - 4]]);
    context.font = theme.font();
    [context.textAlign, context.textBaseline] = ['left', 'middle'];
    for (const [draw, color] of [['strokeText', theme.paper], ['fillText', theme.ink]]) {
      [context.lineWidth, context.strokeStyle, context.fillStyle] = [3, color, color];
      context[draw](Numbers.length(size), x + size * scale + 7, y - 3);
    }
  }

  /** Returns the path of the tip around the lens's time, as far as it is within a distance of the centre. */
  path(center, far) {
    const { followed, time } = this;
    const { clock } = followed.view.model;
    const walk = (step) => {
      const found = [];
      let k = Geometry.interval(clock, time);
      for (let share = step > 0 ? 0 : Lens.POINTS; found.length < Lens.MOST; share += step) {
        if (share < 0 || share > Lens.POINTS) [k, share] = [k + step, step > 0 ? 0 : Lens.POINTS];
        if (k < 0 || k + 1 >= clock.time.length) break;
        const moment = clock.time[k] + ((clock.time[k + 1] - clock.time[k]) * share) / Lens.POINTS;
        if ((moment - time) * step <= 0) continue;
        const tip = followed.tipAt(moment, k);
        found.push(tip);
        if (Math.hypot(tip[0] - center[0], tip[1] - center[1]) > far) break;
      }
      return found;
    };
    return [...walk(-1).reverse(), center, ...walk(1)];
  }

  /** Returns the point of a curve at a parameter: a straight line, an arc of a circle or spiral, or a cubic curve. */
  static at(curve, u) {
    if (curve.length === 4) return [0, 1].map((k) => curve[k] * (1 - u) + curve[k + 2] * u);
    if (curve.length <= 6) {
      const [x, y, radius, from, by, growth = 0] = curve;
      const r = radius + growth * u;
      return [x + r * Math.cos(from + by * u), y + r * Math.sin(from + by * u)];
    }
    const v = 1 - u;
    return [0, 1].map((k) => v * v * v * curve[k] + 3 * v * v * u * curve[k + 2] + 3 * v * u * u * curve[k + 4] + u * u * u * curve[k + 6]);
  }

  /** Returns the parameter at which a curve is nearest to a point. */
  static nearest(curve, [x, y]) {
    const within = (u) => Math.min(1, Math.max(0, u));
    if (curve.length === 4) {
      const [dx, dy] = [curve[2] - curve[0], curve[3] - curve[1]];
      return within(((x - curve[0]) * dx + (y - curve[1]) * dy) / (dx * dx + dy * dy || 1));
    }
    if (curve.length <= 6) {
      const [cx, cy, , from, by] = curve;
      const turn = ((Math.atan2(y - cy, x - cx) - from) * Math.sign(by)) / Geometry.TURN;
      const u = ((turn - Math.floor(turn)) * Geometry.TURN) / Math.abs(by);
      // Beyond the end, the nearer end counts.
      return u <= 1 ? u : within(u > (1 + Geometry.TURN / Math.abs(by)) / 2 ? 0 : 1);
    }
    const far = (u) => {
      const p = Lens.at(curve, u);
      return Math.hypot(p[0] - x, p[1] - y);
    };
    let [best, step] = [0, 1 / 64];
    for (let k = 1; k <= 64; k += 1) if (far(k / 64) < far(best)) best = k / 64;
    for (; step > 1e-10; step /= 2) best = [within(best - step), best, within(best + step)].reduce((a, b) => (far(b) < far(a) ? b : a));
    return best;
  }

  /** Returns the part of a curve near a point, and the distance of the curve from it; `null` if it is farther than `far`. */
  static near(curve, center, far) {
    const foot = Lens.nearest(curve, center);
    const at = Lens.at(curve, foot);
    const off = Math.hypot(at[0] - center[0], at[1] - center[1]);
    if (off > far) return null;
    const [a, b] = [Lens.at(curve, Math.max(0, foot - 1e-4)), Lens.at(curve, Math.min(1, foot + 1e-4))];
    const speed = Math.hypot(b[0] - a[0], b[1] - a[1]) / (Math.min(1, foot + 1e-4) - Math.max(0, foot - 1e-4));
    const half = Math.min(1, (1.5 * far) / (speed || 1e-12));
    const [from, to] = [Math.max(0, foot - half), Math.min(1, foot + half)];
    return { off, points: Array.from({ length: Lens.CHORDS + 1 }, (_, k) => Lens.at(curve, from + ((to - from) * k) / Lens.CHORDS)) };
  }
}

// The editable parts of a world: obstacles, start, goal, clearance; with undo.
'use strict';

/** Rounds places to a tenth of a millimetre, angles to a ten-thousandth of a radian. */
const rounded4 = (x) => Math.round(x * 1e4) / 1e4;
const roundedPoint = (p) => p.map(rounded4);

class Scene {
  /** Creates the scene from the server's message. */
  constructor(world) {
    this.world = world;
    this.obstacles = world.obstacles.map(({ name, ...shape }, from) => ({ from, name, shape: Object.keys(shape).length ? shape : null }));
    /** @type {{ joints?: Point, tip?: Point, near?: Point } | null | undefined} */
    this.start = world.start && { joints: world.start };
    this.goal = world.goal;
    this.clearance = world.clearance;
    /** Limits of joints that differ from those of the text: least and greatest value by the joint's name. */
    this.limits = {};
    this.past = [];
    this.future = [];
    this.kept = this.snapshot();
    this.first = this.kept;
  }

  snapshot() {
    const { obstacles, start, goal, clearance, limits } = this;
    return JSON.stringify({ obstacles, start, goal, clearance, limits });
  }

  /** Returns the record to keep. */
  get record() {
    const { kept, past, future } = this;
    return { scene: kept, past, future };
  }

  /** Restores a record that was kept. */
  restore({ scene, past, future }) {
    Object.assign(this, { kept: scene, past, future }, JSON.parse(scene));
  }

  /** Returns true if anything differs from the text. */
  get isChanged() {
    return this.kept !== this.first;
  }

  /** Returns to the state of the text. */
  reset() {
    Object.assign(this, JSON.parse(this.first));
  }

  /** Adds the current state to the history. Returns true if it differs from the previous one. */
  settle() {
    const now = this.snapshot();
    if (now === this.kept) return false;
    this.past.push(this.kept);
    if (this.past.length > 200) this.past.shift();
    this.future = [];
    this.kept = now;
    return true;
  }

  /** Goes one step back or forward. */
  step(from, to) {
    if (!from.length) return false;
    to.push(this.kept);
    this.kept = from.pop();
    Object.assign(this, JSON.parse(this.kept));
    return true;
  }

  undo() {
    return this.step(this.past, this.future);
  }

  redo() {
    return this.step(this.future, this.past);
  }

  /** Returns the state in a request. */
  request() {
    const piece = ({ from, name, shape }) => ({ from, ...(from === null ? { name } : {}), ...(shape ?? {}) });
    return { obstacles: this.obstacles.map(piece), start: this.start, goal: this.goal, clearance: this.clearance, limits: Object.entries(this.limits).map(([joint, range]) => ({ joint, range })) };
  }

  /** Returns a name that no obstacle has. */
  name(kind) {
    const taken = new Set(this.obstacles.map((obstacle) => obstacle.name));
    let number = 1;
    while (taken.has(`${kind} ${number}`)) number += 1;
    return `${kind} ${number}`;
  }

  add(kind, shape) {
    this.obstacles.push({ from: null, name: this.name(kind), shape });
    return this.obstacles.length - 1;
  }
}

const Shapes = {
  corners: (shape) => shape?.polygon ?? shape?.polyline ?? null,

  /** Returns the shape, moved as a whole. */
  moved(shape, by) {
    const move = ([x, y]) => roundedPoint([x + by[0], y + by[1]]);
    if (shape.circle) return { circle: { ...shape.circle, center: move(shape.circle.center) } };
    if (shape.polygon) return { polygon: shape.polygon.map(move) };
    return { polyline: shape.polyline.map(move) };
  },

  /** Returns the shape with other corners. */
  cornered(shape, corners) {
    return shape.polygon ? { polygon: corners } : { polyline: corners };
  },

  /** Returns the sides, as pairs of indices of corners. */
  sides(shape) {
    const n = Shapes.corners(shape).length;
    return Array.from({ length: shape.polygon ? n : n - 1 }, (_, i) => [i, (i + 1) % n]);
  },

  middle(shape) {
    if (shape.circle) return shape.circle.center;
    const corners = Shapes.corners(shape);
    return [0, 1].map((k) => corners.reduce((sum, p) => sum + p[k], 0) / corners.length);
  },

  toSide([px, py], [ax, ay], [bx, by]) {
    const [dx, dy] = [bx - ax, by - ay];
    const square = dx * dx + dy * dy;
    const t = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / square)) : 0;
    return { distance: Math.hypot(px - ax - t * dx, py - ay - t * dy), at: [ax + t * dx, ay + t * dy] };
  },

  /** Returns the side nearest to a point. */
  nearestSide(shape, p) {
    const corners = Shapes.corners(shape);
    const sides = Shapes.sides(shape).map(([a, b]) => ({ after: a, ...Shapes.toSide(p, corners[a], corners[b]) }));
    return sides.reduce((best, side) => (side.distance < best.distance ? side : best));
  },

  /** Returns true if a point is in the shape, or not farther from it than `near`. */
  holds(shape, p, near) {
    if (shape.circle) return Math.hypot(p[0] - shape.circle.center[0], p[1] - shape.circle.center[1]) <= shape.circle.radius + near;
    if (Shapes.nearestSide(shape, p).distance <= near) return true;
    if (!shape.polygon) return false;
    const odd = (inside, [a, b]) => {
      const [[ax, ay], [bx, by]] = [shape.polygon[a], shape.polygon[b]];
      return (ay > p[1]) !== (by > p[1]) && p[0] < ax + ((bx - ax) * (p[1] - ay)) / (by - ay) ? !inside : inside;
    };
    return Shapes.sides(shape).reduce(odd, false);
  },

  /** Returns the shape for the contact tests, roughly: as pieces of its outline. */
  pieces(shape) {
    if (shape.circle) return [{ core: shape.circle.center, radius: shape.circle.radius }];
    const corners = Shapes.corners(shape);
    return Shapes.sides(shape).map(([a, b]) => ({ core: [...corners[a], ...corners[b]], radius: 0 }));
  },
};

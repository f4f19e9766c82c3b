// Kinematics, contacts and motion in time: the same computations as in the program, for users who move the arm by hand.
// Points are [x, y], poses [x, y, cosine, sine], shapes { core: [x0, y0, x1, y1, ...], radius }.
'use strict';

const Geometry = (() => {
  const TURN = 2 * Math.PI;

  const compose = (a, b) => [
    a[0] + a[2] * b[0] - a[3] * b[1],
    a[1] + a[3] * b[0] + a[2] * b[1],
    a[2] * b[2] - a[3] * b[3],
    a[3] * b[2] + a[2] * b[3],
  ];
  const apply = (pose, x, y) => [pose[0] + pose[2] * x - pose[3] * y, pose[1] + pose[3] * x + pose[2] * y];
  const turned = (x, y, angle) => [x, y, Math.cos(angle), Math.sin(angle)];

  function motion(joint, value) {
    if (joint.sign !== undefined) return turned(0, 0, joint.sign * value);
    return [value * joint.direction[0], value * joint.direction[1], 1, 0];
  }

  /** Returns the poses of both links. */
  function poses(arm, q) {
    const first = compose([arm.base[0], arm.base[1], 1, 0], motion(arm.joints[0], q[0]));
    const second = compose(compose(first, [arm.offset[0], arm.offset[1], 1, 0]), motion(arm.joints[1], q[1]));
    return [first, second];
  }

  const tipAt = (arm, q) => apply(poses(arm, q)[1], arm.tip[0], arm.tip[1]);
  const elbowAt = (arm, q) => apply(poses(arm, q)[0], arm.offset[0], arm.offset[1]);

  /** Returns the pose of the payload. */
  function payloadPose(arm, payload, q) {
    if (payload.grip.rigid) {
      const [x, y, angle] = payload.grip.rigid;
      return compose(poses(arm, q)[1], turned(x, y, angle));
    }
    const [angle, x, y] = payload.grip.level;
    const tip = tipAt(arm, q);
    return compose(turned(tip[0], tip[1], angle), [-x, -y, 1, 0]);
  }

  /**
   * Returns a moving obstacle at a time: it moves straight and at constant speed from stop to stop, and continues after
   * the last.
   */
  function moved(mover, time) {
    const { stops, velocity, outline, pieces } = mover;
    const next = stops.findIndex(([at]) => at > time);
    let [, x, y, angle] = stops[next < 0 ? stops.length - 1 : Math.max(0, next - 1)];
    if (next > 0) {
      const [a, b] = [stops[next - 1], stops[next]];
      const part = (time - a[0]) / (b[0] - a[0]);
      [x, y, angle] = [1, 2, 3].map((k) => a[k] + (b[k] - a[k]) * part);
    } else if (next < 0) {
      const since = time - stops[stops.length - 1][0];
      [x, y] = [x + velocity[0] * since, y + velocity[1] * since];
    }
    const pose = turned(x, y, angle);
    const all = (points) => points && placed({ core: points }, pose).core;
    const { polygon, circle, polyline } = outline;
    const disc = circle && [...apply(pose, circle[0], circle[1]), circle[2]];
    return { ...mover, outline: { polygon: all(polygon), circle: disc, polyline: all(polyline) }, pieces: pieces.map((piece) => placed(piece, pose)) };
  }

  function placed(shape, pose) {
    const core = new Array(shape.core.length);
    for (let i = 0; i < core.length; i += 2) {
      const [x, y] = apply(pose, shape.core[i], shape.core[i + 1]);
      core[i] = x;
      core[i + 1] = y;
    }
    return { core, radius: shape.radius };
  }

  /** Returns directions that can separate two convex shapes: normals of sides; for a segment also its own direction. */
  function axes({ core }) {
    const n = core.length / 2;
    const found = [];
    for (let i = 0; i < (n === 2 ? 1 : n > 2 ? n : 0); i += 1) {
      const j = (i + 1) % n;
      const [dx, dy] = [core[2 * j] - core[2 * i], core[2 * j + 1] - core[2 * i + 1]];
      const length = Math.hypot(dx, dy);
      if (length === 0) continue;
      const [x, y] = [dy / length, -dx / length];
      found.push([x, y]);
      if (n === 2) found.push([-x, -y], [-y, x], [y, -x]);
    }
    return found;
  }

  function farthest(core, x, y) {
    let best = -Infinity;
    for (let i = 0; i < core.length; i += 2) best = Math.max(best, core[i] * x + core[i + 1] * y);
    return best;
  }

  function toSegment(px, py, ax, ay, bx, by) {
    const [dx, dy] = [bx - ax, by - ay];
    const square = dx * dx + dy * dy;
    const t = square > 0 ? Math.min(1, Math.max(0, ((px - ax) * dx + (py - ay) * dy) / square)) : 0;
    return Math.hypot(px - ax - t * dx, py - ay - t * dy);
  }

  function cornersToSides(a, b) {
    let least = Infinity;
    const n = b.length / 2;
    for (let i = 0; i < a.length; i += 2) {
      for (let k = 0; k < n; k += 1) {
        const l = (k + 1) % n;
        least = Math.min(least, toSegment(a[i], a[i + 1], b[2 * k], b[2 * k + 1], b[2 * l], b[2 * l + 1]));
      }
    }
    return least;
  }

  /** Returns the signed distance of two shapes: by separating axes if they meet, by corners and sides if they do not. */
  function separation(a, b) {
    let gap = -Infinity;
    for (const [x, y] of axes(a)) gap = Math.max(gap, -farthest(b.core, -x, -y) - farthest(a.core, x, y));
    for (const [x, y] of axes(b)) gap = Math.max(gap, -farthest(a.core, -x, -y) - farthest(b.core, x, y));
    const apart = gap > 0 || gap === -Infinity;
    const distance = apart ? Math.min(cornersToSides(a.core, b.core), cornersToSides(b.core, a.core)) : gap;
    return distance - a.radius - b.radius;
  }

  /** Returns the signed distance of every link (or payload) and obstacle that can meet, nearest first. */
  function contacts(arm, world, q) {
    // Poses of both links, and of link 2 relative to link 1.
    const at = [...poses(arm, q), poses(arm, [0, q[1]])[1]];
    const nearest = new Map();
    const parts = new Map();
    for (const [link, part, obstacle, first, end] of world.pairs) {
      const key = `${link} ${part}`;
      if (!parts.has(key)) {
        const own = arm.links[Math.min(link, 1)].parts;
        const carried = part >= own.length;
        const shape = carried ? world.payload.parts[part - own.length] : own[part];
        parts.set(key, { shape: placed(shape, at[link]), carried, body: carried ? world.payload.object : own[part].body });
      }
      const { shape, carried, body } = parts.get(key);
      for (let piece = first; piece < end; piece += 1) {
        const distance = separation(shape, world.obstacles[obstacle].pieces[piece]);
        const name = `${carried ? 'payload' : link} ${obstacle}`;
        if (!(nearest.get(name)?.distance <= distance)) nearest.set(name, { link: Math.min(link, 1), carried, body, obstacle, distance });
      }
    }
    return [...nearest.values()].sort((a, b) => a.distance - b.distance);
  }

  /** Returns the value of a circle within its domain; other values stay unchanged. */
  function wrap(joint, value) {
    if (!joint.circle) return value;
    return value - TURN * Math.floor((value + Math.PI) / TURN);
  }

  /** Returns the index of the sample whose interval contains this time. */
  function interval(clock, t) {
    let [low, high] = [0, clock.time.length - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (clock.time[middle] <= t) low = middle;
      else high = middle;
    }
    return low;
  }

  /** Returns position and velocity at a time, from the cubic between two samples. */
  function moving(clock, t) {
    const k = interval(clock, t);
    const h = clock.time[k + 1] - clock.time[k];
    const u = h > 0 ? Math.min(1, Math.max(0, (t - clock.time[k]) / h)) : 0;
    const at = (list, i, joint) => list[2 * i + joint];
    const joint = (j) => {
      const [p0, p1] = [at(clock.position, k, j), at(clock.position, k + 1, j)];
      const [m0, m1] = [h * at(clock.velocity, k, j), h * at(clock.velocity, k + 1, j)];
      const [a, b] = [2 * (p0 - p1) + m0 + m1, 3 * (p1 - p0) - 2 * m0 - m1];
      return [((a * u + b) * u + m0) * u + p0, h > 0 ? ((3 * a * u + 2 * b) * u + m0) / h : 0];
    };
    const [first, second] = [joint(0), joint(1)];
    return {
      position: [first[0], second[0]],
      velocity: [first[1], second[1]],
      acceleration: [at(clock.acceleration, k, 0), at(clock.acceleration, k, 1)],
    };
  }

  /** Returns the points of a polyline, given as a flat list of coordinates. */
  function* pointsOf(flat) {
    for (let i = 0; i + 1 < flat.length; i += 2) yield [flat[i], flat[i + 1]];
  }

  return { TURN, apply, poses, tipAt, elbowAt, payloadPose, placed, moved, separation, contacts, wrap, moving, pointsOf };
})();

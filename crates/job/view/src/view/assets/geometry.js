// Kinematics, contacts and motion in time: the same computations as in the program, for users who move the arm by hand.
// Points are [x, y], poses [x, y, cosine, sine], shapes { core: [x0, y0, x1, y1, ...], radius }.
'use strict';

const Geometry = (() => {
  const TURN = 2 * Math.PI;
  /** Angle of a short side that stands for a part of an arc. */
  const ARC = Math.PI / 12;
  /** Number of rounds in which inverse kinematics approaches a place beside the limits. */
  const ROUNDS = 8;
  /** Error, as a fraction of the arm's size, that is accepted to change the joints by one radian less. */
  const STEADY = 0.02;

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

  /** Returns the pose of the payload. A level one may be turned to another angle than in its world. */
  function payloadPose(arm, payload, q, turnedTo = undefined) {
    if (payload.grip.rigid) {
      const [x, y, angle] = payload.grip.rigid;
      return compose(poses(arm, q)[1], turned(x, y, angle));
    }
    const [angle, x, y] = payload.grip.level;
    const tip = tipAt(arm, q);
    return compose(turned(tip[0], tip[1], turnedTo ?? angle), [-x, -y, 1, 0]);
  }

  /**
   * Returns a moving obstacle at a time: it moves straight and at constant speed from stop to stop, and continues after
   * the last.
   */
  function moved(mover, time) {
    const { stops, velocity } = mover;
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
    return lying(mover, [x, y, angle]);
  }

  /** Returns an obstacle that is given in its own frame, at a pose. */
  function lying(obstacle, /** @type {Point} */ [x, y, angle]) {
    const pose = turned(x, y, angle);
    const all = (points) => points && placed({ core: points }, pose).core;
    const { outline: { polygon, circle, polyline }, pieces } = obstacle;
    const disc = circle && [...apply(pose, circle[0], circle[1]), circle[2]];
    return { ...obstacle, outline: { polygon: all(polygon), circle: disc, polyline: all(polyline) }, pieces: pieces.map((piece) => placed(piece, pose)) };
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

  /** Returns the shapes of the arm and of its payload at q. */
  function armShapes(arm, payload, q) {
    const at = poses(arm, q);
    const links = arm.links.flatMap(({ parts }, k) => parts.map((part) => placed(part, at[k])));
    return [...links, ...(payload?.pieces ?? []).map((piece) => placed(piece, payloadPose(arm, payload, q)))];
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

  /**
   * Returns the distance of two shapes, and the points that are nearest to each other. If the shapes meet, the distance is
   * not positive, and the points are meaningless.
   */
  function nearest(a, b) {
    const distance = separation(a, b);
    let [least, ends] = [Infinity, [[NaN, NaN], [NaN, NaN]]];
    for (const [one, other, isFirst] of [[a, b, true], [b, a, false]]) {
      const points = [...pointsOf(other.core)];
      for (const p of pointsOf(one.core)) {
        for (const [i, from] of points.entries()) {
          const to = points[(i + 1) % points.length];
          const side = minus(to, from);
          const share = Math.min(1, Math.max(0, dot(minus(p, from), side) / (dot(side, side) || 1)));
          const foot = [from[0] + share * side[0], from[1] + share * side[1]];
          const apart = Math.hypot(...minus(p, foot));
          if (apart < least) [least, ends] = [apart, isFirst ? [p, foot] : [foot, p]];
        }
      }
    }
    // From the cores to the rounded outlines.
    const toward = (k, radius) => [0, 1].map((c) => ends[k][c] + ((ends[1 - k][c] - ends[k][c]) * radius) / (least || 1));
    return { distance, ends: [toward(0, a.radius), toward(1, b.radius)] };
  }

  /** Returns the corners of a shape, with its rounding as short sides, counter-clockwise. */
  function corners({ core, radius }) {
    const points = [...pointsOf(core)];
    if (!radius) return points;
    const n = points.length;
    const around = (center, from, to) => {
      const count = Math.max(1, Math.ceil((to - from) / ARC));
      return Array.from({ length: count + 1 }, (_, k) => from + ((to - from) * k) / count).map((angle) => [center[0] + radius * Math.cos(angle), center[1] + radius * Math.sin(angle)]);
    };
    if (n === 1) return around(points[0], 0, TURN - ARC);
    const normal = (a, b) => Math.atan2(a[0] - b[0], b[1] - a[1]);
    return points.flatMap((point, i) => {
      const from = normal(points[(i + n - 1) % n], point);
      const turn = normal(point, points[(i + 1) % n]) - from;
      return around(point, from, from + turn - TURN * Math.floor(turn / TURN));
    });
  }

  /** Returns the middle of the common part of two convex shapes, or `null` if they have none. */
  function touch(a, b) {
    let common = corners(a);
    const sides = corners(b);
    sides.forEach((p, i) => {
      const q = sides[(i + 1) % sides.length];
      /** @param {Point} point */
      const depth = ([x, y]) => (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
      common = common.flatMap((to, k) => {
        const from = common[(k + common.length - 1) % common.length];
        const [d, e] = [depth(from), depth(to)];
        const cut = d < 0 !== e < 0 ? [[0, 1].map((c) => from[c] + ((to[c] - from[c]) * d) / (d - e))] : [];
        return e >= 0 ? [...cut, to] : cut;
      });
    });
    return common.length ? [0, 1].map((c) => common.reduce((sum, point) => sum + point[c], 0) / common.length) : null;
  }

  /**
   * Returns the signed distance of every link (or payload) and obstacle that can meet, nearest first. A contact has the
   * place of the touch as `at`.
   */
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
        if (nearest.get(name)?.distance <= distance) continue;
        const contact = { link: Math.min(link, 1), carried, body, obstacle, distance };
        if (distance <= 0) contact.at = touch(shape, world.obstacles[obstacle].pieces[piece]);
        // If an obstacle moves with link 1, both are placed as for joint 1 at zero.
        if (contact.at && link > 1) contact.at = apply(at[0], contact.at[0] - arm.base[0], contact.at[1] - arm.base[1]);
        nearest.set(name, contact);
      }
    }
    return [...nearest.values()].sort((a, b) => a.distance - b.distance);
  }

  // Inverse kinematics.

  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  const angleOf = (/** @type {Point} */ [x, y]) => Math.atan2(y, x);
  /** @type {(point: Point, angle: number) => Point} */
  const rotated = ([x, y], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
  const isRevolute = (joint) => joint.sign !== undefined;

  /** Returns the value of joint 1 that brings the tip nearest to a place, for a value of joint 2. */
  function firstFor(arm, place, second) {
    const [joint] = arm.joints;
    const tip = apply(motion(arm.joints[1], second), ...arm.tip);
    const [to, from] = [minus(place, arm.base), [arm.offset[0] + tip[0], arm.offset[1] + tip[1]]];
    if (isRevolute(joint)) return joint.sign * (angleOf(to) - angleOf(from));
    return dot(minus(to, from), joint.direction) / dot(joint.direction, joint.direction);
  }

  /** Returns the value of joint 2 that brings the tip nearest to a place, for a value of joint 1. */
  function secondFor(arm, place, first) {
    const [own, joint] = arm.joints;
    const to = minus(place, arm.base);
    const seen = isRevolute(own) ? rotated(to, -own.sign * first) : minus(to, own.direction.map((x) => x * first));
    const from = minus(seen, arm.offset);
    if (isRevolute(joint)) return joint.sign * (angleOf(from) - angleOf(arm.tip));
    return dot(minus(from, arm.tip), joint.direction) / dot(joint.direction, joint.direction);
  }

  /** Returns both solutions of a quadratic equation, or the place of the minimum if it has none. */
  function roots(a, b, c) {
    const root = Math.sqrt(Math.max(0, b * b - 4 * a * c));
    return [(-b - root) / (2 * a), (-b + root) / (2 * a)];
  }

  /** Returns IK solutions for a place of the tip, without regard to limits. If it is out of reach, they come near. */
  function solutions(arm, place) {
    const [one, two] = arm.joints;
    const { base, offset, tip } = arm;
    const to = minus(place, base);
    const by = (second) => [firstFor(arm, place, second), second];
    if (isRevolute(one) && isRevolute(two)) {
      const [a, b] = [Math.hypot(...offset), Math.hypot(...tip)];
      const half = Math.acos(Math.min(1, Math.max(-1, (dot(to, to) - a * a - b * b) / (2 * a * b || 1))));
      return [half, -half].map((angle) => by(two.sign * (angle + angleOf(offset) - angleOf(tip))));
    }
    if (isRevolute(one)) {
      const rest = [offset[0] + tip[0], offset[1] + tip[1]];
      return roots(dot(two.direction, two.direction), 2 * dot(rest, two.direction), dot(rest, rest) - dot(to, to)).map(by);
    }
    const rest = minus(to, offset);
    if (isRevolute(two)) {
      const values = roots(dot(one.direction, one.direction), -2 * dot(rest, one.direction), dot(rest, rest) - dot(tip, tip));
      return values.map((first) => [first, secondFor(arm, place, first)]);
    }
    const [u, v, goal] = [one.direction, two.direction, minus(rest, tip)];
    const determinant = u[0] * v[1] - u[1] * v[0];
    return [[(goal[0] * v[1] - goal[1] * v[0]) / determinant, (u[0] * goal[1] - u[1] * goal[0]) / determinant]];
  }

  /** Returns the value within a joint's limits that has the same effect, or the nearest limit; near another value. */
  function limited(joint, value, near) {
    if (joint.circle) return wrap(joint, value);
    const [low, high] = joint.domain;
    if (!isRevolute(joint)) return Math.min(high, Math.max(low, value));
    const turns = [-2, -1, 0, 1, 2].map((n) => value + TURN * (n + Math.round((near - value) / TURN)));
    const allowed = turns.filter((x) => x >= low && x <= high);
    const best = (all) => all.reduce((a, b) => (Math.abs(b - near) < Math.abs(a - near) ? b : a));
    if (allowed.length) return best(allowed);
    const excess = (x) => Math.max(low - x, x - high);
    return Math.min(high, Math.max(low, turns.reduce((a, b) => (excess(b) < excess(a) ? b : a))));
  }

  /** Returns the difference of two values of a joint; on a circle, the shorter way round. */
  const apart = (joint, a, b) => Math.abs(joint.circle ? wrap(joint, a - b) : a - b);

  /**
   * Returns the configuration with the tip at a place, or as near to it as the joints allow: of several solutions, one
   * near `near`.
   */
  function inverse(arm, place, near) {
    const size = Math.hypot(...arm.offset) + Math.hypot(...arm.tip) || 1;
    const fit = (q) => q.map((value, k) => limited(arm.joints[k], value, near[k]));
    let [best, least] = [near, Infinity];
    for (const solution of solutions(arm, place)) {
      let q = fit(solution);
      // At a limit, each joint in turn comes nearer.
      for (let k = 0; k < ROUNDS; k += 1) {
        q = fit([firstFor(arm, place, q[1]), q[1]]);
        q = fit([q[0], secondFor(arm, place, q[0])]);
      }
      const error = Math.hypot(...minus(tipAt(arm, q), place));
      const change = arm.joints.reduce((sum, joint, k) => sum + apart(joint, q[k], near[k]) / (isRevolute(joint) ? 1 : size), 0);
      const cost = error + STEADY * size * change;
      if (cost < least) [best, least] = [q, cost];
    }
    return best;
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

  /**
   * Returns position and velocity at a time, from the cubic between two samples. If `smooth`, the position is that of the
   * polynomial of degree five that also has the accelerations. `k` is the index of the first sample.
   */
  function moving(clock, t, k = interval(clock, t), smooth = false) {
    const h = clock.time[k + 1] - clock.time[k];
    const u = h > 0 ? Math.min(1, Math.max(0, (t - clock.time[k]) / h)) : 0;
    const at = (list, i, joint) => list[2 * i + joint];
    const joint = (j) => {
      const [p0, p1] = [at(clock.position, k, j), at(clock.position, k + 1, j)];
      const [m0, m1] = [h * at(clock.velocity, k, j), h * at(clock.velocity, k + 1, j)];
      const [a, b] = [2 * (p0 - p1) + m0 + m1, 3 * (p1 - p0) - 2 * m0 - m1];
      // Half the differences of the accelerations at both ends.
      const [c, d] = smooth ? [(h * h * at(clock.acceleration, k, j)) / 2 - b, (h * h * at(clock.acceleration, k + 1, j)) / 2 - 3 * a - b] : [0, 0];
      return [((a * u + b) * u + m0) * u + p0 + (u * (1 - u)) ** 2 * (c * (1 - u) + d * u), h > 0 ? ((3 * a * u + 2 * b) * u + m0) / h : 0];
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

  return { TURN, apply, poses, armShapes, tipAt, elbowAt, payloadPose, placed, moved, lying, separation, nearest, contacts, inverse, solutions, wrap, interval, moving, pointsOf };
})();

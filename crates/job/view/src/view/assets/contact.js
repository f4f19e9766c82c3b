// Lessons in geometry, computed from the page's data: the values of joint 2 at which link 2 begins to touch, the tests
// of penetration, and Minkowski differences. Polygons are lists of corners [x, y], counter-clockwise.
'use strict';

const Contact = (() => {
  const { TURN, apply, poses, placed, separation, pointsOf } = Geometry;

  /** Places nearer than this are the same contact, in metres. Coordinates of some 100 m lose about 1e-13 m in these formulas. */
  const ROUNDING = 1e-9;

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1];
  /** @type {(a: Point, b: Point) => Point} */
  const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  /** @type {(a: Point, b: Point) => Point} */
  const plus = (a, b) => [a[0] + b[0], a[1] + b[1]];
  const angle = ([x, y]) => Math.atan2(y, x);
  /** Cross product; positive if `b` is counter-clockwise of `a`. */
  const cross = (a, b) => a[0] * b[1] - a[1] * b[0];

  /** Sides of a polygon. A segment has two, there and back; a point has none. */
  const sides = (corners) => (corners.length < 2 ? [] : corners.map((p, i) => [p, corners[(i + 1) % corners.length]]));

  /** Returns the lines of the sides, `normal . x = offset`, with normals that point outwards. */
  function walls(corners) {
    return sides(corners).map(([p, q]) => {
      const length = Math.hypot(...minus(q, p));
      const normal = [(q[1] - p[1]) / length, (p[0] - q[0]) / length];
      return { normal, offset: dot(normal, p) };
    });
  }

  // Values at which joint 2 begins and ends to touch.

  /** Returns the angles by which `v` must be turned so that its product with `w` is `product`; NaN if there are none. */
  function turnsTo(v, w, product) {
    const half = Math.acos(product / (Math.hypot(...v) * Math.hypot(...w)));
    return [-half, half].map((by) => angle(w) - angle(v) + by);
  }

  /**
   * Returns values of a turn about the origin, or of a slide along `slide`, at which two features are `radius` apart.
   * Each value comes with the feature of the part and that of the piece: [value, 'corner' or 'side', its number, and
   * the same of the piece]. All contacts are among them.
   */
  function* candidates(part, piece, slide, radius) {
    const along = (a, normal, offset) => (slide ? [(offset - dot(normal, a)) / dot(normal, slide)] : turnsTo(a, normal, offset));
    const [mine, others] = [walls(part), walls(piece)];
    for (const [i, a] of part.entries()) {
      for (const [k, { normal, offset }] of others.entries()) {
        for (const value of along(a, normal, offset + radius)) yield [value, 'corner', i, 'side', k];
      }
    }
    // As seen from the part's side, the piece moves in the opposite direction.
    for (const [k, b] of piece.entries()) {
      for (const [i, { normal, offset }] of mine.entries()) {
        for (const value of along(b, normal, offset + radius)) yield [-value, 'side', i, 'corner', k];
      }
    }
    if (radius === 0) return;
    for (const [i, a] of part.entries()) {
      for (const [k, b] of piece.entries()) {
        const to = minus(b, a);
        const half = slide && Math.sqrt(radius ** 2 - cross(slide, to) ** 2);
        const values = slide ? [dot(slide, to) - half, dot(slide, to) + half] : turnsTo(a, b, (dot(a, a) + dot(b, b) - radius ** 2) / 2);
        for (const value of values) yield [value, 'corner', i, 'corner', k];
      }
    }
  }

  /**
   * Returns intervals of a turn or slide in which a part is within `level` of a piece: [begin, end], each { value,
   * features }.
   */
  function intervals(part, piece, pivot, slide, level) {
    const seen = (shape) => [...pointsOf(shape.core)].map((p) => minus(p, pivot));
    const [moving, resting] = [seen(part), seen(piece)];
    const radius = part.radius + piece.radius + level;
    const flat = { core: moving.flat(), radius: part.radius };
    const other = { core: resting.flat(), radius: piece.radius };
    const reach = Math.max(...moving.map((p) => Math.hypot(...p)));
    if (!slide && separation({ core: [0, 0], radius: reach }, other) > part.radius + level) return [];
    const gap = (value) => {
      const pose = slide ? [value * slide[0], value * slide[1], 1, 0] : [0, 0, Math.cos(value), Math.sin(value)];
      return separation(placed(flat, pose), other) - level;
    };
    const wrapped = (value) => (slide ? value : value - TURN * Math.floor((value + Math.PI) / TURN));
    const ends = [];
    for (const [value, ...features] of candidates(moving, resting, slide, radius)) {
      if (Math.abs(gap(value)) <= ROUNDING) ends.push({ value: wrapped(value), features });
    }
    ends.sort((a, b) => a.value - b.value);
    // A contact of two corners occurs twice.
    const places = ends.filter((end, i) => i === 0 || end.value - ends[i - 1].value > ROUNDING);
    if (!places.length) return gap(0) <= 0 && !slide ? [[{ value: -Math.PI }, { value: Math.PI }]] : [];
    const found = [];
    const meets = (i, j, by) => gap((places[i].value + places[j].value + by) / 2) <= 0;
    const last = places.length - 1;
    // Across the seam of the circle, from the last to the first.
    const around = !slide && meets(last, 0, TURN);
    places.forEach((place, i) => {
      const before = i ? meets(i - 1, i, 0) : around;
      const after = i < last ? meets(i, i + 1, 0) : around;
      const end = i < last ? places[i + 1] : { ...places[0], value: places[0].value + TURN };
      if (after) found.push([place, end]);
      else if (!before) found.push([place, place]);
    });
    return found;
  }

  /** Returns the parts of an interval of joint 2 in its domain. Ends at limits are not contacts, and have no features. */
  function* within({ sign, domain: [low, high] }, [begin, end]) {
    const [a, b] = sign < 0 ? [{ ...end, value: -end.value }, { ...begin, value: -begin.value }] : [begin, end];
    const by = sign === undefined ? 0 : TURN;
    const first = by ? Math.ceil((low - b.value) / TURN) : 0;
    for (let n = first; n === first || (by && a.value + n * by <= high); n += 1) {
      const [from, to] = [a, b].map((place) => ({ ...place, value: place.value + n * by }));
      if (from.value > high || to.value < low) continue;
      yield [from.value < low ? { value: low } : from, to.value > high ? { value: high } : to];
    }
  }

  /** Returns the union of intervals, ascending. */
  function united(all) {
    const merged = [];
    for (const [begin, end] of all.sort((a, b) => a[0].value - b[0].value)) {
      const last = merged[merged.length - 1];
      if (!last || begin.value > last[1].value + ROUNDING) merged.push([begin, end]);
      else if (end.value > last[1].value) last[1] = end;
    }
    return merged;
  }

  /**
   * Returns the slice of the configuration space at a value of joint 1. `bands` are obstacles that link 1 touches,
   * which blocks the whole slice. `rows` has closed intervals of joint 2 for each obstacle that link 2 can touch. Their
   * ends { value, features, part, piece, body } are contacts.
   */
  function slice(arm, world, q1) {
    const at = [...poses(arm, [q1, 0]), poses(arm, [0, 0])[1]];
    const joint = arm.joints[1];
    // Frame of link 2, and frame of link 2 relative to link 1.
    const frames = [at[0], poses(arm, [0, 0])[0]].map((pose) => ({
      pivot: apply(pose, ...arm.offset),
      slide: joint.direction && minus(apply(pose, ...joint.direction), apply(pose, 0, 0)),
    }));
    const [bands, rows] = [new Set(), new Map()];
    for (const [link, number, obstacle, first, end] of world.pairs) {
      const own = arm.links[Math.min(link, 1)].parts;
      const shape = own[number] ?? world.payload.parts[number - own.length];
      const part = placed(shape, at[link]);
      for (const piece of world.obstacles[obstacle].pieces.slice(first, end)) {
        if (link === 0) {
          if (separation(part, piece) <= world.clearance) bands.add(obstacle);
          continue;
        }
        const named = (e) => ({ ...e, shape, piece, body: own[number]?.body ?? world.payload.object });
        const { pivot, slide } = frames[link - 1];
        for (const found of intervals(part, piece, pivot, slide, world.clearance)) {
          if (!rows.has(obstacle)) rows.set(obstacle, []);
          rows.get(obstacle).push(...within(joint, found.map(named)));
        }
      }
    }
    const merged = [...rows].map(([obstacle, all]) => ({ obstacle, intervals: united(all) }));
    return { bands: [...bands], rows: merged.filter((row) => row.intervals.length).sort((a, b) => a.obstacle - b.obstacle) };
  }

  // The tests of penetration. With coordinates from `snapped`, all signs are exact.

  /** Rounds coordinates to so few binary digits that products of their differences are exact. */
  function snapped(corners, size) {
    const unit = 2 ** (Math.ceil(Math.log2(size)) - 18);
    return corners.map((p) => p.map((x) => unit * Math.round(x / unit)));
  }

  /** Locates a point in a convex polygon: signed distances to the lines of the sides, positive inside, and the least of them. */
  function pointTest(point, polygon) {
    const distances = sides(polygon).map(([p, q]) => cross(minus(q, p), minus(point, p)) / Math.hypot(...minus(q, p)));
    const depth = Math.min(...distances);
    return { distances, depth, side: distances.indexOf(depth), inside: depth >= 0 };
  }

  /** Returns true if two sides cross in a point that is not an end of either. */
  function isCrossing([p, q], [r, s]) {
    const of = (a, b, c) => Math.sign(cross(minus(b, a), minus(c, a)));
    return of(p, q, r) * of(p, q, s) < 0 && of(r, s, p) * of(r, s, q) < 0;
  }

  /** Tests two convex polygons: corners of each in the other or on its boundary, and sides that cross. */
  function polygonTest(a, b) {
    const inside = (corners, polygon) => corners.map((p) => pointTest(p, polygon));
    const crossings = sides(a).flatMap((one, i) => sides(b).flatMap((other, k) => (isCrossing(one, other) ? [[i, k]] : [])));
    const [mine, others] = [inside(a, b), inside(b, a)];
    return { mine, others, crossings, meet: crossings.length > 0 || [...mine, ...others].some((test) => test.inside) };
  }

  // The Minkowski difference.

  /** Returns 1 if a direction points into [pi, 2 pi), otherwise 0. */
  const isDown = (/** @type {Point} */ [x, y]) => Number(y < 0 || (y === 0 && x < 0));

  /**
   * Returns `b - a` of convex polygons by a sweep: the sides of `b` and of `-a`, ordered by the angles of their
   * directions, from 0 on. Each step is a corner { at, i, k }, corner k of b minus corner i of a, with the side to the
   * next one, { of: 'a', 'b' or 'both', direction }.
   */
  function difference(b, a) {
    const lowest = (corners, sign) => corners.reduce((best, p, i) => {
      const [x, y] = minus(p, corners[best]).map((v) => sign * v);
      return y < 0 || (y === 0 && x < 0) ? i : best;
    }, 0);
    let [k, i] = [lowest(b, 1), lowest(a, -1)];
    let [left, rest] = [b.length, a.length];
    const steps = [];
    while (left || rest) {
      const plusSide = minus(b[(k + 1) % b.length], b[k]);
      const minusSide = minus(a[i], a[(i + 1) % a.length]);
      const order = !left ? 1 : !rest ? -1 : isDown(plusSide) - isDown(minusSide) || -Math.sign(cross(plusSide, minusSide));
      const of = order < 0 ? 'b' : order > 0 ? 'a' : 'both';
      steps.push({ at: minus(b[k], a[i]), i, k, of, direction: of === 'a' ? minusSide : plusSide });
      if (order <= 0) [k, left] = [(k + 1) % b.length, left - 1];
      if (order >= 0) [i, rest] = [(i + 1) % a.length, rest - 1];
    }
    return steps;
  }

  return { slice, snapped, pointTest, polygonTest, difference, sides, minus, plus, cross };
})();

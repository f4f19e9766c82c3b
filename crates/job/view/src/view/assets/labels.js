// The placer of names in a panel. A name lies within its shape, touches it, or has a line that ends on it. It lies
// neither on the arm, nor on a marker, nor on another name, avoids paths as far as possible, and is left out if there is no
// place for it. A named shape is { rect, pieces }: the box on which or around which the name may lie, and the shape as
// convex pieces in pixels (without any, the box); `moves` is true for a shape that moves.
// Pictures have the same rule in `labels.rs`, `named.rs` and `regions.rs`: the same places in the same order, with the same
// costs. A change here needs the same change there.
'use strict';

const Labels = (() => {
  /** Height of a name's box, its distance from the shape beside it, and half the width of markers, in pixels. */
  const [LINE, GAP, MARKER] = [15, 3, 8];
  /** Distances from the shape at which a name needs a line to it, in pixels. */
  const LEADERS = [18, 36, 58];
  /** Greatest distance between a name's box and its shape without a line, in pixels: across a corner, or beside a wall. */
  const TOUCH = 5;
  /** Largest fraction of a named area that its name may cover. */
  const COVERED = 0.5;
  /** Side of a cell of the raster in which names are placed within regions, in pixels. */
  const CELL = 4;
  /** Value of a cell that no name may cover, and the least part of a name that must lie on its region. */
  const [BLOCKED, PART] = [-1, 0.3];
  /** Possible positions of a name: on its shape, then above, below, to the sides and at the corners of it. */
  const SIDES = [[0, 0], [0, -1], [0, 1], [1, 0], [-1, 0], [1, -1], [-1, -1], [1, 1], [-1, 1]];
  /**
   * Costs of a place: crossing a path, the same for a shape that moves, and a line to the shape. A name that stays where it
   * was costs less. The name of a moving shape rather crosses a path than that it is far from its shape.
   */
  const [CROSSING, MOVING_CROSSING, LEADER, STAYING] = [3, 0.3, 0.6, -0.3];

  // Boxes.

  /** Returns a square about a spot. */
  const about = (/** @type {Point} */ [x, y], half = 0) => ({ x: x - half, y: y - half, width: 2 * half, height: 2 * half });
  /** Returns the box about a spot as a named shape. */
  const spotted = (spot, half = 0) => ({ rect: about(spot, half) });
  const middle = ({ x, y, width, height }) => [x + width / 2, y + height / 2];
  const grown = ({ x, y, width, height }, by) => ({ x: x - by, y: y - by, width: width + 2 * by, height: height + 2 * by });
  /** Returns the common area in square pixels. */
  const common = (a, b) => Math.max(0, Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x)) * Math.max(0, Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y));
  const within = (a, b) => a.x >= b.x && a.y >= b.y && a.x + a.width <= b.x + b.width && a.y + a.height <= b.y + b.height;
  const holds = (box, /** @type {Point} */ [x, y]) => x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + box.height;
  /** Moves a box into another one. */
  const pushed = (a, b) => ({ ...a, x: Math.max(b.x, Math.min(b.x + b.width - a.width, a.x)), y: Math.max(b.y, Math.min(b.y + b.height - a.height, a.y)) });

  function size(context, panel, text) {
    context.font = panel.theme.font(600);
    return [context.measureText(text).width + 6 * panel.zoom, LINE * panel.zoom];
  }

  // What names must avoid.

  /** Returns an empty collection: boxes of names and markers, boxes of names alone, shapes of arms, and points on paths, all in pixels. */
  const nothing = () => ({ boxes: [], names: [], shapes: [], points: [] });
  const copy = ({ boxes, names, shapes, points }) => ({ boxes: [...boxes], names: [...names], shapes: [...shapes], points: [...points] });

  /** Returns a shape in pixels that count upwards, so that corners stay counter-clockwise. */
  function inPixels(panel, { core, radius }) {
    const flat = [];
    for (let i = 0; i + 1 < core.length; i += 2) {
      const [x, y] = panel.at([core[i], core[i + 1]]);
      flat.push(x, -y);
    }
    return { core: flat, radius: radius * panel.pixels };
  }

  /** Returns a box as a shape in pixels that count upwards, grown by a radius. */
  const outlineOf = ({ x, y, width, height }, radius) => ({ core: [x, -y - height, x + width, -y - height, x + width, -y, x, -y], radius });

  /** Returns the shape of lines between the points of flat lists, in pixels. */
  const lines = (/** @type {Point[][]} */ all) => all.flatMap((spots) => spots.slice(1).map(([x, y], i) => ({ core: [spots[i][0], -spots[i][1], x, -y], radius: 0 })));

  /** Returns convex shapes of the panel's plane as a named shape, whose name may lie on or around a box. */
  const shaped = (panel, rect, shapes) => ({ rect, pieces: shapes.map((shape) => inPixels(panel, shape)) });

  /** Lets names avoid a convex shape of the panel's plane, such as a part of the arm. */
  const blockShape = (panel, shape) => panel.blocked.shapes.push(inPixels(panel, shape));
  const blockSpot = (panel, spot, half = MARKER) => panel.blocked.boxes.push(about(spot, half));

  /** Lets later names and their lines avoid the box of a name. */
  function take(panel, box) {
    panel.blocked.boxes.push(box);
    panel.blocked.names.push(box);
  }

  /** Lets names dodge a line through spots. */
  function blockLine(panel, spots) {
    const { points } = panel.blocked;
    spots.forEach((spot, i) => {
      points.push(spot);
      const before = spots[i - 1];
      const length = before ? Math.hypot(spot[0] - before[0], spot[1] - before[1]) : 0;
      for (let k = 1; k * CELL < length; k += 1) points.push([0, 1].map((c) => before[c] + ((spot[c] - before[c]) * k * CELL) / length));
    });
  }

  /** Returns true if a name in this box would lie on something. */
  function isBlocked(panel, box) {
    const { boxes, shapes } = panel.blocked;
    if (!within(box, panel.rect) || boxes.some((other) => common(box, other) > 0)) return true;
    const own = outlineOf(box, 1);
    return shapes.some((shape) => Geometry.separation(own, shape) <= 0);
  }

  const crosses = (panel, box) => panel.blocked.points.some((point) => holds(grown(box, 2), point));

  // Placing.

  /** Returns the possible places of a name, nearest first: { box, isFar }. */
  function places(panel, /** @type {Point} */ [width, height], of) {
    const fits = width <= of.width && height <= of.height;
    const at = (gap) => ([dx, dy]) => ({
      x: of.x + of.width / 2 - width / 2 + dx * (width / 2 + gap + of.width / 2),
      y: of.y + of.height / 2 - height / 2 + dy * (height / 2 + gap + of.height / 2),
      width, height,
    });
    const near = SIDES.slice(fits ? 0 : 1).map(at(GAP)).map((box) => ({ box, isFar: false }));
    const far = LEADERS.flatMap((gap) => SIDES.slice(1).map(at(gap * panel.zoom))).map((box) => ({ box, isFar: true }));
    return [...near, ...far];
  }

  /**
   * Returns the distance between a box and a shape, not positive if they overlap, and the nearest place on the shape.
   * @returns {[number, Point]}
   */
  function nearest(box, { rect, pieces = [outlineOf(rect, 0)] }) {
    const own = outlineOf(box, 0);
    let [least, best] = [Infinity, null];
    for (const piece of pieces) {
      const distance = Geometry.separation(own, piece);
      if (distance < least) [least, best] = [distance, piece];
    }
    if (!best) return [Infinity, [NaN, NaN]];
    const [x, y] = Geometry.nearest(own, best).ends[1];
    return [least, [x, -y]];
  }

  const clamped = (/** @type {Point} */ [x, y], to) => [Math.max(to.x, Math.min(to.x + to.width, x)), Math.max(to.y, Math.min(to.y + to.height, y))];

  /** Returns true if the line from a name to a place on its shape would cross another name. */
  function crossesName(panel, box, end) {
    const begin = clamped(end, box);
    const count = Math.ceil(Math.hypot(end[0] - begin[0], end[1] - begin[1]) / CELL);
    for (let k = 0; k <= count; k += 1) {
      const share = k / Math.max(1, count);
      const [x, y] = [begin[0] + (end[0] - begin[0]) * share, begin[1] + (end[1] - begin[1]) * share];
      if (panel.blocked.names.some((name) => holds(name, [x, y]))) return true;
    }
    return false;
  }

  /** Draws a line from a name to a place on the shape that it names. Later names dodge it. */
  function leader(context, panel, box, end) {
    const begin = clamped(end, box);
    blockLine(panel, [begin, end]);
    for (const [width, color] of [[3, panel.theme.paper], [1, panel.theme.grey]]) {
      [context.lineWidth, context.strokeStyle] = [width, color];
      line(context, [begin, end]);
    }
  }

  /**
   * Draws a name at the best of its free places, or leaves it out. `cost` adds to the cost of a box, with or without a line
   * to the shape.
   */
  function put(context, panel, text, shape, cost) {
    const before = panel.placed.get(text);
    const crossing = shape.moves ? MOVING_CROSSING : CROSSING;
    let [best, least] = [null, Infinity];
    places(panel, size(context, panel, text), shape.rect).forEach(({ box, isFar }, index) => {
      const known = 0.01 * index + (before === index ? STAYING : 0);
      if (known >= least || isBlocked(panel, box)) return;
      const [distance, end] = nearest(box, shape);
      const hasLine = isFar || distance > TOUCH;
      if (hasLine && (!holds(panel.rect, end) || crossesName(panel, box, end))) return;
      const whole = known + (hasLine ? LEADER : 0) + (crosses(panel, box) ? crossing : 0) + cost(box, hasLine);
      if (whole < least) [best, least] = [{ box, end: hasLine ? end : null, index }, whole];
    });
    if (!best) {
      panel.placed.delete(text);
      return false;
    }
    panel.placed.set(text, best.index);
    take(panel, best.box);
    if (best.end) leader(context, panel, best.box, best.end);
    write(context, panel.theme, text, ...middle(best.box));
    return true;
  }

  /**
   * Draws names, each with its shape: on the shape or, if that is smaller, beside it, where the name covers least of the
   * others. Earlier names choose first.
   */
  function beside(context, panel, names, markers = []) {
    for (const spot of markers) blockSpot(panel, spot);
    // It is better to hide a part of a large shape than all of a small one.
    const share = (box, other) => common(box, other) / Math.max(LINE * LINE, other.width * other.height);
    for (const [text, shape] of names) {
      put(context, panel, text, shape, (box) => names.reduce((sum, [, other]) => sum + (other === shape ? 0 : share(box, other.rect)), 0));
    }
  }

  /** Does the same among regions. `covered` returns the share of a box that lies on regions. */
  function besideAmong(context, panel, names, covered) {
    for (const [text, shape] of names) put(context, panel, text, shape, covered);
  }

  /**
   * Draws names on regions of any shape: within the part of a region that is visible, as far as possible from its
   * outline, or beside a smaller part. A name that would cover another region there has a line to its own. A region is
   * { text, paint(context) }; later ones cover earlier ones. On bars, which may be lower than letters, no name sticks out:
   * it is within its bar, above it or below it.
   */
  function onRegions(context, panel, regions, areBars = false) {
    if (!regions.length) return;
    const { rect, blocked } = panel;
    const [columns, rows] = [rect.width, rect.height].map((side) => Math.max(1, Math.ceil(side / CELL)));
    const raster = document.createElement('canvas');
    [raster.width, raster.height] = [columns, rows];
    const painter = raster.getContext('2d', { willReadFrequently: true });
    painter.setTransform(1 / CELL, 0, 0, 1 / CELL, -rect.x / CELL, -rect.y / CELL);
    /** Number of the region in each cell, from 1; 0 for none. */
    const cells = new Int32Array(columns * rows);
    // Each on a raster of its own: where two regions meet, a mixture of colours would be that of a third.
    regions.forEach(({ paint }, index) => {
      painter.clearRect(rect.x, rect.y, columns * CELL, rows * CELL);
      paint(painter);
      const { data } = painter.getImageData(0, 0, columns, rows);
      for (let k = 0; k < cells.length; k += 1) if (data[4 * k + 3] > 127) cells[k] = index + 1;
    });
    const full = cells.slice();
    const clear = ({ x, y, width, height }) => {
      const [x0, x1] = [x - rect.x, x + width - rect.x].map((at) => Math.floor(at / CELL));
      const [y0, y1] = [y - rect.y, y + height - rect.y].map((at) => Math.floor(at / CELL));
      for (let j = Math.max(0, y0); j <= Math.min(rows - 1, y1); j += 1) {
        cells.fill(BLOCKED, j * columns + Math.max(0, x0), j * columns + Math.max(0, Math.min(columns - 1, x1) + 1));
      }
    };
    blocked.boxes.forEach(clear);
    for (const point of blocked.points) clear(about(point, 2));
    const regionAt = (x, y) => full[Math.floor((y - rect.y) / CELL) * columns + Math.floor((x - rect.x) / CELL)];
    const onPage = (/** @type {Point} */ [i, j]) => [rect.x + i * CELL, rect.y + j * CELL];
    /** Returns the upright part of a region through a cell of it, as a box without width. */
    const uprightPart = (own, /** @type {Point} */ at) => {
      const [i, j] = at.map(Math.floor);
      let [above, below] = [j, j];
      while (above > 0 && full[(above - 1) * columns + i] === own) above -= 1;
      while (below < rows && full[below * columns + i] === own) below += 1;
      const [x, y] = onPage([at[0], above]);
      return { x, y, width: 0, height: (below - above) * CELL };
    };
    const rest = [];
    regions.forEach(({ text }, index) => {
      const [width, height] = size(context, panel, text);
      const spot = roomiest(cells, [columns, rows], index + 1, [width, height].map((side) => Math.ceil(side / CELL)), !areBars);
      const [x, y] = spot ? onPage(spot.at) : [0, 0];
      const box = pushed({ x: x - width / 2, y: y - height / 2, width, height }, rect);
      // A name that sticks out of its region may meet another one that does.
      if (spot?.fits && !isBlocked(panel, box)) {
        take(panel, box);
        write(context, panel.theme, text, ...middle(box));
      } else {
        // The path may cover all of a small region.
        const place = spot ?? roomiest(full, [columns, rows], index + 1, [1, 1]);
        if (place) rest.push([text, index + 1, { rect: areBars ? uprightPart(index + 1, place.at) : about(onPage(place.at)) }]);
      }
    });
    /** Returns how many of the points of a box lie on regions, except on region `own`. */
    const covered = ({ x, y, width, height }, own = 0) => {
      let count = 0;
      for (let i = 0; i < 5; i += 1) for (let j = 0; j < 3; j += 1) count += Number(![0, own].includes(regionAt(x + (width * (i + 0.5)) / 5, y + (height * (j + 0.5)) / 3)));
      return count / 15;
    };
    for (const [text, own, spot] of rest) {
      put(context, panel, text, spot, (box, hasLine) => (!hasLine && covered(box, own) > 0 ? Infinity : covered(box)));
    }
  }

  /**
   * Returns the place in region `id` for a name of this size: { at, fits }, with the middle in cells. A name that fits
   * within the region lies as far as possible from the outline. Otherwise, if it may stick out, its middle lies on the
   * region, and the rest covers nothing else. `fits` is false if there is no such place. Returns `null` if the region has no cells.
   */
  function roomiest(cells, /** @type {Point} */ [columns, rows], id, /** @type {Point} */ [width, height], mayStickOut = true) {
    let [x0, x1, y0, y1] = [columns, -1, rows, -1];
    for (let k = 0; k < cells.length; k += 1) {
      if (cells[k] !== id) continue;
      const [x, y] = [k % columns, Math.floor(k / columns)];
      [x0, x1, y0, y1] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, y), Math.max(y1, y)];
    }
    if (x1 < 0) return null;
    const center = [(x0 + x1 + 1) / 2, (y0 + y1 + 1) / 2];
    // A name may stick out of the region.
    [x0, x1] = [Math.max(0, x0 - width), Math.min(columns - 1, x1 + width)];
    [y0, y1] = [Math.max(0, y0 - height), Math.min(rows - 1, y1 + height)];
    const [nx, ny] = [x1 - x0 + 1, y1 - y0 + 1];
    /** Returns a function that counts the cells of a kind in a box. */
    const counter = (isCounted) => {
      const sums = new Int32Array((nx + 1) * (ny + 1));
      for (let y = 0; y < ny; y += 1) {
        for (let x = 0, row = 0; x < nx; x += 1) {
          row += isCounted(cells[(y0 + y) * columns + x0 + x]);
          sums[(y + 1) * (nx + 1) + x + 1] = sums[y * (nx + 1) + x + 1] + row;
        }
      }
      return (x, y, w, h) => sums[(y + h) * (nx + 1) + x + w] - sums[y * (nx + 1) + x + w] - sums[(y + h) * (nx + 1) + x] + sums[y * (nx + 1) + x];
    };
    const own = counter((cell) => cell === id);
    /** Returns the middle of the best box by `rate`, which returns -1 for a box that is not possible. */
    const find = (w, h, rate) => {
      let [best, most] = [null, -Infinity];
      for (let y = 0; y + h <= ny; y += 1) {
        for (let x = 0; x + w <= nx; x += 1) {
          const rating = rate(x, y);
          if (rating < 0) continue;
          const at = [x0 + x + w / 2, y0 + y + h / 2];
          const whole = rating - 1e-4 * (Math.abs(at[0] - center[0]) + Math.abs(at[1] - center[1]));
          if (whole > most) [best, most] = [at, whole];
        }
      }
      return best;
    };
    const fitting = (w, h) => find(w, h, (x, y) => (own(x, y, w, h) === w * h ? 1 : -1));
    let fit = fitting(width, height);
    if (!fit) {
      const foreign = counter((cell) => cell !== id && cell !== 0);
      const part = (x, y) => own(x, y, width, height) / (width * height);
      const isOn = (x, y) => cells[(y0 + y + (height >> 1)) * columns + x0 + x + (width >> 1)] === id;
      const place = mayStickOut && find(width, height, (x, y) => (isOn(x, y) && !foreign(x, y, width, height) && part(x, y) >= PART ? part(x, y) : -1));
      if (place) return { at: place, fits: true };
      let side = 1;
      while (fitting(2 * side, 2 * side)) side *= 2;
      return { at: fitting(side, side), fits: false };
    }
    // The largest margin about the name, by bisection.
    let [low, high] = [0, Math.ceil(Math.max(nx, ny) / 2)];
    while (high - low > 1) {
      const margin = (low + high) >> 1;
      const found = fitting(width + 2 * margin, height + 2 * margin);
      if (found) [fit, low] = [found, margin];
      else high = margin;
    }
    return { at: fit, fits: true };
  }

  /** Draws names centred at spots, each with the area of its shape in square pixels. No name covers one of the markers. */
  function inside(context, panel, markers, names) {
    const taken = markers.map((spot) => about(spot, MARKER));
    for (const [text, [x, y], area] of names) {
      const [width, height] = size(context, panel, text);
      const place = pushed({ x: x - width / 2, y: y - height / 2, width, height }, panel.rect);
      if (width * height > COVERED * area || taken.some((other) => common(place, other) > 0)) continue;
      taken.push(place);
      write(context, panel.theme, text, place.x + width / 2, place.y + height / 2);
    }
  }

  /** Returns the box for a name beyond `tip`, as seen from `from`. */
  function beyond(context, panel, text, tip, from) {
    const [width, height] = size(context, panel, text);
    const away = [tip[0] - from[0], tip[1] - from[1]];
    const length = Math.hypot(...away) || 1;
    const [x, y] = [width, height].map((side, k) => tip[k] + (away[k] / length) * (side / 2 + 2 * GAP) - side / 2);
    return { x, y, width, height };
  }

  function write(context, theme, text, x, y) {
    context.font = theme.font(600);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.lineWidth = 3.5;
    context.strokeStyle = theme.paper;
    context.strokeText(text, x, y);
    context.fillStyle = theme.ink;
    context.fillText(text, x, y);
  }

  return { about, spotted, shaped, lines, beside, besideAmong, beyond, inside, onRegions, write, nothing, copy, blockShape, blockSpot, blockLine };
})();

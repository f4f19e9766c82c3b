// Places for the names of C-obstacles that others cover. The program chooses the middle of each C-obstacle, which
// another one may hide, for instance after a drag.
'use strict';

const VisibleNames = (() => {
  /** Numbers of places along both axes at which a covered C-obstacle is searched for a visible part. Names are wide. */
  const [COLUMNS, ROWS] = [48, 120];
  /** Least distance of a name's middle from the edge of the visible part, in steps of these places. */
  const LEAST_DEPTH = 2;
  /** Half the size of a typical name, as fractions of both axes. */
  const [HALF_WIDTH, HALF_HEIGHT] = [0.04, 0.015];
  const raster = element('canvas', { width: COLUMNS, height: ROWS });
  const context = raster.getContext('2d', { willReadFrequently: true });

  /**
   * Returns the outlines of C-obstacles as seen in the panel, in fractions of both axes: for each its obstacle, its box,
   * and its corners. A shape of a revolute joint repeats after each turn.
   */
  function outlines({ c_obstacles }, joints) {
    const found = [];
    for (const { obstacle, contour } of c_obstacles) {
      const [xs, ys] = joints.map(({ domain: [low, high] }, k) => {
        const values = [];
        for (let i = k; i < contour.length; i += 2) values.push((contour[i] - low) / (high - low));
        return values;
      });
      const shifts = [xs, ys].map((values, k) => {
        const [least, greatest] = [Math.min(...values), Math.max(...values)];
        const { sign, domain: [low, high] } = joints[k];
        const turn = Geometry.TURN / (high - low);
        return (sign === undefined ? [0] : [-turn, 0, turn]).filter((by) => least + by < 1 && greatest + by > 0).map((by) => [by, least + by, greatest + by]);
      });
      for (const [dx, left, right] of shifts[0]) {
        for (const [dy, low, high] of shifts[1]) found.push({ obstacle, left, right, low, high, xs, ys, dx, dy });
      }
    }
    return found;
  }

  /** Returns outlines as one path. */
  function pathOf(shapes) {
    const path = new Path2D();
    for (const { xs, ys, dx, dy } of shapes) {
      xs.forEach((x, i) => (i ? path.lineTo(x + dx, ys[i] + dy) : path.moveTo(x + dx, ys[i] + dy)));
      path.closePath();
    }
    return path;
  }

  /** Returns which places of a shape the shapes above it (`above`, one path) leave visible, as a raster: its alpha values are 255 there. */
  function visible(shape, above) {
    context.setTransform(COLUMNS, 0, 0, ROWS, 0, 0);
    context.clearRect(0, 0, 1, 1);
    context.fill(shape);
    context.globalCompositeOperation = 'destination-out';
    context.fill(above);
    context.globalCompositeOperation = 'source-over';
    return context.getImageData(0, 0, COLUMNS, ROWS).data;
  }

  /** Returns the visible place with the most room around it, and the visible area; `null` if there is too little room. */
  function roomiest(pixels) {
    // Distance to the nearest invisible place, in steps: two sweeps over the grid, which has a border.
    const stride = COLUMNS + 2;
    const depth = new Int32Array(stride * (ROWS + 2));
    const cells = [];
    for (let k = 1; k <= ROWS; k += 1) {
      for (let i = 1; i <= COLUMNS; i += 1) {
        if (pixels[4 * ((k - 1) * COLUMNS + i - 1) + 3] < 200) continue;
        const at = k * stride + i;
        depth[at] = 1 + Math.min(depth[at - 1], depth[at - stride], depth[at - stride - 1], depth[at - stride + 1]);
        cells.push(at);
      }
    }
    let best = null;
    for (const at of cells.reverse()) {
      depth[at] = Math.min(depth[at], 1 + Math.min(depth[at + 1], depth[at + stride], depth[at + stride + 1], depth[at + stride - 1]));
      if (best === null || depth[at] > depth[best]) best = at;
    }
    if (best === null || depth[best] < LEAST_DEPTH) return null;
    const place = [((best % stride) - 0.5) / COLUMNS, (Math.floor(best / stride) - 0.5) / ROWS];
    return { place, area: cells.length / (COLUMNS * ROWS) };
  }

  /** Moves the names in a world of the view that others cover to a visible part, or removes them if there is none. */
  function correct(world, joints) {
    if (world.names.length < 2) return;
    const all = outlines(world, joints);
    // Later C-obstacles are drawn over earlier ones.
    const orders = new Map([...new Set(all.map(({ obstacle }) => obstacle))].map((obstacle, i) => [obstacle, i]));
    context.resetTransform();
    world.names = world.names.flatMap((name) => {
      const [x, y] = name.at.map((value, k) => (value - joints[k].domain[0]) / (joints[k].domain[1] - joints[k].domain[0]));
      const isNear = ({ left, right, low, high }) => left < x + HALF_WIDTH && right > x - HALF_WIDTH && low < y + HALF_HEIGHT && high > y - HALF_HEIGHT;
      const order = orders.get(name.obstacle);
      const above = all.filter(({ obstacle }) => orders.get(obstacle) > order);
      const near = above.filter(isNear);
      if (!near.length) return [name];
      const cover = pathOf(near);
      const parts = [[0, 0], [1, 1], [1, -1], [-1, 1], [-1, -1]].map(([dx, dy]) => [x + dx * HALF_WIDTH, y + dy * HALF_HEIGHT]);
      if (!parts.some((part) => context.isPointInPath(cover, ...part))) return [name];
      const found = roomiest(visible(pathOf(all.filter(({ obstacle }) => obstacle === name.obstacle)), pathOf(above)));
      if (!found) return [];
      const at = found.place.map((part, k) => joints[k].domain[0] + part * (joints[k].domain[1] - joints[k].domain[0]));
      return [{ ...name, at, area: Math.min(name.area, found.area) }];
    });
  }

  return { correct };
})();

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

  /** Returns the outlines of each C-obstacle as one path in fractions of both axes. Later ones are drawn over earlier ones. */
  function outlines({ c_obstacles }, joints) {
    const paths = new Map();
    const width = joints.map(({ domain: [low, high] }) => high - low);
    // A shape of a revolute joint repeats after each turn.
    const turns = joints.map((joint) => (joint.sign === undefined ? [0] : [-1, 0, 1].map((n) => n * Geometry.TURN)));
    for (const { obstacle, contour } of c_obstacles) {
      if (!paths.has(obstacle)) paths.set(obstacle, new Path2D());
      const path = paths.get(obstacle);
      for (const a of turns[0]) {
        for (const b of turns[1]) {
          for (let i = 0; i + 1 < contour.length; i += 2) {
            const [x, y] = [(contour[i] + a - joints[0].domain[0]) / width[0], (contour[i + 1] + b - joints[1].domain[0]) / width[1]];
            if (i) path.lineTo(x, y);
            else path.moveTo(x, y);
          }
          path.closePath();
        }
      }
    }
    return [...paths];
  }

  /** Returns which places of a shape the shapes above it leave visible, as a raster: its alpha values are 255 there. */
  function visible(shape, above) {
    context.setTransform(COLUMNS, 0, 0, ROWS, 0, 0);
    context.clearRect(0, 0, 1, 1);
    context.fill(shape);
    context.globalCompositeOperation = 'destination-out';
    for (const other of above) context.fill(other);
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
    const paths = outlines(world, joints);
    context.resetTransform();
    world.names = world.names.flatMap((name) => {
      const own = paths.findIndex(([obstacle]) => obstacle === name.obstacle);
      if (own < 0) return [name];
      const above = paths.slice(own + 1).map(([, path]) => path);
      const isHidden = (x, y) => above.some((path) => context.isPointInPath(path, x, y));
      const [x, y] = name.at.map((value, k) => (value - joints[k].domain[0]) / (joints[k].domain[1] - joints[k].domain[0]));
      const parts = [[0, 0], [1, 1], [1, -1], [-1, 1], [-1, -1]].map(([dx, dy]) => [x + dx * HALF_WIDTH, y + dy * HALF_HEIGHT]);
      if (!parts.some((part) => isHidden(...part))) return [name];
      const found = roomiest(visible(paths[own][1], above));
      if (!found) return [];
      const at = found.place.map((part, k) => joints[k].domain[0] + part * (joints[k].domain[1] - joints[k].domain[0]));
      return [{ ...name, at, area: Math.min(name.area, found.area) }];
    });
  }

  return { correct };
})();

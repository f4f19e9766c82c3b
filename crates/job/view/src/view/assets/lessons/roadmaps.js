// The chapter on roadmaps, for pages of planners that search a graph of free motions.
'use strict';

const ROADMAPS = (() => {
  /** Distance of a click from its target that is still right, as a fraction of the joints' ranges. */
  const NEAR = 0.025;
  /** Least angle of a bend, in radians. */
  const BEND = 0.17;

  /** Returns which kind of roadmap a model has: 'visibility', 'prm', 'voronoi', 'slices'; or `null`. */
  function kindOf({ worlds: [world], replay, paths }) {
    const kind = paths.length === 1 && replay ? world?.trace?.kind : null;
    if (kind === 'roads') return replay.some((phase) => phase.kind === 'nodes') ? 'prm' : 'voronoi';
    return { roadmap: 'visibility', rows: 'slices' }[kind] ?? null;
  }

  const A_GRAPH = 'A roadmap is a graph: its vertices are free configurations, and its edges are free straight motions.';
  const KINDS = {
    visibility: ['Corners that see each other', `${A_GRAPH} The visibility graph joins corners of the C-obstacles that see each other. The shortest path around polygons bends only at corners, so it is in this graph. Play the search.`],
    prm: ['Random configurations, joined', `${A_GRAPH} A probabilistic roadmap draws random free configurations, and joins each to its neighbours. With more samples, a path is found with higher probability. If no path is found, nothing is proven.`],
    voronoi: ['As far away as possible', `${A_GRAPH} The Voronoi diagram consists of the configurations that are equally near to two places of the boundary. Its paths keep as far away from obstacles as possible, so they are longer.`],
    slices: ['Slices with exact free intervals', 'This planner cuts configuration space into slices of joint 1, in which free space is known exactly. A shortest path from slice to slice is a lower bound for all paths. Play the search: slices are added until the path is nearly as short as the bound.'],
  };

  /** Returns the configurations in which a path bends. Corners of a path may be rounded, so directions are compared at a distance. */
  function bends({ joints }, flat) {
    const points = [...Geometry.pointsOf(flat)];
    const along = [0];
    for (let i = 1; i < points.length; i += 1) along.push(along[i - 1] + Math.hypot(...Contact.minus(points[i], points[i - 1])));
    const window = NEAR * Math.max(...joints.map(({ domain: [low, high] }) => high - low));
    const last = along[along.length - 1];
    const at = (length) => {
      const k = Math.max(1, along.findIndex((other) => other >= length));
      const part = (length - along[k - 1]) / (along[k] - along[k - 1] || 1);
      return Contact.plus(points[k - 1], Contact.minus(points[k], points[k - 1]).map((x) => x * part));
    };
    return points.filter((q, i) => {
      if (along[i] < window || along[i] > last - window) return false;
      const [a, b] = [Contact.minus(q, at(along[i] - window)), Contact.minus(at(along[i] + window), q)];
      return Math.abs(Math.atan2(Contact.cross(a, b), a[0] * b[0] + a[1] * b[1])) > BEND;
    });
  }

  /** Returns the distance of a configuration from the nearest edge of a roadmap, as a fraction of the joints' ranges. */
  function fromEdges({ joints }, q, edges) {
    const size = joints.map(({ domain: [low, high] }) => high - low);
    const scaled = (i) => [edges[i] / size[0], edges[i + 1] / size[1]];
    let least = Infinity;
    for (const image of Places.images({ joints }, q)) {
      const p = [image[0] / size[0], image[1] / size[1]];
      for (let i = 0; i + 3 < edges.length; i += 4) {
        const [a, b] = [scaled(i), scaled(i + 2)];
        const [along, to] = [Contact.minus(b, a), Contact.minus(p, a)];
        const square = along[0] ** 2 + along[1] ** 2;
        const part = square ? Math.min(1, Math.max(0, (along[0] * to[0] + along[1] * to[1]) / square)) : 0;
        least = Math.min(least, Math.hypot(to[0] - part * along[0], to[1] - part * along[1]));
      }
    }
    return least;
  }

  /** Returns the question about the graph: for a roadmap of curves a place on it, otherwise a bend of the path. */
  function askPlace(view) {
    const { arm, paths: [path], worlds: [world] } = view.model;
    const corners = bends(arm, path.points);
    if (kindOf(view.model) === 'voronoi' || !corners.length) {
      const { edges = path.points } = world.trace;
      return Ask.place(view, {
        prompt: 'Click on a configuration that is on the roadmap.',
        check: (q) => (fromEdges(arm, q, edges) <= NEAR ? null : 'No edge is at this place. The edges are the thin lines in free space.'),
        right: 'An edge passes here. The search only considers such configurations.',
      });
    }
    return Ask.place(view, {
      prompt: 'Click on a configuration in which the path bends.',
      check: (q) => (corners.some((corner) => Places.near(arm, q, corner, NEAR)) ? null : 'The path does not bend there. Follow it from the ring to the diamond; you can zoom in.'),
      right: 'The path turns here. A path that is pulled taut bends only around C-obstacles.',
    });
  }

  return {
    name: 'roadmaps',
    title: 'Roadmaps',
    lessons: [
      {
        name: 'graph', figure: 'think',
        title: (model) => KINDS[kindOf(model)][0],
        isOffered: (model) => kindOf(model) !== null,
        text: ({ model }) => KINDS[kindOf(model)][1],
        question: askPlace,
      },
      {
        name: 'detour', figure: 'move', title: () => 'The price of the obstacles',
        isOffered: (model) => kindOf(model) !== null,
        text: ({ model: { paths: [{ points }], arm: { joints } } }) => {
          const straight = Places.length([...points.slice(0, 2), ...points.slice(-2)]);
          return `The length of a path in joint space is the sum of its straight pieces. The straight line from start to goal would have the length ${Numbers.pathLength(joints, straight)}. The path that was found has the length ${Numbers.pathLength(joints, Places.length(points))}, because it goes around C-obstacles.`;
        },
        question: ({ model: { paths: [{ points }] } }) => {
          const more = 100 * (Places.length(points) / Places.length([...points.slice(0, 2), ...points.slice(-2)]) - 1);
          return Ask.number({
            prompt: 'By how many percent is the path longer than the straight line?', unit: '%', value: more, tolerance: 1 + 0.01 * more,
            hint: 'Divide the length of the path by that of the straight line, and subtract one.',
            right: `It is ${Numbers.digits(more)} % longer.`,
          });
        },
      },
    ],
  };
})();

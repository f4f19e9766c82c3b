// The chapter on certificates and proofs: why a motion is free, or why no motion exists.
'use strict';

const PROOFS = (() => {
  /** Places of the motion at which its least distance is sought, and how much greater a right answer may be. */
  const [SAMPLES, GREATER] = [600, 1.25];
  /** Difference of distances that readers cannot see, in metres. */
  const HAIR = 0.002;
  /** Boxes nearer than this touch, as a fraction of the joints' ranges. The data of the page are rounded. */
  const TOUCHING = 1e-3;

  const isSingle = ({ paths, ending }) => paths.length === 1 && !paths[0].step && ending === 'found';
  const hasProof = ({ worlds: [world] }) => Boolean(world?.proof.length);

  /** Returns the distance of the arm from the nearest obstacle. */
  const distance = ({ arm, worlds: [world] }, q) => Geometry.contacts(arm, world, q)[0]?.distance ?? Infinity;

  /** Returns the greatest distance of a corner of a link's parts from the origin of the link, with their rounding. */
  const radius = ({ parts }) => Math.max(0, ...parts.flatMap(({ core, radius: rounding }) => [...Geometry.pointsOf(core)].map((p) => Math.hypot(...p) + rounding)));

  /** Returns a bound on the motion of all points of the arm if the joints change by these amounts. */
  function motionBound({ joints, links, offset }, changes) {
    const second = radius(links[1]);
    // Link 2 is farther from joint 1 if it slides outwards.
    const slide = joints[1].sign === undefined ? Math.max(...joints[1].domain.map(Math.abs)) : 0;
    const levers = [Math.max(radius(links[0]), Math.hypot(...offset) + slide + second), second];
    return changes.reduce((sum, change, k) => sum + Math.abs(change) * (joints[k].sign === undefined ? 1 : levers[k]), 0);
  }

  /** Returns the longest straight piece of the path: the distance in its middle, and the bound on the motion from there. */
  function longestPiece(model) {
    const points = [...Geometry.pointsOf(model.paths[0].points)];
    const pieces = points.slice(1).map((q, i) => [points[i], q]);
    const length = (/** @type {Point[]} */ [a, b]) => Math.hypot(b[0] - a[0], b[1] - a[1]);
    const [a, b] = pieces.reduce((best, piece) => (length(piece) > length(best) ? piece : best));
    return { gap: distance(model, Contact.plus(a, b).map((x) => x / 2)), moved: motionBound(model.arm, Contact.minus(b, a).map((x) => x / 2)) };
  }

  /** Returns the least distance of the motion at many places. */
  function leastDistance(model) {
    const { time } = model.clock;
    const duration = time[time.length - 1];
    let least = Infinity;
    for (let k = 0; k <= SAMPLES; k += 1) least = Math.min(least, distance(model, Geometry.moving(model.clock, (duration * k) / SAMPLES).position));
    return least;
  }

  /** Returns the number of walls: groups of boxes that touch each other, also across the seam of a circle. */
  function walls({ arm, worlds: [world] }) {
    const boxes = Places.boxes(world.proof);
    const touch = (a, b) => [0, 1].every((k) => {
      const { circle, domain: [low, high] } = arm.joints[k];
      const near = TOUCHING * (high - low);
      return (circle ? [-Geometry.TURN, 0, Geometry.TURN] : [0]).some((by) => a[k] + by <= b[k + 2] + near && b[k] <= a[k + 2] + by + near);
    });
    const groups = boxes.map((_, i) => i);
    const group = (i) => (groups[i] === i ? i : group(groups[i]));
    boxes.forEach((a, i) => boxes.slice(0, i).forEach((b, j) => {
      if (touch(a, b)) groups[group(i)] = group(j);
    }));
    return groups.filter((other, i) => other === i).length;
  }

  const SHAPES = [
    'The edges of the picture are limits of the joints. No path leads past boxes that reach from one limit to another, or all around the start or a goal. The boxes of a proof may overlap. Boxes that touch each other belong to the same wall.',
    'One joint turns without end, so two edges of the picture are the same configurations: the space is a cylinder. A path may still go around a wall across the cylinder, on the other side. Boxes that touch each other, also across the seam, belong to the same wall.',
    'Both joints turn without end, so opposite edges of the picture are the same configurations: the space is a torus. A path can always go around a single wall from the other side. Boxes that touch each other, also across a seam, belong to the same wall.',
  ];

  return {
    name: 'proofs',
    title: 'Certificates and proofs',
    lessons: [
      {
        name: 'certified', figure: 'move', title: () => 'Free between all samples',
        isOffered: isSingle,
        text: () => 'How can a whole motion be free, and not only its samples? Take the arm in the middle of a straight piece, and its distance from all obstacles. If no point of the arm moves farther than this distance within the piece, the piece is free. Otherwise, look at both halves.',
        question: ({ model }) => {
          const { gap, moved } = longestPiece(model);
          const isFree = moved < gap;
          return Ask.choice({
            prompt: `In the middle of the longest piece of this path, the arm is ${Numbers.length(gap, 0, Math.floor)} from the nearest obstacle. From there to an end of the piece, no point of the arm moves more than ${Numbers.length(moved, 0, Math.ceil)}. What follows?`,
            options: ['The piece is free.', 'The piece has a collision.', 'Nothing yet: halve the piece.'], index: isFree ? 0 : 2,
            hint: 'Compare both lengths. A small bound on the motion proves that nothing is touched. A large bound proves nothing, not even contact.',
            right: isFree ? 'The arm cannot get as far as the obstacle.' : 'The arm might get as far as the obstacle. The halves have smaller bounds.',
          });
        },
      },
      {
        name: 'clearance', figure: 'move', title: () => 'The clearance of a motion',
        isOffered: (model) => isSingle(model) && Boolean(model.clock) && Number.isFinite(distance(model, model.start)),
        text: () => 'The certificate states a distance that the arm keeps from all obstacles during the whole motion: its clearance. A shortest path passes its obstacles closely, so the clearance is small. Play the motion, or move the slider, and look where the arm is nearest to an obstacle.',
        question: (view) => Ask.figure({
          prompt: 'Stop the motion where the arm is nearest to an obstacle, and check.',
          check: () => {
            const [here, least] = [distance(view.model, view.q), leastDistance(view.model)];
            return here <= GREATER * least + HAIR ? null : `Here the arm keeps ${Numbers.length(here)}. Elsewhere the arm comes nearer.`;
          },
          right: 'Nowhere else does the arm come much nearer.',
        }),
      },
      {
        name: 'collision_boxes', figure: 'think', title: () => 'Boxes in which the arm always collides',
        isOffered: (model) => hasProof(model) && Boolean(model.replay),
        text: () => 'A box of configurations is a collision box if two shapes overlap in its middle deeper than any point of the arm moves within the box. If such boxes separate the start from every goal, there is no path. That is a proof, and not a search that failed.',
        question: (view) => {
          const { arm, worlds: [world] } = view.model;
          return Ask.place(view, {
            prompt: 'Click into a box of the proof.',
            check: (q) => (Places.boxes(world.proof).some((box) => Places.inBox(arm, q, box)) ? null : 'No box is there. The boxes of the proof are hatched.'),
            right: 'In this whole box, the arm overlaps an obstacle.',
          });
        },
      },
      {
        name: 'walls', figure: 'think', title: () => 'Walls in a space that closes up',
        isOffered: (model) => hasProof(model) && Boolean(model.replay),
        text: ({ model: { arm: { joints } } }) => SHAPES[joints.filter(({ circle }) => circle).length],
        question: ({ model }) => {
          const count = walls(model);
          return Ask.number({
            prompt: 'How many separate walls do the boxes of this proof form?', value: count,
            hint: 'Count the groups of hatched boxes that do not touch each other. Opposite edges may be the same place.',
            right: count === 1 ? 'One wall is enough here.' : `${count} walls are needed: past a single wall, a path leads around the other side.`,
          });
        },
      },
    ],
  };
})();

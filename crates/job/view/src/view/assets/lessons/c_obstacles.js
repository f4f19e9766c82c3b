// The chapter on C-obstacles: from the arm to its configuration space. Every page with an obstacle has it.
'use strict';

const C_OBSTACLES = (() => {
  /** Tolerances of an angle in radians, and of a length in metres, that is read from a table. */
  const [ANGLE, LENGTH] = [0.009, 0.002];

  /** Returns the first C-obstacle's obstacle, or `null`. */
  const firstObstacle = ({ worlds: [world] }) => (world?.c_obstacles.length ? world.c_obstacles[0].obstacle : null);

  /** Asks to touch an obstacle with the arm. */
  function askContact(view) {
    const { arm, worlds: [world] } = view.model;
    const wanted = firstObstacle(view.model);
    const { name } = world.obstacles[wanted];
    return Ask.place(view, {
      prompt: `Place the arm so that it touches \u201c${name}\u201d.`,
      check: (q) => {
        const hits = Geometry.contacts(arm, world, q).filter(({ distance }) => distance <= 0);
        if (hits.some(({ obstacle }) => obstacle === wanted)) return null;
        return hits.length ? `Here the arm touches \u201c${world.obstacles[hits[0].obstacle].name}\u201d.` : 'Here the arm is free. In the configuration space, look for the region with the name of the obstacle.';
      },
      right: `This configuration belongs to the C-obstacle of \u201c${name}\u201d.`,
    });
  }

  /** Asks for the width of a blocked interval of the current slice. */
  function askWidth(view) {
    const { rows, bands } = view.learn.slices.slice;
    const [, joint] = view.model.arm.joints;
    const isAngle = joint.unit === 'rad';
    const own = bands.length ? [] : rows.flatMap(({ obstacle, intervals }) => intervals.map(([from, to]) => ({ obstacle, from, to })));
    // An end at a limit of the joint is not in the table.
    const [first] = [...own.filter(({ from, to }) => from.features && to.features), ...own];
    const unit = isAngle ? '\u00b0' : 'mm';
    if (!first) {
      return Ask.number({ prompt: `How wide is the first blocked interval of ${joint.name} in this slice?`, unit, value: NaN, hint: 'This slice has no blocked interval. Move the slider to another slice.', right: '' });
    }
    const width = first.to.value - first.from.value;
    return Ask.number({
      prompt: `How wide is the first interval of ${joint.name} that \u201c${view.world.obstacles[first.obstacle].name}\u201d blocks in this slice?`,
      unit, value: isAngle ? (width * 180) / Math.PI : 1000 * width, tolerance: isAngle ? (ANGLE * 180) / Math.PI : 1000 * LENGTH,
      hint: 'Subtract the value at the beginning of the interval from the value at its end.',
      right: `The arm touches it from ${Numbers.joint(joint, first.from.value)} to ${Numbers.joint(joint, first.to.value)}.`,
    });
  }

  /** Asks which test of penetration detects the contact of the two polygons. */
  function askTest(view) {
    const { meet, mine, others, crossings } = view.learn.pair.test();
    const corners = [...mine, ...others].filter(({ inside }) => inside).length;
    const index = !meet ? 3 : corners && crossings.length ? 2 : corners ? 0 : 1;
    const found = `Corners inside: ${corners}; crossings of sides: ${crossings.length}.`;
    return Ask.choice({
      prompt: 'Which of the tests detects that these polygons meet?',
      options: ['Only that a corner is inside', 'Only that sides cross', 'Both', 'None: the polygons do not meet'], index,
      hint: 'In the picture, corners inside the other polygon are red, and sides that cross are bold.',
      right: `${found} Drag the link until only the other test detects the overlap.`,
    });
  }

  const askCorners = ({ learn: { pair } }) => {
    const { a, b } = pair.pieces;
    return Ask.number({
      prompt: 'How many corners does this difference have?', value: pair.steps.length,
      hint: `The link has ${a.length} sides, and the obstacle ${b.length}. Sides with the same direction become one side.`,
      right: `${a.length} and ${b.length} sides make ${pair.steps.length}${pair.steps.length < a.length + b.length ? ', because parallel ones merge' : ', because none are parallel'}.`,
    });
  };

  const askAngles = ({ learn: { pair } }) => {
    const { at, b } = pair.pieces;
    const blocked = pair.angles.filter((angle) => Contact.polygonTest(pair.rotated(angle).map((p) => Contact.plus(p, at)), b).meet).length;
    return Ask.number({
      prompt: `At how many of the ${pair.angles.length} angles in the picture is the link blocked at its place?`, value: blocked,
      hint: 'Move the slider to each multiple of 30\u00b0. The link is blocked if it meets the obstacle.',
      right: `The blue line is inside ${blocked} of the ${pair.angles.length} differences.`,
    });
  };

  return {
    name: 'c_obstacles',
    title: 'C-obstacles',
    lessons: [
      {
        name: 'point', figure: 'move', isPlain: true, title: () => 'A whole arm as one point',
        isOffered: (model) => firstObstacle(model) !== null,
        text: () => 'Two numbers describe the pose of this arm: its joint values. In the configuration space, each pair of values is one point, a configuration. A coloured region has all configurations in which the arm touches an obstacle: its C-obstacle. Drag the tip of the arm, or point into the configuration space.',
        question: askContact,
      },
      {
        name: 'slice', figure: 'slice', title: () => 'Contact angles of a slice',
        isOffered: SliceFigure.isOffered,
        text: ({ model: { arm: { joints } } }) => `Hold ${joints[0].name} still. Now only link 2 ${joints[1].sign === undefined ? 'slides' : 'turns'}. A contact begins or ends where a corner meets a side, which gives ${joints[1].sign === undefined ? 'a linear equation' : 'an equation r cos(\u03c6 + \u03b1) = d'}. The slider moves the slice, and a click into the configuration space chooses a contact.`,
        question: askWidth,
      },
      {
        name: 'tests', figure: 'pair', title: () => 'When do two polygons meet?',
        isOffered: PolygonFigure.isOffered,
        text: () => 'Compute the signed distances of a corner from the sides of the other polygon, positive on the inner side. If no distance is negative, the corner is inside, and the least distance is its depth. Two convex polygons meet if a corner of one is inside the other, or if two sides cross.',
        question: askTest,
      },
      {
        name: 'sweep', figure: 'pair', title: () => 'Minkowski difference, corner by corner',
        isOffered: PolygonFigure.isOffered,
        text: () => 'Let the link translate without turning. The positions of its origin in which the polygons meet are their Minkowski difference. Its sides are those of the obstacle and of the mirrored link, sorted by direction. Sides with the same direction merge. Play: each step adds one side.',
        question: askCorners,
      },
      {
        name: 'stack', figure: 'pair', title: () => 'Minkowski differences of a link that turns',
        isOffered: (model) => PolygonFigure.isOffered(model) && model.arm.joints.some((joint) => joint.sign !== undefined),
        text: () => 'When the link turns, each angle has its own difference. Stacked by angle, they form the C-obstacle of a body that moves and turns. The blue line keeps the link\u2019s origin in place and turns the link once. An angle is blocked where the line is inside the stack.',
        question: askAngles,
      },
    ],
  };
})();

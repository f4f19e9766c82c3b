// The chapter on potential fields, for pages of planners that follow the slope of a field.
'use strict';

const FIELDS = (() => {
  /** Distance of a click from the goal that is still right, as a fraction of the joints' ranges. */
  const NEAR = 0.04;
  const traceOf = ({ worlds: [world], replay, paths }) => (paths.length === 1 && replay && world?.trace?.kind === 'field' ? world.trace : null);
  const goalOf = ({ paths: [{ points }] }) => points.slice(-2);

  /** Returns the usual angle between a path and the equipotentials that it crosses, in degrees from 0 to 90. */
  function crossingAngle(model) {
    const [{ points }] = model.paths;
    const pieces = (flat) => {
      const all = [...Geometry.pointsOf(flat)];
      return all.slice(1).map((q, i) => [all[i], q]);
    };
    const isCrossed = (/** @type {Point[]} */ [p, q], /** @type {Point[]} */ [r, s]) => {
      const side = (a, b, c) => Math.sign(Contact.cross(Contact.minus(b, a), Contact.minus(c, a)));
      return side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0;
    };
    const along = pieces(points);
    const angles = traceOf(model).levels.flatMap(({ lines }) => lines.flatMap(pieces)).flatMap((line) => along.filter((piece) => isCrossed(line, piece)).map((piece) => {
      const [a, b] = [line, piece].map(([p, q]) => Contact.minus(q, p));
      return (Math.atan2(Math.abs(Contact.cross(a, b)), Math.abs(a[0] * b[0] + a[1] * b[1])) * 180) / Math.PI;
    }));
    angles.sort((a, b) => a - b);
    return angles.length ? angles[Math.floor(angles.length / 2)] : null;
  }

  /** Answers, with their angles in degrees. @type {[string, number][]} */
  const CHOICES = [['0\u00b0: along them', 0], ['45\u00b0', 45], ['90\u00b0: straight across', 90]];

  return {
    name: 'fields',
    title: 'Potential fields',
    lessons: [
      {
        name: 'minimum', figure: 'think', title: () => 'Only one minimum',
        isOffered: (model) => Boolean(traceOf(model)),
        text: ({ model: { facts } }) => (facts.some(([name, value]) => name === 'field' && !value.startsWith('harmonic'))
          ? 'A field gives each free cell a value: high at obstacles, low at the goal. The motion follows its slope, without a search. A place that is lower than its neighbours is a minimum; a motion that comes to a minimum stays there. Lines join places of the same value.'
          : 'A field gives each free cell a value, and the motion follows its slope, without a search. In a harmonic field, obstacles are high, the goal is low, and each other value is the mean of its neighbours. So no free cell except the goal is lower than all its neighbours.'),
        question: (view) => Ask.place(view, {
          prompt: 'Click on the minimum of the field to which the motion leads.',
          check: (q) => (Places.near(view.model.arm, q, goalOf(view.model), NEAR) ? null : 'From there, the field still falls in some direction. Follow the path downhill.'),
          right: 'This is the goal. Motions from everywhere around it lead here.',
        }),
      },
      {
        name: 'slope', figure: 'think', title: () => 'Contour lines of a field',
        isOffered: (model) => Boolean(traceOf(model)) && crossingAngle(model) !== null,
        text: () => 'Equipotentials join places of the same value, like contour lines on a map. Where they are dense, the field is steep. The path follows the steepest descent, and so crosses one line after the other. Look at the places of the path that are far from its bends.',
        question: ({ model }) => {
          const angle = crossingAngle(model);
          const distances = CHOICES.map(([, degrees]) => Math.abs(degrees - angle));
          return Ask.choice({
            prompt: 'At which angle does the path usually cross the equipotentials?', options: CHOICES.map(([text]) => text), index: distances.indexOf(Math.min(...distances)),
            hint: 'Zoom into the path between two bends. Compare the direction of the path with that of the line that it crosses there.',
            right: `At half of all crossings, the angle is at least ${Numbers.digits(angle, 2)}\u00b0: the direction of steepest descent is perpendicular to the lines.`,
          });
        },
      },
    ],
  };
})();

// The chapter on cell decompositions, for pages of planners that search cells.
'use strict';

const CELLS = (() => {
  const traceOf = ({ worlds: [world], replay, paths }) => (paths.length === 1 && replay ? world?.trace : null);
  const isKind = (kind) => (model) => traceOf(model)?.kind === kind;

  /** Returns the number of splits from the whole space to the smallest box. */
  function splits(model) {
    const { joints } = model.arm;
    const { free, stuck, mixed } = traceOf(model);
    const area = ([x0, y0, x1, y1]) => (x1 - x0) * (y1 - y0);
    const whole = joints.reduce((product, { domain: [low, high] }) => product * (high - low), 1);
    const smallest = Math.min(...[free, stuck, mixed].flatMap(Places.boxes).map(area));
    return Math.round(Math.log2(whole / smallest));
  }

  return {
    name: 'cells',
    title: 'Cell decompositions',
    lessons: [
      {
        name: 'convex', figure: 'think', title: () => 'Convex pieces of free space',
        isOffered: isKind('channel'),
        text: ({ model }) => {
          const { cells } = traceOf(model);
          const isSwept = model.replay.some((phase) => phase.kind === 'cells' && phase.swept);
          const how = isSwept
            ? `A vertical line sweeps over the C-obstacles. At each corner, a vertical segment is drawn to the next sides above and below. This gives ${cells.length} cells.`
            : `As many segments between corners as possible, without crossings, give ${cells.length} triangles.`;
          return `${how} Within a convex cell, every straight motion is free. Cells that share an edge are neighbours, and a path from neighbour to neighbour is a channel.`;
        },
        question: (view) => {
          const { arm } = view.model;
          const { cells, channel } = traceOf(view.model);
          return Ask.place(view, {
            prompt: 'Click into a cell of the channel.',
            check: (q) => {
              if (channel.some((index) => Places.within(arm, q, cells[index]))) return null;
              return cells.some((cell) => Places.within(arm, q, cell)) ? 'That cell is free, but does not belong to the channel. The channel is shaded.' : 'That is no cell. The channel is the shaded band from start to goal.';
            },
            right: 'The search chose this cell. Every curve that stays in the channel is free.',
          });
        },
      },
      {
        name: 'portals', figure: 'move', title: () => 'Portals, and a string through them',
        isOffered: isKind('channel'),
        text: () => 'Where two cells of a channel meet, they share an edge: the portal. A path through the channel crosses the portals one after the other. Pulled taut like a string, it bends only at ends of portals. The funnel algorithm finds this taut path in one pass.',
        question: ({ model }) => {
          const { length } = traceOf(model).channel;
          return Ask.number({
            prompt: `The channel has ${length} cells. How many portals does the path cross?`, value: length - 1,
            hint: 'There is one portal between each cell of the channel and the next one.',
            right: `${length} cells in a row share ${length - 1} edges.`,
          });
        },
      },
      {
        name: 'boxes', figure: 'think', title: () => 'Free, in collision, or undecided',
        isOffered: isKind('boxes'),
        text: () => 'Place the arm in the middle of a box of configurations. If its distance from all obstacles is greater than any point of the arm can move within the box, the box is free. If two shapes overlap everywhere in the box, it is a collision box. Otherwise it is undecided, and is split. Play the splitting, from coarse to fine.',
        question: (view) => {
          const { arm } = view.model;
          const { free, mixed } = traceOf(view.model);
          return Ask.place(view, {
            prompt: 'Click into a free box.',
            check: (q) => {
              if (Places.boxes(free).some((box) => Places.inBox(arm, q, box))) return null;
              return Places.boxes(mixed).some((box) => Places.inBox(arm, q, box)) ? 'That box is undecided: it may be partly free.' : 'That box is not free. Free boxes have the pale green colour.';
            },
            right: 'In this box, the arm is free in every configuration.',
          });
        },
      },
      {
        name: 'splits', figure: 'think', title: () => 'Why the splitting ends',
        isOffered: isKind('boxes'),
        text: ({ model }) => `Only undecided boxes are split, so boxes are small along the boundary of the C-obstacles. If a free path exists, it has some clearance, and small enough boxes on the path are decided. Here the smallest box is the ${2 ** splits(model)}th part of the space.`,
        question: ({ model }) => {
          const count = splits(model);
          return Ask.number({
            prompt: 'Each split halves a box. How many splits lead from the whole space to the smallest box?', value: count,
            hint: `One split leaves a half, two leave a quarter, three an eighth. Which power of two is ${2 ** count}?`,
            right: `2 to the power of ${count} is ${2 ** count}.`,
          });
        },
      },
    ],
  };
})();

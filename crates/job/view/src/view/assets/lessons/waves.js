// The chapter on grids, for pages of the wavefront planner.
'use strict';

const WAVES = (() => {
  const LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/';
  const traceOf = ({ worlds: [world], replay, paths }) => (paths.length === 1 && replay && world?.trace?.kind === 'wavefront' ? world.trace : null);

  /** Returns the block of the picture that contains a configuration: column and row, from 0. */
  function blockOf(model, q) {
    const { joints } = model.arm;
    const { blocks, extent } = traceOf(model);
    return joints.map((joint, k) => {
      const [low, high] = joint.domain;
      const part = (Geometry.wrap(joint, q[k]) - low) / (high - low) / extent[k];
      return Math.min(blocks[k] - 1, Math.max(0, Math.floor(part * blocks[k])));
    });
  }

  /** Returns how far the wave had come when it reached a configuration, from 0 to 63; -1 if it never did. */
  function levelAt(model, q) {
    const { blocks: [, rows], levels } = traceOf(model);
    const [i, j] = blockOf(model, q);
    return LETTERS.indexOf(levels[i * rows + j]);
  }

  const endsOf = ({ paths: [{ points }] }) => [points.slice(0, 2), points.slice(-2)];

  /** Returns the number of moves along the axes between two blocks, without obstacles. */
  function moves(model, a, b) {
    const { joints } = model.arm;
    const { blocks } = traceOf(model);
    return joints.reduce((sum, joint, k) => {
      const by = Math.abs(a[k] - b[k]);
      return sum + (joint.circle ? Math.min(by, blocks[k] - by) : by);
    }, 0);
  }

  return {
    name: 'waves',
    title: 'Grids and wavefronts',
    lessons: [
      {
        name: 'labels', figure: 'think', title: () => 'A wave from the goal',
        isOffered: (model) => Boolean(traceOf(model)),
        text: () => 'The space is a grid of cells. The goal\u2019s cell gets the label 0, its free neighbours 1, their neighbours 2, and so on. From the start, each step of the path leads to a smaller label. No other path along the axes has fewer moves. Play the wave.',
        question: (view) => {
          const { model } = view;
          const [start] = endsOf(model);
          const own = levelAt(model, start);
          const isLater = [...traceOf(model).levels].some((letter) => LETTERS.indexOf(letter) > own);
          return Ask.place(view, {
            prompt: `Click on a cell that has a ${isLater ? 'greater' : 'smaller'} label than the start.`,
            check: (q) => {
              const level = levelAt(model, q);
              if (level < 0) return 'This cell has no label, because the wave did not reach it.';
              if (isLater ? level > own : level < own) return null;
              return `The colours count the moves to the goal. The wave comes to this cell ${level === own ? 'with' : isLater ? 'before' : 'after'} the start.`;
            },
            right: `The wave reached this cell ${isLater ? 'after' : 'before'} the start.`,
          });
        },
      },
      {
        name: 'moves', figure: 'think', title: () => 'Counting moves',
        isOffered: (model) => Boolean(traceOf(model)),
        text: ({ model }) => {
          const { blocks } = traceOf(model);
          return `With four neighbours, each move changes one coordinate by one cell. Without obstacles, the least number of moves is the sum of the differences of both coordinates. Obstacles can only add moves. The picture has ${blocks[0]} columns and ${blocks[1]} rows.`;
        },
        question: ({ model }) => {
          const [start, goal] = endsOf(model).map((q) => blockOf(model, q));
          const value = moves(model, start, goal);
          return Ask.number({
            prompt: `The start is in column ${start[0] + 1}, row ${start[1] + 1}; the goal in column ${goal[0] + 1}, row ${goal[1] + 1}. How many moves lead from one to the other without obstacles?`,
            value, hint: 'Add the difference of the columns and the difference of the rows. If a joint turns without end, take the shorter direction.',
            right: `${value} moves. A straight line would be shorter, but by no more than the factor \u221a2.`,
          });
        },
      },
    ],
  };
})();

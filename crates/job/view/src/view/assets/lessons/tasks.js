// The chapter on tasks: pick, carry, place.
'use strict';

const TASKS = (() => {
  const isOffered = ({ paths, motions, worlds }) => paths.some(({ step }) => step) && motions.length > 1 && worlds.some(({ payload }) => payload);

  return {
    name: 'tasks',
    title: 'Tasks: pick, carry, place',
    lessons: [
      {
        name: 'spaces', figure: 'move', title: () => 'Each step has its own space', isOffered,
        text: () => 'An arm that carries an object has another shape, and an object that was placed is another obstacle. So each step of a task has its own configuration space. Play the task, and watch the configuration space at each pick and place.',
        question: (view) => {
          const { object } = view.model.worlds.find(({ payload }) => payload).payload;
          return Ask.figure({
            prompt: `Stop at a moment in which the arm carries \u201c${object}\u201d, and check.`,
            check: () => {
              const held = view.world.payload?.object;
              if (held === object) return null;
              return held ? `Here the arm carries \u201c${held}\u201d.` : 'Here the arm carries nothing. Move the slider, or choose a step.';
            },
            right: 'With this payload, the arm has other C-obstacles.',
          });
        },
      },
      {
        name: 'carrying', figure: 'move', title: () => 'One search for all choices', isOffered,
        text: ({ model: { motions } }) => `Each motion ends at a place of the tip, for which there are up to two IK solutions. The planner chooses IK solutions, grips and order together. It searches states of the world: the places of all objects, the object that the arm holds, and the configuration of the arm. This task has ${motions.length} motions.`,
        question: ({ model: { motions, worlds } }) => {
          const count = motions.filter(({ world }) => worlds[world].payload).length;
          return Ask.number({
            prompt: 'How many of these motions carry an object?', value: count,
            hint: 'Go through the steps. A motion carries an object from the pick to the place.',
            right: `${count} of ${motions.length} motions have a payload, and each is certified with it.`,
          });
        },
      },
    ],
  };
})();

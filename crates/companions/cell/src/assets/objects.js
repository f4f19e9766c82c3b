// The objects that the arms move: where each lies, and which arm carries it, at the times of both arms.

/**
 * An object in its own frame, with its pose at the beginning. From each of its changes on, it lies at a pose, or an arm
 * carries it, and turns it by an angle between two times.
 * @typedef {ObstacleModel & { at: Point, changes: { time: number, arm: number, at?: Point, grip?: any, turns?: [number, number, number][] }[] }} CellObject
 */

const CellObjects = (() => {
  /** Returns the last change of an object until the times of both arms. Undefined before the first one. */
  const changed = ({ changes }, times) => changes.findLast(({ time, arm }) => times[arm] >= time);

  /**
   * Returns the objects that lie somewhere, at their places.
   * @param {CellObject[]} objects
   * @param {number[]} times
   */
  function lying(objects, times) {
    const places = objects.map((object) => ({ object, at: (changed(object, times) ?? object).at }));
    return places.filter(({ at }) => at).map(({ object, at }) => Geometry.lying(object, at));
  }

  /**
   * Returns the object that an arm carries, as a payload: `turned` is its angle if it is level. Undefined without an object.
   * @param {CellObject[]} objects
   * @param {number} arm
   * @param {number[]} times
   */
  function held(objects, arm, times) {
    const carries = (change) => change?.grip && change.arm === arm;
    const object = objects.find((one) => carries(changed(one, times)));
    if (!object) return undefined;
    const { grip, turns = [] } = changed(object, times);
    const share = ([from, to]) => Math.min(1, Math.max(0, (times[arm] - from) / (to - from || 1)));
    const angle = grip.level && turns.reduce((sum, turn) => sum + turn[2] * share(turn), grip.level[0]);
    return { ...object, grip, turned: angle };
  }

  /**
   * Returns the objects at all places to which the arms bring them.
   * @param {CellObject[]} objects
   */
  const destinations = (objects) => objects.flatMap((object) => object.changes.filter(({ at }) => at).map(({ at }) => Geometry.lying(object, at)));

  return { lying, held, destinations };
})();

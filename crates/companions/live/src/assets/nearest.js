// The free configuration nearest to a blocked one.
'use strict';

const NearestFree = (() => {
  /** Distance of neighbouring tries, in radians; for a sliding joint as a fraction of its range, compared with a turn. */
  const STEP = Math.PI / 120;
  /** Room to leave to obstacles beyond the clearance, as a fraction of the arm's reach. Planners with cells need some. */
  const MARGIN = 0.005;
  /** Longest time of a search, in milliseconds. */
  const SEARCH_TIME = 400;

  /**
   * Tries configurations on growing circles about each of the given ones, and returns the first free one, moved back as
   * far as it stays free; `null` if the time is up. `reach` is the arm's reach.
   */
  function find(arm, world, blocked, reach) {
    const end = performance.now() + SEARCH_TIME;
    const units = arm.joints.map(({ unit, domain: [low, high] }) => (unit === 'rad' ? 1 : (high - low) / Geometry.TURN));
    const isInside = (q) => q.every((value, k) => arm.joints[k].circle || (value >= arm.joints[k].domain[0] && value <= arm.joints[k].domain[1]));
    const isFree = (q) => isInside(q) && !(Geometry.contacts(arm, world, q)[0]?.distance <= world.clearance + MARGIN * reach);
    for (let ring = 1; ring * STEP < Geometry.TURN; ring += 1) {
      const tries = Math.max(12, Math.ceil(Geometry.TURN * ring));
      for (const from of blocked) {
        for (let i = 0; i < tries; i += 1) {
          const angle = (Geometry.TURN * i) / tries;
          const at = (part) => [Math.cos(angle), Math.sin(angle)].map((direction, k) => from[k] + part * ring * STEP * direction * units[k]);
          if (isFree(at(1))) return shortened(at, isFree);
        }
        if (performance.now() > end) return null;
      }
    }
    return null;
  }

  /** Returns the free place next to the last blocked one, by bisection. */
  function shortened(at, isFree) {
    let [low, high] = [0, 1];
    for (let i = 0; i < 8; i += 1) {
      const middle = (low + high) / 2;
      if (isFree(at(middle))) high = middle;
      else low = middle;
    }
    return at(high);
  }

  return { find };
})();

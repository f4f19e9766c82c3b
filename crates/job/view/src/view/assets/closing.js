// The proof that closes: the length of the best path, which falls, and the proven lower bound, which rises, until they meet.
'use strict';

const Closing = (() => {
  /** Room above and below the curves, as a share of their range. */
  const ROOM = 0.1;

  /**
   * Returns both lengths over the time of a replay, as steps: { upper, lower, duration, unit }, each of the first two a list of [time, length].
   * `null` if the replay has no lower bound.
   * @param {PhaseModel[] | undefined} replay
   */
  function curves(replay) {
    const bound = replay?.find(({ kind }) => kind === 'bound');
    if (!bound) return null;
    const [upper, lower] = [[], []];
    let from = 0;
    for (const { kind, seconds, length, rounds } of replay) {
      const until = from + seconds;
      // The first path is known when it has been drawn, the last one when it is shown.
      if (length !== undefined) upper.push([kind === 'path' ? from : until, length]);
      for (const [k, round] of (rounds ?? []).entries()) lower.push([from + (seconds * k) / rounds.length, round.lower]);
      from = until;
    }
    return upper.length && lower.length ? { upper, lower, duration: from, unit: bound.unit } : null;
  }

  /** Returns the value of a curve at a time. `undefined` before its beginning. */
  const valueAt = (steps, time) => steps.filter(([at]) => at <= time + 1e-9).pop()?.[1];

  /** Returns the corners of a curve of steps up to its end. */
  const corners = (steps, end) => steps.flatMap(([at, value], k) => [[at, value], [steps[k + 1]?.[0] ?? end, value]]);

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {View} view
   */
  function draw(context, panel, view) {
    const found = curves(view.replay);
    if (!found) return;
    const { theme } = panel;
    const { upper, lower, duration } = found;
    const since = Math.max(upper[0][0], lower[0][0]);
    const spots = (steps) => corners(steps, duration).map((corner) => panel.at(corner));
    // The true length lies between the curves.
    context.beginPath();
    const edge = (steps) => corners(steps, duration).map(([at, value]) => panel.at([Math.max(at, since), value]));
    for (const [k, spot] of [...edge(upper), ...edge(lower).reverse()].entries()) if (k) context.lineTo(spot[0], spot[1]); else context.moveTo(spot[0], spot[1]);
    context.closePath();
    context.fillStyle = theme.faint;
    context.fill();
    for (const [steps, color, dash] of [[upper, theme.ink, []], [lower, theme.accent, [7, 4]]]) {
      [context.lineWidth, context.strokeStyle] = [2.2, color];
      context.setLineDash(dash);
      line(context, spots(steps));
    }
    context.setLineDash([]);
    for (const steps of [upper, lower]) Labels.blockLine(panel, spots(steps));
    const [top, bottom] = [upper[0], lower[lower.length - 1]].map((corner) => panel.at(corner));
    Labels.beside(context, panel, [
      ['best path', { rect: { x: top[0] + 8, y: top[1] - 2, width: 60, height: 4 } }],
      ['no motion is shorter', { rect: { x: bottom[0] + 8, y: bottom[1] - 2, width: 60, height: 4 } }],
    ]);
  }

  /**
   * Creates the curves of a view.
   * @param {View} view
   * @returns {{ root: HTMLElement, panel: Panel, fit: () => void, show: () => void, follow: () => void }}
   */
  function mount(view) {
    const canvas = element('canvas', { role: 'img', 'aria-label': 'Length of the best path and lower bound during the search' });
    const caption = element('figcaption', {}, 'The proof closes');
    const now = element('p', { class: 'lengths' });
    const root = element('figure', { class: 'closing', hidden: true }, caption, canvas, now);
    const panel = new Panel(canvas, {
      x: [0, 1],
      y: [0, 1],
      titles: ['replay (s)', 'length'],
      margins: [58, 12, 6, 40],
      still: (context, panel) => draw(context, panel, view),
      moving: (context, panel) => Timeline.cursor(context, panel, view),
    });
    Timeline.scrub(canvas, panel, view);

    /** Shows the curves of the current replay. */
    function fit() {
      const found = view.model && curves(view.replay);
      root.hidden = !found || view.drawn !== 'think';
      if (!found || root.hidden) return;
      const values = [...found.upper, ...found.lower].map(([, value]) => value);
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = ROOM * (high - low || 1);
      [panel.x, panel.y] = [[0, found.duration], [low - room, high + room]];
      const [upper, lower] = [found.upper, found.lower].map((steps) => steps[steps.length - 1][1]);
      canvas.setAttribute('aria-label', `The length of the best path falls to ${upper.toFixed(4)}, the lower bound rises from ${Numbers.below(found.lower[0][1])} to ${Numbers.below(lower)} ${found.unit}: at most ${Numbers.percent(upper / lower - 1, Math.ceil)} apart`);
      panel.titles = ['replay (s)', `length (${found.unit})`];
      panel.layout();
      panel.dirty = true;
      follow();
    }

    /** States both lengths at the current time. */
    function follow() {
      if (root.hidden) return;
      const found = curves(view.replay);
      if (!found) return;
      const [upper, lower] = [found.upper, found.lower].map((steps) => valueAt(steps, view.time));
      const gap = upper !== undefined && lower !== undefined ? `; at most ${Numbers.percent(upper / lower - 1, Math.ceil)} apart` : '';
      const of = (value, text) => (value === undefined ? null : `${text} ${found.unit}`);
      now.textContent = `best path ${of(upper, upper?.toFixed(4)) ?? 'not found yet'}, lower bound ${of(lower, Numbers.below(lower)) ?? 'not proven yet'}${gap}`;
    }

    return { root, panel, fit, show: fit, follow };
  }

  return { mount, curves, valueAt };
})();

// What panels with a time axis share: their values over time, the mark of the current time, and scrubbing.
'use strict';

const Timeline = (() => {
  /**
   * Returns the value of a chain of times and values at a time. Between its points the value is linear.
   * @param {Chain} chain
   * @param {number} time in seconds
   * @returns {number}
   */
  function valueAt(chain, time) {
    let next = 2;
    while (next + 2 < chain.length && chain[next] < time) next += 2;
    const [from, low, to, high] = chain.slice(next - 2, next + 2);
    return low + (high - low) * Math.min(1, Math.max(0, (time - from) / Math.max(to - from, 1e-9)));
  }

  /**
   * Draws the current time as a line.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {View} view
   */
  function cursor(context, panel, view) {
    const { rect, theme } = panel;
    const [x] = panel.at([view.time, 0]);
    [context.lineWidth, context.strokeStyle] = [1.5, theme.accent];
    line(context, [[x, rect.y], [x, rect.y + rect.height]]);
  }

  /**
   * Draws the current time, and a dot at the value of a chain.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {View} view
   * @param {Chain} chain
   */
  function dot(context, panel, view, chain) {
    const { theme } = panel;
    cursor(context, panel, view);
    const [x, y] = panel.at([view.time, valueAt(chain, view.time)]);
    context.beginPath();
    context.arc(x, y, 5, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [theme.accent, theme.paper, 1.5];
    context.fill();
    context.stroke();
  }

  /**
   * Lets the pointer move the current time along a panel.
   * @param {HTMLCanvasElement} canvas
   * @param {Panel} panel
   * @param {View} view
   */
  function scrub(canvas, panel, view) {
    const seek = (event) => event.buttons && view.seek(panel.value(panel.spot(event))[0]);
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener('pointermove', seek);
  }

  return { valueAt, cursor, dot, scrub };
})();

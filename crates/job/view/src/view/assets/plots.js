// Position, velocity, acceleration and, if known, torque of both joints over time.
'use strict';

const Plots = (() => {
  const QUANTITIES = [
    { key: 'position', title: 'position', per: '' },
    { key: 'velocity', title: 'velocity', per: '/s' },
    { key: 'acceleration', title: 'acceleration', per: '/s\u00b2' },
    { key: 'torque', title: 'torque', units: { rad: 'N m', m: 'N' } },
  ];
  const DASHES = [[], [6, 4]];

  /** Returns the range of one joint's values, including its limits if there are any. */
  function span(model, key) {
    let [low, high] = [0, 0];
    const values = model.clock[key];
    for (let i = 0; i < values.length; i += 1) [low, high] = [Math.min(low, values[i]), Math.max(high, values[i])];
    const room = 0.08 * (high - low || 1);
    return [low - room, high + room];
  }

  function draw(context, panel, view, { key }) {
    const { clock } = view.model;
    const colors = view.jointColors();
    [0, 1].forEach((joint) => {
      const limit = view.model.arm.joints[joint][key];
      context.strokeStyle = colors[joint];
      if (limit !== undefined) {
        context.globalAlpha = 0.45;
        context.lineWidth = 1;
        context.setLineDash([2, 4]);
        for (const value of [limit, -limit]) {
          const [, y] = panel.at([0, value]);
          line(context, [[panel.rect.x, y], [panel.rect.x + panel.rect.width, y]]);
        }
        context.globalAlpha = 1;
      }
      context.setLineDash(DASHES[joint]);
      context.lineWidth = 1.8;
      context.beginPath();
      // Accelerations jump; each value holds until the next sample.
      let before = null;
      let last = -Infinity;
      for (let k = 0; k < clock.time.length; k += 1) {
        const spot = panel.at([clock.time[k], clock[key][2 * k + joint]]);
        if (before && spot[0] - last < 0.3 && Math.abs(spot[1] - before[1]) < 0.3 && k + 1 < clock.time.length) continue;
        if (before && key !== 'position' && key !== 'velocity') context.lineTo(spot[0], before[1]);
        if (before) context.lineTo(...spot);
        else context.moveTo(...spot);
        [before, last] = [spot, spot[0]];
      }
      context.stroke();
      context.setLineDash([]);
    });
  }

  /** Creates one panel per quantity. */
  function mount(element, view) {
    const key = document.createElement('p');
    key.className = 'key';
    element.append(key);
    return QUANTITIES.map((quantity) => {
      const canvas = document.createElement('canvas');
      canvas.setAttribute('role', 'img');
      canvas.setAttribute('aria-label', `${quantity.title} of both joints over time`);
      element.append(canvas);
      const panel = new Panel(canvas, {
        x: [0, 1],
        y: [-1, 1],
        titles: ['time (s)', quantity.title],
        margins: [58, 10, 6, 38],
        still: (context, panel) => shows(view, quantity) && draw(context, panel, view, quantity),
        moving: (context, panel) => shows(view, quantity) && Timeline.cursor(context, panel, view),
      });
      Timeline.scrub(canvas, panel, view);
      return {
        panel,
        fit: () => {
          canvas.style.display = shows(view, quantity) ? '' : 'none';
          fit(panel, view, quantity, key);
        },
      };
    });
  }

  /** Returns true if the view has values of this quantity. */
  function shows(view, { key }) {
    return Boolean(view.model.clock && view.model.clock[key]);
  }

  function fit(panel, view, quantity, legend) {
    const { key, title, per, units: of } = quantity;
    const { clock, arm } = view.model;
    if (!shows(view, quantity)) return;
    const [first, second] = arm.joints.map((joint) => joint.name);
    legend.textContent = `solid: ${first}, dashed: ${second}, dotted: limits`;
    const turns = !of && arm.joints.every((joint) => joint.unit === 'rad');
    const units = turns ? `\u00b0${per}` : [...new Set(arm.joints.map((joint) => (of ? of[joint.unit] : joint.unit + per)))].join(', ');
    // Angles in degrees; the data of the page are in radians.
    panel.degrees = [false, turns && 'plain'];
    panel.titles = ['time (s)', `${title} (${units})`];
    panel.x = [0, Math.max(clock.time[clock.time.length - 1], 1e-6)];
    panel.y = span(view.model, key);
    panel.layout();
    panel.dirty = true;
  }

  return { mount };
})();

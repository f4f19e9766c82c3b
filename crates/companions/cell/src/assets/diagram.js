// The diagram of a cell: how far each arm is on its path, and where both would be too near to each other.

const CellDiagram = (() => {
  /** Number of places of the schedule that are drawn. */
  const PLACES = 400;
  /** Share of the duration above which waits have names. */
  const NAMED_WAIT = 0.02;
  /** Radius of a signal's disc, in pixels. */
  const DISC = 9;

  /**
   * Returns the outline of rectangles, in pixels.
   * @param {Panel} panel
   * @param {Chain} corners
   */
  function outline(panel, corners) {
    const path = new Path2D();
    for (let i = 0; i < corners.length; i += 4) {
      const [[left, bottom], [right, top]] = [panel.at([corners[i], corners[i + 1]]), panel.at([corners[i + 2], corners[i + 3]])];
      path.rect(left, top, right - left, bottom - top);
    }
    return path;
  }

  /** Returns the places of both arms while the first clock is ahead by `shift` seconds, in pixels. */
  function schedule(view, panel, shift) {
    const { duration } = view;
    return Array.from({ length: PLACES + 1 }, (_, k) => {
      const time = (duration * k) / PLACES;
      return panel.at([view.moved(0, Math.max(0, time + shift)), view.moved(1, time)]);
    });
  }

  /**
   * Draws the regions, the schedule and the signals.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {CellView} view
   */
  function still(context, panel, view) {
    const { theme } = panel;
    const { arms, motions, skew, paleness } = view.cell;
    const outlines = motions.regions.map((corners) => outline(panel, corners));
    outlines.forEach((path, first) => {
      context.fillStyle = arms[first] ? Theme.mixed(theme[arms[first].color], theme.paper, paleness) : theme.undecided;
      context.fill(path);
    });
    const route = schedule(view, panel, 0);
    [context.strokeStyle, context.lineWidth] = [theme.ink, 1];
    context.setLineDash([4, 3]);
    if (motions.certified && skew > 0) for (const shift of [-skew, skew]) line(context, schedule(view, panel, shift));
    context.setLineDash([]);
    const look = { width: motions.certified ? 2.4 : 1.4, dash: motions.certified ? [] : [6, 4] };
    pathLine(context, theme, look, () => line(context, route));
    Labels.blockLine(panel, route);
    const spots = [];
    for (const signal of motions.signals) {
      const times = [signal.at, signal.at];
      times[1 - signal.waits] = signal.set;
      const spot = panel.at(times.map((time, arm) => view.moved(arm, time)));
      // Discs at one place stand side by side.
      while (spots.some(([x, y]) => Math.hypot(x - spot[0], y - spot[1]) < 2 * DISC + 2)) spot[0] += 1;
      spots.push(spot);
    }
    motions.signals.forEach(({ waits }, k) => {
      dot(context, spots[k], DISC, theme[arms[waits].color], theme.paper);
      Labels.blockSpot(panel, spots[k], DISC);
      [context.font, context.fillStyle, context.textAlign, context.textBaseline] = [theme.font(600, 0.9), theme.paper, 'center', 'middle'];
      context.fillText(String(k + 1), spots[k][0], spots[k][1] + 0.5);
    });
    const text = (first) => (arms[first] ? `${arms[first].name} first` : 'too near');
    const named = outlines.map((path, first) => ({ text: text(first), paint: (painter) => painter.fill(path) }));
    const { duration } = view;
    const waits = arms.flatMap(({ name, color, waits: spans }) => spans.flatMap((times) => {
      const ends = times.map((time) => panel.at([0, 1].map((arm) => view.moved(arm, time))));
      [context.strokeStyle, context.lineWidth] = [theme[color], 5];
      line(context, ends);
      const isNamed = times[1] - times[0] >= NAMED_WAIT * duration;
      return isNamed ? [[`${name} waits`, { rect: Labels.about(ends[0].map((x, k) => (x + ends[1][k]) / 2), 3) }]] : [];
    }));
    Labels.beside(context, panel, [['start', Labels.spotted(route[0], 7)], ['goals', Labels.spotted(route[PLACES], 7)], ...waits]);
    Labels.onRegions(context, panel, named);
  }

  /** Draws a disc with an edge. @param {CanvasRenderingContext2D} context @param {Point} spot */
  function dot(context, spot, radius, fill, edge) {
    const [x, y] = spot;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    [context.fillStyle, context.strokeStyle, context.lineWidth] = [fill, edge, 1.8];
    context.fill();
    context.stroke();
  }

  /**
   * Draws the current place on the schedule with lines to both axes, and the examined place.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {CellView} view
   */
  function moving(context, panel, view) {
    const { rect, theme } = panel;
    const at = panel.at(view.probe?.q ?? view.q);
    [context.strokeStyle, context.lineWidth] = [theme.grey, 1];
    line(context, [[rect.x, at[1]], at, [at[0], rect.y + rect.height]]);
    const color = view.isTooNear ? theme.infeasible : theme.ink;
    dot(context, panel.at(view.q), 6.5, view.probe ? theme.grey : color, theme.paper);
    if (view.probe) dot(context, at, 6.5, color, theme.paper);
  }

  return { still, moving };
})();

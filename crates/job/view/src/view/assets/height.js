// The strips below the pictures of a task: the value of the joint that lowers the tool, and the angle by which the wrist turns
// the carried object, or the angle of the tool along lines, against time.
'use strict';

const Height = (() => {
  /** Room above and below the line, as a share of the stroke. */
  const ROOM = 0.15;

  /**
   * What the strips show: the member of the model, the unit, and words for the caption and for screen readers.
   * @type {Record<'height' | 'turns' | 'tool', { unit: string, title: string, caption: (strip: { joint?: string, is_empty?: boolean }) => string }>}
   */
  const KINDS = {
    height: { unit: 'mm', title: 'Height of the tool', caption: ({ joint }) => `Height of the tool: joint \u201c${joint}\u201d` },
    turns: {
      unit: '\u00b0',
      title: 'Turns of the wrist',
      caption: ({ is_empty }) =>
        (is_empty ? 'Angle of the wrist' : 'Angle by which the wrist has turned the object'),
    },
    tool: { unit: '\u00b0', title: 'Angle of the tool', caption: () => 'Angle of the tool from the x axis' },
  };

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {{ motion: Chain, lines?: Chain[] }} strip
   */
  function draw(context, panel, { motion, lines }) {
    [context.lineWidth, context.strokeStyle] = [2, panel.theme.ink];
    for (const chain of lines ?? [motion]) line(context, [...Geometry.pointsOf(chain)].map((point) => panel.at(point)));
  }

  /**
   * Returns the chain that has a value at a time.
   * @param {Chain[] | undefined} chains
   * @param {number} time
   */
  const chainAt = (chains, time) => chains?.find((chain) => chain[0] <= time && time <= chain[chain.length - 2]);

  /**
   * Draws the current time, and the value at it if there is one.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {View} view
   * @param {{ motion: Chain, lines?: Chain[] }} strip
   */
  function drawTime(context, panel, view, { motion, lines }) {
    const chain = lines ? chainAt(lines, view.time) : motion;
    if (chain) Timeline.dot(context, panel, view, chain);
    else Timeline.cursor(context, panel, view);
  }

  /**
   * Creates a strip of a view.
   * @param {View} view
   * @param {'height' | 'turns' | 'tool'} kind
   * @returns {{ root: HTMLElement, panel: Panel, fit: () => void, show: () => void }}
   */
  function mount(view, kind) {
    const { unit, title, caption: words } = KINDS[kind];
    const canvas = element('canvas', { role: 'img', 'aria-label': `${title} against time` });
    const caption = element('figcaption', {}, title);
    const root = element('figure', { class: `height ${kind}`, hidden: true }, caption, canvas);
    const panel = new Panel(canvas, {
      x: [0, 1],
      y: [-1, 0],
      titles: ['time (s)', unit],
      margins: [58, 12, 6, 40],
      still: (context, panel) => view.model[kind] && draw(context, panel, view.model[kind]),
      moving: (context, panel) => view.model[kind] && drawTime(context, panel, view, view.model[kind]),
    });
    Timeline.scrub(canvas, panel, view);

    /** Shows the strip of the current model. */
    function fit() {
      const strip = view.model[kind];
      show();
      if (!strip) return;
      const values = strip.motion.filter((_, index) => index % 2 === 1);
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = ROOM * (high - low || 1);
      [panel.x, panel.y] = [[0, Math.max(strip.duration, 1e-6)], [low - room, high + room]];
      caption.textContent = words(strip);
      const of = strip.joint ? `, joint ${strip.joint}` : ',';
      canvas.setAttribute('aria-label', `${title} against time${of} from ${low} to ${high} ${unit}`);
      panel.layout();
      panel.dirty = true;
    }

    /** Hides the strip unless the motion is played, and if the side view shows the height. */
    function show() {
      root.hidden = !view.model[kind] || view.mode !== 'move' || (kind === 'height' && view.sideView.isOffered);
    }

    return { root, panel, fit, show };
  }

  /**
   * Returns the orientation that the carried object has because of a turn, radians. Undefined if it has that of its world.
   * @param {View} view
   */
  function turnedTo({ model, mode, time }) {
    if (mode !== 'move') return undefined;
    const turn = chainAt(model.turns?.turns, time);
    return turn && Timeline.valueAt(turn, time);
  }

  /**
   * Returns the angle of the tool from the x axis, radians. Undefined outside lines along which it has one.
   * @param {View} view
   */
  function toolAngle({ model, mode, time }) {
    const chain = mode === 'move' ? chainAt(model.tool?.lines, time) : undefined;
    return chain && (Timeline.valueAt(chain, time) * Math.PI) / 180;
  }

  return { mount, turnedTo, toolAngle };
})();

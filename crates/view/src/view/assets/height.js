// The strip below the pictures of a task whose tool is lowered and raised: the value of the tool's joint against time.
'use strict';

const Height = (() => {
  /** Room above and below the line, as a share of the stroke. */
  const ROOM = 0.15;

  /**
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   * @param {HeightModel} height
   */
  function draw(context, panel, { motion }) {
    [context.lineWidth, context.strokeStyle] = [2, panel.theme.ink];
    line(context, [...Geometry.pointsOf(motion)].map((point) => panel.at(point)));
  }

  /**
   * Creates the strip of a view.
   * @param {View} view
   * @returns {{ root: HTMLElement, panel: Panel, fit: () => void, show: () => void }}
   */
  function mount(view) {
    const canvas = element('canvas', { role: 'img', 'aria-label': 'Height of the tool against time' });
    const caption = element('figcaption', {}, 'Height of the tool');
    const root = element('figure', { class: 'height', hidden: true }, caption, canvas);
    const panel = new Panel(canvas, {
      x: [0, 1],
      y: [-1, 0],
      titles: ['time (s)', 'mm'],
      margins: [58, 12, 6, 40],
      still: (context, panel) => view.model.height && draw(context, panel, view.model.height),
      moving: (context, panel) => view.model.height && Timeline.dot(context, panel, view, view.model.height.motion),
    });
    Timeline.scrub(canvas, panel, view);

    /** Shows the strip of the current model. */
    function fit() {
      const { height } = view.model;
      show();
      if (!height) return;
      const values = height.motion.filter((_, index) => index % 2 === 1);
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = ROOM * (high - low || 1);
      [panel.x, panel.y] = [[0, Math.max(height.duration, 1e-6)], [low - room, high + room]];
      caption.textContent = `Height of the tool: joint \u201c${height.joint}\u201d`;
      canvas.setAttribute('aria-label', `Height of the tool against time, joint ${height.joint} from ${low} to ${high} mm`);
      panel.layout();
      panel.dirty = true;
    }

    /** Hides the strip unless the motion is played. */
    function show() {
      root.hidden = !view.model.height || view.mode !== 'move';
    }

    return { root, panel, fit, show };
  }

  return { mount };
})();

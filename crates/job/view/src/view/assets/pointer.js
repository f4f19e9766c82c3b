// The pointer in a panel: taking the arm by its tip or its dot, dragging a magnified picture, pointing at things.
'use strict';

/** A finger that moves less than this has tapped, in pixels. */
const TAP = 10;
/** A larger movement of a mouse drags, in pixels. */
const DRAG = 4;

class Pointer {
  /**
   * @param {View} view
   * @param {Panel} panel the workspace or the configuration space of the view
   */
  constructor(view, panel) {
    this.view = view;
    this.panel = panel;
    this.isCSpace = panel === view.panels.cspace;
    /** True while the view's tool has the pointer. */
    this.isTaken = false;
    /**
     * Spot where the pointer was pressed, whether it took the arm there, the last spot of a drag, and the distance
     * from the pointer to the arm's tip.
     * @type {?{ from: Point, last: Point, holds: boolean, drags: boolean, grip?: Point }}
     */
    this.press = null;
    const { canvas } = panel;
    canvas.addEventListener('pointerdown', (event) => this.down(event));
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.up(event));
    canvas.addEventListener('pointercancel', (event) => {
      [this.press, this.isTaken] = [null, false];
      this.asTool('up', event);
    });
    canvas.addEventListener('pointerleave', () => {
      if (this.isCSpace && !view.pinned) view.examine(null);
      if (!this.isCSpace) this.hover(null);
    });
    this.pinches = Zoom.pinch(panel, (touch) => Boolean(this.asTool('grasps', touch)) || this.isAtArm(touch), () => this.pinch());
    Zoom.listen(panel, (event) => Boolean(this.asTool('grasps', event)));
  }

  /** Calls the view's tool, if it has a handler of this name. */
  asTool(name, event) {
    return this.view.tool?.[name]?.(this.panel, this.panel.value(this.panel.spot(event)), event);
  }

  /** Returns true if a pointer takes the arm: by its dot in the configuration space, or by its tip in the workspace. */
  isAtArm(event) {
    const spot = this.panel.spot(event);
    return this.isCSpace ? this.view.isAtDot(spot, event) : this.view.isAtTip(spot, event);
  }

  /** Begins a pinch, unless the tool has the first finger. */
  pinch() {
    if (!this.isTaken) this.press = null;
    return !this.isTaken;
  }

  down(event) {
    const { view, panel } = this;
    this.press = null;
    this.isTaken = Boolean(this.asTool('down', event));
    if (this.isTaken) {
      panel.canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
    } else if (event.button === 0) {
      const spot = panel.spot(event);
      const holds = view.drawn !== 'slice' && this.isAtArm(event);
      this.press = { from: spot, last: spot, holds, drags: false };
      if (!this.isCSpace && holds) {
        view.pause();
        const tip = view.tipSpot;
        this.press.grip = [tip[0] - spot[0], tip[1] - spot[1]];
      }
      if (holds || (panel.times > 1 && event.pointerType === 'mouse')) panel.canvas.setPointerCapture(event.pointerId);
    }
  }

  move(event) {
    const { view, panel, press, isCSpace } = this;
    if (this.asTool('move', event) || this.pinches()) return;
    const spot = panel.spot(event);
    const isMouse = event.pointerType === 'mouse';
    const drags = press && (press.holds ? !isCSpace || isMouse : panel.times > 1);
    if (drags) {
      press.drags ||= Math.hypot(spot[0] - press.from[0], spot[1] - press.from[1]) > DRAG;
      if (press.drags) this.drag(spot);
      return;
    }
    if (!isCSpace && isMouse && view.isAtTip(spot, event)) panel.canvas.style.cursor = 'grab';
    else if (!isCSpace && !view.tool) panel.canvas.style.cursor = '';
    if (!panel.contains(spot)) return;
    if (!isCSpace) this.hover(event);
    else if (isMouse ? !view.pinned : press?.holds) view.examine(panel.value(spot));
  }

  /** Moves what the pointer has taken: the arm's tip, its dot, or the magnified picture. */
  drag(spot) {
    const { view, panel, press } = this;
    if (press.grip) view.dragTip(panel.value([spot[0] + press.grip[0], spot[1] + press.grip[1]]));
    else if (press.holds) view.place(panel.value(spot));
    else {
      panel.move(spot[0] - press.last[0], spot[1] - press.last[1]);
      press.last = spot;
    }
  }

  up(event) {
    const { view, panel, press } = this;
    this.isTaken = false;
    if (this.asTool('up', event) || !press) return;
    const spot = panel.spot(event);
    this.press = null;
    if (press.drags || Math.hypot(spot[0] - press.from[0], spot[1] - press.from[1]) >= TAP) return;
    const isMouse = event.pointerType === 'mouse';
    if (!isMouse) view.tool?.tap(panel);
    if (!this.isCSpace || !panel.contains(spot)) return;
    view.pinned = isMouse ? !view.pinned : !press.holds;
    view.examine(press.holds && !isMouse ? null : panel.value(spot));
  }

  /** Shows the name of the obstacle under the pointer, if obstacles have numbers or no label. */
  hover(event) {
    const { view, panel } = this;
    const index = event && !view.named ? Workspace.found(view, panel.value(panel.spot(event))) : null;
    if (index === null && !view.hovered) return;
    const [x, y] = event ? panel.spot(event) : [0, 0];
    view.hovered = index === null ? null : [`${index + 1} ${view.world.obstacles[index].name}`, x, y - 14];
    panel.draw();
  }
}

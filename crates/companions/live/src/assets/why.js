// Why there is no path: the page asks for an explanation, shows a card for each change that opens a path, and applies it.
'use strict';

class Why {
  /** @param {Live} live the page */
  constructor(live) {
    this.live = live;
    /** Number of the state that the visible explanation is about; `null` without one. */
    this.edition = null;
    this.button = element('button', { type: 'button', class: 'button why', onclick: () => this.ask() }, 'Why?');
    live.view.explain.apply = (card) => this.apply(card);
  }

  /**
   * Returns true if an explanation can be asked for: the current answer is that there is no path, or that start or goal
   * is not possible.
   * @returns {boolean}
   */
  get isOffered() {
    const { live } = this;
    if (!live.isCurrent || live.world.has_steps || live.view.model.worlds[0].movers?.length || this.edition === live.edition) return false;
    return live.shown.error ? ['start', 'goal'].includes(live.refused) : live.shown.ending === 'infeasible';
  }

  /**
   * Shows the button if there is something to ask for, and removes cards about another state.
   * @returns {void}
   */
  update() {
    const { view, edition } = this.live;
    if (this.edition !== null && this.edition !== edition) {
      this.edition = null;
      view.explain.clear();
    }
    this.button.hidden = !this.isOffered;
    this.button.disabled = this.live.link.awaited?.kind === 'explain';
  }

  /**
   * Asks for an explanation of the current state.
   * @returns {void}
   */
  ask() {
    const { live } = this;
    live.link.explain(live.body, live.about);
    live.updateState();
  }

  /**
   * Shows an explanation, unless the state has changed since.
   * @param {{ id: number, explanation: object }} message
   * @param {{ edition: number }} about
   * @returns {void}
   */
  receive({ id, explanation }, { edition }) {
    const { live } = this;
    live.answered = { ...live.answered, id };
    if (edition !== live.edition) return;
    const { view } = live;
    this.edition = edition;
    view.update({ ...view.model, explanation, stuck: explanation.stuck });
    live.spoken.textContent = `${explanation.headline} ${explanation.evidence}`;
    view.explain.root.scrollIntoView({ block: 'nearest', behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
    // The button that was pressed is gone.
    view.explain.buttons[0]?.focus({ preventScroll: true });
  }

  /**
   * Applies the change of a card to the world. It can be undone like any other edit.
   * @param {Card} card
   * @returns {void}
   */
  apply({ edit: { obstacle, removal, clearance, limits } }) {
    const { live } = this;
    const { scene, editor } = live;
    editor.select(null);
    if (obstacle) scene.obstacles[obstacle.number].shape = obstacle.shape;
    if (removal !== undefined) scene.obstacles.splice(removal, 1);
    if (clearance !== undefined) scene.clearance = clearance;
    if (limits) scene.limits = { ...scene.limits, [live.world.joints[limits.joint].name]: limits.range };
    live.controls.showClearance(scene);
    live.changed(true);
    live.view.panels.workspace.canvas.focus({ preventScroll: true });
  }
}

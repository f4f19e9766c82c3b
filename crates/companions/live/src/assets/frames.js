// Work for the next picture of the screen, so that each panel is drawn once per picture, however often pointer and
// program report something.
'use strict';

class Frames {
  constructor() {
    /** Steps of the next picture by name, in this order; a newer step replaces an older one of the same name. */
    this.steps = new Map();
    this.panels = new Set();
  }

  /** Runs a step with the next picture. */
  request(name, step) {
    this.steps.set(name, step);
    this.schedule();
  }

  /** Draws panels with the next picture, after its steps. */
  draw(...panels) {
    for (const panel of panels) this.panels.add(panel);
    this.schedule();
  }

  /** Runs a requested step at once. Returns false if there is none. */
  flush(name) {
    const step = this.steps.get(name);
    this.steps.delete(name);
    step?.();
    return Boolean(step);
  }

  /** Drops a requested step. */
  drop(name) {
    this.steps.delete(name);
  }

  schedule() {
    if (this.isScheduled) return;
    this.isScheduled = true;
    requestAnimationFrame(() => {
      for (const name of [...this.steps.keys()]) this.flush(name);
      const panels = [...this.panels];
      this.panels.clear();
      this.isScheduled = false;
      if (this.steps.size) this.schedule();
      for (const panel of panels) panel.draw();
    });
  }
}

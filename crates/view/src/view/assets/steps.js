// The steps of a task: a list that follows the motion.
'use strict';

class Steps {
  constructor(view) {
    this.view = view;
    this.list = element('ol', { class: 'steps' });
    this.timeline = element('div', { class: 'timeline', hidden: true });
    this.root = element('section', { class: 'box', 'aria-label': 'Steps', hidden: true }, element('h2', {}, 'Steps'), this.list);
    /** Buttons in the order of the motions. */
    this.buttons = [];
    this.current = -1;
  }

  /** Lists the steps of a model as buttons. */
  update({ motions }) {
    const isTask = motions.length > 1;
    this.root.hidden = !isTask;
    this.current = -1;
    this.buttons = (isTask ? motions : []).map((motion) => element(
      'button', { type: 'button', onclick: () => this.view.go(motion) },
      element('span', {}, motion.label), element('span', { class: 'at' }, Numbers.seconds(motion.from)),
    ));
    this.list.replaceChildren(...this.buttons.map((button) => element('li', {}, button)));
  }

  /** Marks the current step, and scrolls to it within the list. */
  follow(current) {
    const { view, buttons } = this;
    buttons.forEach((button, k) => {
      button.setAttribute('aria-current', k === current ? 'step' : 'false');
      button.disabled = view.mode === 'think' && !view.hasReplay(view.model.motions[k]);
    });
    if (current === this.current) return;
    this.current = current;
    const button = buttons[current];
    if (!button) return;
    // `scrollIntoView` would also scroll the page.
    const { list } = this;
    const top = button.getBoundingClientRect().top - list.getBoundingClientRect().top + list.scrollTop;
    list.scrollTo({ top: top - (list.clientHeight - button.offsetHeight) / 2, behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
  }
}

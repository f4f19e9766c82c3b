// The steps of a task: a list by objects that follows the motion, and a timeline with a block for each object.
'use strict';

class Steps {
  constructor(view) {
    this.view = view;
    this.list = element('ol', { class: 'steps' });
    /** A picture for users of a pointer; the list has the same content. */
    this.timeline = element('div', { class: 'timeline', 'aria-hidden': 'true', hidden: true });
    this.root = element('section', { class: 'box', 'aria-label': 'Steps', hidden: true }, element('h2', {}, 'Steps'), this.list);
    /** Buttons and blocks in the order of the motions. */
    this.buttons = [];
    this.blocks = [];
    this.current = -1;
  }

  /**
   * Returns the motions by the objects that they are about, in order: { object, color, motions }. A motion without a
   * payload belongs to the object that the next one carries.
   */
  static groups({ motions, worlds }) {
    const groups = [];
    motions.forEach((motion, k) => {
      const held = worlds[motion.world].payload ?? worlds[motions[k + 1]?.world]?.payload;
      const last = groups[groups.length - 1];
      const isPick = !worlds[motion.world].payload;
      if (last && last.object === held?.object && !isPick) last.motions.push(motion);
      else groups.push({ object: held?.object, color: held?.color, motions: [motion] });
    });
    return groups;
  }

  /** Lists the steps of a model. */
  update(model) {
    const { motions } = model;
    const isTask = motions.length > 1;
    this.root.hidden = this.timeline.hidden = !isTask;
    this.current = -1;
    this.buttons = [];
    this.blocks = [];
    const groups = isTask ? Steps.groups(model) : [];
    this.list.replaceChildren(...groups.map((group) => this.group(group)));
    this.timeline.replaceChildren(...this.blocks);
  }

  /** Creates the part of the list that is about one object. */
  group({ object, color, motions }) {
    const { view } = this;
    const own = motions.map((motion) => {
      const time = element('span', { class: 'at' }, Numbers.seconds(motion.from));
      const button = element('button', { type: 'button', onclick: () => view.go(motion) }, element('span', {}, motion.label), time);
      this.buttons.push(button);
      this.blocks.push(this.block(motion, object));
      return element('li', {}, button);
    });
    if (!object) return element('li', {}, element('ol', {}, ...own));
    const swatch = element('span', { class: 'swatch', style: `background:${color}` });
    return element('li', {}, element('span', { class: 'object' }, swatch, object), element('ol', {}, ...own));
  }

  /** Creates the block of a motion: in the colour of the object that it carries. */
  block(motion, object) {
    const { motions, worlds, clock } = this.view.model;
    const duration = clock ? clock.time[clock.time.length - 1] : 0;
    const end = motions[motions.indexOf(motion) + 1]?.from ?? duration;
    const held = worlds[motion.world].payload;
    const block = element('i', { title: held ? `${motion.label}: ${object}` : motion.label, onclick: () => this.view.go(motion) });
    block.style.setProperty('--from', String(duration ? motion.from / duration : 0));
    block.style.setProperty('--length', String(duration ? Math.max(0, end - motion.from) / duration : 0));
    if (held) block.style.setProperty('--color', held.color);
    return block;
  }

  /** Marks the current step, and scrolls to it within the list. */
  follow(current) {
    const { view, buttons, blocks } = this;
    this.timeline.hidden = !buttons.length || view.drawn !== 'move';
    buttons.forEach((button, k) => {
      button.setAttribute('aria-current', k === current ? 'step' : 'false');
      button.disabled = view.drawn === 'think' && !view.hasReplay(view.model.motions[k]);
    });
    if (current === this.current) return;
    this.current = current;
    blocks.forEach((block, k) => block.classList.toggle('current', k === current));
    const button = buttons[current];
    if (!button) return;
    // `scrollIntoView` would also scroll the page.
    const { list } = this;
    const top = button.getBoundingClientRect().top - list.getBoundingClientRect().top + list.scrollTop;
    // The first row in sight is a whole one: as far up as the current row stays about in the middle.
    const middle = top - (list.clientHeight - button.offsetHeight) / 2;
    const rows = [...list.querySelectorAll('.object, button')].map((row) => row.getBoundingClientRect().top - list.getBoundingClientRect().top + list.scrollTop);
    list.scrollTo({ top: rows.find((at) => at >= middle) ?? middle, behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
  }
}

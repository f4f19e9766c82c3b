// The steps of a task as a chart over time: one row for each object, rounds above them. It is the scrubber of the task.
'use strict';

class Steps {
  /** Least time at rest that is shown as a wait, in seconds. */
  static LEAST_WAIT = 0.1;

  /** @param {View} view */
  constructor(view) {
    this.view = view;
    this.rounds = element('div', { class: 'rounds', 'aria-hidden': 'true', hidden: true });
    this.rows = element('ol', { class: 'rows' });
    this.cursor = element('div', { class: 'cursor', 'aria-hidden': 'true' });
    /** The place of the slider that moves the time. */
    this.head = element('div', { class: 'head' });
    this.root = element('section', { class: 'gantt', 'aria-label': 'Steps', hidden: true }, this.rounds, this.head, this.rows, this.cursor);
    /** Buttons in the order of the motions. */
    this.buttons = [];
    this.current = -1;
    this.rows.addEventListener('pointermove', (event) => event.buttons && this.scrub(event));
    this.rows.addEventListener('pointerdown', (event) => {
      const isBar = /** @type {Element} */ (event.target).closest('button');
      if (!isBar) this.scrub(event);
    });
  }

  /** Moves the time to the place of a pointer. */
  scrub({ clientX }) {
    const lane = this.rows.querySelector('.lane').getBoundingClientRect();
    const { view } = this;
    if (view.drawn === 'move' && clientX >= lane.left) view.seek(((clientX - lane.left) / lane.width) * view.duration);
  }

  /** Returns the index of the object that each motion is about: the one that it carries, or that the next motion carries. */
  static objects({ motions, worlds }) {
    return motions.map((motion, k) => worlds[motion.world].payload ?? worlds[motions[k + 1]?.world]?.payload ?? null);
  }

  /** Returns the spans of time within a motion in which the arm and its tool rest: [from, to] in seconds. */
  static waits({ clock, height, strip }, from, to) {
    const spans = [];
    let since = null;
    const isStill = (k) => [0, 1].every((joint) => clock.velocity[2 * k + joint] === 0 && clock.position[2 * k + joint] === clock.position[2 * k + 2 + joint]);
    const isLevel = (a, b) => !height || Math.abs(Timeline.valueAt(height.motion, a) - Timeline.valueAt(height.motion, b)) < 1e-3;
    for (let k = 0; k + 1 < clock.time.length; k += 1) {
      const [a, b] = [Math.max(clock.time[k], from), Math.min(clock.time[k + 1], to)];
      const rests = b > a && isStill(k) && isLevel(a, b);
      if (rests) since ??= a;
      if (since !== null && (!rests || k + 2 === clock.time.length)) {
        spans.push([since, rests ? b : a]);
        since = null;
      }
    }
    const named = (strip?.waits ?? []).filter((wait) => wait.from < to && wait.to > from).map((wait) => [Math.max(wait.from, from), Math.min(wait.to, to)]);
    return [...named, ...spans.filter(([a, b]) => b - a >= Steps.LEAST_WAIT)];
  }

  /** Shows the steps of a model. */
  update(model) {
    const { view } = this;
    const { motions, clock } = model;
    const isTask = motions.length > 1 && Boolean(clock);
    this.root.hidden = !isTask;
    this.current = -1;
    this.buttons = [];
    // The slider of the time is above the rows.
    (isTask ? this.head : view.parts.track)?.append(view.parts.slider);
    view.root.classList.toggle('task', isTask);
    if (!isTask) {
      this.rows.replaceChildren();
      return;
    }
    const duration = clock.time[clock.time.length - 1];
    const place = (item, from, to) => {
      item.style.setProperty('--from', String(duration ? from / duration : 0));
      item.style.setProperty('--length', String(duration ? Math.max(0, to - from) / duration : 0));
      return item;
    };
    const objects = Steps.objects(model);
    const names = [...new Set(objects.map((object) => object?.object ?? ''))];
    const lanes = new Map(names.map((name) => [name, element('ol', { class: 'lane' })]));
    motions.forEach((motion, k) => {
      const until = motions[k + 1]?.from ?? duration;
      const held = model.worlds[motion.world].payload;
      const title = `${motion.label}, ${Numbers.seconds(motion.from)}`;
      const button = element('button', { type: 'button', class: held ? 'bar held' : 'bar', title, 'aria-label': title, onclick: () => view.go(motion) });
      if (objects[k]) button.style.setProperty('--color', objects[k].color);
      const item = place(element('li', {}, button), motion.from, until);
      for (const [a, b] of Steps.waits(model, motion.from, until)) {
        const mark = element('i', { class: 'wait', title: `waits ${Numbers.seconds(b - a)}` });
        mark.style.setProperty('--from', String((a - motion.from) / (until - motion.from)));
        mark.style.setProperty('--length', String((b - a) / (until - motion.from)));
        button.append(mark);
      }
      this.buttons.push(button);
      lanes.get(objects[k]?.object ?? '').append(item);
    });
    this.rows.replaceChildren(...names.map((name) => {
      const { color } = objects.find((object) => (object?.object ?? '') === name) ?? {};
      const swatch = color ? element('span', { class: 'swatch', style: `background:${color}` }) : null;
      return element('li', { class: 'row' }, element('span', { class: 'object', title: name || 'the arm alone' }, swatch, name || 'arm'), lanes.get(name));
    }));
    const last = Math.max(...motions.map(({ round }) => round ?? 1));
    this.rounds.hidden = last < 2;
    this.rounds.replaceChildren(...Array.from({ length: last > 1 ? last : 0 }, (_, k) => {
      const own = motions.filter(({ round, path }) => (round ?? 1) === k + 1 && path !== null);
      const next = motions.find(({ round, path }) => (round ?? 1) === k + 2 && path !== null);
      return place(element('span', {}, `round ${k + 1} of ${last}`), own[0]?.from ?? 0, next?.from ?? duration);
    }));
  }

  /** Marks the current step and the current time. */
  follow(current) {
    const { view, buttons, rows } = this;
    this.cursor.hidden = view.drawn !== 'move';
    this.cursor.style.setProperty('--at', String(view.duration ? view.time / view.duration : 0));
    buttons.forEach((button, k) => {
      button.setAttribute('aria-current', k === current ? 'step' : 'false');
      button.disabled = view.drawn === 'think' && !view.hasReplay(view.model.motions[k]);
    });
    if (current === this.current) return;
    this.current = current;
    const row = buttons[current]?.closest('.row');
    [...rows.children].forEach((other) => other.classList.toggle('current', other === row));
    // `scrollIntoView` would also scroll the page.
    if (row && rows.scrollHeight > rows.clientHeight) {
      const top = row.getBoundingClientRect().top - rows.getBoundingClientRect().top + rows.scrollTop;
      rows.scrollTo({ top: top - (rows.clientHeight - row.offsetHeight) / 2, behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
    }
  }
}

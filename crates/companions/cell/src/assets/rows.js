// Rows of time below the pictures of a cell: when each arm moves and waits, and a row for each signal. They move the time.

class CellRows {
  /** Length of the axis and distance of its values, in pixels, for a narrow page. */
  static AXIS = 260;
  static SPACING = 52;

  /** @param {CellView} view */
  constructor(view) {
    this.view = view;
    const { arms, motions } = view.cell;
    this.cursor = element('div', { class: 'cursor', 'aria-hidden': 'true' });
    /** Buttons of the steps, each with its span of time. @type {[HTMLElement, [number, number]][]} */
    this.steps = [];
    const lanes = [...arms.map((arm) => this.motionRow(arm)), ...view.cell.handovers.map((handover, k) => this.handoverRow(handover, k + 1)), ...motions.signals.map((signal, k) => this.signalRow(signal, k + 1))];
    this.rows = element('ol', { class: 'rows' }, ...lanes, this.axis());
    this.root = element('section', { class: 'gantt', 'aria-label': 'Motions, steps, waits and signals over time' }, this.rows, this.cursor);
    this.rows.addEventListener('pointerdown', (event) => this.scrub(event));
    this.rows.addEventListener('pointermove', (event) => event.buttons && this.scrub(event));
  }

  /** Moves the time to the place of a pointer. */
  scrub({ clientX }) {
    const lane = this.rows.querySelector('.lane').getBoundingClientRect();
    if (clientX < lane.left) return;
    this.view.pause();
    this.view.seek(((clientX - lane.left) / lane.width) * this.view.duration);
  }

  /**
   * Places an item between two times.
   * @template {HTMLElement} Item
   * @param {Item} item
   * @returns {Item}
   */
  place(item, from, to) {
    const { duration } = this.view.cell.motions;
    item.style.setProperty('--from', String(from / duration));
    item.style.setProperty('--length', String((to - from) / duration));
    return item;
  }

  /**
   * Returns a row with a name on the left.
   * @param {(HTMLElement | string)[]} name
   * @param {...HTMLElement} items
   */
  static row(name, ...items) {
    return element('li', { class: 'row' }, element('span', { class: 'object' }, ...name), element('ol', { class: 'lane' }, ...items));
  }

  /** Returns the row of an arm: its steps, or its motion, and its waits. Steps and waits are buttons that go there. */
  motionRow({ name, color, waits, steps, end }) {
    const swatch = element('span', { class: 'swatch', style: `background:var(--${color})` });
    const bar = element('span', { class: 'bar held', title: `${name} moves until ${Numbers.seconds(end)}`, style: `--color:var(--${color})` });
    const bars = steps.length ? steps.map((step) => this.stepBar(name, color, step, waits)) : [this.place(element('li', {}, bar), 0, end)];
    const stops = waits.map(([from, to]) => {
      const text = `${name} waits from ${CellView.seconds(from)} to ${CellView.seconds(to)}`;
      return this.place(element('button', { type: 'button', class: 'wait', title: text, 'aria-label': text, onclick: () => this.view.seek(from) }), from, to);
    });
    const row = CellRows.row([swatch, name], ...bars, ...stops.map((item) => element('li', { class: 'whole' }, item)));
    row.classList.toggle('steps', steps.length > 0);
    return row;
  }

  /** Returns the bar of a step: outlined before a grasp, filled while an object is carried, with a mark at the grasp or release. */
  stepBar(name, color, step, waits) {
    const { span, number, text, object, event, places } = step;
    const { objects } = this.view.cell;
    const [from, to] = span;
    const share = (time) => String((time - from) / (to - from));
    // The text is in the longest part between the waits.
    const ends = [from, to, ...waits.flat().filter((time) => from < time && time < to)].sort((a, b) => a - b);
    const parts = ends.slice(1).map((end, k) => [ends[k], end]).filter(([a, b]) => !waits.some((wait) => wait[0] <= a && b <= wait[1]));
    const [begin, end] = parts.reduce((best, part) => (part[1] - part[0] > best[1] - best[0] ? part : best));
    const words = element('span', {}, this.view.words(step));
    words.style.setProperty('--from', share(begin));
    words.style.setProperty('--length', String((end - begin) / (to - from)));
    const mark = event === null ? null : element('i');
    mark?.style.setProperty('--from', share(event));
    const title = `${name}, step ${number}: ${text}, from ${CellView.seconds(from)} to ${CellView.seconds(to)}`;
    const bar = element('button', { type: 'button', class: object === null || places ? 'bar held' : 'bar', title, 'aria-label': title, onclick: () => this.view.seek(from) }, words, mark);
    bar.style.setProperty('--color', object === null ? `var(--${color})` : objects[object].color);
    this.steps.push([bar, span]);
    return this.place(element('li', {}, bar), from, to);
  }

  /** Returns the row of a handover: a line from the time at which one arm has placed the object to that at which the other arm takes it. */
  handoverRow({ object, giver, placed, taken }, number) {
    const { arms, objects } = this.view.cell;
    const { name, color } = objects[object];
    const text = `Handover of ${name}: ${arms[giver].name} has placed it at ${CellView.seconds(placed)}, ${arms[1 - giver].name} takes it from ${CellView.seconds(taken)}`;
    return this.link([element('span', { class: 'swatch', style: `background:${color}` }), `handover ${number}`], text, [giver, placed], taken);
  }

  /** Returns the row of a signal: a line from the time at which one arm sets it to that at which the other arm needs it. */
  signalRow({ waits, at, set }, number) {
    const { arms } = this.view.cell;
    const [waiting, setting] = [arms[waits], arms[1 - waits]];
    const text = `Signal ${number}: ${waiting.name} waits at ${CellView.seconds(at)} until ${setting.name} has passed ${CellView.seconds(set)}`;
    return this.link([`signal ${number}`], text, [1 - waits, set], at);
  }

  /** Returns a row with a line between the times of both arms: that of the first one, and that of the other one. Its button goes to the second time. */
  link(name, text, [first, from], to) {
    const { arms } = this.view.cell;
    const style = `--sets:var(--${arms[first].color});--waits:var(--${arms[1 - first].color})`;
    const line = element('button', { type: 'button', class: 'signal', title: text, 'aria-label': text, style, onclick: () => this.view.seek(to) });
    return CellRows.row(name, this.place(element('li', {}, line), from, to));
  }

  /** Returns the row with the values of time. */
  axis() {
    const { duration } = this.view.cell.motions;
    // A value at the end would stick out of the row.
    const marks = ticks(0, duration, false, CellRows.AXIS, CellRows.SPACING).filter(({ value }) => value < 0.95 * duration);
    const row = CellRows.row(['time (s)'], ...marks.map(({ value, text }) => this.place(element('li', {}, text), value, value)));
    row.classList.add('axis');
    row.setAttribute('aria-hidden', 'true');
    return row;
  }

  /** Shows the current time, and marks the current step of each arm. */
  follow() {
    const { time } = this.view;
    for (const [bar, [from, to]] of this.steps) bar.setAttribute('aria-current', from <= time && time < to ? 'step' : 'false');
    this.cursor.style.setProperty('--at', String(this.view.time / this.view.duration));
  }
}

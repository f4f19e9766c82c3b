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
    const lanes = [...arms.map((arm) => this.motionRow(arm)), ...motions.signals.map((signal, k) => this.signalRow(signal, k + 1))];
    this.rows = element('ol', { class: 'rows' }, ...lanes, this.axis());
    this.root = element('section', { class: 'gantt', 'aria-label': 'Motions, waits and signals over time' }, this.rows, this.cursor);
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

  /** Returns the row of an arm: its motion, its waits and the events of its steps. Waits and events are buttons that go there. */
  motionRow({ name, color, waits, steps, end }) {
    const swatch = element('span', { class: 'swatch', style: `background:var(--${color})` });
    const bar = element('span', { class: 'bar held', title: `${name} moves until ${Numbers.seconds(end)}`, style: `--color:var(--${color})` });
    const stops = waits.map(([from, to]) => {
      const text = `${name} waits from ${CellView.seconds(from)} to ${CellView.seconds(to)}`;
      return this.place(element('button', { type: 'button', class: 'wait', title: text, 'aria-label': text, onclick: () => this.view.seek(from) }), from, to);
    });
    const events = steps.map(([time, number, action]) => {
      const text = `${name}, step ${number}: ${action}, at ${CellView.seconds(time)}`;
      return this.place(element('button', { type: 'button', class: 'event', title: text, 'aria-label': text, onclick: () => this.view.seek(time) }), time, time);
    });
    const items = [...stops, ...events].map((item) => element('li', { class: 'whole' }, item));
    return CellRows.row([swatch, name], this.place(element('li', {}, bar), 0, end), ...items);
  }

  /** Returns the row of a signal: a line from the time at which one arm sets it to that at which the other arm needs it. */
  signalRow({ waits, at, set }, number) {
    const { arms } = this.view.cell;
    const [waiting, setting] = [arms[waits], arms[1 - waits]];
    const text = `Signal ${number}: ${waiting.name} waits at ${CellView.seconds(at)} until ${setting.name} has passed ${CellView.seconds(set)}`;
    const line = element('button', { type: 'button', class: 'signal', title: text, 'aria-label': text, style: `--sets:var(--${setting.color});--waits:var(--${waiting.color})`, onclick: () => this.view.seek(at) });
    return CellRows.row([`signal ${number}`], this.place(element('li', {}, line), set, at));
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

  /** Shows the current time. */
  follow() {
    this.cursor.style.setProperty('--at', String(this.view.time / this.view.duration));
  }
}

// Links the parts of a study's page: the layout that the reader points at is drawn beside the map, and is marked in all
// maps, charts and tables.
'use strict';

/**
 * @typedef {{ ending: string, fits: boolean, facts: string[][], command: string }} Layout
 * @typedef {{ shapes: number[][], layouts: Object<string, number[]>, extent: number[][] | null, colors: string[] }} Drawings
 */

const SVG = 'http://www.w3.org/2000/svg';
/** Signs of endings. */
const ENDINGS = { found: ['o-found', '\u2713'], infeasible: ['o-infeasible', '\u2715'], unknown: ['o-unknown', '?'], refused: ['o-unknown', '\u2013'] };
/** Directions of arrow keys in a map, in columns and rows. */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };

/**
 * Creates an element with attributes and children.
 * @param {string} tag
 * @param {Object<string, string>} [attributes]
 * @param {...(Node | string)} children
 * @returns {HTMLElement}
 */
function html(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/**
 * Creates an element of a drawing.
 * @param {string} tag
 * @param {Object<string, string | number>} [attributes]
 * @returns {SVGElement}
 */
function svg(tag, attributes = {}) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  return made;
}

/**
 * Copies the text of an element. Where the clipboard is closed to pages, selects the text and copies the selection.
 * @param {Element} line
 * @returns {Promise<boolean>} true if the text was copied
 */
async function copyText(line) {
  try {
    await navigator.clipboard.writeText(line.textContent);
    return true;
  } catch {
    getSelection()?.selectAllChildren(line);
    return document.execCommand('copy');
  }
}

/**
 * Puts a button beside a command, which copies it.
 * @param {Element} line
 * @returns {HTMLElement}
 */
function withCopy(line) {
  const button = html('button', { type: 'button', class: 'copy' }, 'Copy');
  button.addEventListener('click', async () => {
    button.textContent = await copyText(line) ? 'Copied' : 'Selected';
    setTimeout(() => { button.textContent = 'Copy'; }, 2000);
  });
  return html('div', { class: 'command-line' }, line, button);
}

class StudyPage {
  /**
   * @param {{ best: number | null, layouts: Object<string, Layout>, drawings: Drawings }} data
   */
  constructor(data) {
    this.data = data;
    /** The layout that the reader keeps by a click, or the best one. */
    this.kept = data.best ?? Number(Object.keys(data.layouts)[0]);
    /** The layout that is shown. */
    this.shown = null;
    this.panel = document.querySelector('.pointed');
    this.maps = [...document.querySelectorAll('.maps svg.chart')].filter((map) => map.querySelector('[data-cell]'));
    this.rows = new Map();
    for (const line of document.querySelectorAll('.answer .command')) {
      const place = document.createComment('');
      line.replaceWith(place);
      place.replaceWith(withCopy(line));
    }
    this.findRows();
    for (const map of this.maps) this.listenToMap(map);
    for (const chart of document.querySelectorAll('svg.chart')) if (!this.maps.includes(chart)) this.listenToChart(chart);
    if (this.panel) this.panel.hidden = false;
    this.show(this.kept);
  }

  // The shown layout.

  /**
   * Shows a layout beside the map, and marks it everywhere.
   * @param {number} layout
   */
  show(layout) {
    if (layout === this.shown || !this.data.layouts[layout]) return;
    this.shown = layout;
    for (const mark of document.querySelectorAll('.mark')) mark.remove();
    for (const spot of document.querySelectorAll(`svg.chart [data-layout="${layout}"]`)) StudyPage.mark(spot);
    for (const [number, row] of this.rows) row.classList.toggle('marked', number === layout);
    if (this.panel) this.panel.replaceChildren(...this.describe(layout));
  }

  /**
   * Keeps a layout: it stays when the pointer leaves.
   * @param {number} layout
   */
  keep(layout) {
    this.kept = layout;
    this.show(layout);
  }

  /**
   * Draws a mark around a cell or a dot.
   * @param {SVGElement} spot
   */
  static mark(spot) {
    for (const name of ['mark halo', 'mark']) {
      const mark = spot.cloneNode(false);
      for (const attribute of ['data-layout', 'data-cell', 'fill', 'tabindex']) mark.removeAttribute(attribute);
      if (mark.tagName === 'circle') mark.setAttribute('r', '6');
      mark.setAttribute('class', name);
      spot.closest('svg').append(mark);
    }
  }

  /**
   * Returns the content of the panel: the layout's ending, drawing, numbers and command.
   * @param {number} layout
   * @returns {HTMLElement[]}
   */
  describe(layout) {
    const { ending, fits, facts, command } = this.data.layouts[layout];
    const [style, sign] = ENDINGS[ending];
    const words = ending === 'found' && !fits ? 'found, but the motion does not meet the conditions' : ending;
    const verdict = html('p', { class: `ending ${style}` }, html('span', { 'aria-hidden': 'true' }, sign), ` ${words}`);
    const list = html('dl', {}, ...facts.flatMap(([name, text]) => [html('dt', {}, name), html('dd', {}, text)]));
    const title = `Layout ${layout}${layout === this.data.best ? ', the best' : ''}`;
    const parts = [html('h3', {}, title), verdict, this.drawing(layout), list, withCopy(html('pre', { class: 'command', tabindex: '0' }, command))];
    const row = this.rows.get(layout);
    if (row) parts.push(html('p', { class: 'sub' }, html('a', { href: `#${row.id}` }, 'In the table of the best layouts')));
    return parts;
  }

  /**
   * Returns the drawing of a layout: the obstacles, and the arm at the start and, paler, at the goal. All layouts are
   * drawn in the same frame.
   * @param {number} layout
   * @returns {SVGElement}
   */
  drawing(layout) {
    const { shapes, layouts, extent, colors } = this.data.drawings;
    const placed = layouts[layout];
    if (!placed || !extent) {
      const empty = svg('svg', { class: 'drawing', viewBox: '0 0 300 60', role: 'img', 'aria-label': 'no drawing' });
      const text = svg('text', { class: 'none', x: 150, y: 35 });
      text.textContent = 'this layout cannot be drawn';
      empty.append(text);
      return empty;
    }
    const [[left, low], [right, high]] = extent;
    const margin = 0.04 * Math.max(right - left, high - low);
    const picture = svg('svg', {
      class: 'drawing', role: 'img', 'aria-label': `Layout ${layout}: obstacles, and the arm at the start and at the goal`,
      viewBox: [left - margin, -high - margin, right - left + 2 * margin, high - low + 2 * margin].join(' '),
    });
    const line = Math.max(right - left, high - low) / 160;
    for (let i = 0; i < placed.length; i += 4) {
      const [role, index, x, y] = placed.slice(i, i + 4);
      const [radius, ...corners] = shapes[index];
      const spots = [];
      for (let k = 0; k < corners.length; k += 2) spots.push(`${x + corners[k]} ${-(y + corners[k + 1])}`);
      const d = `M${spots.join('L')}Z`;
      // The outline is a broader shape below: the radius rounds the corners.
      const color = role >= 0 ? colors[role] : null;
      const style = role >= 0 ? '' : role === -1 ? 'arm' : 'goal';
      const edge = svg('path', { class: style, d, 'stroke-linejoin': 'round', 'stroke-linecap': 'round', 'stroke-width': 2 * radius + line });
      const body = svg('path', { class: style, d, 'stroke-linejoin': 'round', 'stroke-linecap': 'round', 'stroke-width': Math.max(0, 2 * radius - line) });
      if (color) {
        for (const [part, value] of [['fill', color], ['stroke', color]]) {
          edge.setAttribute(part, value);
          body.setAttribute(part, value);
        }
      } else body.setAttribute('style', `stroke: var(--${role === -1 ? 'paper' : 'ghost'})`);
      picture.append(edge, body);
    }
    return picture;
  }

  // Tables.

  /** Finds the rows of the tables of layouts, and gives each a button. */
  findRows() {
    for (const row of document.querySelectorAll('tbody tr')) {
      const head = row.querySelector('th');
      const table = row.closest('table');
      if (!head || table.querySelector('thead th')?.textContent !== 'layout') continue;
      const layout = Number(head.textContent);
      row.id = `layout-${layout}`;
      const button = html('button', { type: 'button', class: 'name', 'aria-label': `layout ${layout}` }, head.textContent);
      button.addEventListener('click', () => this.keep(layout));
      button.addEventListener('focus', () => this.show(layout));
      row.addEventListener('pointerenter', () => this.show(layout));
      row.addEventListener('pointerleave', () => this.show(this.kept));
      head.replaceChildren(button);
      this.rows.set(layout, row);
    }
  }

  // Maps and charts.

  /**
   * Lets the pointer and the arrow keys choose a cell.
   * @param {SVGElement} map
   */
  listenToMap(map) {
    map.setAttribute('tabindex', '0');
    const cells = new Map([...map.querySelectorAll('[data-cell]')].map((cell) => [cell.dataset.cell, cell]));
    this.listenToChart(map);
    let place = null;
    map.addEventListener('keydown', (event) => {
      const arrow = ARROWS[event.key];
      if (!arrow) return;
      event.preventDefault();
      const current = map.querySelector(`[data-cell][data-layout="${this.shown}"]`) ?? cells.get(place) ?? cells.values().next().value;
      const [i, j] = current.dataset.cell.split(',').map(Number);
      const next = cells.get(`${i + arrow[0]},${j + arrow[1]}`);
      if (!next) return;
      place = next.dataset.cell;
      this.keep(Number(next.dataset.layout));
    });
    map.addEventListener('focus', () => this.panel?.setAttribute('aria-live', 'polite'));
    map.addEventListener('blur', () => this.panel?.removeAttribute('aria-live'));
  }

  /**
   * Lets the pointer choose a cell or a dot.
   * @param {SVGElement} chart
   */
  listenToChart(chart) {
    const layout = (event) => event.target.closest('[data-layout]')?.dataset.layout;
    chart.addEventListener('pointerover', (event) => {
      if (layout(event) !== undefined && event.pointerType === 'mouse') this.show(Number(layout(event)));
    });
    chart.addEventListener('click', (event) => {
      if (layout(event) !== undefined) this.keep(Number(layout(event)));
    });
    chart.addEventListener('pointerleave', () => this.show(this.kept));
  }
}

window.study = new StudyPage(JSON.parse(document.getElementById('study').textContent));

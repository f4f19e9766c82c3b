// The page of a comparison: tables that are sorted by a click on the head of a column, and rows and paths that light each
// other up.
'use strict';

/** An arrow that points up; the style sheet turns it over. */
const ARROW = '<svg viewBox="0 0 10 10" aria-hidden="true"><path d="M5 1.5 9.5 8.5H.5Z"/></svg>';

/**
 * Returns the value by which a cell is sorted: a number, or a text.
 * @param {Element | undefined} cell
 * @returns {number | string | null}
 */
function sortKey(cell) {
  const value = cell?.getAttribute('data-value');
  if (value !== null && value !== undefined) return Number(value);
  return cell?.tagName === 'TH' ? (cell.querySelector('.name')?.textContent ?? '') : null;
}

/**
 * Returns the order of two keys. Cells without a value come last in both directions.
 * @param {number | string | null} a
 * @param {number | string | null} b
 * @param {number} sign 1 for ascending, -1 for descending order
 * @returns {number}
 */
function order(a, b, sign) {
  if (a === null || b === null) return Number(a === null) - Number(b === null);
  return sign * (typeof a === 'number' && typeof b === 'number' ? a - b : String(a).localeCompare(String(b), 'en'));
}

/**
 * Makes a table sortable: the heads of its columns become buttons. The first click puts the best value first.
 * @param {HTMLTableElement} table
 * @returns {void}
 */
function makeSortable(table) {
  const body = table.tBodies[0];
  const initial = [...body.rows];
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.innerHTML = `<span></span>${ARROW}`;
    button.firstElementChild.textContent = head.textContent;
    head.replaceChildren(button);
    button.addEventListener('click', () => {
      const before = head.getAttribute('aria-sort');
      const first = head.dataset.first ?? 'ascending';
      const direction = before === null ? first : before === 'ascending' ? 'descending' : 'ascending';
      for (const other of heads) other.removeAttribute('aria-sort');
      head.setAttribute('aria-sort', direction);
      const sign = direction === 'ascending' ? 1 : -1;
      // Sorting is stable: rows with equal values remain in their first order.
      const rows = [...initial].sort((a, b) => order(sortKey(a.cells[column]), sortKey(b.cells[column]), sign));
      body.append(...rows);
    });
  });
}

/** The pictures and the table of one problem. One path at a time is lit: the one that is pointed at, or the pinned one. */
class Compared {
  /**
   * @param {Element} root element around the pictures and the table
   * @param {Element[]} cards recommendations for this problem
   */
  constructor(root, cards) {
    this.root = root;
    /** @type {string | null} */
    this.pinned = null;
    this.text = root.querySelector('.lit-path');
    this.rows = [...root.querySelectorAll('tr[data-path]')];
    for (const row of this.rows) this.makeButton(row);
    for (const element of [...root.querySelectorAll('[data-path]'), ...cards]) this.listen(element);
    this.light(null);
  }

  /**
   * Makes the name in a row a button that pins its path.
   * @param {Element} row
   * @returns {void}
   */
  makeButton(row) {
    const name = row.querySelector('.name');
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'name';
    button.textContent = name.textContent;
    button.setAttribute('aria-pressed', 'false');
    name.replaceWith(button);
    button.addEventListener('focus', () => {
      this.light(row.getAttribute('data-path'));
      this.reveal(row);
    });
    button.addEventListener('blur', () => this.light(this.pinned));
  }

  /**
   * Scrolls until a row is not below the pictures, which stay in place on large screens.
   * @param {Element} row
   * @returns {void}
   */
  reveal(row) {
    const pictures = this.root.querySelector('.pictures');
    if (!pictures || getComputedStyle(pictures).position !== 'sticky') return;
    // The first scroll may move the pictures as well.
    for (let turn = 0; turn < 2; turn += 1) {
      const hidden = pictures.getBoundingClientRect().bottom - row.getBoundingClientRect().top;
      if (hidden > 0) window.scrollBy(0, -hidden);
    }
  }

  /**
   * Lights the path of an element while the pointer is over it, and pins it on a click.
   * @param {Element} element
   * @returns {void}
   */
  listen(element) {
    const path = element.getAttribute('data-path');
    // A tap sends a click as well, which pins.
    const point = (/** @type {PointerEvent} */ event, /** @type {string | null} */ lit) => event.pointerType !== 'touch' && this.light(lit);
    element.addEventListener('pointerenter', (/** @type {PointerEvent} */ event) => point(event, path));
    element.addEventListener('pointerleave', (/** @type {PointerEvent} */ event) => point(event, this.pinned));
    element.addEventListener('click', () => this.pin(this.pinned === path ? null : path));
  }

  /**
   * Keeps a path lit, or none.
   * @param {string | null} path
   * @returns {void}
   */
  pin(path) {
    this.pinned = path;
    for (const row of this.rows) {
      const isPinned = row.getAttribute('data-path') === path;
      row.classList.toggle('pinned', isPinned);
      row.querySelector('.name').setAttribute('aria-pressed', String(isPinned));
    }
    this.light(path);
  }

  /**
   * Lights a path and its row, and dims the others. With `null`, all are alike.
   * @param {string | null} path
   * @returns {void}
   */
  light(path) {
    this.root.classList.toggle('lit', path !== null);
    for (const element of this.root.querySelectorAll('[data-path]')) {
      element.classList.toggle('on', path !== null && element.getAttribute('data-path') === path);
    }
    if (!this.text) return;
    const row = this.rows.find((other) => other.getAttribute('data-path') === path);
    this.text.textContent = row?.getAttribute('data-description') ?? this.text.getAttribute('data-hint');
  }
}

for (const table of document.querySelectorAll('table')) if (table.matches('.ranking')) makeSortable(table);
const compared = [...document.querySelectorAll('.compared')].map((root, index) => {
  // Only the page of a single problem has cards with a path.
  const cards = index === 0 ? [...document.querySelectorAll('.pick[data-path]')] : [];
  return new Compared(root, cards);
});
document.addEventListener('keydown', (event) => {
  if (event.key === 'Escape') for (const problem of compared) problem.pin(null);
});

// Tabs: one of several parts of the page at a time. A part for which there is room beside them needs no tab.
'use strict';

class Tabs {
  /**
   * @param label name of the group for screen readers
   * @param entries the parts in order: `name`, `title`, `panel`, and the functions `isOffered` and `isBeside`, which
   * return whether there is something to show, and whether the part is visible without a tab
   */
  constructor(label, entries) {
    this.entries = entries;
    /** Name of the tab that the reader chose; `null` before. */
    this.chosen = null;
    for (const entry of entries) {
      const id = `tab-${entry.name}`;
      entry.tab = element('button', { type: 'button', role: 'tab', id, 'data-tab': entry.name, onclick: () => this.choose(entry.name) }, entry.title);
      entry.panel.id ||= `${id}-panel`;
      entry.tab.setAttribute('aria-controls', entry.panel.id);
    }
    this.root = element('div', { class: 'tabs', role: 'tablist', 'aria-label': label, onkeydown: (event) => this.key(event) }, ...entries.map(({ tab }) => tab));
    this.refresh();
  }

  get offered() {
    return this.entries.filter((entry) => entry.isOffered() && !entry.isBeside());
  }

  get current() {
    const { offered } = this;
    return offered.find(({ name }) => name === this.chosen) ?? offered[0];
  }

  choose(name) {
    this.chosen = name;
    this.refresh();
  }

  /** Handles arrow keys, which move to the next tab. */
  key(event) {
    const { offered, current } = this;
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step || !current) return;
    const next = offered[(offered.indexOf(current) + step + offered.length) % offered.length];
    this.choose(next.name);
    next.tab.focus();
    event.preventDefault();
    event.stopPropagation();
  }

  refresh() {
    const { offered, current } = this;
    for (const entry of this.entries) {
      const { tab, panel } = entry;
      const isCurrent = entry === current;
      tab.hidden = !offered.includes(entry);
      tab.setAttribute('aria-selected', String(isCurrent));
      tab.tabIndex = isCurrent ? 0 : -1;
      panel.hidden = !entry.isOffered() || !(isCurrent || entry.isBeside());
      if (entry.isBeside()) for (const name of ['role', 'aria-labelledby']) panel.removeAttribute(name);
      else {
        panel.setAttribute('role', 'tabpanel');
        panel.setAttribute('aria-labelledby', tab.id);
      }
    }
    this.root.hidden = offered.length < 2;
  }
}

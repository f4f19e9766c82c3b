// Choices of the reader that outlive the page, and wishes that the browser reports.
'use strict';

const Settings = {
  /** Returns a remembered value, or `null` if there is none or the browser remembers nothing. */
  read(name) {
    try {
      return localStorage.getItem(`cplan.${name}`);
    } catch {
      return null;
    }
  },

  /** Remembers a value. Returns false if the browser does not allow it, as in some private windows. */
  write(name, value) {
    try {
      localStorage.setItem(`cplan.${name}`, value);
      return true;
    } catch {
      return false;
    }
  },

  /** Returns true if the reader prefers that nothing moves by itself. */
  get reducesMotion() {
    return matchMedia('(prefers-reduced-motion: reduce)').matches;
  },

  /** True if keys of a single character act on the page. Users of speech input may switch them off (WCAG 2.1.4). */
  get hasShortcuts() {
    return this.read('shortcuts') !== 'off';
  },

  set hasShortcuts(isOn) {
    this.write('shortcuts', isOn ? 'on' : 'off');
  },
};

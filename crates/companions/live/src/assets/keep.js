// Edits kept by the browser: they survive a reload of the page and the end of the server.
'use strict';

/** Largest number of worlds whose edits are kept; the oldest are dropped first. */
const MAX_WORLDS = 8;
/** Largest number of undo steps that are kept with each world. */
const MAX_STEPS = 20;

const Keep = (() => {
  const PREFIX = 'cplan edits ';
  const DRAGGED = 'cplan dragged';

  /** Returns the store of this window first, then that of all windows. Browsers may refuse both. */
  function stores() {
    try {
      return [window.sessionStorage, window.localStorage];
    } catch {
      return [];
    }
  }

  /** Returns a different name for each world: FNV-1a, twice. */
  function name(origin) {
    const hash = (seed) => {
      let h = seed;
      for (let i = 0; i < origin.length; i += 1) h = Math.imul(h ^ origin.charCodeAt(i), 16777619);
      return (h >>> 0).toString(36);
    };
    return `${PREFIX}${hash(2166136261)} ${hash(40389)} ${origin.length}`;
  }

  function dropOldest(store) {
    const names = Object.keys(store).filter((key) => key.startsWith(PREFIX));
    const age = (key) => {
      try {
        return JSON.parse(store.getItem(key)).at ?? 0;
      } catch {
        return 0;
      }
    };
    if (names.length <= MAX_WORLDS) return;
    names.sort((a, b) => age(b) - age(a)).slice(MAX_WORLDS).forEach((key) => store.removeItem(key));
  }

  /** Keeps the edits of an initial world. */
  function write(origin, record) {
    const dated = { at: Date.now(), ...record };
    const tries = [
      { ...dated, past: record.past.slice(-MAX_STEPS), future: record.future.slice(-MAX_STEPS) },
      { ...dated, past: [], future: [] },
    ];
    for (const store of stores()) {
      for (const text of tries.map((one) => JSON.stringify(one))) {
        try {
          store.setItem(name(origin), text);
          dropOldest(store);
          break;
        } catch {
          // There is not enough room.
        }
      }
    }
  }

  /** Returns the edits of an initial world, or `null`. */
  function read(origin) {
    for (const store of stores()) {
      try {
        const record = JSON.parse(store.getItem(name(origin)));
        if (record) return record;
      } catch {
        // The entry is not one of ours.
      }
    }
    return null;
  }

  function forget(origin) {
    for (const store of stores()) {
      try {
        store.removeItem(name(origin));
      } catch {
        // Then it was not kept either.
      }
    }
  }

  /**
   * Returns true if anything was ever dragged in this browser. Also true if the browser keeps nothing, so that the
   * marks do not reappear each time.
   */
  function hasDragged() {
    try {
      return window.localStorage.getItem(DRAGGED) !== null;
    } catch {
      return true;
    }
  }

  function recordDrag() {
    try {
      window.localStorage.setItem(DRAGGED, '1');
    } catch {
      // Then the marks appear again.
    }
  }

  return { write, read, forget, hasDragged, recordDrag };
})();

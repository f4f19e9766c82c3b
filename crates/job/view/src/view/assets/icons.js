// Icons as inline SVG, so that no icon depends on the fonts of the reader's machine.
'use strict';

/** Outlines of the icons on a square of 24 units. `fill` is the text's colour instead of a stroke. */
const ICONS = {
  play: { fill: 'M7 4.5v15l12.5-7.5z' },
  pause: { fill: 'M6.5 4.5h4v15h-4zM13.5 4.5h4v15h-4z' },
  plus: { stroke: 'M12 5v14M5 12h14' },
  minus: { stroke: 'M5 12h14' },
  reset: { stroke: 'M4.5 9.5a8 8 0 1 1-.4 4.4M4.5 4.2v5.3h5.3' },
  close: { stroke: 'M6 6l12 12M18 6L6 18' },
  found: { stroke: 'M5 12.5l4.5 4.5L19 7.5' },
  infeasible: { stroke: 'M6 6l12 12M18 6L6 18' },
};

/** Returns an icon in the size and colour of the surrounding text. Screen readers ignore it. */
function icon(name) {
  const { fill, stroke } = ICONS[name];
  const made = document.createElement('template');
  const shape = fill
    ? `<path d="${fill}" fill="currentColor"/>`
    : `<path d="${stroke}" fill="none" stroke="currentColor" stroke-width="2" stroke-linecap="round" stroke-linejoin="round"/>`;
  made.innerHTML = `<svg class="icon" data-icon="${name}" viewBox="0 0 24 24" width="1em" height="1em" aria-hidden="true" focusable="false">${shape}</svg>`;
  return made.content.firstChild;
}

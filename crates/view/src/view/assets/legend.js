// The legend: the entries of the picture's legend, each with its sign.
'use strict';

const Legend = (() => {
  const SQUARE = 'd="M6 2h16v12h-16z"';
  const diamond = (fill) => `<path d="M18 1l7 7l-7 7l-7-7z" fill="var(--${fill})" stroke="var(--ink)" stroke-width="1.6"/>`;

  /** Signs. Colours are those of the page, or those of obstacles as #rrggbb. */
  const SIGNS = {
    start: () => '<circle cx="18" cy="8" r="6" fill="var(--paper)" stroke="var(--ink)" stroke-width="2.2"/>',
    goal: () => diamond('ink'),
    unreached: () => diamond('paper'),
    line: (theme, { color, width, dash = [] }) => `<path d="M0 8h26" stroke="${theme.tint(color)}" stroke-width="${width}" stroke-dasharray="${dash.join(' ')}"/>`,
    swatch: (theme, { color }) => {
      const { fill, line: edge } = theme[color] ? { fill: theme[color], line: theme.grey } : theme.obstacle(color);
      return `<path ${SQUARE} fill="${fill}" stroke="${edge}"/>`;
    },
    shade: (theme, { part }) => `<path ${SQUARE} fill="${theme.scale(part)}" stroke="${theme.grey}"/>`,
    dashed: (theme, { color }) => `<path ${SQUARE} fill="none" stroke="${theme.tint(color)}" stroke-width="1.4" stroke-dasharray="5 3"/>`,
    center: () => '<circle cx="18" cy="8" r="3" fill="var(--ink)" stroke="var(--paper)" stroke-width="0.8"/>',
    middle: () => '<circle cx="18" cy="8" r="3" fill="var(--paper)" stroke="var(--ink)" stroke-width="1.4"/>',
    hatched: (theme) => `<path d="M6 7l5-5M6 14l12-12M13 14l9-9M20 14l2-2" stroke="${theme.proof}" stroke-width="1.6"/><path ${SQUARE} fill="none" stroke="${theme.proof}" stroke-width="1.1"/>`,
  };

  /** Returns the entries as items of a list. */
  function items(theme, keys) {
    return keys.map((key) => {
      const sign = document.createElement('template');
      sign.innerHTML = `<svg width="26" height="16" viewBox="0 0 26 16" aria-hidden="true">${SIGNS[key.sign](theme, key)}</svg>`;
      return element('li', {}, sign.content, key.text);
    });
  }

  return { items };
})();

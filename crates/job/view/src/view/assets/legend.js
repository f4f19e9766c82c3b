// Signs of the legend: those of the program's pictures, and those of layers that only pages have.
'use strict';

const Legend = (() => {
  const SQUARE = 'd="M6 2h16v12h-16z"';
  const diamond = (fill) => `<path d="M18 1l7 7l-7 7l-7-7z" fill="var(--${fill})" stroke="var(--ink)" stroke-width="1.6"/>`;

  /** Signs. Colours are those of the page, or those of obstacles as #rrggbb. */
  const SIGNS = {
    start: () => '<circle cx="18" cy="8" r="6" fill="var(--paper)" stroke="var(--ink)" stroke-width="2.2"/>',
    goal: () => diamond('ink'),
    unreached: () => diamond('paper'),
    line: (theme, { color, width, dash = [] }) => `<path d="M0 8h26" stroke="${theme.stroke(color)}" stroke-width="${width}" stroke-dasharray="${dash.join(' ')}"/>`,
    /** `pale` is the share of the background in the colour. */
    swatch: (theme, { color, pale = 0 }) => {
      if (pale) return `<path ${SQUARE} fill="${Theme.mixed(theme[color], theme.paper, pale)}" stroke="${theme.grey}"/>`;
      const { fill, line: edge } = theme[color] ? { fill: theme[color], line: theme.grey } : theme.obstacle(color);
      return `<path ${SQUARE} fill="${fill}" stroke="${edge}"/>`;
    },
    shade: (theme, { part }) => `<path ${SQUARE} fill="${theme.scale(part)}" stroke="${theme.grey}"/>`,
    dashed: (theme, { color }) => `<path ${SQUARE} fill="none" stroke="${theme.tint(color)}" stroke-width="1.4" stroke-dasharray="5 3"/>`,
    center: () => '<circle cx="18" cy="8" r="3" fill="var(--ink)" stroke="var(--paper)" stroke-width="0.8"/>',
    middle: () => '<circle cx="18" cy="8" r="3" fill="var(--paper)" stroke="var(--ink)" stroke-width="1.4"/>',
    hatched: (theme) => `<path d="M6 7l5-5M6 14l12-12M13 14l9-9M20 14l2-2" stroke="${theme.proof}" stroke-width="1.6"/><path ${SQUARE} fill="none" stroke="${theme.proof}" stroke-width="1.1"/>`,
    contact: () => '<circle cx="18" cy="8" r="4.5" fill="var(--infeasible)" stroke="var(--paper)" stroke-width="1.2"/>',
    solutions: () => '<path d="M2 13c2-12 8-12 10-4M24 3c-2 12-8 12-10 4" fill="none" stroke="var(--grey)" stroke-width="2.2"/>',
    path: () => '<path d="M0 8h26" stroke="var(--ink)" stroke-width="2.4"/>',
    'c-obstacles': () => `<path d="M7 12c-3-5 2-10 8-9s9 6 5 9s-9 3-13 0z" fill="var(--ghost)" stroke="var(--grey)" stroke-width="1.2"/>`,
    map: () => '<path d="M2 2h7v12h-7z" fill="var(--paper)" stroke="var(--grey)"/><path d="M9 2h8v12h-8z" fill="var(--ink)" stroke="var(--grey)"/><path d="M17 2h7v12h-7z" fill="var(--pale)" stroke="var(--grey)"/>',
    sensor: () => '<path d="M3 14L23 8a20 20 0 0 0-8-7z" fill="var(--accent)" fill-opacity="0.3" stroke="var(--accent)"/>',
    known: () => `<path ${SQUARE} fill="var(--free)" stroke="var(--grey)"/>`,
    // The heading of the kinds of positions, which have signs.
    access: () => '',
    poses: () => '<path d="M5 14l7-9l9-2" fill="none" stroke="var(--grey)" stroke-width="5" stroke-linejoin="round"/><path d="M5 14l7-9l9-2" fill="none" stroke="var(--ghost)" stroke-width="3.4" stroke-linejoin="round"/>',
    names: () => '<path d="M4 13L8.5 2.5L13 13M5.7 9.5h5.6M22 6v7M22 9.5a3 3.4 0 1 0-.01 .1" fill="none" stroke="var(--ink)" stroke-width="1.6"/>',
    frames: () => '<path d="M7 14V2M7 14h14" stroke="var(--ink)" stroke-width="1.8"/>',
    regions: () => `<path ${SQUARE} fill="none" stroke="var(--preferred)" stroke-width="1.4" stroke-dasharray="5 3"/>`,
    proof: (theme) => SIGNS.hatched(theme),
    channel: () => `<path ${SQUARE} fill="var(--channel)" stroke="var(--grey)"/>`,
    cells: () => '<path d="M2 2v12M9 2v12M16 2v12M24 2v12M2 3h22M2 13h22" stroke="var(--edge)"/>',
    rows: () => '<path d="M4 1v14M8 1v14M12 1v14M18 1v14M22 1v14" stroke="var(--edge)"/>',
    roadmap: () => '<path d="M1 14L10 3l14 9M10 3l-2 12" fill="none" stroke="var(--edge)" stroke-width="1.2"/>',
    roads: () => '<path d="M1 14L10 3l14 9M10 3l-2 12" fill="none" stroke="var(--edge)" stroke-width="1.2"/>',
    expanded: (theme) => [0, 0.5, 1].map((part, k) => `<circle cx="${5 + 8 * k}" cy="8" r="3" fill="${theme.scale(part)}"/>`).join(''),
    wavefront: (theme) => [0, 0.33, 0.67, 1].map((part, k) => `<path d="M${1 + 6 * k} 2h6v12h-6z" fill="${theme.scale(part)}"/>`).join(''),
    equipotentials: (theme) => `<path d="M2 14c2-10 20-10 22 0M7 14c2-6 10-6 12 0" fill="none" stroke="${theme.scale(0.5)}" stroke-width="1.4"/>`,
    flow: () => '<path d="M2 12c8 0 12-8 20-8m-5-3l5 3l-4 4" fill="none" stroke="var(--accent)" stroke-width="1.4"/>',
    boxes: () => '<path d="M2 2h11v12h-11z" fill="var(--free)" stroke="var(--edge)"/><path d="M13 2h11v12h-11z" fill="var(--undecided)" stroke="var(--edge)"/>',
  };

  /** Returns the sign of an entry. */
  function sign(theme, key) {
    const made = document.createElement('template');
    made.innerHTML = `<svg viewBox="0 0 26 16" aria-hidden="true">${SIGNS[key.sign](theme, key)}</svg>`;
    return made.content;
  }

  return { sign };
})();

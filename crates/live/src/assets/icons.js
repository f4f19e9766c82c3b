// Icons of the live page's toolbar, drawn in the colour of the text.
'use strict';

/** Outlines in a square of 24 units. */
const LIVE_ICONS = {
  undo: 'M9 14 4 9l5-5M4 9h10a5.5 5.5 0 0 1 0 11h-3',
  redo: 'm15 14 5-5-5-5M20 9H10a5.5 5.5 0 0 0 0 11h3',
  polygon: 'm10 3 7 5-2.5 8h-9L3 8zM19 15v6M16 18h6',
  circle: 'M17 10a7 7 0 1 1-14 0 7 7 0 0 1 14 0M19 15v6M16 18h6',
  wall: 'M3 16 17 4M19 15v6M16 18h6',
  corner: 'M3 19 10 6l4 6M8 4h4v4H8zM18 13v6M15 16h6',
  corners: 'M6 8v9M9 6h7M9 19h7M18 9v8M3 4h4v4H3zM17 4h4v4h-4zM3 17h4v4H3zM17 17h4v4h-4z',
  remove: 'M4 7h16M9 7V4h6v3M6 7l1 13h10l1-13M10 11v5M14 11v5',
  open: 'M3 19V5h6l2 3h10v11z',
  save: 'M12 3v12M7 10l5 5 5-5M4 20h16',
  restart: 'M4 4v5h5M4.5 9a8 8 0 1 1-.4 5',
  link: 'M10 14a4 4 0 0 0 6 .4l3-3a4 4 0 0 0-5.7-5.7l-1.6 1.6M14 10a4 4 0 0 0-6-.4l-3 3a4 4 0 0 0 5.7 5.7l1.6-1.6',
};

/** Returns an icon by its name, which screen readers ignore. */
function liveIcon(name) {
  const svg = (tag, attributes) => {
    const made = document.createElementNS('http://www.w3.org/2000/svg', tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    return made;
  };
  const icon = svg('svg', { viewBox: '0 0 24 24', class: 'icon', 'aria-hidden': 'true' });
  icon.append(svg('path', { d: LIVE_ICONS[name] }));
  return icon;
}

/** Creates a button with an icon. The label is its name and its tooltip; `keys` are added to the tooltip. */
function iconButton(name, label, onclick, keys = '') {
  return element('button', { type: 'button', class: 'button tool', 'aria-label': label, title: keys ? `${label} (${keys})` : label, onclick }, liveIcon(name));
}

// Further icons, of the live page's toolbar.
'use strict';

Object.assign(ICONS, {
  undo: { stroke: 'M9 14 4 9l5-5M4 9h10a5.5 5.5 0 0 1 0 11h-3' },
  redo: { stroke: 'm15 14 5-5-5-5M20 9H10a5.5 5.5 0 0 0 0 11h3' },
  polygon: { stroke: 'm10 3 7 5-2.5 8h-9L3 8zM19 15v6M16 18h6' },
  circle: { stroke: 'M17 10a7 7 0 1 1-14 0 7 7 0 0 1 14 0M19 15v6M16 18h6' },
  wall: { stroke: 'M3 16 17 4M19 15v6M16 18h6' },
  corner: { stroke: 'M3 19 10 6l4 6M8 4h4v4H8zM18 13v6M15 16h6' },
  corners: { stroke: 'M6 8v9M9 6h7M9 19h7M18 9v8M3 4h4v4H3zM17 4h4v4h-4zM3 17h4v4H3zM17 17h4v4h-4z' },
  remove: { stroke: 'M4 7h16M9 7V4h6v3M6 7l1 13h10l1-13M10 11v5M14 11v5' },
  open: { stroke: 'M3 19V5h6l2 3h10v11z' },
  save: { stroke: 'M12 3v12M7 10l5 5 5-5M4 20h16' },
  restart: { stroke: 'M4 4v5h5M4.5 9a8 8 0 1 1-.4 5' },
  link: { stroke: 'M10 14a4 4 0 0 0 6 .4l3-3a4 4 0 0 0-5.7-5.7l-1.6 1.6M14 10a4 4 0 0 0-6-.4l-3 3a4 4 0 0 0 5.7 5.7l1.6-1.6' },
});

/** Creates a button with an icon. The label is its name and its tooltip; `keys` are added to the tooltip. */
function iconButton(name, label, onclick, keys = '') {
  return element('button', { type: 'button', class: 'button tool', 'aria-label': label, title: keys ? `${label} (${keys})` : label, onclick }, icon(name));
}

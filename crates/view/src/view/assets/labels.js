// Names in a panel, placed as in pictures: no name covers another one, or its own shape.
'use strict';

const Labels = (() => {
  const FONT = '600 12px system-ui, sans-serif';
  /** Height of a name's box, and its distance from the shape beside it, in pixels. */
  const [LINE, GAP] = [15, 3];
  /** Half the width of the markers of start and goals, in pixels. */
  const MARKER = 8;
  /** Largest fraction of a named area that its name may cover. */
  const COVERED = 0.5;
  /** Possible positions of a name: on its shape, then above, below, to the sides and at the corners of it. */
  const SIDES = [[0, 0], [0, -1], [0, 1], [1, 0], [-1, 0], [1, -1], [-1, -1], [1, 1], [-1, 1]];

  /** Returns a square about a spot. */
  const about = ([x, y], half = 0) => ({ x: x - half, y: y - half, width: 2 * half, height: 2 * half });

  /** Returns the common area in square pixels. */
  const common = (a, b) => Math.max(0, Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x)) * Math.max(0, Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y));
  /** Moves a box into another one. */
  const pushed = (a, b) => ({ ...a, x: Math.max(b.x, Math.min(b.x + b.width - a.width, a.x)), y: Math.max(b.y, Math.min(b.y + b.height - a.height, a.y)) });
  const within = (a, b) => a.x >= b.x && a.y >= b.y && a.x + a.width <= b.x + b.width && a.y + a.height <= b.y + b.height;

  function size(context, text) {
    context.font = FONT;
    return [context.measureText(text).width + 6, LINE];
  }

  /**
   * Draws names, each with the box of its shape: on the shape or, if that is smaller, beside it, where the name covers
   * least of the others. Earlier names choose first. No name covers one of the markers.
   */
  function beside(context, panel, names, markers = []) {
    const taken = markers.map((spot) => about(spot, MARKER));
    for (const [text, of] of names) {
      const [width, height] = size(context, text);
      const fits = width <= of.width && height <= of.height;
      const free = SIDES.slice(fits ? 0 : 1)
        .map(([dx, dy]) => ({
          x: of.x + of.width / 2 - width / 2 + dx * (width / 2 + GAP + of.width / 2),
          y: of.y + of.height / 2 - height / 2 + dy * (height / 2 + GAP + of.height / 2),
          width, height,
        }))
        .filter((box) => within(box, panel.rect) && !taken.some((other) => common(box, other) > 0));
      if (!free.length) continue;
      // It is better to hide a part of a large shape than all of a small one.
      const share = (box, other) => common(box, other) / Math.max(LINE * LINE, other.width * other.height);
      const hidden = (box) => names.reduce((sum, [, other]) => sum + (other === of ? 0 : share(box, other)), 0);
      const place = free.reduce((best, box) => (hidden(box) < hidden(best) ? box : best));
      taken.push(place);
      write(context, panel.theme, text, place.x + width / 2, place.y + height / 2);
    }
  }

  /** Draws names centred at spots, each with the area of its shape in square pixels. No name covers one of the markers. */
  function inside(context, panel, markers, names) {
    const taken = markers.map((spot) => about(spot, MARKER));
    for (const [text, [x, y], area] of names) {
      const [width, height] = size(context, text);
      const place = pushed({ x: x - width / 2, y: y - height / 2, width, height }, panel.rect);
      if (width * height > COVERED * area || taken.some((other) => common(place, other) > 0)) continue;
      taken.push(place);
      write(context, panel.theme, text, place.x + width / 2, place.y + height / 2);
    }
  }

  /** Returns the box for a name beyond `tip`, as seen from `from`. */
  function beyond(context, text, tip, from) {
    const [width, height] = size(context, text);
    const away = [tip[0] - from[0], tip[1] - from[1]];
    const length = Math.hypot(...away) || 1;
    const [x, y] = [width, height].map((side, k) => tip[k] + (away[k] / length) * (side / 2 + 2 * GAP) - side / 2);
    return { x, y, width, height };
  }

  function write(context, theme, text, x, y) {
    context.font = FONT;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.lineWidth = 3.5;
    context.strokeStyle = theme.paper;
    context.strokeText(text, x, y);
    context.fillStyle = theme.ink;
    context.fillText(text, x, y);
  }

  return { about, beside, beyond, inside, write };
})();

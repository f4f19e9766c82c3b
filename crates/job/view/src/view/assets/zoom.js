// Magnification of a panel by buttons, wheel, double click and two fingers.
'use strict';

const Zoom = {
  /** Magnification by a key or button. */
  FACTOR: 1.5,
  /** Logarithm of the magnification per pixel of a wheel. */
  PER_PIXEL: 0.002,
  /** A wheel that scrolled the page within this time continues to do so, in milliseconds. */
  SCROLLING: 300,

  /**
   * Magnifies a panel about a spot, or about its middle if the spot is missing or outside.
   * @param {Panel} panel
   * @param {number} factor
   * @param {?Point} spot in pixels
   */
  magnify(panel, factor, spot = null) {
    const { rect } = panel;
    panel.magnify(factor, spot && panel.contains(spot) ? spot : [rect.x + rect.width / 2, rect.y + rect.height / 2]);
  },

  /**
   * Creates the buttons of a panel.
   * @param {string} label name of the panel
   * @param {() => Panel} panel returns the panel, which may be created later than the buttons
   * @param {() => ?Point} spot returns the spot about which the buttons magnify
   * @returns {HTMLElement}
   */
  buttons(label, panel, spot = () => null) {
    const button = (sign, what, act) => element('button', { type: 'button', class: 'button', 'aria-label': `${what}: ${label}`, title: what, onclick: act }, icon(sign));
    return element(
      'span',
      { class: 'zoom' },
      button('plus', 'zoom in', () => Zoom.magnify(panel(), Zoom.FACTOR, spot())),
      button('minus', 'zoom out', () => Zoom.magnify(panel(), 1 / Zoom.FACTOR, spot())),
      button('reset', 'show all', () => panel().reset()),
    );
  },

  /**
   * Magnifies by wheel, and shows all after a double click on nothing that `takes` the pointer.
   * @param {Panel} panel
   * @param {(event: MouseEvent) => boolean} takes
   */
  listen(panel, takes = () => false) {
    const { canvas } = panel;
    let scrolled = -Infinity;
    document.addEventListener('scroll', () => (scrolled = performance.now()), { passive: true });
    canvas.addEventListener('wheel', (event) => {
      const spot = panel.spot(event);
      const leaves = panel.times === 1 && (event.deltaY > 0 || (!event.ctrlKey && performance.now() - scrolled < Zoom.SCROLLING));
      if (leaves || !panel.contains(spot)) {
        // Otherwise, a pinch on a touchpad would magnify the page.
        if (event.ctrlKey) event.preventDefault();
        return;
      }
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode === 1 ? 30 : 1) * (event.ctrlKey ? 4 : 1);
      panel.magnify(Math.exp(-Zoom.PER_PIXEL * Math.min(400, Math.max(-400, pixels))), spot);
    }, { passive: false });
    canvas.addEventListener('dblclick', (event) => {
      if (panel.times > 1 && !takes(event)) panel.reset();
    });
  },

  /**
   * Magnifies and moves the picture by two fingers. A touch that begins where `takes` returns true does not scroll the
   * page. Nor do two fingers, or one finger in a magnified picture.
   * @param {Panel} panel
   * @param {(touch: PointerPlace) => boolean} takes
   * @param {() => boolean} begins called when two fingers touch; returns whether they pinch
   * @returns {() => boolean} tells whether two fingers pinch now
   */
  pinch(panel, takes, begins) {
    const { canvas } = panel;
    /** Distance of the fingers, and the spot between them. */
    let pinch = null;
    const between = (/** @type {TouchList} */ [a, b]) => ({
      apart: Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY),
      spot: panel.spot({ clientX: (a.clientX + b.clientX) / 2, clientY: (a.clientY + b.clientY) / 2 }),
    });
    canvas.addEventListener('touchstart', (event) => {
      const { touches } = event;
      const keeps = touches.length === 1
        ? panel.times > 1 || takes({ clientX: touches[0].clientX, clientY: touches[0].clientY, pointerType: 'touch' })
        : touches.length === 2;
      if (keeps) event.preventDefault();
      pinch = touches.length === 2 && begins() ? between(touches) : null;
    }, { passive: false });
    canvas.addEventListener('touchmove', (event) => {
      if (!pinch || event.touches.length !== 2) return;
      event.preventDefault();
      const now = between(event.touches);
      panel.move(now.spot[0] - pinch.spot[0], now.spot[1] - pinch.spot[1]);
      panel.magnify(now.apart / pinch.apart, now.spot);
      pinch = now;
    }, { passive: false });
    for (const end of ['touchend', 'touchcancel']) canvas.addEventListener(end, () => (pinch = null));
    return () => pinch !== null;
  },
};

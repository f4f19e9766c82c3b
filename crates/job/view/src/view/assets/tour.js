// A tour of the page in a few steps, for the first visit. It stands beside what it explains, and can be closed at any
// time.
'use strict';

class Tour {
  /** Possible places of the tour in the window, the preferred one first. */
  static PLACES = ['bottom right', 'bottom left', 'top right', 'top left'];

  constructor(view) {
    this.view = view;
    this.step = 0;
    this.title = element('h2', {});
    this.text = element('p', {});
    this.count = element('span', { class: 'count' });
    this.next = element('button', { type: 'button', class: 'button primary', onclick: () => this.go(this.step + 1) }, 'Next');
    this.root = element(
      'section', { class: 'tour', role: 'dialog', 'aria-label': 'Tour', hidden: true, onkeydown: (event) => event.key === 'Escape' && this.end() },
      this.title, this.text,
      element('p', { class: 'actions' }, this.count, element('button', { type: 'button', class: 'button', onclick: () => this.end() }, 'Close'), this.next),
    );
  }

  /**
   * Returns the words for the places of two pictures, and whether one is below the other, as on a narrow page.
   * @returns {{ here: string, there: string, isNarrow: boolean }}
   */
  static sides(one, other) {
    const [first, second] = [one, other].map((canvas) => canvas.getBoundingClientRect());
    const isNarrow = second.top > first.top + first.height / 2;
    return isNarrow ? { here: 'Above', there: 'Below', isNarrow } : { here: 'On the left', there: 'On the right', isNarrow };
  }

  /** Steps: title, text, and the element that the step is about. */
  get steps() {
    const { view } = this;
    const { parts, layers, panels, sideView, steps, model, tourSteps } = view;
    const about = { think: 'replays the search of the planner', learn: 'is a course of short lessons with questions' };
    const modes = parts.modes.hidden ? [] : [...parts.modes.children].filter((button) => !button.hidden && about[button.dataset.mode]);
    const more = modes.map((button, k) => `${k ? ', and ' : ''}\u201c${button.textContent}\u201d ${about[button.dataset.mode]}`).join('') + (modes.length ? '.' : '');
    const { here, there, isNarrow } = Tour.sides(panels.workspace.canvas, sideView.isShown ? sideView.panel.canvas : panels.cspace.canvas);
    const seen = sideView.isShown
      ? ['A task, step by step', `${here}, the arm and its objects; dashed outlines are the places where they will be. ${there}, the height of the tool along its path or, after a click, the configuration space of the step.`]
      : ['One arm, seen twice', `${here}, the arm among its obstacles. ${there}, the same arm as one point: a coordinate for each joint. Coloured regions are collisions.`];
    const workspace = panels.workspace.canvas.parentElement;
    return tourSteps ?? [
      // Both pictures together would leave no room for the tour on a narrow page.
      [...seen, isNarrow ? workspace : parts.panels],
      ['Take the arm', 'Drag the tip of the arm, or its dot in the configuration space. Contacts are marked in red. Escape puts the arm back.', workspace],
      ...(view.isTask && model.clock ? [['Go to a step', `Each object has a row. Click on a step to go there, or drag to move the time. ${more}`, steps.root]]
        : model.clock ? [['Play it', `Space plays the motion. ${more}`, parts.transport]]
          : more ? [['See why', more, parts.transport]] : []),
      ['Choose what is drawn', 'Each layer has its sign and a checkbox. More about the result is in the tabs below the pictures.', layers.root],
    ];
  }

  /** Starts the tour if this is the first visit. Browsers that are driven by a program, or remember nothing, see none. */
  offer() {
    if (navigator.webdriver || Settings.read('tour') !== null || !Settings.write('tour', 'offered')) return;
    this.start();
  }

  start() {
    this.root.hidden = false;
    this.go(0);
  }

  go(step) {
    this.mark(null);
    const { steps } = this;
    if (step >= steps.length) {
      this.end();
      return;
    }
    this.step = step;
    const [title, text, about] = steps[step];
    this.title.textContent = title;
    this.text.textContent = text;
    this.count.textContent = `${step + 1} of ${steps.length}`;
    this.next.textContent = step + 1 < steps.length ? 'Next' : 'Done';
    this.mark(about);
    this.stand(about);
  }

  /** Stands where the tour hides least of an element, and scrolls the element into the room beside the tour. */
  stand(about) {
    about.scrollIntoView({ block: 'nearest' });
    const hidden = () => {
      const [own, other] = [this.root, about].map((part) => part.getBoundingClientRect());
      const common = [Math.min(own.right, other.right) - Math.max(own.left, other.left), Math.min(own.bottom, other.bottom) - Math.max(own.top, other.top)];
      return Math.max(0, common[0]) * Math.max(0, common[1]);
    };
    const areas = Tour.PLACES.map((place) => {
      this.root.dataset.place = place;
      return hidden();
    });
    const least = Math.min(...areas);
    this.root.dataset.place = Tour.PLACES[areas.indexOf(least)];
    if (!least) return;
    const margin = 8;
    this.root.dataset.place = Tour.PLACES[0];
    scrollBy(0, about.getBoundingClientRect().bottom - this.root.getBoundingClientRect().top + margin);
    if (!hidden()) return;
    this.root.dataset.place = Tour.PLACES[2];
    scrollBy(0, about.getBoundingClientRect().top - this.root.getBoundingClientRect().bottom - margin);
  }

  /** Frames the element that a step is about. */
  mark(about) {
    this.about?.classList.remove('toured');
    this.about = about;
    about?.classList.add('toured');
  }

  end() {
    this.mark(null);
    this.root.hidden = true;
  }
}

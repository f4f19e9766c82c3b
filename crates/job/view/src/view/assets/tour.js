// A tour of the page in four steps, for the first visit. It covers nothing that the reader needs, and can be closed at
// any time.
'use strict';

class Tour {
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

  /** Steps: title, text, and the element that the step is about. */
  get steps() {
    const { view } = this;
    const { parts, layers, panels, sideView, steps, model, tourSteps } = view;
    const more = '\u201cHow it was found\u201d replays the search of the planner, and \u201cLearn\u201d is a course of short lessons with questions.';
    // On a narrow page, one picture is below the other.
    const [first, second] = [panels.workspace.canvas, sideView.isShown ? sideView.panel.canvas : panels.cspace.canvas].map((canvas) => canvas.getBoundingClientRect());
    const [here, there] = second.top > first.top + first.height / 2 ? ['Above', 'Below'] : ['On the left', 'On the right'];
    const seen = sideView.isShown
      ? ['A task, step by step', `${here}, the arm and its objects; dashed outlines are the places where they will be. ${there}, the height of the tool along its path or, after a click, the configuration space of the step.`]
      : ['One arm, seen twice', `${here}, the arm among its obstacles. ${there}, the same arm as one point: a coordinate for each joint. Coloured regions are collisions.`];
    return tourSteps ?? [
      [...seen, parts.panels],
      ['Take the arm', 'Drag the tip of the arm, or its dot in the configuration space. Contacts are marked in red. Escape puts the arm back.', panels.workspace.canvas.parentElement],
      view.isTask && model.clock ? ['Go to a step', `Each object has a row. Click on a step to go there, or drag to move the time. ${more}`, steps.root]
        : model.clock ? ['Play it', `Space plays the motion. ${more}`, parts.transport]
          : ['See why', more, parts.transport],
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
    about.scrollIntoView?.({ block: 'nearest', behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
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

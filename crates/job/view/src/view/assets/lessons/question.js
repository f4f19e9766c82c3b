// Questions of lessons, which the page checks. The next lesson is open without an answer.
'use strict';

/**
 * A question. Right answers are computed from the page's own world.
 * @typedef {object} QuestionModel
 * @property {string} kind 'number', 'choice' or 'figure': a number, one of several options, or something to do in the figure
 * @property {string} prompt
 * @property {string} [unit] unit of a number
 * @property {string[]} [options]
 * @property {(answer: number) => ?string} check returns a hint, or `null` if the answer is right: a number, the index of
 * an option, or nothing
 * @property {string} right what follows from the right answer
 */

class Question {
  /** @param {() => void} solved called when an answer is right */
  constructor(solved) {
    this.solved = solved;
    /** Returns the current question. @type {() => QuestionModel} */
    this.ask = null;
    /** @type {?string} */
    this.signature = null;
    this.prompt = element('span', { class: 'prompt' });
    this.answer = element('div', { class: 'answer' });
    this.feedback = element('p', { class: 'feedback', role: 'status' });
    this.button = element('button', { type: 'submit', class: 'button primary' }, 'Check');
    this.root = element('form', { class: 'question', novalidate: true, onsubmit: (event) => this.submit(event) }, this.answer, this.button, this.feedback);
  }

  /**
   * Shows a question. Its own texts may change with the figure; the reader's answer stays.
   * @param {string} name name of the lesson
   * @param {() => QuestionModel} ask
   */
  show(name, ask) {
    this.ask = ask;
    const { kind, prompt, unit, options } = ask();
    if (this.prompt.textContent !== prompt) this.prompt.textContent = prompt;
    const signature = JSON.stringify([name, kind, unit, options]);
    if (signature === this.signature) return;
    this.signature = signature;
    this.answer.replaceChildren(...this.inputs(kind, unit, options));
    this.say(null);
  }

  /** Creates the inputs for a kind of question, with the prompt as their label. */
  inputs(kind, unit, options) {
    if (kind === 'number') {
      const input = element('input', { type: 'text', inputmode: 'decimal', autocomplete: 'off', name: 'answer', oninput: () => this.say(null) });
      return [element('label', {}, this.prompt, element('span', { class: 'entry' }, input, unit ? ` ${unit}` : null))];
    }
    if (kind === 'choice') {
      const choice = (text, index) => element('label', { class: 'option' }, element('input', { type: 'radio', name: 'answer', value: index, onchange: () => this.say(null) }), text);
      return [element('fieldset', {}, element('legend', {}, this.prompt), ...options.map(choice))];
    }
    return [element('p', {}, this.prompt)];
  }

  /** Checks the reader's answer. @param {Event} event */
  submit(event) {
    event.preventDefault();
    const { kind, check, right } = this.ask();
    const given = new FormData(this.root).get('answer');
    // Readers write decimal commas, and copy minus signs.
    const value = kind === 'figure' ? 0 : Number(String(given ?? '').trim().replace(',', '.').replace('\u2212', '-').replace(/\s*(\u00b0|mm|%)$/u, '') || NaN);
    if (Number.isNaN(value)) {
      this.say(false, kind === 'number' ? 'Enter a number.' : 'Choose one of the answers.');
      return;
    }
    const hint = check(value);
    this.say(hint === null, hint ?? right);
    if (hint === null) this.solved();
  }

  /** Shows whether an answer is right, and why; `null` for no answer so far. */
  say(isRight, text = '') {
    const { feedback } = this;
    feedback.dataset.right = isRight === null ? '' : String(isRight);
    feedback.replaceChildren(...(isRight === null ? [] : [icon(isRight ? 'found' : 'infeasible'), element('span', {}, element('strong', {}, isRight ? 'Right. ' : 'Not yet. '), text)]));
  }
}

/** Questions of the usual kinds. */
const Ask = {
  /**
   * Asks for a number within a tolerance.
   * @returns {QuestionModel}
   */
  number: ({ prompt, unit = '', value, tolerance = 0, hint, right }) => ({
    kind: 'number', prompt, unit, right, check: (given) => (Math.abs(given - value) <= tolerance + 1e-9 ? null : hint),
  }),

  /**
   * Asks for one of several options. `hints` has a hint for each option, or there is one hint for all.
   * @returns {QuestionModel}
   */
  choice: ({ prompt, options, index, hint, right }) => ({ kind: 'choice', prompt, options, right, check: (given) => (given === index ? null : hint) }),

  /**
   * Asks for something in the figure. `check` returns a hint, or `null` if it is done.
   * @returns {QuestionModel}
   */
  figure: ({ prompt, check, right }) => ({ kind: 'figure', prompt, right, check }),

  /**
   * Asks for a place in the configuration space, which the reader chooses with the cross.
   * @returns {QuestionModel}
   */
  place: (view, { prompt, check, right }) => ({
    kind: 'figure', prompt, right,
    check: () => (view.probe ? check(view.probe.q) : 'Choose a place first: click into the configuration space, or press an arrow key in it.'),
  }),
};

/** Geometry in the configuration space, for checks of answers. */
const Places = {
  /** Returns the difference of two configurations as fractions of the joints' ranges; the shorter way round a circle. */
  apart: ({ joints }, a, b) => joints.map((joint, k) => {
    const by = joint.circle ? Geometry.wrap(joint, a[k] - b[k]) : a[k] - b[k];
    return Math.abs(by) / (joint.domain[1] - joint.domain[0]);
  }),

  /** Returns true if two configurations are near to each other, as a fraction of the joints' ranges. */
  near: (arm, a, b, part) => Math.max(...Places.apart(arm, a, b)) <= part,

  /** Returns the images of a configuration that differ by whole turns of continuous joints. */
  images: ({ joints }, q) => {
    const along = (k) => (joints[k].circle ? [-Geometry.TURN, 0, Geometry.TURN] : [0]).map((by) => q[k] + by);
    return along(0).flatMap((x) => along(1).map((y) => [x, y]));
  },

  /** Returns true if a polygon, given as a flat list of coordinates, contains a configuration. */
  within: (arm, q, flat) => {
    const corners = [...Geometry.pointsOf(flat)];
    return Places.images(arm, q).some(([x, y]) => corners.reduce((isInside, [x1, y1], i) => {
      const [x2, y2] = corners[(i + 1) % corners.length];
      return y1 > y !== y2 > y && x < x1 + ((x2 - x1) * (y - y1)) / (y2 - y1) ? !isInside : isInside;
    }, false));
  },

  /** Returns boxes, given as a flat list of least and greatest values, one by one. */
  boxes: (flat) => Array.from({ length: flat.length / 4 }, (_, k) => flat.slice(4 * k, 4 * k + 4)),

  /** Returns true if a box contains a configuration. */
  inBox: (arm, q, [x0, y0, x1, y1]) => Places.images(arm, q).some(([x, y]) => x >= x0 && x <= x1 && y >= y0 && y <= y1),

  /** Returns the length of a path. */
  length: (flat) => {
    const points = [...Geometry.pointsOf(flat)];
    return points.slice(1).reduce((sum, q, i) => sum + Math.hypot(q[0] - points[i][0], q[1] - points[i][1]), 0);
  },
};

// The course of the page: chapters with short lessons. Each lesson has a few sentences, one figure, and one question that
// the page checks. The page keeps the progress.
'use strict';

/**
 * A lesson.
 * @typedef {object} Lesson
 * @property {string} name
 * @property {string} figure 'move', 'think', 'slice' or 'pair': the motion, the planner's replay, a slice, or two polygons
 * @property {boolean} [isPlain] true if the figure shows only the arm, the obstacles and the C-obstacles
 * @property {(model: Model) => string} title
 * @property {(model: Model) => boolean} isOffered whether the model has the subject of the lesson
 * @property {(view: View) => string} text at most about sixty words
 * @property {(view: View) => QuestionModel} question
 */

/**
 * A chapter of the book.
 * @typedef {{ name: string, title: string, lessons: Lesson[] }} Chapter
 */

/** The chapters in the order of the book, with its names. @type {Chapter[]} */
const COURSE = [C_OBSTACLES, ROADMAPS, CELLS, WAVES, FIELDS, PROOFS, TASKS];

class Learn {
  /** @param {View} view */
  constructor(view) {
    this.view = view;
    /** The chapters that the model has lessons of. @type {Chapter[]} */
    this.chapters = [];
    /** Numbers of the current chapter and lesson. */
    [this.chapter, this.at] = [0, 0];
    /** True after the first lesson was opened. */
    this.isOpen = false;
    this.slices = new SliceFigure(this);
    this.pair = new PolygonFigure(this);
    this.question = new Question(() => this.solve());
    /** Names of the solved lessons, with their chapters. @type {Set<string>} */
    this.solved = new Set(Learn.remembered());
    const step = (by, text, name) => element('button', { type: 'button', class: `button ${name}`, onclick: () => this.move(by) }, text);
    this.parts = {
      chapter: element('select', { 'aria-label': 'chapter', onchange: (event) => this.open(event.target.value) }),
      progress: element('ol', { class: 'progress', 'aria-label': 'Lessons of this chapter' }),
      title: element('h2'),
      text: element('p', { class: 'text' }),
      back: step(-1, 'Back', 'back'),
      next: step(1, 'Next', 'next'),
      tables: element('div', { class: 'lesson' }),
    };
    const { parts } = this;
    this.head = element('section', { class: 'course-head', 'aria-label': 'Lesson', hidden: true }, element('div', { class: 'course-place' }, parts.chapter, parts.progress), parts.title, parts.text);
    this.foot = element('section', { class: 'course-foot', 'aria-label': 'Question', hidden: true }, this.question.root);
    this.steps = element('p', { class: 'course-steps', hidden: true }, parts.back, parts.next);
    this.details = element('section', { class: 'course-details', 'aria-label': 'Numbers of the figure', hidden: true }, this.pair.choice, parts.tables);
  }

  /** Returns a table. */
  static table(caption, head, rows) {
    return element(
      'table',
      {},
      element('caption', {}, caption),
      element('thead', {}, element('tr', {}, ...head.map((name) => element('th', { scope: 'col' }, name)))),
      element('tbody', {}, ...rows),
    );
  }

  // Chapters and lessons.

  /** Switches to another model. The current lesson stays if the model has it. */
  update(model) {
    const { name } = this.current ?? {};
    const chapter = this.chapters[this.chapter]?.name;
    this.slices.known = null;
    this.pair.update(model);
    this.chapters = COURSE
      .map((one) => ({ ...one, lessons: one.lessons.filter((lesson) => lesson.isOffered(model)) }))
      .filter(({ lessons }) => lessons.length);
    this.chapter = Math.max(0, this.chapters.findIndex((one) => one.name === chapter));
    this.at = Math.max(0, this.chapters[this.chapter]?.lessons.findIndex((lesson) => lesson.name === name) ?? 0);
  }

  /** Returns true if the model has anything to learn from. */
  get isOffered() {
    return this.chapters.length > 0;
  }

  /** Returns the current lesson. @returns {?Lesson} */
  get current() {
    return this.chapters[this.chapter]?.lessons[this.at] ?? null;
  }

  /** Returns the name of the current lesson. */
  get lesson() {
    return this.current?.name;
  }

  /** Returns the kind of the current figure. */
  get figure() {
    return this.current?.figure ?? 'move';
  }

  /** Returns the figure that has its own drawings, or `null`. @returns {SliceFigure | PolygonFigure | null} */
  get own() {
    return { slice: this.slices, pair: this.pair }[this.figure] ?? null;
  }

  get duration() {
    if (this.figure === 'slice') return SliceFigure.SECONDS;
    if (this.figure === 'pair') return this.pair.duration;
    return this.figure === 'think' ? Think.duration(this.view.replay) : this.view.motionDuration;
  }

  /**
   * Opens a place of the course: a chapter, a lesson, or both; returns false if the model has no such place.
   * @param {string} [name] name of a chapter, or of a lesson of any chapter
   * @param {string} [lesson] name of a lesson of the chapter
   * @returns {boolean}
   */
  open(name, lesson) {
    const at = (chapter, one) => this.chapters[chapter].lessons.findIndex((other) => other.name === one);
    let chapter = this.chapters.findIndex((one) => one.name === name);
    if (chapter < 0) {
      chapter = this.chapters.findIndex((_, k) => at(k, name) >= 0);
      lesson = name;
    }
    if (chapter < 0) return false;
    this.enter(chapter, Math.max(0, at(chapter, lesson)));
    return true;
  }

  /** Goes to the lesson before or after the current one, also across chapters. */
  move(by) {
    const at = this.at + by;
    if (this.chapters[this.chapter].lessons[at]) this.enter(this.chapter, at);
    else if (this.chapters[this.chapter + by]) this.enter(this.chapter + by, by > 0 ? 0 : this.chapters[this.chapter + by].lessons.length - 1);
    else return;
    // The buttons stay under the finger, but the reader begins with the text.
    this.reveal();
  }

  /** Begins a lesson, with a view of its figure that shows as much as possible. */
  enter(chapter, at) {
    const { view } = this;
    [this.chapter, this.at] = [chapter, at];
    this.isOpen = true;
    view.pause();
    view.examine(null);
    this.note(`#learn=${this.chapters[chapter].name}/${this.current.name}`);
    view.time = this.figure === 'think' ? this.duration : this.figure === 'slice' ? this.slices.richest : 0;
    view.ready();
  }

  /** Writes the place of the course into the address, so that it can be sent. Not in frames and on live pages. */
  note(hash) {
    if (window.parent === window && !this.view.recall && location.hash !== hash) history.replaceState(null, '', hash);
  }

  /** Shows the course again, or its first lesson, and scrolls to its text if that is out of sight. Frames in other pages do not scroll. */
  resume() {
    if (this.isOpen) this.view.ready();
    else this.enter(this.chapter, this.at);
    // In the next frame, the browser may scroll to keep the old content in place. So the text has its place in the one after.
    if (window.parent === window) requestAnimationFrame(() => requestAnimationFrame(() => this.reveal()));
  }

  /** Scrolls to the text of the lesson, unless its beginning is visible. */
  reveal() {
    const { top } = this.head.getBoundingClientRect();
    if (top < 0 || top >= window.innerHeight) this.head.scrollIntoView({ behavior: Settings.reducesMotion ? 'auto' : 'smooth' });
  }

  // Progress.

  /** Returns the names of the lessons that the reader has solved on earlier visits. @returns {string[]} */
  static remembered() {
    try {
      const names = JSON.parse(Settings.read('course') ?? '[]');
      return Array.isArray(names) ? names.filter((name) => typeof name === 'string') : [];
    } catch {
      return [];
    }
  }

  key(chapter, lesson) {
    return `${this.chapters[chapter].name}/${lesson.name}`;
  }

  /** Notes that the current lesson is solved. */
  solve() {
    this.solved.add(this.key(this.chapter, this.current));
    Settings.write('course', JSON.stringify([...this.solved].sort()));
    this.showProgress();
  }

  showProgress() {
    const { parts } = this;
    const { lessons } = this.chapters[this.chapter];
    const isSolved = (chapter) => (lesson) => this.solved.has(this.key(chapter, lesson));
    parts.chapter.replaceChildren(...this.chapters.map(({ name, title, lessons: own }, k) => {
      const done = own.filter(isSolved(k)).length;
      return element('option', { value: name, selected: k === this.chapter }, `${title}${done ? ` (${done} of ${own.length} solved)` : ''}`);
    }));
    parts.progress.replaceChildren(...lessons.map((lesson, k) => {
      const done = isSolved(this.chapter)(lesson);
      const label = `${k + 1}: ${lesson.title(this.view.model)}${done ? ', solved' : ''}`;
      const button = element('button', { type: 'button', 'aria-label': label, title: lesson.title(this.view.model), 'aria-current': k === this.at ? 'step' : undefined, class: done ? 'solved' : undefined, onclick: () => this.enter(this.chapter, k) }, done ? icon('found') : String(k + 1));
      return element('li', {}, button);
    }));
    parts.back.disabled = this.chapter === 0 && this.at === 0;
    // Until the question is solved, the button that checks the answer is the prominent one.
    parts.next.classList.toggle('primary', isSolved(this.chapter)(this.current));
    const isLast = this.at === lessons.length - 1;
    const next = this.chapters[this.chapter + 1];
    this.showHeading();
    parts.next.textContent = isLast && next ? `Next: ${next.title}` : 'Next';
    parts.next.disabled = isLast && !next;
  }

  // The page.

  /** Shows or hides the course. */
  show() {
    const { view, current, parts } = this;
    const isActive = view.mode === 'learn' && Boolean(current);
    const wasActive = view.root.classList.contains('learning');
    view.root.classList.toggle('learning', isActive);
    view.root.dataset.figure = isActive ? this.figure : '';
    this.head.hidden = this.foot.hidden = this.steps.hidden = !isActive;
    this.details.hidden = !isActive || !this.own;
    this.pair.root.hidden = !isActive || this.figure !== 'pair';
    this.pair.choice.hidden = this.figure !== 'pair';
    if (wasActive && !isActive) view.headings();
    if (!isActive) return;
    parts.title.textContent = current.title(view.model);
    parts.text.textContent = current.text(view);
    this.showProgress();
    if (this.figure === 'pair') this.pair.show();
  }

  /** Shows what the course is about, instead of the result. A live page keeps its own heading. */
  showHeading() {
    const { parts, recall } = this.view;
    if (recall) return;
    const lessons = this.chapters.flatMap(({ lessons: own }, k) => own.map((lesson) => this.key(k, lesson)));
    const solved = lessons.filter((lesson) => this.solved.has(lesson)).length;
    parts.title.textContent = `Learn: ${this.chapters[this.chapter].title}`;
    parts.lines.replaceChildren(element('p', {}, `${lessons.length} short lessons with questions, about this arm among its obstacles; ${solved} solved`));
  }

  /** Updates what depends on the figure. */
  changed() {
    if (this.view.mode !== 'learn' || !this.current) return;
    this.describe();
    if (this.figure === 'pair') this.pair.draw();
  }

  /** Writes the caption, the tables and the question of the figure. */
  describe() {
    const { own, view, parts } = this;
    this.question.show(this.key(this.chapter, this.current), () => this.current.question(view));
    if (!own) return;
    const { step } = view.parts;
    if (step.textContent !== own.caption) step.textContent = own.caption;
    parts.tables.replaceChildren(...own.tables());
  }

  /** Returns the text beside the scrubber for figures of lessons. */
  get clock() {
    return this.own.clock;
  }
}

// The live page: a world that is moved by hand, and the plan that follows.
'use strict';

/** Time after which a plan that is awaited is said to be, milliseconds. */
const NOTICED = 150;

class Live {
  constructor(root) {
    this.root = root;
    this.waiting = element('p', { class: 'waiting', role: 'status' }, 'Connecting\u2026');
    root.append(this.waiting);
    /** Times at which answers came while something moved. */
    this.beats = [];
    /** For whoever watches the page from outside. */
    this.answered = { id: 0, verdict: null, certified: false, final: false, error: null };
    this.link = new Link({
      hear: (message, about) => this.hear(message, about),
      file: (head, content) => this.hand(head, content),
      state: (isUp) => this.lineIs(isUp),
    });
  }

  /** Answers a second, while something is dragged. */
  get updatesPerSecond() {
    const now = performance.now();
    this.beats = this.beats.filter((beat) => now - beat < 1000);
    return this.beats.length;
  }

  // What the page is made of, once there is something to show.

  build(model) {
    this.waiting.remove();
    this.view = new View(this.root, model);
    this.editor = new Editor(this.view, {
      changed: (final) => this.changed(final),
      selected: () => this.controls?.follow(),
      postures: () => ({ start: this.places?.start, goals: this.places?.goals ?? [] }),
    });
    this.controls = new Controls(this);
    this.message = element('pre', { class: 'message', role: 'alert', hidden: true });
    this.figures = element('p', { class: 'figures' });
    this.spoken = element('p', { class: 'spoken', 'aria-live': 'polite' });
    const header = this.root.querySelector('header');
    header.after(this.controls.root);
    this.root.querySelector('.panels').after(this.message, this.figures, this.spoken, this.controls.files);
    this.root.querySelector('.help').before(this.controls.world);
    this.root.querySelector('.help dl').prepend(...[
      ['drag an obstacle, the start\u2019s tip (ring) or the goal (target)', 'the configuration space follows, the plan when you let go'],
      ['drag start (ring) or goal (diamond) in the configuration space', 'the same by joint values'],
      ['click an obstacle, then drag a corner or the rim', 'changes its shape; a double click on a side adds a corner'],
      ['arrow keys with something selected', 'move it (with Shift further)'],
      ['c', 'selects the next corner'],
      ['Delete', 'deletes the corner or the obstacle'],
      ['Ctrl+Z, Ctrl+Y', 'undo, redo'],
    ].flatMap(([keys, what]) => [element('dt', {}, keys), element('dd', {}, what)]));
    document.addEventListener('keydown', (event) => this.key(event));
    this.begin();
  }

  key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.target.matches?.('textarea, input')) return;
    const key = event.key.toLowerCase();
    if (key !== 'z' && key !== 'y') return;
    event.preventDefault();
    this.turn(key === 'y' || event.shiftKey ? 'redo' : 'undo');
  }

  /** Begins anew with a world. */
  begin() {
    this.scene = new Scene(this.world);
    this.changedSince = false;
    this.controls.use(this.world);
    this.controls.text.value = this.world.toml;
    this.editor.use(this.scene);
    this.tell(null);
  }

  // From the server.

  hear(message, about) {
    if (message.kind === 'world') {
      this.takeWorld(message);
    } else if (message.kind === 'failed') {
      this.answered = { ...this.answered, id: message.id, error: message.error };
      this.tell(message.error);
      this.mark();
    } else if (about.isAwaited) {
      clearTimeout(this.soon);
      if (!message.done) this.soon = setTimeout(() => this.preview(message), NOTICED);
      else if (message.final || !this.view) this.show(message, about);
      else this.showSoon(message, about);
    }
  }

  takeWorld(world) {
    const lost = world.id === null && this.text;
    this.world = world;
    if (lost) {
      // The server has forgotten the page while the line was down.
      this.link.load(this.text, this.controls.words);
      return;
    }
    this.places = { start: world.start, goals: [] };
    if (this.view) this.begin();
    if (world.id === null) this.plan(true);
  }

  /** The configuration space before its plan, which takes long. */
  preview(message) {
    this.take(message);
    this.figures.textContent = 'planning\u2026';
  }

  /** Draws the latest answer with the next picture of the screen. */
  showSoon(message, about) {
    const waits = this.latest;
    this.latest = () => this.show(message, about);
    if (waits) return;
    requestAnimationFrame(() => {
      const show = this.latest;
      this.latest = null;
      show?.();
    });
  }

  show(message, { since }) {
    this.latest = null;
    if (!message.final) this.beats.push(performance.now());
    this.took = performance.now() - since;
    this.take(message);
    const { id, verdict, certified, error } = message;
    this.answered = { id, verdict, certified, final: message.final, error, figures: message.figures };
    if (message.toml) {
      this.text = message.toml;
      if (document.activeElement !== this.controls.text) this.controls.text.value = message.toml;
    }
    this.tell(error);
    this.sum(message);
    this.mark();
  }

  /** Draws an answer. */
  take(message) {
    if (message.start) {
      this.places = { start: message.start, goals: message.goals };
      // Where the tip was dragged to, the arm is now.
      const { scene } = this;
      if (scene?.start?.tip && message.final && message.done) {
        scene.start = { joints: message.start };
        scene.kept = scene.snapshot();
      }
    }
    if (!message.view) return;
    if (!this.view) this.build(message.view);
    else {
      const light = !message.final || !message.done;
      // What holds for places along the way only would jump: facts come when all of them are known.
      if (!message.view.facts.length) message.view.facts = this.view.model.facts;
      this.view.light = light;
      this.root.classList.toggle('light', light);
      this.view.update(message.view);
    }
    this.controls.follow();
  }

  /** The figures, in a line. */
  sum({ figures, reason, final, verdict, certified, error }) {
    this.root.classList.toggle('known', final && !error);
    if (error) {
      this.figures.textContent = '';
      return;
    }
    const { length, lower_bound: bound, clearance, duration, size, milliseconds } = figures;
    const parts = [
      verdict && (certified ? 'found and certified' : verdict === 'infeasible' ? 'no path: proven' : verdict),
      length && `length ${length.toFixed(4)}`,
      bound && `at most ${(100 * Math.max(0, length / bound - 1)).toPrecision(2)} % longer than the shortest`,
      clearance && `clearance ${(1000 * clearance).toPrecision(3)} mm proven`,
      duration && `motion ${duration.toFixed(3)} s`,
      size,
      `planned in ${milliseconds.toFixed(milliseconds < 10 ? 1 : 0)} ms`,
      !final && `${this.updatesPerSecond} updates/s`,
      verdict !== 'found' && reason,
    ].filter(Boolean);
    this.figures.textContent = parts.join(' \u00b7 ');
    if (final) this.spoken.textContent = parts.slice(0, 5).join(', ');
  }

  /** A message about what is wrong; none for none. */
  tell(error) {
    if (!this.message) {
      if (error) this.waiting.textContent = error;
      return;
    }
    this.message.hidden = !error;
    if (this.message.textContent !== (error ?? '')) this.message.textContent = error ?? '';
  }

  lineIs(isUp) {
    this.isUp = isUp;
    if (this.view) this.tell(isUp ? null : 'The connection to cplan is lost; trying again\u2026');
    else if (!isUp) this.waiting.textContent = 'cplan does not answer; trying again\u2026';
    this.mark();
  }

  /** Says so when what is shown is not what is asked for. */
  mark() {
    clearTimeout(this.late);
    const isBehind = Boolean(this.link?.awaited || this.link?.next);
    const show = (behind) => this.root.classList.toggle('behind', behind || !this.isUp);
    if (isBehind) this.late = setTimeout(() => show(true), NOTICED);
    else show(false);
  }

  // To the server.

  get body() {
    const state = this.changedSince && !this.world.has_steps ? this.scene.request() : null;
    return { base: this.world.base, state, options: this.controls ? this.controls.words : this.world.options };
  }

  plan(final) {
    this.link.plan(() => this.body, final);
    this.mark();
  }

  changed(final) {
    this.changedSince = true;
    if (final) this.scene.settle();
    this.controls.follow();
    this.plan(final);
  }

  /** Keeps that far from obstacles, metres. */
  keep(clearance) {
    this.scene.clearance = clearance;
    this.changed(true);
  }

  turn(way) {
    if (!this.scene[way]()) return;
    this.changedSince = true;
    this.controls.clearance.value = String(+(this.scene.clearance * 1000).toFixed(3));
    this.editor.select(null);
    this.plan(true);
  }

  load(text) {
    this.link.load(text, this.controls.words);
    this.mark();
  }

  save(format) {
    this.link.download(this.body, format);
    this.mark();
  }

  hand({ name }, content) {
    const address = URL.createObjectURL(new Blob([content]));
    element('a', { href: address, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
    this.mark();
  }
}

window.cplan = new Live(document.querySelector('main'));

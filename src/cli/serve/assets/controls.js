// The controls: what can be added, the planner and its options, files.
'use strict';

/** Options with a control of their own: which planners have them, and their values. */
const OPTIONS = {
  '--gap': { label: 'proven within', planners: ['visibility'], values: { '': 'as it comes', 0.01: '1 %', 0.001: '0.1 %', 0.0001: '0.01 %' } },
  '--metric': { label: 'short means', planners: ['visibility'], values: { '': 'length', time: 'travel time' } },
  '--cells': { label: 'cells', planners: ['wavefront', 'harmonic'], values: { 64: '64', 128: '128', '': '256', 512: '512', 1024: '1024' } },
  '--path': { label: 'path', planners: ['trapezoid', 'wavefront', 'harmonic', 'subdivision'], values: { '': "planner's default", own: 'its own', taut: 'pulled taut' } },
  '--search': { label: 'search', planners: ['wavefront'], values: { '': 'wave', bfs: 'bfs', dfs: 'dfs', dijkstra: 'dijkstra', astar: 'A*' } },
  '--neighbors': { label: 'neighbours', planners: ['wavefront'], values: { '': '4', 8: '8' } },
};
const FILES = {
  toml: 'world (.toml)', json: 'result (.json)', csv: 'trajectory (.csv)', yaml: 'trajectory (.yaml, ROS 2)', svg: 'picture (.svg)',
  png: 'picture (.png)', html: 'page (.html)',
};

class Controls {
  /** `live` is what the buttons call: see there. */
  constructor(live) {
    this.live = live;
    const button = (text, label, action) => element('button', { type: 'button', class: 'button', 'aria-label': label, title: label, onclick: action }, text);
    const { editor } = live;
    this.things = element('select', { 'aria-label': 'selected', onchange: (event) => this.choose(event.target.value) });
    this.remove = button('Delete', 'delete what is selected', () => editor.remove());
    this.corner = button('+ corner', 'add a corner to the longest side', () => editor.insertCorner());
    this.undo = button('\u21b6', 'undo', () => live.turn('undo'));
    this.redo = button('\u21b7', 'redo', () => live.turn('redo'));
    this.clearance = element('input', {
      type: 'number', min: '0', step: '1', inputmode: 'decimal', 'aria-label': 'clearance in millimetres',
      onchange: () => live.keep(Math.max(0, Number(this.clearance.value) || 0) / 1000),
    });
    this.planner = element('select', { 'aria-label': 'planner', onchange: () => this.replan() });
    this.options = {};
    const options = Object.entries(OPTIONS).map(([name, { label, values }]) => {
      const entries = Object.entries(values).map(([value, text]) => element('option', { value }, text));
      this.options[name] = element('select', { onchange: () => this.replan(), 'data-option': name }, ...entries);
      return element('label', {}, `${label} `, this.options[name]);
    });
    this.more = element('input', {
      type: 'text', class: 'more', spellcheck: 'false', autocomplete: 'off', placeholder: '--field oriented --epsilon 0.5 --direction 0,-1',
      'aria-label': 'more options, as on the command line', onchange: () => this.replan(),
    });
    this.command = element('code', {});
    this.edit = element(
      'div', { class: 'group' }, this.things, this.corner, this.remove,
      button('+ polygon', 'add a polygon', () => editor.add('polygon')), button('+ circle', 'add a circle', () => editor.add('circle')),
      button('+ wall', 'add a thin wall', () => editor.add('wall')), this.undo, this.redo,
      element('label', {}, 'clearance ', this.clearance, ' mm'),
    );
    this.root = element(
      'section', { class: 'controls', 'aria-label': 'World and planner' },
      this.edit,
      element('div', { class: 'group' }, element('label', {}, 'planner ', this.planner), ...options, element('label', {}, 'more ', this.more)),
    );
    this.world = this.textPart(button);
  }

  /** The world as text, and files. */
  textPart(button) {
    const { live } = this;
    this.text = element('textarea', { rows: '16', spellcheck: 'false', autocomplete: 'off', 'aria-label': 'world as TOML' });
    this.file = element('input', { type: 'file', accept: '.toml', hidden: true, onchange: () => this.open() });
    this.format = element('select', { 'aria-label': 'file to save' }, ...Object.entries(FILES).map(([value, text]) => element('option', { value }, text)));
    return element(
      'details', { class: 'world' },
      element('summary', {}, 'World as text'),
      element('p', {}, element('label', {}, this.text)),
      button('Plan in this world', 'take the text for the world', () => live.load(this.text.value)),
    );
  }

  /** Buttons for files, which are always at hand. */
  get files() {
    const { live } = this;
    const button = (text, action) => element('button', { type: 'button', class: 'button', onclick: action }, text);
    return element(
      'div', { class: 'group files' }, button('Open world\u2026', () => this.file.click()), this.file, this.format,
      button('Save', () => live.save(this.format.value)), element('span', { class: 'command' }, 'as a command: ', this.command),
    );
  }

  async open() {
    const [file] = this.file.files;
    this.file.value = '';
    if (file) this.live.load(await file.text());
  }

  /** Takes planner and options apart into the controls. */
  use(world) {
    this.planner.replaceChildren(...world.planners.map((name) => element('option', { value: name }, name)));
    if (world.options) {
      const [planner, ...words] = world.options.split(/\s+/);
      this.planner.value = planner;
      const rest = [];
      while (words.length) {
        const word = words.shift();
        const [name, ...joined] = word.split('=');
        const control = this.options[name];
        const value = joined.length ? joined.join('=') : words[0];
        if (control && [...control.options].some((option) => option.value === value)) {
          control.value = value;
          if (!joined.length) words.shift();
        } else rest.push(word);
      }
      this.more.value = rest.join(' ');
    } else this.planner.value = this.chosen ?? this.planner.value;
    this.edit.hidden = world.has_steps;
    this.clearance.value = String(+(world.clearance * 1000).toFixed(3));
    this.show();
  }

  /** Planner and options as on the command line. */
  get words() {
    const planner = this.planner.value;
    const of = ([name, { planners }]) => (planners.includes(planner) && this.options[name].value !== '' ? [name, this.options[name].value] : []);
    return [planner, ...Object.entries(OPTIONS).flatMap(of), ...this.more.value.trim().split(/\s+/).filter(Boolean)].join(' ');
  }

  replan() {
    this.show();
    this.live.plan(true);
  }

  /** Which options there are depends on the planner. */
  show() {
    this.chosen = this.planner.value;
    for (const [name, { planners }] of Object.entries(OPTIONS)) this.options[name].parentElement.hidden = !planners.includes(this.planner.value);
    this.command.textContent = `cplan ROBOT.urdf WORLD.toml --planner ${this.words}`;
  }

  // What is selected.

  choose(value) {
    const [kind, index] = value.split(' ');
    this.live.editor.select(!kind ? null : kind === 'obstacle' ? { kind, index: Number(index), corner: null } : { kind });
    this.live.view.panels.workspace.canvas.focus({ preventScroll: true });
  }

  /** Follows the editor. */
  follow() {
    const { scene, selection } = this.live.editor;
    if (!scene) return;
    const value = !selection ? '' : selection.kind === 'obstacle' ? `obstacle ${selection.index}` : selection.kind;
    const entries = [['', 'nothing selected'], ['start', 'start'], ['goal', 'goal'], ...scene.obstacles.map(({ name }, i) => [`obstacle ${i}`, name])];
    const signature = JSON.stringify(entries);
    if (signature !== this.signature) {
      this.signature = signature;
      this.things.replaceChildren(...entries.map(([of, text]) => element('option', { value: of }, text)));
    }
    this.things.value = value;
    const shape = this.live.editor.obstacle?.shape;
    this.remove.disabled = selection?.kind !== 'obstacle';
    this.corner.disabled = !shape || Boolean(shape.circle);
    this.undo.disabled = !scene.past.length;
    this.redo.disabled = !scene.future.length;
  }
}

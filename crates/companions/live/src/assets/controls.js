// The controls: the toolbar, the planner and its options, the world as text.
'use strict';

const FILES = [
  ['toml', 'world (.toml)'], ['json', 'result (.json)'], ['csv', 'trajectory (.csv)'], ['yaml', 'trajectory (.yaml, ROS 2)'],
  ['svg', 'picture (.svg)'], ['png', 'picture (.png)'], ['html', 'page (.html)'],
];

/** Returns entries of a menu from pairs of value and label, in this order. */
const entries = (pairs) => pairs.map(([value, text]) => element('option', { value }, text));

class Controls {
  /** `live` is the page that the buttons act on. */
  constructor(live) {
    this.live = live;
    const { editor } = live;
    this.selected = element('select', { 'aria-label': 'selected', autocomplete: 'off', onchange: (event) => this.choose(event.target.value) });
    this.inspector = new Inspector(editor, this.selected);
    this.remove = iconButton('remove', 'delete the selection', () => editor.remove(), 'Delete');
    this.corner = iconButton('corner', 'add a corner to the longest side', () => editor.insertCorner(), 'double click on a side');
    this.cornerMode = iconButton('corners', 'drag corners', () => editor.setCornerMode(!editor.editsCorners));
    // Elsewhere corners can always be dragged.
    const offerCornerMode = () => {
      this.cornerMode.hidden = !Editor.hasCornerMode.matches;
      editor.setCornerMode(this.cornerMode.hidden);
    };
    Editor.hasCornerMode.addEventListener('change', offerCornerMode);
    this.cornerMode.hidden = !Editor.hasCornerMode.matches;
    this.undo = iconButton('undo', 'undo', () => live.stepHistory('undo'), 'Ctrl+Z');
    this.redo = iconButton('redo', 'redo', () => live.stepHistory('redo'), 'Ctrl+Y');
    this.clearance = element('input', {
      type: 'number', min: '0', step: '1', inputmode: 'decimal', autocomplete: 'off', 'aria-label': 'clearance in millimetres',
      onchange: () => live.setClearance(Math.max(0, Number(this.clearance.value) || 0) / 1000),
    });
    this.clearanceLabel = element('label', {}, 'clearance ', this.clearance, ' mm');
    this.planner = element('select', { 'aria-label': 'planner', autocomplete: 'off', onchange: () => this.replan(true) });
    this.menus = element('div', { class: 'group menus' });
    this.more = element('input', {
      type: 'text', class: 'more', spellcheck: 'false', autocomplete: 'off', autocapitalize: 'off', placeholder: '--field oriented --epsilon 0.5',
      'aria-label': 'other options, as on the command line', onchange: () => this.replan(),
    });
    this.command = element('code', {});
    const group = (label, ...children) => element('div', { class: 'tools', role: 'group', 'aria-label': label }, ...children);
    /** Groups that change the world; hidden for tasks. */
    this.edits = [
      group('History', this.undo, this.redo),
      group('Add', ...[['polygon', 'add a polygon'], ['circle', 'add a circle'], ['wall', 'add a thin wall']].map(([kind, label]) => iconButton(kind, label, () => editor.add(kind)))),
      group('Selected obstacle', this.cornerMode, this.corner, this.remove),
    ];
    this.files = group('Files', ...this.fileTools());
    this.toolbar = element('section', { class: 'toolbar', 'aria-label': 'Tools' }, ...this.edits);
    this.root = element(
      'section', { class: 'controls', 'aria-label': 'Planner' },
      element('div', { class: 'group' }, element('label', {}, 'planner ', this.planner), this.menus, this.clearanceLabel, element('label', { class: 'grows' }, 'more ', this.more)),
    );
    this.remarks = element('span', { class: 'remark', role: 'status' }, live.remarked ?? '');
    this.commandLine = element('p', { class: 'command' }, 'as a command: ', this.command);
    this.world = this.textPart();
  }

  /** Creates the part with the world as text. */
  textPart() {
    const { live } = this;
    this.text = element('textarea', {
      rows: '16', spellcheck: 'false', autocomplete: 'off', 'aria-label': 'world as TOML',
      oninput: () => {
        this.isTyped = true;
        live.notices.show('text', null);
      },
    });
    return element(
      'details', { class: 'world' },
      element('summary', {}, 'World as text'),
      element('p', {}, element('label', {}, this.text)),
      live.notices.places.text,
      element('button', { type: 'button', class: 'button', onclick: () => live.load(this.text.value) }, 'Plan in this world'),
    );
  }

  /** Creates the tools that open and save files. */
  fileTools() {
    const { live } = this;
    this.file = element('input', { type: 'file', accept: '.toml', hidden: true, onchange: () => this.open() });
    this.format = element('select', { 'aria-label': 'file to save', autocomplete: 'off' }, ...entries(live.gallery.isAlone ? FILES.filter(([name]) => name !== 'png') : FILES));
    return [
      iconButton('open', 'open a world file', () => this.file.click()), this.file,
      iconButton('save', 'save as', () => live.save(this.format.value)), this.format,
      iconButton('restart', 'start again with the first world', () => live.reset()),
    ];
  }

  async open() {
    const [file] = this.file.files;
    this.file.value = '';
    if (file) this.live.load(await file.text(), true);
  }

  /** Shows the world's text, unless the user is typing there. */
  showText(text) {
    if (this.isTyped && this.text.value !== this.shownText) return;
    this.isTyped = false;
    this.shownText = text;
    this.text.value = text;
  }

  remark(text) {
    this.remarks.textContent = text;
  }

  /** Marks the typed options as wrong, or removes the mark. */
  markInvalid(isWrong) {
    if (isWrong) this.more.setAttribute('aria-invalid', 'true');
    else this.more.removeAttribute('aria-invalid');
  }

  /** Shows another world. */
  showWorld(world, scene) {
    this.planners = world.menus;
    this.planner.replaceChildren(...entries(this.planners.map(({ name }) => [name, name])));
    this.showOptions(this.live.words);
    for (const part of [...this.edits, this.inspector.root, this.clearanceLabel]) part.hidden = world.has_steps;
    this.isTyped = false;
    this.showClearance(scene);
    this.showCommand();
  }

  showClearance(scene) {
    this.clearance.value = String(+(scene.clearance * 1000).toFixed(3));
  }

  /** Distributes planner and options over the controls. */
  showOptions(text) {
    const [planner, ...words] = text.split(/\s+/);
    this.planner.value = planner;
    const chosen = new Map();
    const rest = [];
    const options = this.options;
    while (words.length) {
      const word = words.shift();
      const [name, ...joined] = word.split('=');
      const option = options.find((one) => one.name === name);
      const value = joined.length ? joined.join('=') : words[0];
      const isListed = option && (value === option.standard || option.values.some(([one]) => one === value));
      if (isListed && !chosen.has(name)) {
        chosen.set(name, value);
        if (!joined.length) words.shift();
      } else rest.push(word);
    }
    this.more.value = rest.join(' ');
    this.showMenus(chosen);
  }

  /** Returns the menus of the chosen planner. */
  get options() {
    return this.planners.find(({ name }) => name === this.planner.value)?.options ?? [];
  }

  /** Creates the planner's menus. The entry for the default sends nothing, so that the program chooses. Numbers ascend. */
  showMenus(chosen) {
    this.selects = this.options.map(({ name, label, standard, values }) => {
      const size = Number.parseFloat(standard);
      const larger = values.findIndex(([value]) => Number(value) >= size);
      const pairs = values.toSpliced(Math.max(0, larger), 0, ['', standard]);
      const select = element('select', { autocomplete: 'off', 'data-option': name, onchange: () => this.replan() }, ...entries(pairs));
      select.value = values.some(([value]) => value === chosen.get(name)) ? chosen.get(name) : '';
      return [name, select, element('label', {}, `${label} `, select)];
    });
    this.menus.replaceChildren(...this.selects.map(([, , label]) => label));
  }

  /** Returns planner and options as on the command line. */
  get words() {
    const chosen = this.selects.flatMap(([name, { value }]) => (value === '' ? [] : [name, value]));
    return [this.planner.value, ...chosen, ...this.more.value.trim().split(/\s+/).filter(Boolean)].join(' ');
  }

  /** Plans with the current choices. Another planner shows its own menus; those with the same names keep their values. */
  replan(isOther = false) {
    if (isOther) this.showMenus(new Map(this.selects.map(([name, { value }]) => [name, value])));
    this.showCommand();
    this.live.choose(this.words);
  }

  showCommand() {
    this.command.textContent = `cplan ROBOT.urdf WORLD.toml --planner ${this.words}`;
  }

  // Selection.

  choose(value) {
    const [kind, index] = value.split(' ');
    this.live.editor.select(!kind ? null : kind === 'obstacle' ? { kind, index: Number(index), corner: null } : { kind });
    this.live.editor.focus();
  }

  /** Updates the controls after a change in the editor. */
  updateSelection() {
    const { scene, selection } = this.live.editor;
    if (!scene) return;
    const value = !selection ? '' : selection.kind === 'obstacle' ? `obstacle ${selection.index}` : selection.kind;
    const pairs = [['', 'nothing'], ['start', 'start'], ['goal', 'goal'], ...scene.obstacles.map(({ name }, i) => [`obstacle ${i}`, name])];
    const signature = JSON.stringify(pairs);
    if (signature !== this.signature) {
      this.signature = signature;
      this.selected.replaceChildren(...entries(pairs));
    }
    this.selected.value = value;
    const shape = this.live.editor.obstacle?.shape;
    this.cornerMode.setAttribute('aria-pressed', String(this.live.editor.editsCorners));
    this.remove.disabled = selection?.kind !== 'obstacle';
    this.corner.disabled = !shape || Boolean(shape.circle);
    this.undo.disabled = !scene.past.length;
    this.redo.disabled = !scene.future.length;
    this.inspector.update();
  }
}

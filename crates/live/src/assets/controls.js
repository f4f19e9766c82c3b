// The controls: buttons that add something, the planner and its options, files.
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
    const button = (text, label, action) => element('button', { type: 'button', class: 'button', 'aria-label': label, title: label, onclick: action }, text);
    const { editor } = live;
    this.selected = element('select', { class: 'selected', 'aria-label': 'selected', autocomplete: 'off', onchange: (event) => this.choose(event.target.value) });
    this.remove = button('Delete', 'delete what is selected', () => editor.remove());
    this.corner = button('+ corner', 'add a corner to the longest side', () => editor.insertCorner());
    this.undo = button('\u21b6', 'undo', () => live.stepHistory('undo'));
    this.redo = button('\u21b7', 'redo', () => live.stepHistory('redo'));
    this.clearance = element('input', {
      type: 'number', min: '0', step: '1', inputmode: 'decimal', autocomplete: 'off', 'aria-label': 'clearance in millimetres',
      onchange: () => live.setClearance(Math.max(0, Number(this.clearance.value) || 0) / 1000),
    });
    this.planner = element('select', { 'aria-label': 'planner', autocomplete: 'off', onchange: () => this.replan(true) });
    this.menus = element('div', { class: 'group menus' });
    this.more = element('input', {
      type: 'text', class: 'more', spellcheck: 'false', autocomplete: 'off', autocapitalize: 'off', placeholder: '--field oriented --epsilon 0.5 --direction 0,-1',
      'aria-label': 'more options, as on the command line', onchange: () => this.replan(),
    });
    this.command = element('code', {});
    this.edit = element(
      'div', { class: 'group' }, this.selected, this.corner, this.remove,
      button('+ polygon', 'add a polygon', () => editor.add('polygon')), button('+ circle', 'add a circle', () => editor.add('circle')),
      button('+ wall', 'add a thin wall', () => editor.add('wall')), this.undo, this.redo,
      element('label', {}, 'clearance ', this.clearance, ' mm'),
    );
    this.root = element(
      'section', { class: 'controls', 'aria-label': 'World and planner' },
      this.edit,
      element('div', { class: 'group' }, element('label', {}, 'planner ', this.planner), this.menus, element('label', {}, 'more ', this.more)),
    );
    this.files = this.filePart();
    this.world = this.textPart(button);
  }

  /** Creates the part with the world as text. */
  textPart(button) {
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
      button('Plan in this world', 'take the text for the world', () => live.load(this.text.value)),
    );
  }

  /** Creates the buttons for files, which are always visible. */
  filePart() {
    const { live } = this;
    const button = (text, action, label) => element('button', { type: 'button', class: 'button', title: label, onclick: action }, text);
    this.file = element('input', { type: 'file', accept: '.toml', hidden: true, onchange: () => this.open() });
    this.format = element('select', { 'aria-label': 'file to save', autocomplete: 'off' }, ...entries(live.gallery.isAlone ? FILES.filter(([name]) => name !== 'png') : FILES));
    this.remarks = element('span', { class: 'remark', role: 'status' }, live.remarked ?? '');
    return element(
      'div', { class: 'group files' }, button('Open world\u2026', () => this.file.click()), this.file, this.format,
      button('Save', () => live.save(this.format.value)),
      button('Start again', () => live.reset(), 'back to the world that cplan was started with'),
      this.remarks, element('span', { class: 'command' }, 'as a command: ', this.command),
    );
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
    this.edit.hidden = world.has_steps;
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
    const pairs = [['', 'nothing selected'], ['start', 'start'], ['goal', 'goal'], ...scene.obstacles.map(({ name }, i) => [`obstacle ${i}`, name])];
    const signature = JSON.stringify(pairs);
    if (signature !== this.signature) {
      this.signature = signature;
      this.selected.replaceChildren(...entries(pairs));
    }
    this.selected.value = value;
    const shape = this.live.editor.obstacle?.shape;
    this.remove.disabled = selection?.kind !== 'obstacle';
    this.corner.disabled = !shape || Boolean(shape.circle);
    this.undo.disabled = !scene.past.length;
    this.redo.disabled = !scene.future.length;
  }
}

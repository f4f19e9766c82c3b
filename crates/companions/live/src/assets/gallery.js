// The gallery: worlds and puzzles to open, and links that contain a world.
'use strict';

/** Packed text in an address: deflated, and written with letters that an address may contain. */
const Packed = {
  async through(stream, bytes) {
    return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
  },

  async write(text) {
    const bytes = await Packed.through(new CompressionStream('deflate-raw'), new TextEncoder().encode(text));
    const letters = Array.from(bytes, (byte) => String.fromCodePoint(byte)).join('');
    return btoa(letters).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
  },

  async read(packed) {
    const bytes = Uint8Array.from(atob(packed.replaceAll('-', '+').replaceAll('_', '/')), (letter) => letter.codePointAt(0));
    return new TextDecoder().decode(await Packed.through(new DecompressionStream('deflate-raw'), bytes));
  },
};

/** The rules of puzzles: the allowed changes, and the test of a solution. */
const Puzzles = {
  /** Returns true if two shapes differ only by a translation. */
  moved(a, b) {
    const points = (shape) => (shape?.circle ? [shape.circle.center] : Shapes.corners(shape) ?? []);
    const [from, to] = [points(a), points(b)];
    if (from.length !== to.length || a?.circle?.radius !== b?.circle?.radius) return false;
    const [dx, dy] = from.length ? [0, 1].map((k) => to[0][k] - from[0][k]) : [0, 0];
    // Each coordinate is rounded separately.
    return from.every(([x, y], i) => Math.hypot(to[i][0] - x - dx, to[i][1] - y - dy) < 5e-4);
  },

  /** Describes a change against the rules; `null` if there is none. */
  fault({ free }, scene) {
    const first = JSON.parse(scene.first);
    const same = (key) => JSON.stringify(first[key]) === JSON.stringify(scene[key]);
    if (!same('start') || !same('goal')) return 'Leave start and goal where they were.';
    if (free === 'clearance') return same('obstacles') ? null : 'Leave the obstacles where they were; change the clearance.';
    if (!same('clearance')) return 'Leave the clearance as it was.';
    const { obstacles } = scene;
    const areThere = obstacles.length === first.obstacles.length && obstacles.every(({ from }, i) => from === i);
    if (!areThere) return 'Do not add or delete obstacles; move the present ones.';
    return obstacles.every(({ shape }, i) => Puzzles.moved(first.obstacles[i].shape, shape)) ? null : 'Move the obstacles, but do not change their shapes.';
  },

  /** Returns true if an answer solves the puzzle. */
  isSolved({ verdict, length, clearance }, answered, scene) {
    if (answered.error || answered.verdict !== verdict) return false;
    if (length && !(answered.figures.lower_bound >= length)) return false;
    return !clearance || scene.clearance >= clearance;
  },
};

class Gallery {
  /** @param {Live} live */
  constructor(live) {
    this.live = live;
    const { alone, robots, choices } = JSON.parse(document.getElementById('gallery').textContent);
    /** Initial files of the page, if the program is inside it; otherwise `null`, and the server has them. */
    this.files = alone?.[0] ?? null;
    /** Time that a plan may take, in seconds. */
    this.seconds = alone?.[1] ?? null;
    this.robots = robots;
    this.choices = choices;
    /** The choice that the address names. @type {any} */
    this.choice = null;
    /** Name in the address, without its number sign. `undefined` before the first world. @type {string | undefined} */
    this.name = undefined;
    /** True if the address has changed to another world. */
    this.hasMoved = false;
    /** Reason why the puzzle is not solved. @type {?string} */
    this.fault = null;
    const groups = [['worlds', (one) => !one.puzzle], ['puzzles', (one) => one.puzzle]].map(([label, isOf]) => (
      element('optgroup', { label }, ...choices.filter(isOf).map(({ name, title }) => element('option', { value: name }, title)))
    ));
    this.select = element('select', { 'aria-label': 'world to open', autocomplete: 'off', onchange: () => this.go(this.select.value) }, element('option', { value: '' }, 'this page\u2019s'), ...groups);
    this.copy = iconButton('link', 'copy link', () => this.link());
    this.task = element('p', { class: 'task', role: 'status' });
    this.root = element('div', { class: 'group gallery' }, element('label', {}, 'open ', this.select), this.copy);
    window.addEventListener('hashchange', () => {
      // Quick steps through the history announce the last address several times.
      if (location.hash === this.linked || location.hash.slice(1) === this.name) return;
      live.remark('');
      this.open();
    });
  }

  /** Returns true if the program is inside the page. */
  get isAlone() {
    return Boolean(this.files);
  }

  /** Opens a connection to the program. */
  openSocket() {
    return this.isAlone ? new Alone(() => this.seconds) : Link.server();
  }

  /** Opens the world that the address names. */
  async open() {
    const { live } = this;
    live.keepEdits();
    const { socket } = live.link;
    const { hash } = location;
    const files = await this.read();
    // If the address or the connection has changed in the meantime, that change opens a world itself.
    if (hash !== location.hash || socket !== live.link.socket || !live.link.isUp) return;
    live.link.open(files);
    live.updateState();
  }

  /** Returns the files of the address: a choice by its name, or files packed in it; otherwise the initial files. */
  async read() {
    const [, name] = /^#(.*)$/.exec(location.hash) ?? [];
    Object.assign(this, { hasMoved: this.name !== undefined && this.name !== (name ?? ''), name: name ?? '', fault: null, isSolved: false, isOwn: false });
    this.choice = this.choices.find((one) => one.name === name) ?? null;
    this.select.value = this.choice?.name ?? '';
    if (this.choice) return { urdf: this.robots[this.choice.robot], world: this.choice.world, options: 'shortest' };
    if (!name?.startsWith('w=')) return this.ownFiles();
    try {
      const { urdf, world, options } = JSON.parse(await Packed.read(name.slice(2)));
      return { urdf, world, options };
    } catch {
      return this.ownWithRemark();
    }
  }

  /** Returns the initial files. */
  ownFiles() {
    this.isOwn = true;
    return this.files;
  }

  /** Returns the initial files with a remark, if the world in the address cannot be opened. */
  ownWithRemark() {
    this.live.remark('The world in the address cannot be read, so the page shows its own world.');
    return this.ownFiles();
  }

  /** Opens another world by its name. */
  go(name) {
    location.hash = name;
  }

  /** Copies an address of the current world to the clipboard, or writes it into the address bar if there is no clipboard. */
  async link() {
    const { toml, words, first: { urdf } } = this.live;
    const packed = `#w=${await Packed.write(JSON.stringify({ urdf, world: toml, options: words }))}`;
    try {
      await navigator.clipboard.writeText(`${location.href.split('#', 1)[0]}${packed}`);
      this.live.remark('Link copied. It contains arm, world and options.');
    } catch {
      this.linked = packed;
      location.hash = packed;
      this.live.remark('The address of this page is now the link. It contains arm, world and options.');
    }
  }

  /** Shows the task of the puzzle, and whether it is solved. */
  showTask() {
    const isWhole = Boolean(this.live.first?.urdf);
    this.copy.disabled = !isWhole || !this.live.isCurrent;
    this.copy.title = isWhole ? 'copy an address that contains arm, world and options' : 'not possible: arm or world name other files, which an address cannot contain';
    const { puzzle } = this.choice ?? {};
    const { scene, answered } = this.live;
    if (!puzzle || !scene) {
      this.task.textContent = '';
      return;
    }
    if (this.live.isCurrent) {
      this.fault = this.live.world.toml === this.choice.world ? Puzzles.fault(puzzle, scene) : 'This is another world; start again.';
      this.isSolved = !this.fault && Puzzles.isSolved(puzzle, answered, scene);
    }
    const state = this.fault ?? (this.isSolved ? '\u2714 Solved.' : '');
    const text = `${puzzle.text} ${state}`.trim();
    if (this.task.textContent !== text) this.task.textContent = text;
    this.task.classList.toggle('solved', this.isSolved);
  }
}

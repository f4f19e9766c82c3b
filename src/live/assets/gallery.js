// What a page without a server has in place of one: worlds and puzzles to open, and links that hold a world.
'use strict';

/** Text in an address, packed: deflated, in letters that an address may have. */
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

/** What a puzzle allows to change, and whether the end is reached. */
const Puzzles = {
  /** Whether two shapes differ by where they are alone. */
  moved(a, b) {
    const points = (shape) => (shape?.circle ? [shape.circle.center] : Shapes.corners(shape) ?? []);
    const [from, to] = [points(a), points(b)];
    if (from.length !== to.length || a?.circle?.radius !== b?.circle?.radius) return false;
    const [dx, dy] = from.length ? [0, 1].map((k) => to[0][k] - from[0][k]) : [0, 0];
    // Places are rounded, each by itself.
    return from.every(([x, y], i) => Math.hypot(to[i][0] - x - dx, to[i][1] - y - dy) < 5e-4);
  },

  /** What was changed against the rules, in words; none for nothing. */
  fault({ free }, scene) {
    const first = JSON.parse(scene.first);
    const same = (key) => JSON.stringify(first[key]) === JSON.stringify(scene[key]);
    if (!same('start') || !same('goal')) return 'Start and goal have to stay.';
    if (free === 'clearance') return same('obstacles') ? null : 'The obstacles have to stay: change the clearance.';
    if (!same('clearance')) return 'The clearance has to stay.';
    const { obstacles } = scene;
    const areThere = obstacles.length === first.obstacles.length && obstacles.every(({ from }, i) => from === i);
    if (!areThere) return 'No obstacle may come or go: move those that are there.';
    return obstacles.every(({ shape }, i) => Puzzles.moved(first.obstacles[i].shape, shape)) ? null : 'Obstacles may be moved, not reshaped.';
  },

  /** Whether an answer is the end. */
  isSolved({ verdict, length, clearance }, answered, scene) {
    if (answered.error || answered.verdict !== verdict) return false;
    if (length && !(answered.figures.lower_bound >= length)) return false;
    return !clearance || scene.clearance >= clearance;
  },
};

class Gallery {
  /** None for a page that a server serves. */
  static of(live) {
    const data = document.getElementById('gallery');
    return data && new Gallery(live, JSON.parse(data.textContent));
  }

  constructor(live, { files, robots, choices }) {
    Object.assign(this, { live, files, robots, choices, now: files });
    const groups = [['worlds', (one) => !one.puzzle], ['puzzles', (one) => one.puzzle]].map(([label, isOf]) => (
      element('optgroup', { label }, ...choices.filter(isOf).map(({ name, title }) => element('option', { value: name }, title)))
    ));
    this.select = element('select', { 'aria-label': 'world to open', autocomplete: 'off', onchange: () => this.go(this.select.value) }, element('option', { value: '' }, 'this page\u2019s'), ...groups);
    this.copy = element('button', { type: 'button', class: 'button', title: 'copy an address that holds arm, world and options', onclick: () => this.link() }, 'Copy link');
    this.task = element('span', { class: 'task', role: 'status' });
    this.root = element('div', { class: 'group gallery' }, element('label', {}, 'open ', this.select), this.copy, this.task);
    window.addEventListener('hashchange', () => this.open());
  }

  /** A line to the program, with the files that the address names. */
  dial() {
    return new Alone(this.read());
  }

  /** Files of the address: a choice by its name, or those packed in it; else the page's own. */
  async read() {
    const [, name] = /^#(.*)$/.exec(location.hash) ?? [];
    const choice = this.choices.find((one) => one.name === name);
    Object.assign(this, { choice: choice ?? null, fault: null, isSolved: false });
    this.now = this.files;
    if (choice) this.now = { ...this.files, urdf: this.robots[choice.robot], world: choice.world, options: 'shortest' };
    else if (name?.startsWith('w=')) {
      try {
        this.now = { ...this.files, ...JSON.parse(await Packed.read(name.slice(2))) };
      } catch {
        this.live.remark('The address holds no world that can be read: this is the page\u2019s own.');
      }
    }
    this.select.value = choice?.name ?? '';
    this.say();
    return this.now;
  }

  /** Another world, by the name of a choice. */
  go(name) {
    location.hash = name;
  }

  /** What the address names now. */
  open() {
    if (location.hash === this.linked) return;
    this.live.remark('');
    this.live.keepEdits();
    this.live.link.socket.close();
    this.live.link.retry();
  }

  /** The address of what is seen, into the clipboard, or into the address bar where there is none. */
  async link() {
    const { urdf } = this.now;
    const { toml, words } = this.live;
    const packed = `#w=${await Packed.write(JSON.stringify({ urdf, world: toml, options: words }))}`;
    try {
      await navigator.clipboard.writeText(`${location.href.split('#', 1)[0]}${packed}`);
      this.live.remark('The link is copied: it holds arm, world and options.');
    } catch {
      this.linked = packed;
      location.hash = packed;
      this.live.remark('The address of this page is the link: it holds arm, world and options.');
    }
  }

  /** Says what is to be done, and whether it is. */
  say() {
    this.copy.disabled = !this.live.isCurrent;
    const { puzzle } = this.choice ?? {};
    const { scene, answered } = this.live;
    if (!puzzle || !scene) {
      this.task.textContent = '';
      return;
    }
    if (this.live.isCurrent) {
      this.fault = this.live.world.toml === this.choice.world ? Puzzles.fault(puzzle, scene) : 'The world is another one: start again.';
      this.isSolved = !this.fault && Puzzles.isSolved(puzzle, answered, scene);
    }
    const state = this.fault ?? (this.isSolved ? '\u2714 Solved.' : '');
    const text = `${puzzle.text} ${state}`.trim();
    if (this.task.textContent !== text) this.task.textContent = text;
    this.task.classList.toggle('solved', this.isSolved);
  }
}

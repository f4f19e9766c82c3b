// The layers of the pictures. Their list is the legend: each layer has its sign, and a checkbox that shows or hides it.
'use strict';

/**
 * Name, label, and visibility at the beginning of each layer. The content determines which of them exist.
 * @type {[string, string, boolean][]}
 */
const LAYERS = [
  ['map', 'map of the space seen so far', true],
  ['sensor', 'view of the sensor', true],
  ['known', 'configurations that are known to be free', true],
  ['path', 'paths, and traces of the tip', true],
  ['solutions', 'IK solutions of the line', true],
  ['c-obstacles', 'C-obstacles', true],
  ['access', 'reachable tip positions', true],
  ['proof', 'proof of infeasibility', true],
  ['regions', 'preferred regions', true],
  ['roadmap', 'reduced visibility graph', true],
  ['roads', 'roadmap', true],
  ['rows', 'slices that the path passes', true],
  ['channel', 'channel', true],
  ['cells', 'cells', true],
  ['expanded', 'order of the search', true],
  ['wavefront', 'wavefront', true],
  ['equipotentials', 'equipotentials', true],
  ['flow', 'flow lines', false],
  ['boxes', 'subdivision boxes', true],
  ['poses', 'poses along the path', true],
  ['names', 'names', true],
  ['frames', 'frames', true],
];
/** Layers that show how the planner found its answer. They are not drawn over the motion. */
const PLANNER_LAYERS = new Set(['roadmap', 'roads', 'rows', 'channel', 'cells', 'expanded', 'wavefront', 'equipotentials', 'flow', 'boxes']);

class Layers {
  constructor(view) {
    this.view = view;
    this.shown = new Map(LAYERS.map(([name, , isShown]) => [name, isShown]));
    this.list = element('ul', { class: 'legend', 'aria-label': 'Legend' });
    this.root = element('section', { class: 'box', 'aria-label': 'Layers' }, element('h2', {}, 'Layers'), this.list);
    /** Rows: { item, key, theme, layer, isVisible }. */
    this.rows = [];
  }

  /** Returns the names of the layers that a model has, and those that the page draws itself. */
  static of({ worlds, replays = [], paths, reach, frames, line: given }, own) {
    const traces = [...worlds, ...replays].map(({ trace }) => trace);
    const kinds = new Set(traces.map((trace) => trace?.kind));
    const any = (key) => worlds.some((world) => world[key]?.length > 0);
    const exists = {
      path: paths.length > 0 || Boolean(given), solutions: Boolean(given?.solutions.length), 'c-obstacles': any('c_obstacles') || any('moments'), access: Boolean(reach), proof: any('proof'), regions: any('regions'),
      roadmap: kinds.has('roadmap'), roads: kinds.has('roads'), rows: kinds.has('rows'), channel: kinds.has('channel'), cells: kinds.has('channel'),
      expanded: traces.some((trace) => trace?.expanded?.length > 0), wavefront: kinds.has('wavefront'), equipotentials: kinds.has('field'), flow: kinds.has('field'),
      boxes: kinds.has('boxes'), poses: paths.length > 0, names: any('obstacles') || any('movers'), frames: frames.length > 0,
    };
    return LAYERS.map(([name]) => name).filter((name) => exists[name] || own.includes(name));
  }

  /** Returns the layer to which an entry of the legend belongs, of those that it names. */
  static owner({ layers, sign, text }) {
    if (sign === 'shade' && layers.includes('expanded')) return 'expanded';
    return layers.find((layer) => text.includes(layer)) ?? layers[0];
  }

  /** Lists the layers and obstacles of a model. */
  update(model) {
    const { view } = this;
    const names = [...new Map(model.worlds.flatMap((world) => [...world.obstacles, ...(world.movers ?? [])].map((o) => [o.name, o.color])))];
    const layers = Layers.of(model, view.ownLayers);
    const signature = JSON.stringify([layers, names, model.legend, view.named]);
    if (signature === this.signature) return;
    this.signature = signature;
    this.rows = [];
    const texts = new Map(names.flatMap(([name]) => [[name, name], [`${name}, moving`, name]]));
    const isObstacle = ({ sign, text }) => sign === 'swatch' && texts.has(text);
    const ofLayer = (name) => model.legend.filter((key) => key.layers && Layers.owner(key) === name);
    const entries = model.legend.filter((key) => !key.layers && !isObstacle(key));
    for (const key of entries.filter(({ sign }) => ['start', 'goal', 'unreached'].includes(sign))) this.row({ key });
    for (const [name, label] of LAYERS.filter(([one]) => layers.includes(one))) {
      const keys = ofLayer(name);
      const [only] = keys.length === 1 ? keys : [];
      const text = name === 'path' && model.line ? 'path of the tip, and the limit that it reaches' : label;
      this.row({ key: only ?? { sign: name, text }, layer: name, box: this.box(name) });
      if (!only) for (const key of keys) this.row({ key, layer: name });
    }
    for (const key of entries.filter(({ sign }) => !['start', 'goal', 'unreached'].includes(sign))) this.row({ key });
    names.forEach(([name, color], index) => {
      const listed = model.legend.find((key) => isObstacle(key) && texts.get(key.text) === name);
      const text = view.named ? listed?.text ?? name : `${index + 1} ${name}`;
      this.row({ key: { sign: 'swatch', color, text }, box: this.obstacleBox(name) });
    });
    this.list.replaceChildren(...this.rows.map(({ item }) => item));
    this.refresh();
  }

  box(name) {
    return element('input', {
      type: 'checkbox', checked: this.shown.get(name), 'data-layer': name,
      onchange: (event) => this.show(name, event.target.checked),
    });
  }

  obstacleBox(name) {
    const { hidden } = this.view;
    return element('input', {
      type: 'checkbox', checked: !hidden.has(name), 'data-obstacle': name,
      onchange: (event) => {
        hidden[event.target.checked ? 'delete' : 'add'](name);
        this.view.refresh();
      },
    });
  }

  /**
   * Adds a row: a sign and its meaning, with a checkbox if it can be hidden.
   * @param {{ key: any, layer?: string, box?: HTMLElement }} row
   */
  row({ key, layer, box }) {
    const sign = element('span', { class: 'sign' });
    const parts = [sign, element('span', {}, key.text)];
    const item = element('li', { class: layer && !box ? 'part' : undefined }, box ? element('label', {}, box, ...parts) : element('span', {}, ...parts));
    this.rows.push({ item, sign, key, layer, box });
  }

  /** Shows or hides a layer. */
  show(name, isShown) {
    this.shown.set(name, isShown);
    const box = this.list.querySelector(`[data-layer="${name}"]`);
    if (box) box.checked = isShown;
    this.view.refresh();
  }

  /** Hides the rows of layers that the current mode does not draw, and draws the signs in the colours of the page. */
  refresh() {
    const { view } = this;
    const { theme } = view.panels.workspace;
    for (const row of this.rows) {
      const { item, sign, key, layer, box } = row;
      const isOfMotion = ['start', 'goal', 'unreached'].includes(key.sign);
      item.hidden = layer ? !(box ? view.draws(layer) : view.shows(layer)) : isOfMotion && view.isPlain;
      if (row.theme === theme) continue;
      row.theme = theme;
      sign.replaceChildren(Legend.sign(theme, key));
    }
  }
}

// The inspector: exact coordinates of the selected obstacle, start or goal, as numbers that the user can change.
'use strict';

const Inspector = (() => {
  const METRES = { unit: 'metres', symbol: 'm', factor: 1, digits: 4, step: '0.001' };
  const DEGREES = { unit: 'degrees', symbol: '\u00b0', factor: 180 / Math.PI, digits: 2, step: '0.1' };

  /** Shortest time between two changes of the fields during a drag, in milliseconds. */
  const DRAG_INTERVAL = 120;

  class Inspector {
    /** `editor` has the selection; `select` is the menu of things to select. */
    constructor(editor, select) {
      this.editor = editor;
      this.values = element('div', { class: 'values' });
      this.root = element('section', { class: 'inspector', 'aria-label': 'Coordinates' }, element('label', {}, 'selected ', select), this.values);
    }

    /** Returns the groups of fields for the selection: their names, and for each field its name, unit, value and setter. */
    groups() {
      const { editor } = this;
      const { selection, obstacle } = editor;
      if (!selection) return [];
      if (!obstacle) return this.configurationGroups(selection.kind);
      const { shape } = obstacle;
      const point = (value, set) => ['x', 'y'].map((name, k) => ({ name, unit: METRES, value: value?.[k], set: (to) => set(value.map((x, i) => (i === k ? to : x))) }));
      if (!shape) return [];
      if (shape.circle) {
        const { center, radius } = shape.circle;
        const set = (circle) => editor.setShape({ circle });
        const radiusField = { name: 'radius', unit: METRES, value: radius, least: 1e-3, set: (to) => set({ center, radius: Math.max(1e-3, to) }) };
        return [{ title: 'centre', fields: point(center, (to) => set({ center: to, radius })) }, { title: '', fields: [radiusField] }];
      }
      const corners = Shapes.corners(shape);
      return corners.map((corner, i) => ({
        title: String(i + 1), label: `corner ${i + 1}`, corner: i,
        fields: point(corner, (to) => editor.setShape(Shapes.cornered(shape, corners.with(i, to)))),
      }));
    }

    /** Returns the fields of the start or the goal: the tip, and the joint values if they are known. */
    configurationGroups(kind) {
      const { editor } = this;
      const tip = editor.tips[kind];
      const joints = editor[kind];
      const groups = [];
      if (tip) {
        groups.push({ title: 'tip', fields: ['x', 'y'].map((name, k) => ({ name, unit: METRES, value: tip[k], set: (to) => editor.setTip(kind, tip.map((x, i) => (i === k ? to : x))) })) });
      }
      if (joints) {
        groups.push({
          title: '',
          fields: editor.arm.joints.map((joint, k) => ({
            name: joint.name, unit: joint.unit === 'rad' ? DEGREES : METRES, value: joints[k],
            set: (to) => editor.setConfiguration(kind, joints.map((x, i) => (i === k ? to : x))),
          })),
        });
      }
      return groups;
    }

    /** Shows the selection. Fields are created only if other ones are needed; a field in which the user types stays. */
    update() {
      // Fields cost more time than all of a small picture. During a drag, some of its places are enough.
      const now = performance.now();
      if (this.editor.held?.moved && now - this.updated < DRAG_INTERVAL) return;
      this.updated = now;
      const groups = this.groups();
      const { selection, obstacle } = this.editor;
      const signature = JSON.stringify([selection?.kind, selection?.index, groups.map(({ title, fields }) => [title, fields.map(({ name, unit }) => [name, unit.unit])])]);
      if (signature !== this.signature) {
        this.signature = signature;
        this.inputs = groups.map(({ fields }) => fields.map((field) => this.input(field)));
        const isFixed = obstacle && !obstacle.shape;
        const hint = isFixed ? 'This shape cannot be changed here.' : 'Select an obstacle, the start or the goal to see and change its coordinates.';
        this.values.replaceChildren(...(groups.length ? groups.map((group, i) => this.groupElement(group, this.inputs[i])) : [element('span', { class: 'empty' }, hint)]));
      }
      groups.forEach(({ title, label, corner, fields }, i) => {
        const group = this.values.children[i];
        if (corner !== undefined) group.classList.toggle('chosen', selection.corner === corner);
        fields.forEach((field, k) => {
          const input = this.inputs[i][k];
          const { unit, value } = field;
          Object.assign(input, { field, corner });
          const text = value === undefined ? '' : String(+(value * unit.factor).toFixed(unit.digits));
          const name = `${label ?? title} ${field.name} in ${unit.unit}`.trim();
          if (input.getAttribute('aria-label') !== name) input.setAttribute('aria-label', name);
          const isTyping = document.activeElement === input && input.value !== input.shown;
          if (!isTyping && input.value !== text) input.value = text;
          if (!isTyping) input.shown = text;
        });
      });
    }

    input({ unit, least }) {
      const input = element('input', {
        type: 'number', step: unit.step, min: least, inputmode: 'decimal', autocomplete: 'off',
        onchange: () => this.change(input),
        onfocus: () => input.corner !== undefined && this.editor.selectCorner(input.corner),
      });
      return input;
    }

    groupElement({ title, fields }, inputs) {
      // One symbol for neighbouring fields of the same unit.
      const symbol = (k) => (fields[k + 1]?.unit === fields[k].unit ? '' : ` ${fields[k].unit.symbol}`);
      const labels = fields.map(({ name }, k) => element('label', {}, `${name} `, inputs[k], symbol(k)));
      return element('span', { class: 'coordinates' }, title ? element('b', {}, title) : null, ...labels);
    }

    /** Takes over a changed number. Text that is no number is replaced by the current value. */
    change(input) {
      const { field } = input;
      const value = Number(input.value);
      input.shown = input.value;
      if (input.value.trim() === '' || !Number.isFinite(value)) this.update();
      else field.set(value / field.unit.factor);
    }
  }

  return Inspector;
})();

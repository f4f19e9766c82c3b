// The page of an inspection: defects first, a drawing of the arm if there is one, and the joints and links in tables.
// Pointing at a row shows its link in the drawing.
'use strict';

/**
 * @typedef {{ value: number, source: string }} Rate
 * @typedef {{ name: string, type: string, line: number, parent: string, child: string, axis: number[] | null,
 *   direction: number[] | null, mimics: string | null, role: string, value: number | null,
 *   limits: { source: string, range: number[] | null } | null, velocity: Rate | null, acceleration: Rate | null,
 *   jerk?: Rate | null }} JointReport
 */

/** The arm at zero. It may touch obstacles there: a motion need not begin at zero. */
class InspectionView extends View {
  /** Obstacles keep their colours until the arm is moved. */
  get marksContacts() {
    return Boolean(this.probe);
  }

  /** Describes the arm; at zero in grey, since a contact there is no fault. */
  report() {
    super.report();
    if (!this.probe && this.parts.probe.dataset.free === 'false') this.parts.probe.dataset.free = '';
  }

  /**
   * Says which obstacles the arm touches.
   * @param {ContactModel[]} contacts
   */
  touched(contacts) {
    const hits = contacts.filter(({ distance }) => distance <= 0);
    if (!hits.length || this.probe) return super.touched(contacts);
    const called = (name) => (/^[a-z][a-z _-]+$/.test(name) ? `the ${name}` : `"${name}"`);
    const names = hits.map(({ obstacle, distance }) => `${called(this.world.obstacles[obstacle].name)} (${Numbers.length(-distance)} deep)`);
    return `the arm at zero touches ${[...new Set(names)].join(', ')}. This does not prevent planning.`;
  }
}

class Inspection {
  /** Names of the sources of values. */
  static SOURCES = { urdf: 'URDF', soft: 'URDF, soft limits', world: 'world file', default: 'default', continuous: '', unset: '' };

  /**
   * @param {HTMLElement} root
   * @param {object | null} model the view of the arm, or `null`
   * @param {object} report the report of `cplan inspect`
   */
  constructor(root, model, report) {
    this.report = report;
    /** Link that the drawing emphasises, or `null`. */
    this.lit = null;
    root.classList.add('inspects');
    /** Cells with the current values of the arm's joints. */
    this.values = [];
    this.view = model ? new InspectionView(root, model) : null;
    const sections = [this.joints(), this.links(), this.arm(), this.tree(), this.pairs(), this.notes(), this.text()];
    const body = element('div', { class: 'inspection' }, ...sections.filter(Boolean));
    const count = report.defects.length;
    const words = report.plannable ? 'ready for planning' : `${count} defect${count === 1 ? '' : 's'}`;
    if (this.view) this.attach(body, words);
    else {
      const status = element('p', { class: 'status', role: 'status', 'data-ending': 'infeasible' }, element('span', { 'aria-hidden': 'true' }, SYMBOLS.infeasible), ` ${words}`);
      root.replaceChildren(element('header', {}, element('div', {}, element('h1', {}, report.robot ?? 'Robot without a name'), this.lines()), status), body);
    }
    // The status in the header is enough for a robot without defects.
    if (!report.plannable) root.querySelector('header').after(this.defects());
  }

  /**
   * Adds the report to the page of the view, which shows the workspace alone.
   * @param {HTMLElement} body
   * @param {string} words
   */
  attach(body, words) {
    const { view, report } = this;
    view.judged = true;
    view.say(report.plannable ? 'found' : 'infeasible', words);
    view.parts.lines.replaceWith(this.lines());
    view.panels.cspace.canvas.parentElement.hidden = true;
    view.root.querySelector('.stage').append(body);
    view.panels.workspace.overlays.push((context, panel) => this.emphasise(context, panel), () => this.follow());
    view.refresh();
  }

  /** Returns the lines below the title. */
  lines() {
    const { urdf, world, chosen } = this.report;
    const of = chosen ? `${chosen.join(' and ')} at zero. ` : '';
    return element('div', { class: 'lines' }, element('p', {}, `${of}${urdf}${world ? `, completed by ${world}` : ''}`));
  }

  // Defects.

  /** Returns the list of defects. */
  defects() {
    const { report } = this;
    const sign = icon('infeasible');
    const count = report.defects.length;
    const items = report.defects.map(({ origin, line, column, message, cure }) => {
      const place = [origin, line, column].filter((part) => part !== null).join(':');
      return element('li', {}, element('span', { class: 'place' }, place), element('p', {}, message), cure ? element('p', {}, element('strong', {}, 'Hint: '), cure) : null);
    });
    const remedy = report.remedy ? [element('p', {}, 'With these entries in the world file, cplan can read the robot (the numbers are examples):'), element('pre', { tabindex: '0' }, `[robot]\n${report.remedy}`)] : [];
    return element('section', { class: 'defects inspection-defects' }, element('h2', {}, sign, count === 1 ? 'One defect prevents planning' : `${count} defects prevent planning`), element('ol', {}, ...items), ...remedy);
  }

  // Tables.

  /**
   * Returns a section with a heading.
   * @param {string} title
   * @param {...Node} content
   */
  static section(title, ...content) {
    return element('section', { class: 'box', 'aria-label': title }, element('h2', {}, title), ...content);
  }

  /**
   * Returns a table that can be scrolled sideways.
   * @param {string} label
   * @param {string[]} columns
   * @param {HTMLElement[]} rows
   */
  static table(label, columns, rows) {
    const head = element('thead', {}, element('tr', {}, ...columns.map((name) => element('th', { scope: 'col' }, name))));
    return element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': label }, element('table', {}, head, element('tbody', {}, ...rows)));
  }

  /**
   * Returns a cell: a value, and where it comes from in small type.
   * @param {string | Node} value
   * @param {string} [note]
   */
  static cell(value, note) {
    return element('td', {}, value, note ? element('small', {}, note) : null);
  }

  /**
   * Returns a row whose link is emphasised in the drawing while the pointer or the focus is there.
   * @param {string} name
   * @param {string} note
   * @param {string} link
   * @param {HTMLElement[]} cells
   */
  row(name, note, link, cells) {
    const show = () => this.show(link);
    const hide = () => this.show(null);
    const title = this.view
      ? element('button', { type: 'button', class: 'name', 'data-link': link, onfocus: show, onblur: hide, onclick: show }, name)
      : element('strong', {}, name);
    return element('tr', { 'data-link': link, onpointerenter: show, onpointerleave: hide }, element('th', { scope: 'row' }, title, note ? element('small', {}, note) : null), ...cells);
  }

  /** Returns the table of joints. */
  joints() {
    const { report } = this;
    if (!report.joints.length) return null;
    const has = (key) => report.joints.some((joint) => joint[key]);
    const efforts = report.dynamics?.efforts;
    const columns = ['joint', 'role', 'value', 'limits', 'speed', 'acceleration', ...(has('jerk') ? ['jerk'] : []), ...(efforts ? ['effort'] : [])];
    const rows = report.joints.map((joint) => {
      const { name, type, line, child, mimics, limits, velocity, acceleration, jerk } = joint;
      const isTurning = type !== 'prismatic';
      const number = report.chosen?.indexOf(name) ?? -1;
      const value = Inspection.cell(joint.value === null ? '\u2013' : Inspection.quantity(isTurning, joint.value));
      if (this.view && number >= 0) this.values[number] = value;
      const per = (rate, unit) => (rate ? Inspection.cell(`${Inspection.quantity(isTurning, rate.value)}${unit}`, Inspection.SOURCES[rate.source]) : Inspection.cell('\u2013'));
      return this.row(name, `${type}, line ${line}`, child, [
        Inspection.cell(Inspection.role(joint, number), [mimics && `mimics ${mimics}`, Inspection.axis(joint)].filter(Boolean).join(', ')),
        value,
        limits ? Inspection.cell(Inspection.range(isTurning, limits), Inspection.SOURCES[limits.source]) : Inspection.cell('\u2013'),
        per(velocity, '/s'),
        per(acceleration, '/s\u00b2'),
        ...(has('jerk') ? [per(jerk, '/s\u00b3')] : []),
        ...(efforts ? [Inspection.cell(number < 0 ? '\u2013' : `${Numbers.digits(efforts[number])} ${isTurning ? 'N m' : 'N'}`)] : []),
      ]);
    });
    return Inspection.section('Joints', Inspection.table('Table of joints', columns, rows));
  }

  /**
   * Returns the role of a joint in words.
   * @param {JointReport} joint
   * @param {number} number index of the joint among the two of the arm, or -1
   */
  static role({ role }, number) {
    return {
      moves: number === 0 ? 'first joint' : 'second joint', held: 'held', follows: 'follows, held', ignored: 'ignored: not part of the arm', rigid: 'fixed', undecided: 'not decided',
    }[role];
  }

  /**
   * Describes the axis of a joint.
   * @param {JointReport} joint
   */
  static axis({ direction, axis }) {
    const components = (direction ?? axis)?.map((x) => Number(x.toFixed(4)) + 0).join(', ');
    return components && `axis (${components})${direction ? '' : ' in its own frame'}`;
  }

  /**
   * Formats an angle in degrees or a length.
   * @param {boolean} isTurning
   * @param {number} value
   */
  static quantity(isTurning, value) {
    if (!isTurning) return Numbers.length(value);
    const degrees = (value * 180) / Math.PI;
    // Limits are often stated with four digits of a radian.
    const unit = Math.abs(degrees) < 1000 ? 10 : 1;
    return `${(Math.round(unit * degrees) / unit + 0).toString().replace('-', '\u2212')}\u00b0`;
  }

  /**
   * Formats a range of values.
   * @param {boolean} isTurning
   * @param {{ source: string, range: number[] | null }} limits
   */
  static range(isTurning, { source, range }) {
    if (!range) return source === 'continuous' ? 'none: continuous' : 'not set';
    return range.map((value) => Inspection.quantity(isTurning, value)).join(' to ');
  }

  /** Returns the table of links with their outlines and masses. */
  links() {
    const { links, outlines, dynamics, chosen, joints } = this.report;
    if (!links.length) return null;
    const bodies = new Map(outlines.flatMap(({ source, bodies: all, link }) => all.map((body) => [body.link, { ...body, source, of: link }])));
    const whole = new Map(outlines.map((outline) => [outline.link, outline]));
    const masses = new Map((dynamics && chosen ? chosen : []).map((name, k) => [joints.find((joint) => joint.name === name).child, dynamics.masses[k]]));
    const columns = ['link', 'shapes in the URDF', 'outline', ...(masses.size ? ['mass'] : [])];
    const rows = links.map(({ name, above, collision, visual }) => {
      const [body, outline] = [bodies.get(name), whole.get(name)];
      const parts = body && `${body.parts} part${body.parts === 1 ? '' : 's'}, ${Numbers.digits(body.area * 1e4)} cm\u00b2`;
      const heights = outline?.heights && `at heights ${outline.heights.map((height) => Numbers.length(height)).join(' to ')}`;
      const none = outline ? 'none: this link cannot collide' : '\u2013';
      const from = body && `from ${body.source === 'bar' ? 'the bar of the world file' : `${body.source} geometry`}${body.of === name ? '' : `, part of ${body.of}`}`;
      return this.row(name, above ? `moved by ${above}` : 'root', name, [
        Inspection.cell(collision + visual ? [collision && `${collision} collision`, visual && `${visual} visual`].filter(Boolean).join(', ') : 'none'),
        Inspection.cell(parts ?? none, [from, heights].filter(Boolean).join('; ')),
        ...(masses.size ? [Inspection.cell(masses.has(name) ? `${Numbers.digits(masses.get(name))} kg` : '\u2013', masses.has(name) ? 'with all that it carries' : '')] : []),
      ]);
    });
    const table = Inspection.table('Table of links', columns, rows);
    table.classList.add('wraps');
    return Inspection.section('Links', table);
  }

  /** Returns the facts about the planar arm: plane, tip, reach, and links that it can hit. */
  arm() {
    const { chosen, assumed, plane, tip, reach, self_obstacles: own } = this.report;
    if (!chosen) return null;
    const facts = [['joints', `${chosen.join(' and ')}${assumed ? ', chosen by default, as the first pair that forms a planar arm' : ''}`]];
    if (plane) facts.push(['plane', plane.words.replace(/^plane: /, '')]);
    if (tip && reach) {
      facts.push(['tip', `origin of link ${tip}, at ${reach.tip.map((x) => Numbers.length(x)).join(', ')} with both joints at zero`]);
      if (reach.distances) facts.push(['reach of the tip', `${reach.distances.map((x) => Numbers.length(x)).join(' to ')} from joint 1, without joint limits`]);
      facts.push(['reach of all parts', `within ${Numbers.length(reach.outline)} of joint 1, if sliding joints are at zero`]);
    }
    const hit = own.map(({ link, moves, heights, ignored }) => `${link}: an obstacle for ${moves ? 'link 2' : 'both links'}${ignored.length ? `, except ${ignored.join(', ')}` : ''}, at heights ${heights.map((x) => Numbers.length(x)).join(' to ')}`);
    [...new Set(hit)].forEach((text) => facts.push(['own body', text]));
    return Inspection.section('Arm', element('dl', { class: 'facts' }, ...facts.flatMap(([name, text]) => [element('dt', {}, name), element('dd', {}, text)])));
  }

  /** Returns the tree of links; if the links form none, the list of joints. */
  tree() {
    const { root, joints, links } = this.report;
    if (!joints.length && !links.length) return null;
    const branch = ({ name, type, child, parent }, isTree) => element('li', {}, isTree ? '' : `${parent} \u2013 `, `${name} (${type}) \u2013 `, element('strong', {}, child), isTree ? below(child) : null);
    const below = (link) => {
      const own = joints.filter(({ parent }) => parent === link);
      return own.length ? element('ul', {}, ...own.map((joint) => branch(joint, true))) : null;
    };
    const list = root ? element('ul', {}, element('li', {}, element('strong', {}, root), below(root))) : element('ul', {}, ...joints.map((joint) => branch(joint, false)));
    return Inspection.section(root ? 'Tree of links' : 'Joints and links (not a tree)', list);
  }

  /** Returns the table of pairs of joints, with the reason why they form no planar arm. */
  pairs() {
    const { pairs } = this.report;
    if (!pairs.length) return null;
    const rows = [...pairs].sort((a, b) => Number(b.planar) - Number(a.planar)).map(({ joints, kind, planar, reason }) => {
      const verdict = element('span', { class: 'verdict', 'data-ending': planar ? 'found' : 'infeasible' }, `${planar ? SYMBOLS.found : SYMBOLS.infeasible} ${planar ? 'planar' : 'no'}`);
      return element('tr', {}, element('th', { scope: 'row' }, joints.join(', ')), Inspection.cell(kind), Inspection.cell(verdict), element('td', { class: 'words' }, reason.replace(/^plane: /, '')));
    });
    const table = Inspection.table('Pairs of joints', ['joints', 'kind', 'planar arm', 'why'], rows);
    return element('details', { class: 'box' }, element('summary', {}, `Pairs of joints: ${pairs.filter(({ planar }) => planar).length} of ${pairs.length} form a planar arm`), table);
  }

  /** Returns the warnings, and what is ignored. */
  notes() {
    const { ignored, warnings } = this.report;
    const all = [...warnings.map((text) => `Warning: ${text}`), ...ignored.map((text) => `Ignored: ${text}`)];
    return all.length ? Inspection.section('Notes', element('ul', {}, ...all.map((text) => element('li', {}, text)))) : null;
  }

  /** Returns the report as the terminal shows it. */
  text() {
    return element('details', { class: 'box' }, element('summary', {}, 'The report as text'), element('pre', { tabindex: '0' }, this.report.text));
  }

  // The drawing.

  /**
   * Emphasises a link, and its rows.
   * @param {string | null} link
   */
  show(link) {
    if (this.lit === link || !this.view) return;
    this.lit = link;
    for (const row of this.view.root.querySelectorAll('tr[data-link]')) row.classList.toggle('lit', row.getAttribute('data-link') === link);
    this.view.panels.workspace.draw();
  }

  /** Shows the current values of the arm's joints. */
  follow() {
    const { view } = this;
    const q = view.probe?.q ?? view.q;
    this.values.forEach((cell, k) => {
      const text = Numbers.joint(view.model.arm.joints[k], q[k]);
      if (cell.textContent !== text) cell.textContent = text;
    });
  }

  /**
   * Draws the emphasised link, and the pivot of its joint.
   * @param {CanvasRenderingContext2D} context
   * @param {Panel} panel
   */
  emphasise(context, panel) {
    const { view, lit, report } = this;
    if (!lit) return;
    const { theme } = panel;
    const { arm } = view.model;
    const q = view.probe?.q ?? view.q;
    const at = Geometry.poses(arm, q);
    context.lineWidth = 4;
    context.strokeStyle = theme.accent;
    for (const obstacle of view.world.obstacles.filter(({ name, own }) => name === lit && own > 0)) {
      Workspace.outline(context, panel, obstacle);
      context.stroke();
    }
    context.beginPath();
    arm.links.forEach(({ parts }, k) => parts.filter(({ body }) => body === lit).forEach((part) => rounded(context, panel, Geometry.placed(part, at[k]))));
    context.stroke();
    context.globalAlpha = 0.35;
    context.fillStyle = theme.accent;
    context.fill();
    context.globalAlpha = 1;
    const joint = report.chosen?.indexOf(report.joints.find(({ child }) => child === lit)?.name) ?? -1;
    if (joint < 0) return;
    const [x, y] = panel.at(joint === 0 ? arm.base : Geometry.elbowAt(arm, q));
    context.beginPath();
    context.arc(x, y, 12, 0, 2 * Math.PI);
    context.lineWidth = 3;
    context.strokeStyle = theme.ink;
    context.stroke();
  }
}

{
  const { view, report } = JSON.parse(document.getElementById('view').textContent);
  window.inspection = new Inspection(document.querySelector('main'), view, report);
  window.cplan = window.inspection.view;
}

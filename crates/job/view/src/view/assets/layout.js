// The elements of the page and their arrangement.
'use strict';

/** Width of the page from which layers stand beside the pictures. */
const WIDE = '(min-width: 77.5rem)';

/** Creates the elements of the page, its panels and everything in them, as properties of the view. */
function buildPage(view) {
  const canvas = (label) => element('canvas', { tabindex: '0', role: 'img', 'aria-label': label, 'aria-describedby': 'description' });
  const [left, right] = [canvas('Workspace'), canvas(view.space)];
  const parts = {
    title: element('h1'),
    lines: element('div', { class: 'lines' }),
    cards: element('dl', { class: 'cards', 'aria-label': 'Key figures', hidden: true }),
    status: element('p', { class: 'status', role: 'status' }),
    facts: element('dl', { class: 'facts' }),
    probe: element('p', { class: 'probe', 'aria-live': 'polite' }),
    description: element('p', { class: 'unseen', id: 'description' }),
    measure: element('span', { class: 'measure', 'aria-hidden': 'true' }),
    ticks: element('span', { class: 'ticks', 'aria-hidden': 'true' }),
    play: element('button', { type: 'button', class: 'play', onclick: () => view.toggle() }),
    scrubber: element('input', {
      type: 'range', min: '0', max: '1', step: 'any', value: '0', 'aria-label': 'time',
      oninput: (event) => view.seek(Number(event.target.value)),
    }),
    clock: element('span', { class: 'clock' }),
    spaceTitle: element('figcaption', {}, view.space),
    step: element('p', { class: 'step', 'aria-live': 'polite' }),
    key: element('ul', { class: 'key', 'aria-label': 'Colours', hidden: true }),
    plots: element('section', { class: 'plots', 'aria-label': 'Motion over time' }),
  };
  const speed = element('select', { 'aria-label': 'speed', onchange: (event) => view.setSpeed(Number(event.target.value)) });
  for (const value of SPEEDS) speed.append(element('option', { value, selected: value === 1 }, `${value}\u00d7`));
  parts.speed = speed;
  const mode = (name, text) => element('button', { type: 'button', class: 'button', 'data-mode': name, onclick: () => view.switchTo(name) }, text);
  parts.modes = element('span', { class: 'modes', role: 'group', 'aria-label': 'What is played' }, mode('move', 'Motion'), mode('think', 'How it was found'), mode('learn', 'Learn'));
  view.steps = new Steps(view);
  view.sideView = new SideView(view);
  view.layers = new Layers(view);
  parts.slider = element('span', { class: 'slider' }, parts.ticks, parts.scrubber);
  parts.track = element('div', { class: 'track' }, parts.slider);
  const controls = element('div', { class: 'controls-of-time' }, parts.modes, parts.play, parts.track, parts.clock, speed);
  parts.transport = element('section', { class: 'transport', 'aria-label': 'Time' }, element('div', { class: 'caption' }, parts.step, parts.key, view.sideView.choice), controls);
  const zoom = (name, label) => Zoom.buttons(label, () => view.panels[name], () => view.zoomSpot(view.panels[name]));
  parts.panels = element(
    'section',
    { class: 'panels' },
    element('figure', {}, element('figcaption', {}, 'Workspace'), left, zoom('workspace', 'Workspace')),
    element('figure', {}, parts.spaceTitle, right, zoom('cspace', view.space)),
    view.sideView.root,
    parts.probe,
  );
  view.parts = parts;
  view.tabs = buildTabs(view);
  view.tour = new Tour(view);
  view.strip = Strip.mount(view);
  view.closing = Closing.mount(view);
  view.height = Height.mount(view, 'height');
  view.turns = Height.mount(view, 'turns');
  view.toolAngle = Height.mount(view, 'tool');
  view.root.append(
    element('header', {}, element('div', {}, parts.title, parts.lines), parts.status),
    parts.cards,
    view.explain.root,
    element(
      'div',
      { class: 'stage' },
      element('div', { class: 'pictures' }, element('div', { class: 'course' }, view.learn.head, view.learn.foot, view.learn.steps), parts.panels, view.learn.pair.root, parts.description, parts.measure, parts.transport, view.steps.root, view.closing.root, view.strip.root, view.height.root, view.turns.root, view.toolAngle.root, view.learn.details),
      element('div', { class: 'below' }, view.tabs.root, ...view.tabs.entries.filter(({ isAside }) => !isAside).map(({ panel }) => panel)),
      element('aside', { class: 'side', 'aria-label': 'Layers' }, view.layers.root),
    ),
    help(view),
    view.tour.root,
  );
  view.panels = {
    workspace: new Panel(left, {
      x: [0, 1], y: [0, 1], scale: 'fill',
      still: (context, panel) => Workspace.still(context, panel, view),
      moving: (context, panel) => (view.drawn === 'slice' ? view.learn.slices.drawArm(context, panel) : Workspace.moving(context, panel, view)),
    }),
    cspace: new Panel(right, {
      x: [0, 1], y: [0, 1], scale: 'fit',
      still: (context, panel) => CSpace.still(context, panel, view),
      moving: (context, panel) => (view.drawn === 'slice' ? view.learn.slices.drawSlice(context, panel) : CSpace.moving(context, panel, view)),
      beside: (context, panel) => CSpace.beside(context, panel, view),
    }),
  };
  view.explain.watch(view.panels);
  view.budget.watch(view.panels);
  // The pictures and the controls of time fit below the header.
  const stage = view.root.querySelector('.stage');
  const fit = () => view.root.style.setProperty('--above', `${Math.round(stage.getBoundingClientRect().top + scrollY)}px`);
  const above = new ResizeObserver(fit);
  for (const part of [view.root.querySelector('header'), parts.cards]) above.observe(part);
  // Texts on canvases follow the text size of the page.
  new ResizeObserver(() => view.model && view.recolor()).observe(parts.measure);
  view.plots = [...Plots.mount(parts.plots, view), view.sideView, view.closing, view.strip, view.height, view.turns, view.toolAngle];
}

/** Creates the tabs. Layers stand beside the pictures if there is room. */
function buildTabs(view) {
  const wide = matchMedia(WIDE);
  const never = () => false;
  const isBeside = () => wide.matches;
  const tabs = new Tabs('More', [
    { name: 'layers', title: 'Layers', panel: view.layers.root, isAside: true, isOffered: () => true, isBeside },
    { name: 'plots', title: 'Plots', panel: element('div', {}, view.parts.plots), isOffered: () => Boolean(view.model?.clock) && view.mode === 'move', isBeside: never },
    { name: 'margins', title: 'Margins', panel: view.budget.root, isOffered: () => view.budget.rows.length > 0 && view.mode === 'move', isBeside: never },
    { name: 'details', title: 'Details', panel: element('div', {}, view.parts.facts), isOffered: () => Boolean(view.model?.facts.length), isBeside: never },
  ]);
  wide.addEventListener('change', () => tabs.refresh());
  return tabs;
}

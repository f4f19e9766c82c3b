// The planner's replay: the part of its trace that is visible at a moment.
'use strict';

const Think = (() => {
  /** Changes per second of the arm's configuration during the replay; more would flicker. */
  const LOOKS = 5;

  const duration = (replay) => (replay ?? []).reduce((sum, phase) => sum + phase.seconds, 0);

  /** Returns the phase at a time, its index, and the part of it that has been shown, from 0 to 1. */
  function moment(replay, time) {
    let from = 0;
    for (const [index, phase] of replay.entries()) {
      if (time < from + phase.seconds || index === replay.length - 1) {
        return { index, phase, part: Math.min(1, Math.max(0, (time - from) / phase.seconds)) };
      }
      from += phase.seconds;
    }
    return null;
  }

  /** Returns the visible part of the content of phases of this kind. */
  function part(view, kind) {
    const { moment: now } = view;
    const at = now ? view.replay.findIndex((phase) => phase.kind === kind) : -1;
    if (at < 0 || at < now.index) return 1;
    return at > now.index ? 0 : now.part;
  }

  const count = (all, share) => Math.min(all, Math.round(all * share));

  /** Returns the first items of a list, each of which consists of `each` numbers. */
  const firstItems = (flat, each, share) => flat.slice(0, each * count(flat.length / each, share));

  /** Returns the beginning of a path, as a part of its length. */
  function firstPart(points, share) {
    const at = (i) => [points[2 * i], points[2 * i + 1]];
    const n = points.length / 2;
    const length = (i) => Math.hypot(points[2 * i + 2] - points[2 * i], points[2 * i + 3] - points[2 * i + 1]);
    let left = 0;
    for (let i = 0; i + 1 < n; i += 1) left += share * length(i);
    const there = at(0);
    for (let i = 0; i + 1 < n; i += 1) {
      const [a, b] = [at(i), at(i + 1)];
      const along = length(i);
      if (along > left) return [...there, ...a.map((x, k) => x + ((b[k] - x) * left) / along)];
      left -= along;
      there.push(...b);
    }
    return there;
  }

  /** Returns the boxes that have appeared; all others are undecided so far. */
  function cut({ free, stuck, mixed }, order, share) {
    const kinds = [free, stuck, mixed];
    const found = { kind: 'boxes', free: [], stuck: [], mixed: [], rest: [] };
    const names = ['free', 'stuck', 'mixed'];
    const there = count(order.length, share);
    order.forEach((place, k) => {
      let [kind, at] = [0, 4 * place];
      while (at >= kinds[kind].length) {
        at -= kinds[kind].length;
        kind += 1;
      }
      found[k < there ? names[kind] : 'rest'].push(...kinds[kind].slice(at, at + 4));
    });
    return found;
  }

  const LETTERS = 'ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/';

  /** Returns the cells that a wave or a search has reached. */
  function upTo(seen, share) {
    const order = seen.order ?? seen.levels;
    const there = new Set([...LETTERS.slice(0, Math.floor(share * LETTERS.length))]);
    const less = { ...seen, levels: [...seen.levels].map((level, k) => (there.has(order[k]) ? level : '.')).join('') };
    if (seen.numbers) less.numbers = seen.numbers.map((number, k) => (there.has(order[k]) ? number : -1));
    return less;
  }

  /** Returns the visible part of the planner's trace. */
  function seen(view, trace) {
    const { moment: now } = view;
    if (!now) return trace;
    const { phase } = now;
    // The only trace of some planners is their slabs.
    if (phase.kind === 'slabs') return cut(phase, phase.order, now.part);
    if (!trace) return trace;
    const of = (kind) => part(view, kind);
    if (phase.kind === 'boxes') return cut(trace, phase.order, now.part);
    if (phase.kind === 'sweeps') {
      const at = Math.min(phase.frames.length - 1, Math.floor(now.part * phase.frames.length));
      return { kind: 'wavefront', ...phase.frames[at][1] };
    }
    const less = { ...trace };
    if (trace.edges) less.edges = firstItems(trace.edges, 4, phase.kind === 'nodes' ? 0 : of('edges'));
    if (phase.kind === 'nodes') less.nodes = firstItems(trace.edges, 4, now.part);
    if (trace.expanded) less.expanded = firstItems(trace.expanded, 2, of('expanded'));
    if (trace.kind === 'rows') less.free = firstItems(trace.free, 4, of('slices'));
    if (phase.kind === 'bound') [less.slices, less.before] = [roundOf(now).slices, roundOf(now, 1)?.slices ?? []];
    if (trace.kind === 'channel') {
      less.cells = trace.cells.slice(0, count(trace.cells.length, of('cells')));
      less.channel = trace.channel.slice(0, count(trace.channel.length, of('channel')));
      if (trace.centers) less.centers = trace.centers.slice(0, 2 * less.channel.length);
      if (trace.middles) less.middles = trace.middles.slice(0, 2 * Math.max(less.channel.length - 1, 0));
      const last = less.cells[less.cells.length - 1];
      if (phase.kind === 'cells' && phase.swept && last) less.sweep = Math.min(...last.filter((_, k) => k % 2 === 0));
    }
    if (trace.kind === 'wavefront') return upTo(trace, of('wave'));
    if (trace.kind === 'field') {
      less.levels = trace.levels.slice(0, count(trace.levels.length, of('levels')));
      less.flow = of('levels') < 1 ? [] : trace.flow;
    }
    return less;
  }

  /** Returns the round of the lower bound at a moment, or one that is `back` rounds earlier. */
  const roundOf = ({ phase, part: share }, back = 0) => phase.rounds[Math.min(phase.rounds.length - 1, Math.floor(share * phase.rounds.length)) - back];

  /** Returns the lines of a proof that closes: the first path, and the shortest line around known walls. */
  function ofProof(view, { phase, part: share }) {
    const { theme } = view.panels.cspace;
    const first = view.replay.find(({ kind }) => kind === 'first');
    const begins = first && phase.kind !== 'path' ? part(view, 'first') : 0;
    const lines = begins > 0 ? [{ color: theme.grey, width: 1.6, dash: [], points: firstPart(first.points, begins) }] : [];
    const round = phase.kind === 'bound' ? roundOf({ phase, part: share }) : null;
    if (round?.points.length) lines.push({ color: theme.accent, width: 2, dash: [7, 4], points: round.points });
    return lines;
  }

  /** Returns the visible paths: the final one, those of the proof, and the one before it was pulled taut. */
  function paths(view, all) {
    const { moment: now } = view;
    if (!now) return all;
    const own = view.replay.find((phase) => phase.kind === 'own');
    const begins = own ? part(view, 'own') : 0;
    const before = begins > 0 ? [{ color: view.panels.cspace.theme.grey, width: 1.6, dash: [], points: firstPart(own.points, begins) }] : [];
    const share = part(view, 'path');
    return [...ofProof(view, now), ...before, ...(share > 0 ? all.map((path) => ({ ...path, points: firstPart(path.points, share) })) : [])]
      .map((path) => ({ ...path, ghosts: [] }));
  }

  /** Returns the configuration at which the planner works; the arm is shown there. */
  function focus(view) {
    const { phase, part: share } = view.moment;
    const looks = Math.max(1, Math.round(phase.seconds * LOOKS));
    const now = { ...view.moment, part: Math.floor(share * looks) / looks };
    const there = { replay: view.replay, panels: view.panels, moment: now };
    if (['path', 'own', 'first'].includes(phase.kind)) {
      const all = paths({ ...there, moment: view.moment }, view.pathsHere());
      return all.length ? all[all.length - 1].points.slice(-2) : null;
    }
    const trace = seen(there, view.trace);
    const middle = (flat) => [0, 1].map((k) => flat.filter((_, i) => i % 2 === k).reduce((sum, x) => sum + x, 0) / (flat.length / 2));
    const last = (flat, each) => (flat?.length ? middle(flat.slice(-each)) : null);
    switch (phase.kind) {
      case 'edges': return last(trace.edges, 2);
      case 'nodes': return last(trace.nodes, 4);
      case 'expanded': return last(trace.expanded, 2);
      case 'slices': return last(trace.free, 4);
      case 'cells': return trace.cells.length ? middle(trace.cells[trace.cells.length - 1]) : null;
      case 'channel': return trace.channel.length ? middle(trace.cells[trace.channel[trace.channel.length - 1]]) : null;
      // At the end the arm is at the start again, and does not lie on what blocks it.
      case 'proof': return now.part < 1 ? last(firstItems(view.world.proof, 4, now.part), 4) : null;
      default: return null;
    }
  }

  return { duration, moment, part, firstItems, seen, paths, focus };
})();

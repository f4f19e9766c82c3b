// A page by itself, which contains its view. The address can choose the initial mode, chapter and lesson: #think,
// #learn=c_obstacles, #learn=c_obstacles/sweep, #learn/sweep.
'use strict';

/** The page of a checked configuration, which has key figures of its own. */
class CheckedView extends View {
  cards() {
    return this.model.checked.cards;
  }
}

{
  const model = JSON.parse(document.getElementById('view').textContent);
  window.cplan = new (model.checked ? CheckedView : View)(document.querySelector('main'), model);
}
if (cplan.model.reach) new ReachMap(cplan);
if (cplan.model.line) new FollowedLine(cplan);
{
  /** Shows what the address asks for. */
  const follow = () => {
    const [mode, ...place] = location.hash.slice(1).split(/[=/]/u);
    if (['move', 'think', 'learn'].includes(mode)) cplan.switchTo(mode);
    if (cplan.mode === 'learn' && place.length) cplan.learn.open(place[0], place[1]);
    return mode;
  };
  const asked = follow();
  // As a figure of a lesson in another page, the page is as high as its content, which it reports.
  if (window.parent !== window && cplan.mode === 'learn') {
    cplan.root.classList.add('embedded');
    const report = () => window.parent.postMessage({ height: Math.ceil(cplan.root.getBoundingClientRect().height) }, '*');
    new ResizeObserver(report).observe(cplan.root);
    for (const panel of Object.values(cplan.panels)) panel.resize();
  }
  // A task opens where it is hardest, or before the step that fails.
  if (!asked && cplan.isTask && cplan.mode === 'move') cplan.seek(cplan.model.ending === 'found' ? cplan.hardest : cplan.duration);
  if (!asked && cplan.isMotion) cplan.tour.offer();
  addEventListener('hashchange', follow);
}

// A page by itself, which contains its view. The address can choose the initial mode: #think, #learn/sweep.
'use strict';

window.cplan = new View(document.querySelector('main'), JSON.parse(document.getElementById('view').textContent));
if (cplan.model.reach) new ReachMap(cplan);
{
  const [mode, lesson] = location.hash.slice(1).split('/');
  if (['move', 'think', 'learn'].includes(mode)) cplan.switchTo(mode);
  if (!mode && cplan.isMotion) cplan.tour.offer();
  if (cplan.mode === 'learn' && cplan.learn.lessons.some(([name]) => name === lesson)) cplan.learn.start(lesson);
}

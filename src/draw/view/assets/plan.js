// A page by itself: what it shows lies in it.
'use strict';

window.cplan = new View(document.querySelector('main'), JSON.parse(document.getElementById('view').textContent));

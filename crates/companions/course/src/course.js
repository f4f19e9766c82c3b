// The figures are pages of their own: each reports its height whenever it changes.
'use strict';

addEventListener('message', ({ source, data }) => {
  for (const frame of document.querySelectorAll('iframe'))
    if (source === frame.contentWindow && Number.isFinite(data?.height)) frame.style.height = `${data.height + 4}px`;
});

// In the book the figure of a chapter of the course is live: the page that stands in the comment after the picture takes its place.
'use strict';

/** Greatest width of a figure, in pixels. It may be wider than the text. */
const WIDEST = 1000;

/** Makes a figure as wide as the page allows, in the middle of the text. */
function widen(frame) {
  const text = frame.parentElement.clientWidth;
  const room = (document.querySelector('#content, .content') ?? document.documentElement).clientWidth - 32;
  const width = Math.max(Math.min(text, room), Math.min(WIDEST, room));
  frame.style.width = `${width}px`;
  frame.style.marginLeft = `${(text - width) / 2}px`;
}

for (const image of document.querySelectorAll('main img')) {
  const { parentElement: paragraph } = image;
  const after = [...image.parentNode.childNodes, paragraph.nextSibling, paragraph.nextSibling?.nextSibling];
  const live = after.find((node) => node?.nodeType === Node.COMMENT_NODE && node.data.startsWith(' live: '));
  if (!live) continue;
  const frame = document.createElement('iframe');
  frame.src = `live/${live.data.slice(' live: '.length).trim()}`;
  frame.title = image.alt;
  frame.style.cssText = 'height: 60rem; border: 0;';
  image.replaceWith(frame);
  widen(frame);
  addEventListener('resize', () => widen(frame));
  // The figure reports its height whenever it changes.
  addEventListener('message', ({ source, data }) => {
    if (source === frame.contentWindow && Number.isFinite(data?.height)) frame.style.height = `${data.height + 4}px`;
  });
}

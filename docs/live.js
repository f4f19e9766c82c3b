// In the book the figure of a chapter of the course is live: the page that stands in the comment after the picture takes its place.
'use strict';

for (const image of document.querySelectorAll('main img')) {
  const { parentElement: paragraph } = image;
  const after = [...image.parentNode.childNodes, paragraph.nextSibling, paragraph.nextSibling?.nextSibling];
  const live = after.find((node) => node?.nodeType === Node.COMMENT_NODE && node.data.startsWith(' live: '));
  if (!live) continue;
  const frame = document.createElement('iframe');
  frame.src = `live/${live.data.slice(' live: '.length).trim()}`;
  frame.title = image.alt;
  frame.style.cssText = 'width: 100%; height: 60rem; border: 0;';
  image.replaceWith(frame);
}

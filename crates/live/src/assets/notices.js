// What is wrong, said where one looks: on the picture, beside the options, the text or the files; gone once it is cured.
'use strict';

class Notices {
  constructor() {
    const alert = (name) => element('p', { class: `notice ${name}`, role: 'alert', hidden: true });
    /** `picture` lies over the panel that was used last. */
    this.places = Object.fromEntries(['picture', 'options', 'text', 'files'].map((name) => [name, alert(name)]));
  }

  /** Says it at a place; nothing for nothing. */
  say(place, text) {
    const notice = this.places[place];
    notice.hidden = !text;
    if (notice.textContent !== (text ?? '')) notice.textContent = text ?? '';
  }

  /** Puts what is said of the picture over this panel. */
  over(panel) {
    const figure = panel.canvas.parentElement;
    const { picture } = this.places;
    if (picture.parentElement !== figure) figure.append(picture);
  }
}

// Problems, shown where the user looks: on the picture, or beside the options, the text or the files. They disappear
// when they are solved.
'use strict';

class Notices {
  constructor() {
    const alert = (name) => element('p', { class: `notice ${name}`, role: 'alert', hidden: true });
    /** `picture` lies over the panel that was used last. */
    this.places = Object.fromEntries(['picture', 'options', 'text', 'files'].map((name) => [name, alert(name)]));
  }

  /** Shows a text at a place; an empty one removes it. */
  show(place, text) {
    const notice = this.places[place];
    notice.hidden = !text;
    if (notice.textContent !== (text ?? '')) notice.textContent = text ?? '';
  }

  /** Moves the notice of the picture over this panel. */
  over(panel) {
    const figure = panel.canvas.parentElement;
    const { picture } = this.places;
    if (picture.parentElement !== figure) figure.append(picture);
  }
}

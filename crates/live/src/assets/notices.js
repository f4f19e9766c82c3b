// Problems, shown beside the place where the user can solve them: below the pictures, or beside the options, the text or
// the files. They disappear when they are solved.
'use strict';

class Notices {
  constructor() {
    const alert = (name) => element('p', { class: `notice ${name}`, role: 'alert', hidden: true });
    /** `picture` has its own room below the panels, so that it covers nothing and moves nothing. */
    this.places = Object.fromEntries(['picture', 'options', 'text', 'files'].map((name) => [name, alert(name)]));
  }

  /** Shows a text at a place; an empty one removes it. */
  show(place, text) {
    const notice = this.places[place];
    notice.hidden = !text;
    if (notice.textContent !== (text ?? '')) notice.textContent = text ?? '';
  }
}

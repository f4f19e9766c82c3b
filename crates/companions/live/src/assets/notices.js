// Problems, shown beside the place where the user can solve them: below the pictures, or beside the options or the text.
// They disappear when they are solved.
'use strict';

class Notices {
  constructor() {
    const alert = (name) => element('div', { class: `notice ${name}`, role: 'alert', hidden: true });
    /** `picture` and `files` have their own room below the panels, so that they cover nothing and move nothing. */
    this.places = Object.fromEntries(['picture', 'options', 'text', 'files'].map((name) => [name, alert(name)]));
    this.shown = {};
  }

  /** Shows a text at a place; an empty one removes it. `action` adds a button: its label, and what it does. */
  show(place, text, action = null) {
    const notice = this.places[place];
    notice.hidden = !text;
    const key = JSON.stringify([text ?? '', action?.label]);
    if (this.shown[place] === key) return;
    this.shown[place] = key;
    const button = action && element('button', { type: 'button', class: 'button', onclick: action.run }, action.label);
    notice.replaceChildren(element('span', {}, text ?? ''), ...(button ? [' ', button] : []));
  }
}

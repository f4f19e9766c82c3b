// The connection: one request under way at a time, the latest state next.
'use strict';

/** First and longest pause before the next attempt to connect, milliseconds. */
const PAUSES = [250, 4000];

class Link {
  /** The line to the server that the page came from. */
  static server() {
    return new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/live`);
  }

  /**
   * `dial` makes a line; `hear` is called with each message, `file` with the head and content of each file, `state` when the line is
   * up or down. Whoever hears that it is up opens something.
   */
  constructor({ dial, hear, file, state }) {
    Object.assign(this, { dial, hear, file, state });
    this.id = 0;
    /** The request whose answer is awaited: its number, what it is (open, plan, load, download), whether it is final, and what it is about. */
    this.awaited = null;
    /** What is to be asked next: a function that makes the request, and whether it is final. */
    this.next = null;
    /** Whether a plan was dropped for something that may leave the world as it is. */
    this.owed = false;
    this.pause = PAUSES[0];
    this.connect();
    // Whoever comes back to the page does not wait for the end of a pause.
    for (const [target, name] of [[window, 'online'], [window, 'focus'], [document, 'visibilitychange']]) {
      target.addEventListener(name, () => !document.hidden && this.retry());
    }
  }

  connect() {
    clearTimeout(this.later);
    const socket = this.dial();
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.pause = PAUSES[0];
      this.state(true);
    };
    socket.onmessage = ({ data }) => (typeof data === 'string' ? this.message(JSON.parse(data)) : this.content(data));
    socket.onclose = () => {
      [this.awaited, this.next, this.owed] = [null, null, false];
      this.state(false);
      this.later = setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(2 * this.pause, PAUSES[1]);
    };
    this.socket = socket;
  }

  /** Tries to connect now rather than later. */
  retry() {
    if (this.socket.readyState === WebSocket.CLOSED) this.connect();
  }

  get isUp() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  /** Asks for a plan of what `make` returns when its turn comes (and what that is about, for the answer); what waited before is forgotten. */
  plan(make, final) {
    if (!this.isUp) return;
    this.next = { make, final: final || (this.next?.final ?? false) };
    this.pump();
  }

  pump() {
    if (!this.next || !this.isUp) return;
    const { awaited } = this;
    // What is opened or loaded has to be there first. On the way from place to place the server answers as soon as it can: to ask
    // before it has would only stop it. What the user stopped at is asked at once; so is whatever follows something left.
    if (awaited?.kind === 'open' || awaited?.kind === 'load') return;
    if (awaited && !this.next.final && !awaited.final) return;
    const { make, final } = this.next;
    this.next = null;
    const { body, about } = make();
    this.send('plan', { do: 'plan', ...this.ask(body, final) }, { final, ...about });
  }

  ask(body, final) {
    this.id += 1;
    return { id: this.id, final, ...body };
  }

  /** Begins with these files, or with what the program was started with. */
  open(files) {
    this.id += 1;
    this.next = null;
    this.send('open', { do: 'open', id: this.id, files }, { final: true });
    this.owed = false;
  }

  /** Takes another text for the world. */
  load(text, options) {
    this.id += 1;
    this.owed ||= Boolean(this.next);
    this.next = null;
    this.send('load', { do: 'load', id: this.id, text, options }, { final: true });
  }

  download(body, format) {
    const ask = this.ask(body, true);
    this.send('download', { do: 'download', ask, format }, { final: true });
  }

  send(kind, request, about) {
    if (!this.isUp) return;
    if (kind !== 'plan' && this.awaited?.kind === 'plan') this.owed = true;
    if (kind === 'plan') this.owed = false;
    this.awaited = { id: this.id, kind, since: performance.now(), ...about };
    this.socket.send(JSON.stringify(request));
  }

  message(message) {
    const isLast = message.kind === 'failed' || message.done;
    const { awaited } = this;
    const isAwaited = Boolean(awaited && (message.id === awaited.id || message.id === 0));
    // Of what was open before nobody wants to hear any more.
    if (awaited?.kind === 'open' && !isAwaited) return;
    // Once a text is loaded, what follows is its plan.
    if (isAwaited && message.kind === 'world' && awaited.kind === 'load') Object.assign(awaited, { kind: 'plan' });
    else if (isAwaited && (isLast || message.kind === 'world')) this.awaited = null;
    // The next plan is made while this one is drawn.
    this.pump();
    this.hear(message, { ...awaited, isAwaited });
  }

  /** A file: four bytes tell the length of its head. */
  content(data) {
    const length = new DataView(data).getUint32(0);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    if (this.awaited?.id === head.id) this.awaited = null;
    this.file(head, new Uint8Array(data, 4 + length));
    this.pump();
  }
}

// The connection: one request under way at a time, the latest state next.
'use strict';

/** A plan that takes longer than this while something moves is given up for a newer place, milliseconds. */
const PATIENCE = 250;
/** First and longest pause before the next attempt to connect, milliseconds. */
const PAUSES = [250, 4000];

class Link {
  /** `hear` is called with each message, `file` with the head and content of each file, `state` when the line is up or down. */
  constructor({ hear, file, state }) {
    Object.assign(this, { hear, file, state });
    this.id = 0;
    /** The request whose answer is awaited. */
    this.awaited = null;
    /** What is to be asked next: a function that makes the request, and whether it is final. */
    this.next = null;
    this.pause = PAUSES[0];
    this.connect();
  }

  connect() {
    const socket = new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/live`);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.pause = PAUSES[0];
      this.state(true);
    };
    socket.onmessage = ({ data }) => (typeof data === 'string' ? this.message(JSON.parse(data)) : this.content(data));
    socket.onclose = () => {
      this.awaited = null;
      this.state(false);
      setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(2 * this.pause, PAUSES[1]);
    };
    this.socket = socket;
  }

  get isUp() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  /** Asks for a plan of what `make` returns when its turn comes; what waited before is forgotten. */
  plan(make, final) {
    this.next = { make, final: final || (this.next?.final ?? false) };
    this.pump();
  }

  pump() {
    clearTimeout(this.timer);
    if (!this.next || !this.isUp) return;
    const now = performance.now();
    if (this.awaited) {
      // What the user stopped at is asked at once; so is whatever follows something that the user has left.
      const left = this.awaited.since + PATIENCE - now;
      if (!this.next.final && !this.awaited.final && left > 0) {
        this.timer = setTimeout(() => this.pump(), left + 1);
        return;
      }
    }
    const { make, final } = this.next;
    this.next = null;
    this.send({ do: 'plan', ...this.ask(make(), final) }, final);
  }

  ask(body, final) {
    this.id += 1;
    return { id: this.id, final, ...body };
  }

  /** Takes another text for the world. */
  load(text, options) {
    this.id += 1;
    this.next = null;
    this.send({ do: 'load', id: this.id, text, options }, true);
  }

  download(body, format) {
    const ask = this.ask(body, true);
    this.send({ do: 'download', ask, format }, true);
  }

  send(request, final) {
    if (!this.isUp) return;
    this.awaited = { id: this.id, final, since: performance.now() };
    this.socket.send(JSON.stringify(request));
  }

  message(message) {
    const isLast = message.kind === 'failed' || message.done;
    const isAwaited = this.awaited && (message.id === this.awaited.id || message.id === 0);
    const since = this.awaited?.since;
    if (isLast && isAwaited) this.awaited = null;
    // The next plan is made while this one is drawn.
    this.pump();
    this.hear(message, { isAwaited, since });
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

// The connection: one request in progress at a time, then the latest state.
'use strict';

/** Shortest and longest pause before the next attempt to connect, in milliseconds. */
const PAUSES = [250, 4000];

class Link {
  /** Opens a connection to the server that the page came from. */
  static server() {
    return new WebSocket(`${location.protocol === 'https:' ? 'wss' : 'ws'}://${location.host}/live`);
  }

  /**
   * `openSocket` opens a connection. `receive` is called with each message, `file` with the head and content of each file, and
   * `state` when the connection opens or closes. The handler of an open connection has to open a world.
   */
  constructor({ openSocket, receive, file, state }) {
    this.openSocket = openSocket;
    this.receive = receive;
    this.file = file;
    this.state = state;
    this.id = 0;
    /**
     * The request in progress: its number, its kind (open, plan, load, explain, download), whether it is final, and the state
     * that it is about.
     */
    this.awaited = null;
    /** The next request: a function that makes it, and whether it is final. */
    this.next = null;
    /** True if a plan was dropped for a request that may leave the world unchanged. */
    this.isPlanDue = false;
    this.pause = PAUSES[0];
    this.connect();
    // A user who comes back to the page does not have to wait for the end of a pause.
    const retry = () => !document.hidden && this.retry();
    for (const name of ['online', 'focus']) window.addEventListener(name, retry);
    document.addEventListener('visibilitychange', retry);
  }

  connect() {
    clearTimeout(this.later);
    const socket = this.openSocket();
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      this.pause = PAUSES[0];
      this.state(true);
    };
    socket.onmessage = ({ data }) => (typeof data === 'string' ? this.message(JSON.parse(data)) : this.content(data));
    socket.onclose = () => {
      [this.awaited, this.next, this.isPlanDue] = [null, null, false];
      this.state(false);
      this.later = setTimeout(() => this.connect(), this.pause);
      this.pause = Math.min(2 * this.pause, PAUSES[1]);
    };
    this.socket = socket;
  }

  /** Tries to connect immediately. */
  retry() {
    if (this.socket.readyState === WebSocket.CLOSED) this.connect();
  }

  get isUp() {
    return this.socket.readyState === WebSocket.OPEN;
  }

  /**
   * Requests a plan of the state that `make` returns when its turn comes, together with a description of it for the
   * answer. It replaces a waiting request.
   */
  plan(make, final) {
    if (!this.isUp) return;
    this.next = { make, final: final || (this.next?.final ?? false) };
    this.sendNext();
  }

  sendNext() {
    if (!this.next || !this.isUp) return;
    const { awaited } = this;
    // Wait until a world has been opened or loaded. During a drag, the server answers as fast as it can, and a new
    // request before its answer would only interrupt it. A final state is requested at once, and so is any state after
    // a final one.
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

  /** Opens a world from these files, or the program's initial world. */
  open(files) {
    this.id += 1;
    this.next = null;
    this.send('open', { do: 'open', id: this.id, files }, { final: true });
    this.isPlanDue = false;
  }

  /** Loads another text as the world. */
  load(text, options) {
    this.id += 1;
    this.isPlanDue ||= Boolean(this.next);
    this.next = null;
    this.send('load', { do: 'load', id: this.id, text, options }, { final: true });
  }

  /** Requests an explanation of a state, and repeats the description `about` with the answer. */
  explain(body, about) {
    const ask = this.ask(body, true);
    this.send('explain', { do: 'explain', ...ask }, { final: true, ...about });
  }

  download(body, format) {
    const ask = this.ask(body, true);
    this.send('download', { do: 'download', ask, format }, { final: true });
  }

  send(kind, request, about) {
    if (!this.isUp) return;
    if (kind !== 'plan' && this.awaited?.kind === 'plan') this.isPlanDue = true;
    if (kind === 'plan') this.isPlanDue = false;
    this.awaited = { id: this.id, kind, since: performance.now(), ...about };
    this.socket.send(JSON.stringify(request));
  }

  message(message) {
    const isLast = message.kind === 'failed' || message.kind === 'explanation' || message.done;
    const { awaited } = this;
    const isAwaited = Boolean(awaited && (message.id === awaited.id || message.id === 0));
    // Answers about the previous world are not relevant any more.
    if (awaited?.kind === 'open' && !isAwaited) return;
    // After a text has been loaded, its plan follows.
    if (isAwaited && message.kind === 'world' && awaited.kind === 'load') Object.assign(awaited, { kind: 'plan' });
    else if (isAwaited && (isLast || message.kind === 'world')) this.awaited = null;
    // The server makes the next plan while this one is drawn.
    this.sendNext();
    this.receive(message, { ...awaited, isAwaited });
  }

  /** Handles a file: its first four bytes are the length of its head. */
  content(data) {
    const length = new DataView(data).getUint32(0);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    if (this.awaited?.id === head.id) this.awaited = null;
    this.file(head, new Uint8Array(data, 4 + length));
    this.sendNext();
  }
}

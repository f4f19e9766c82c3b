// The program within the page: a worker that answers as a server does, behind the interface of a WebSocket.
'use strict';

/** Time that a request in progress still has when a newer one arrives, in milliseconds. */
const GRACE_PERIOD = 120;
/** Largest number of waiting requests; of plans only the latest waits. */
const MAX_WAITING = 8;

class Alone {
  /** The compiled program. @type {Promise<WebAssembly.Module> | undefined} */
  static compiled;
  /** The address of the worker's script. @type {string | undefined} */
  static scriptAddress;
  /** Returns the program, compiled once for the page. */
  static get module() {
    Alone.compiled ??= (async () => {
      const packed = Uint8Array.from(atob(document.getElementById('program').textContent), (letter) => letter.codePointAt(0));
      const bytes = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
      return WebAssembly.compile(await new Response(bytes).arrayBuffer());
    })();
    return Alone.compiled;
  }

  static get script() {
    Alone.scriptAddress ??= URL.createObjectURL(new Blob([document.getElementById('worker').textContent], { type: 'text/javascript' }));
    return Alone.scriptAddress;
  }

  /** `limit` returns the time that a plan may take, in seconds. */
  constructor(limit) {
    this.limit = limit;
    this.waiting = [];
    this.running = null;
    /** State of the connection, as of a WebSocket. @type {number} */
    this.readyState = WebSocket.CONNECTING;
    /** Handlers, as of a WebSocket. */
    this.onopen = () => {};
    this.onmessage = (_message) => {};
    this.onclose = () => {};
    this.compile();
  }

  async compile() {
    try {
      this.module = await Alone.module;
    } catch (error) {
      this.reportFailure({ id: 0 }, `This browser cannot run cplan: ${error.message ?? error}`);
      return;
    }
    if (this.readyState === WebSocket.CLOSED) return;
    this.readyState = WebSocket.OPEN;
    this.onopen();
  }

  /** Starts a worker with the open world. */
  startWorker() {
    this.worker = new Worker(Alone.script);
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.running = { do: 'open' };
    this.worker.postMessage({ module: this.module, open: this.open });
  }

  /** Ends the worker and its current request. */
  endWorker() {
    if (!this.worker) return;
    this.worker.onmessage = null;
    this.worker.terminate();
  }

  send(text) {
    const request = JSON.parse(text);
    if (request.do === 'open') {
      this.endWorker();
      this.waiting = [];
      this.open = { ...request, seconds: this.limit(), held: null };
      this.startWorker();
      return;
    }
    if (request.do === 'plan') this.waiting = this.waiting.filter((one) => one.do !== 'plan');
    if (this.waiting.length >= MAX_WAITING) this.reportFailure(request, 'Too many requests are waiting. Try again.');
    else this.waiting.push(request);
    this.sendNext();
  }

  reportFailure(request, error) {
    this.onmessage({ data: JSON.stringify({ kind: 'failed', id: request.id ?? request.ask.id, error }) });
  }

  sendNext() {
    if (!this.running) {
      this.running = this.waiting.shift() ?? null;
      if (this.running) this.worker.postMessage({ request: this.running });
    }
    this.interruptSlowRequest();
  }

  /**
   * Ends the request in progress in favour of a newer one, unless it finishes soon. A text is always read, because
   * newer requests may refer to it.
   */
  interruptSlowRequest() {
    const { running } = this;
    if (!running || !this.waiting.length || running.do === 'open' || (running.do === 'load' && !running.isRead) || running.isLate) return;
    running.isLate = true;
    setTimeout(() => this.running === running && this.waiting.length && this.restartWorker(running), GRACE_PERIOD);
  }

  restartWorker(running) {
    this.endWorker();
    if (running.do === 'download') this.reportFailure(running, 'The file was not saved, because the world has changed since. Save again.');
    this.startWorker();
  }

  receive({ data, held, isFree }) {
    if (this.readyState === WebSocket.CLOSED) return;
    if (held) {
      this.open.held = held;
      if (this.running?.do === 'load') this.running.isRead = true;
    }
    if (isFree) this.running = null;
    else this.onmessage({ data });
    this.sendNext();
  }

  close() {
    this.readyState = WebSocket.CLOSED;
    this.endWorker();
    this.onclose();
  }
}

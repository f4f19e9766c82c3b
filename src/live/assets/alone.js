// The program within the page: a worker that answers as a server does, behind what looks like a WebSocket.
'use strict';

/** Time that what is under way still has once something newer is asked, milliseconds. */
const GRACE = 120;
/** Requests that may wait at a time; of plans only the latest waits. */
const MOST_WAITING = 8;

class Alone {
  /** The program, compiled once for the page. */
  static get module() {
    Alone.compiled ??= (async () => {
      const packed = Uint8Array.from(atob(document.getElementById('program').textContent), (letter) => letter.codePointAt(0));
      const bytes = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
      return WebAssembly.compile(await new Response(bytes).arrayBuffer());
    })();
    return Alone.compiled;
  }

  static get script() {
    Alone.address ??= URL.createObjectURL(new Blob([document.getElementById('worker').textContent], { type: 'text/javascript' }));
    return Alone.address;
  }

  /** With a promise of the files to begin with: `urdf`, `world`, `options`, `seconds`. */
  constructor(files) {
    this.files = files;
    this.waiting = [];
    this.running = null;
    this.readyState = WebSocket.CONNECTING;
    this.start();
  }

  async start() {
    let module;
    try {
      module = await Alone.module;
      this.open ??= { do: 'open', held: null, ...(await this.files) };
    } catch (error) {
      this.refuse({ id: 0 }, `This browser cannot run cplan: ${error.message ?? error}`);
      return;
    }
    if (this.readyState === WebSocket.CLOSED) return;
    this.worker = new Worker(Alone.script);
    this.worker.onmessage = ({ data }) => this.hear(data);
    this.running = { do: 'open' };
    this.worker.postMessage({ module, open: this.open });
    if (this.readyState === WebSocket.OPEN) return;
    this.readyState = WebSocket.OPEN;
    this.onopen();
  }

  send(text) {
    const request = JSON.parse(text);
    if (request.do === 'plan') this.waiting = this.waiting.filter((one) => one.do !== 'plan');
    if (this.waiting.length >= MOST_WAITING) this.refuse(request, 'too many requests wait');
    else this.waiting.push(request);
    this.next();
  }

  refuse(request, error) {
    this.onmessage({ data: JSON.stringify({ kind: 'failed', id: request.id ?? request.ask.id, error }) });
  }

  next() {
    if (!this.running) {
      this.running = this.waiting.shift() ?? null;
      if (this.running) this.worker.postMessage({ request: this.running });
    }
    this.hurry();
  }

  /** Ends what is under way for something newer, unless it is over soon; but texts are read, since what is newer may speak of them. */
  hurry() {
    const { running } = this;
    if (!running || !this.waiting.length || running.do === 'open' || (running.do === 'load' && !running.isRead) || running.isLate) return;
    running.isLate = true;
    setTimeout(() => this.running === running && this.waiting.length && this.restart(running), GRACE);
  }

  restart(running) {
    this.worker.onmessage = null;
    this.worker.terminate();
    if (running.do === 'download') this.refuse(running, 'the file is not made: the page has changed since');
    this.start();
  }

  hear({ data, held, isFree }) {
    if (this.readyState === WebSocket.CLOSED) return;
    if (held) {
      this.open.held = held;
      if (this.running?.do === 'load') this.running.isRead = true;
    }
    if (isFree) this.running = null;
    else this.onmessage({ data });
    this.next();
  }

  close() {
    this.readyState = WebSocket.CLOSED;
    this.worker?.terminate();
    this.onclose();
  }
}

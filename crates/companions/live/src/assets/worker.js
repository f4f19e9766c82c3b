// The worker in which the page's own program runs: it receives orders and posts messages. Work that takes too long ends
// the instance, and another one continues with the same state.
'use strict';

/** Exception that stops work. */
const STOPPED = Symbol('stopped');
const FAULT = 'The planner failed on this world. This is a defect of cplan; you can go on editing.';

/** The module, the order that opens the world, the instance, and the message of the last panic. */
const program = { module: null, open: null, exports: null, panic: null };

function startInstance() {
  const read = (at, bytes) => new Uint8Array(program.exports.memory.buffer, at >>> 0, bytes >>> 0);
  const text = (at, bytes) => new TextDecoder().decode(read(at, bytes));
  const page = {
    elapsed: () => performance.now(),
    stop() {
      throw STOPPED;
    },
    post_message: (at, bytes, isText) => (isText ? post(text(at, bytes)) : self.postMessage({ data: read(at, bytes).slice().buffer })),
    panicked: (at, bytes) => {
      program.panic = text(at, bytes);
    },
  };
  program.exports = new WebAssembly.Instance(program.module, { page }).exports;
  sendOrder(program.open);
}

/** Posts a message to the page. Keeps the text of a world, so that another instance can continue with it. */
function post(data) {
  if (data.startsWith('{"kind":"world"')) {
    const { base, toml, id } = JSON.parse(data);
    const held = { base, text: toml };
    program.open = { ...program.open, held };
    program.loadedId = id;
    self.postMessage({ data, held });
  } else self.postMessage({ data });
}

function sendOrder(what) {
  const bytes = new TextEncoder().encode(JSON.stringify(what));
  const at = program.exports.room(bytes.length) >>> 0;
  new Uint8Array(program.exports.memory.buffer, at, bytes.length).set(bytes);
  program.exports.take();
}

/** Handles a request of the page: completely, or, when the time for a plan or for everything is up, the rest of it. */
function handle(request) {
  let rest = request;
  for (const spent of ['nothing', 'plan', 'all']) {
    try {
      program.loadedId = null;
      if (!program.exports) startInstance();
      sendOrder({ do: 'take', request: rest, spent: rest === request && request.do === 'load' && spent !== 'nothing' ? 'all' : spent });
      return;
    } catch (error) {
      program.exports = null;
      if (error !== STOPPED) {
        console.warn(program.panic ?? error);
        post(JSON.stringify({ kind: 'failed', id: request.id ?? request.ask.id, error: FAULT }));
        return;
      }
    }
    // The text has been loaded; its plan remains.
    if (request.do === 'load' && program.loadedId === request.id) {
      rest = { do: 'plan', id: request.id, base: program.open.held.base, final: true, state: null, options: request.options };
    }
  }
}

self.onmessage = ({ data: { module, open, request } }) => {
  if (module) {
    [program.module, program.open] = [module, open];
    try {
      startInstance();
    } catch (error) {
      program.exports = null;
      console.warn(program.panic ?? error);
      if (!open.held) post(JSON.stringify({ kind: 'failed', id: open.id, error: FAULT }));
    }
  } else handle(request);
  self.postMessage({ isFree: true });
};

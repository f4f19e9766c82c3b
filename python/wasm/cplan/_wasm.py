"""The planner as WebAssembly: in Pyodide the browser's own engine runs it, elsewhere the package `wasmtime`."""

import json
import os
import sys
import threading
from collections.abc import Callable
from importlib.resources import files
from typing import Any

from cplan._wasi import System

_CLOCK = "clock_time_get"
_IN_BROWSER = sys.platform == "emscripten"
# The stack of WebAssembly code, on top of its own memory for arrays, and the stack of its thread.
_STACK_BYTES, _THREAD_STACK_BYTES = 2 << 20, 8 << 20
Function = Callable[..., Any]


class _Wasmtime:
    """An instance in the package `wasmtime`."""

    module: Any = None
    engine: Any = None

    def __init__(self, imports: Callable[[str, str], Function]) -> None:
        import wasmtime

        if self.module is None:
            type(self)._compile()
        self.store = wasmtime.Store(self.engine)
        self.store.set_wasi(wasmtime.WasiConfig())
        linker = wasmtime.Linker(self.engine)
        linker.allow_shadowing = True
        linker.define_wasi()
        for needed in self.module.imports:
            # Only the clock is that of wasmtime, since loops read it.
            if needed.name != _CLOCK:
                linker.define_func(needed.module, needed.name, needed.type, imports(needed.module, needed.name))
        self.exports: Any = linker.instantiate(self.store, self.module).exports(self.store)
        self.memory: Any = self.exports["memory"]

    @classmethod
    def _compile(cls) -> None:
        import wasmtime

        config = wasmtime.Config()
        config.max_wasm_stack = _STACK_BYTES
        try:
            # Compiled code is kept for the next process.
            config.cache = True
        except wasmtime.WasmtimeError:
            pass
        cls.engine = wasmtime.Engine(config)
        cls.module = wasmtime.Module(cls.engine, _program())

    def call(self, name: str, *arguments: int) -> Any:
        """Calls an exported function."""
        return self.exports[name](self.store, *arguments)

    def read(self, at: int, count: int) -> bytes:
        """Returns bytes of the memory."""
        return bytes(self.memory.read(self.store, at, at + count))

    def write(self, at: int, data: bytes) -> None:
        """Writes bytes to the memory."""
        self.memory.write(self.store, data, at)


# Loops read the clock, and a call of Python takes longer.
_JAVASCRIPT_CLOCK = """
(() => {
  const clock = { exports: null };
  clock.read = (kind, precision, at) => {
    const milliseconds = kind === 0 ? Date.now() : performance.now();
    new DataView(clock.exports.memory.buffer).setBigUint64(at >>> 0, BigInt(Math.round(milliseconds * 1e6)), true);
    return 0;
  };
  return clock;
})()
"""


class _Browser:
    """An instance in the engine of the browser, or of Node, in which Pyodide runs."""

    module: Any = None

    def __init__(self, imports: Callable[[str, str], Function]) -> None:
        import js  # type: ignore[import-not-found]
        from pyodide.code import run_js  # type: ignore[import-not-found]
        from pyodide.ffi import create_proxy, to_js  # type: ignore[import-not-found]

        if self.module is None:
            type(self).module = js.WebAssembly.Module.new(to_js(_program()))
        clock, table = run_js(_JAVASCRIPT_CLOCK), js.Object.new()
        for needed in js.WebAssembly.Module.imports(self.module):
            if not hasattr(table, needed.module):
                setattr(table, needed.module, js.Object.new())
            is_clock = needed.name == _CLOCK
            function = clock.read if is_clock else create_proxy(imports(needed.module, needed.name))
            setattr(getattr(table, needed.module), needed.name, function)
        self.bytes = js.Uint8Array
        self.exports = js.WebAssembly.Instance.new(self.module, table).exports
        clock.exports = self.exports

    def call(self, name: str, *arguments: int) -> Any:
        """Calls an exported function."""
        return getattr(self.exports, name)(*arguments)

    def read(self, at: int, count: int) -> bytes:
        """Returns bytes of the memory."""
        view: bytes = self.bytes.new(self.exports.memory.buffer, at, count).to_bytes()
        return view

    def write(self, at: int, data: bytes) -> None:
        """Writes bytes to the memory."""
        self.bytes.new(self.exports.memory.buffer, at, len(data)).assign(data)


def _program() -> bytes:
    return (files("cplan") / "cplan.wasm").read_bytes()


_CALLED_BACK = "cplan cannot be called by a function that cplan calls, such as `progress` or the handler of a signal"


class _Stopped(BaseException):
    """Ends work because of an exception in the thread that waits for it."""


class Planner:
    """The planner. One call runs at a time. An exception during a call ends the instance, and the next call begins
    another one.
    """

    def __init__(self) -> None:
        self.lock = threading.RLock()
        # Number of instances that were begun.
        self.generation = 0
        self.released: list[int] = []
        self.instance: Any = None
        self.worker: threading.Thread | None = None
        self._system = System()
        self._progress: Callable[[str], object] | None = None
        self._raised: BaseException | None = None
        self._stops = self._is_busy = False

    def call(self, request: bytes, progress: Callable[[str], object] | None) -> bytes:
        """Returns the answer to a request."""
        if self._is_busy:
            raise RuntimeError(_CALLED_BACK)
        self._is_busy, self._progress, self._raised, self._stops = True, progress, None, False
        try:
            return self._answer(request) if _IN_BROWSER else self._answer_in_thread(request)
        except BaseException:
            self.instance = None
            self._system.close()
            raise
        finally:
            self._is_busy, self._progress = False, None

    def _answer(self, request: bytes) -> bytes:
        try:
            instance = self.instance or self._begin()
            instance.write(instance.call("allocate", len(request)) & 0xFFFFFFFF, request)
            count = instance.call("call") & 0xFFFFFFFF
            return bytes(instance.read(instance.call("answer") & 0xFFFFFFFF, count))
        except Exception as error:
            # Engines replace exceptions of Python by their own.
            if self._raised is not None:
                raise self._raised from None
            raise RuntimeError(f"the planner failed: {error}; this is a defect of cplan, please report it") from error

    def _answer_in_thread(self, request: bytes) -> bytes:
        """Python raises exceptions of signals in its main thread, between any two lines. There the engine must not be at
        work, so that thread only waits.
        """
        outcome: list[bytes | BaseException] = []

        def work() -> None:
            try:
                outcome.append(self._answer(request))
            except BaseException as error:
                outcome.append(error)

        before = threading.stack_size(_THREAD_STACK_BYTES)
        try:
            self.worker = threading.Thread(target=work, name="cplan", daemon=True)
            self.worker.start()
        finally:
            threading.stack_size(before)
        try:
            self._wait()
        except BaseException:
            self._stops = True
            self._wait()
            raise
        finally:
            self.worker = None
        if isinstance(outcome[0], BaseException):
            raise outcome[0]
        return outcome[0]

    def _wait(self) -> None:
        # With a time limit, signals interrupt it on all systems.
        while self.worker is not None and self.worker.is_alive():
            self.worker.join(0.1)

    def _begin(self) -> Any:
        self._system = System()
        self.instance = (_Browser if _IN_BROWSER else _Wasmtime)(self._import)
        self._system.memory = self.instance
        self.generation += 1
        self.released.clear()
        self.instance.call("__wasm_call_ctors")
        return self.instance

    def _import(self, module: str, name: str) -> Function:
        """Returns a function that the program imports, which keeps its exception."""
        own: dict[str, Function] = {"poll": self._poll, "progress": self._report}
        function = own[name] if module == "python" else self._system.call(name)

        def guarded(*arguments: int) -> Any:
            try:
                return function(*arguments)
            except BaseException as error:
                self._raised = error
                raise

        return guarded

    def _poll(self) -> None:
        if self._stops:
            raise _Stopped

    def _report(self, at: int, count: int) -> None:
        if self._progress is not None:
            self._progress(self.instance.read(at & 0xFFFFFFFF, count).decode())


PLANNER = Planner()


class InputError(ValueError):
    """Invalid input. The text of the exception states each problem with file, line and hint. `diagnostics` lists them as
    dictionaries with `file`, `line`, `column`, `message` and `help`; `line` and `column` are None if unknown.
    """

    diagnostics: list[dict[str, Any]]


def ask(request: dict[str, Any], progress: Callable[[str], object] | None = None) -> Any:
    """Returns the answer to a request: a value, or the bytes of a text or a file."""
    if threading.current_thread() is PLANNER.worker:
        raise RuntimeError(_CALLED_BACK)
    with PLANNER.lock:
        # Objects of an instance that has ended are made again now, before the request itself.
        encoded = json.dumps(request, default=_encoded, allow_nan=False)
        released, PLANNER.released = PLANNER.released, []
        envelope = f'{{"folder": {json.dumps(os.getcwd())}, "released": {released}, "request": {encoded}}}'
        answer = PLANNER.call(envelope.encode(), progress)
    kind, content = answer[:1], answer[1:]
    if kind == b"b":
        return content
    value = json.loads(content)
    if kind == b"j":
        return value
    if value["kind"] == "input":
        error = InputError(value["message"])
        error.diagnostics = value["diagnostics"]
        raise error
    raise {"value": ValueError, "system": OSError}[value["kind"]](value["message"])


def _encoded(value: Any) -> Any:
    """Returns what JSON has in place of an object: its number, its content, or the list of an array."""
    if isinstance(value, Handle):
        return value.number
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    for member in ("_content", "tolist"):
        if hasattr(value, member):
            return getattr(value, member)()
    raise TypeError(f"unexpected {type(value).__name__}: {value!r}")


class Handle:
    """An object of the planner, by its number. If its instance has ended, the same request makes it again."""

    __slots__ = ("request", "answer", "_generation")

    def __init__(self, request: dict[str, Any], progress: Callable[[str], object] | None = None) -> None:
        self.request = request
        self._make(progress)

    def _make(self, progress: Callable[[str], object] | None = None) -> None:
        with PLANNER.lock:
            self.answer = ask(self.request, progress)
            self._generation = PLANNER.generation

    @property
    def number(self) -> int:
        """The number in the present instance."""
        # After an exception, the next instance has no objects.
        if self._generation != PLANNER.generation or PLANNER.instance is None:
            self._make()
        number: int = self.answer["id"]
        return number

    def __del__(self) -> None:
        # The answer is missing if the request failed.
        if getattr(self, "_generation", None) == PLANNER.generation:
            PLANNER.released.append(self.answer["id"])

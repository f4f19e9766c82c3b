"""Arms, worlds, problems and plans, which the planner in WebAssembly reads and makes."""

import json
import os
from collections.abc import Callable, Sequence
from importlib import import_module
from typing import Any, ClassVar, final

from cplan._wasm import Handle, ask


def absolute(path: str | os.PathLike[str]) -> str:
    """Returns an absolute path. After unpickling in another process, or in another working directory, the files beside
    it are still found.
    """
    return os.path.abspath(path)


def frozen(rows: Any, *shape: int) -> Any:
    """Returns a read-only array."""
    import numpy as np

    array = np.array(rows, dtype=np.float64).reshape(*shape)
    array.flags.writeable = False
    return array


class _File:
    """A file that Python holds as the planner read it."""

    __slots__ = ("_data", "_description", "_text")
    _text: str
    _description: str

    def __init__(self, answer: dict[str, Any]) -> None:
        self._data, self._text, self._description = answer["data"], answer["text"], answer["description"]

    def _content(self) -> Any:
        return self._data

    def __eq__(self, other: object, /) -> bool:
        return type(other) is type(self) and other._data == self._data

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return self._description

    def __reduce__(self) -> Any:
        return type(self).restored, (json.dumps(self._data, ensure_ascii=False, separators=(",", ":")),)  # type: ignore[attr-defined]


@final
class Arm(_File):
    """A planar two-joint arm: a robot in URDF, or one that is made in code.

    Lengths are metres, angles radians. A URDF is checked together with a world, which contains the data that a URDF
    leaves open.
    """

    __slots__ = ()

    @staticmethod
    def from_urdf(path: Any, *, xacro_args: dict[str, str] | None = None) -> "Arm":
        """Reads a URDF or xacro file; `xacro_args` replace the defaults of its arguments."""
        return Arm(ask({"do": "read_arm", "path": absolute(path), "arguments": xacro_args or {}}))

    @staticmethod
    def from_text(text: str, name: str = "arm.urdf") -> "Arm":
        """Reads a URDF text. `name` appears in messages."""
        return Arm(ask({"do": "arm_of_text", "text": text, "name": name}))

    @staticmethod
    def restored(data: str) -> "Arm":
        """Restores a pickled arm."""
        return Arm(ask({"do": "arm_restored", "arm": json.loads(data)}))

    @staticmethod
    def rr(
        lengths: Sequence[float],
        width: float,
        *,
        limits: Any = None,
        velocity: Any = None,
        acceleration: Any = None,
    ) -> "Arm":
        """Creates an arm of two bars with round ends, of these lengths and this width in metres. The joints "joint 1" and
        "joint 2" are continuous, or have `limits` ((lower, upper) of each, radians). They move at 1 rad/s, or at
        `velocity`. They reach that in 0.25 s, or with `acceleration`.
        """
        numbers = {"limits": limits, "velocity": velocity, "acceleration": acceleration}
        return Arm(ask({"do": "rr", "lengths": lengths, "width": width, "numbers": numbers}))

    @staticmethod
    def scara(links: Any = None, stroke: float | None = None, *, limits: Any = None, velocity: Any = None) -> "Arm":
        """Creates a SCARA by the numbers of its data sheet, as `cplan init --kind scara` does: lengths of both links and
        travel of the quill in metres, `limits` ((lower, upper) of "axis_1" and "axis_2", radians) and their top speeds
        `velocity` (rad/s). Missing numbers are those of `cplan init`.
        """
        numbers = {"limits": limits, "velocity": velocity}
        return Arm(ask({"do": "scara", "links": links, "stroke": stroke, "numbers": numbers}))

    @property
    def urdf(self) -> str | None:
        """The text of the URDF; None for an arm that is made in code."""
        text: str | None = self._text
        return text

    def joints(self, world: "World") -> list[str]:
        """Returns the names of the two joints that are planned in a world, base to tip."""
        names: list[str] = ask({"do": "joints", "arm": self, "world": world})
        return names


@final
class World(_File):
    """A polygonal workspace, with start and goal or steps: the text of a world file (TOML)."""

    __slots__ = ()

    def __new__(cls, *obstacles: Any, **keys: Any) -> "World":
        """Creates a world from obstacles, given one after the other, and the other keys of a world file by name."""
        document = import_module("cplan._world").document
        return cls._of(ask({"do": "world_of_keys", "keys": document(obstacles, keys)}))

    def __init__(self, *obstacles: Any, **keys: Any) -> None:
        pass

    @staticmethod
    def _of(answer: dict[str, Any]) -> "World":
        world = object.__new__(World)
        _File.__init__(world, answer)
        return world

    @staticmethod
    def from_toml(path: Any) -> "World":
        """Reads a world file (TOML)."""
        return World._of(ask({"do": "read_world", "path": absolute(path)}))

    @staticmethod
    def from_text(text: str, name: str = "world.toml") -> "World":
        """Reads the text of a world file. `name` appears in messages."""
        return World._of(ask({"do": "world_of_text", "text": text, "name": name}))

    @staticmethod
    def restored(data: str) -> "World":
        """Restores a pickled world."""
        return World._of(ask({"do": "world_restored", "world": json.loads(data)}))

    @property
    def toml(self) -> str:
        """The text of the world file."""
        return self._text


@final
class Options:
    """Options of a plan, which can also replace the world's start, goal and clearance: words of the program's command
    line.
    """

    __slots__ = ("_words",)
    _words: list[str]

    def __new__(cls, words: Sequence[str]) -> "Options":
        """Parses words such as `--planner=harmonic`."""
        options = object.__new__(cls)
        options._words = list(words)
        if words:
            ask({"do": "options", "options": options._words})
        return options

    def _content(self) -> list[str]:
        return self._words

    def __eq__(self, other: object, /) -> bool:
        return type(other) is Options and other._words == self._words

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<cplan.Options: {' '.join(self._words)}>"

    def __reduce__(self) -> Any:
        return Options, (self._words,)


class Held:
    """An object that the planner holds. It never changes."""

    __slots__ = ("_handle",)
    _handle: Handle

    @classmethod
    def _of(cls, request: dict[str, Any], progress: Callable[[str], object] | None = None) -> Any:
        held = object.__new__(cls)
        held._handle = Handle(request, progress)
        return held

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, _memo: Any) -> Any:
        return self


def answered(name: str, doc: str) -> Any:
    """Returns a property with a member of the planner's answer."""
    return property(lambda self: self._handle.answer[name], doc=doc)


@final
class Problem(Held):
    """An arm in its world with a task, read and checked."""

    __slots__ = ()

    def __new__(cls, arm: Arm, world: World, options: Options | None = None) -> "Problem":
        """Creates a problem. Raises InputError with all defects of arm, world, start and goal."""
        problem: Problem = cls._of({"do": "problem", "arm": arm, "world": world, "options": options or []})
        return problem

    notes = answered("notes", "Notes on the files for the user, line by line.")
    joints = answered("joints", "Names of the two joints, base to tip.")
    kind = answered("kind", "Kind of the arm: RR, PP, RP or PR.")
    start = answered("start", "The start, base to tip, radians or metres.")

    @property
    def goals(self) -> Any:
        """The goals, shape (n, 2): each is enough. Goals that leave a joint free are not listed."""
        return frozen(self._handle.answer["goals"], -1, 2)

    @staticmethod
    def restored(data: str) -> "Problem":
        """Restores a pickled problem."""
        problem: Problem = Problem._of({"do": "problem_restored", "data": data})
        return problem

    def __reduce__(self) -> Any:
        data = ask({"do": "problem_stored", "problem": self._handle})
        return Problem.restored, (json.dumps(data, ensure_ascii=False, separators=(",", ":")),)


class Plan(Held):
    """An answer to a problem, with everything that the program prints, writes and draws: Found, Infeasible or Unknown.
    Frozen. A pickled plan contains problem, options and result; unpickling plans again, and compares the results.
    """

    __slots__ = ("_path", "_trajectory")

    def __new__(cls) -> "Plan":
        raise TypeError(f"cannot create 'cplan.{cls.__name__}' instances")

    status = answered("status", "The status of the answer: found, infeasible or unknown.")
    planner = answered("planner", "Name of the planner.")
    reason = answered("reason", "The reason why there is no motion, or why the answer is unknown.")
    notes = answered("notes", "Notes on the problem for the user, line by line.")

    def _asked(self, content: str) -> str:
        text: str = ask({"do": "plan_text", "plan": self._handle, "content": content}).decode()
        return text

    def summary(self) -> str:
        """Returns a summary of some ten lines for people."""
        return self._asked("summary")

    def to_json(self) -> str:
        """Returns the result as a JSON object."""
        return self._asked("json")

    def svg(self) -> str:
        """Returns workspace and configuration space side by side, as SVG."""
        return self._asked("svg")

    def html(self) -> str:
        """Returns a page in which the arm can be moved."""
        return self._asked("html")

    def cspaces(self) -> Any:
        """Returns the configuration spaces and the planner's data in them, as arrays (see `cplan.cspace`): one space for
        a motion, and for a task one for each world that the arm moves in.
        """
        return import_module("cplan.cspace").read(self._asked("cspaces"))

    def save(self, path: Any) -> None:
        """Writes the plan into a file, in the format of its name: .json, .csv, .yaml, .mcap, .svg, .png, .gif, .html;
        cspace.json and .geojson.
        """
        ask({"do": "save", "plan": self._handle, "path": path})

    def _repr_html_(self) -> str:
        """Returns the plan as HTML for a notebook."""
        page = self.html().replace("&", "&amp;").replace('"', "&quot;")
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 640px; border: 0"></iframe>'

    def __repr__(self) -> str:
        return f"<cplan.{type(self).__name__}: {self._handle.answer['verdict']}>"

    def __reduce__(self) -> Any:
        return restored, (self._asked("stored").encode(),)


@final
class Found(Plan):
    """A motion that is certified collision-free along its whole length."""

    __slots__ = ()
    __match_args__: ClassVar[tuple[str, ...]] = ("path", "trajectory")

    @property
    def path(self) -> Any:
        """The waypoints, shape (n, 2), with straight segments between them; read-only."""
        if not hasattr(self, "_path"):
            self._path = frozen(ask({"do": "path", "plan": self._handle}), -1, 2)
        return self._path

    @property
    def trajectory(self) -> Any:
        """The whole motion in time."""
        if not hasattr(self, "_trajectory"):
            motion = ask({"do": "trajectory", "plan": self._handle})
            columns = [frozen(motion.pop("time"), -1)]
            columns += [frozen(motion.pop(name), -1, 2) for name in ("position", "velocity", "acceleration")]
            self._trajectory = import_module("cplan._frames").Trajectory(*columns, **motion)
        return self._trajectory

    length = answered("length", "Euclidean length of the path in joint space; for a task, the sum for all its motions.")
    duration = answered("duration", "Duration of the whole motion in seconds.")
    clearance = answered(
        "clearance",
        "Proven lower bound on the distance between arm and obstacles during the whole motion, in metres; None if no "
        "obstacle is within reach.",
    )
    lower_bound = answered(
        "lower_bound", "Proven lower bound on the length of all paths; None for planners that do not compute one."
    )
    gap = answered("gap", "Largest possible excess of the path over the shortest one, as a fraction.")


@final
class Infeasible(Plan):
    """A proof that there is no motion."""

    __slots__ = ()
    __match_args__: ClassVar[tuple[str, ...]] = ("reason",)


@final
class Unknown(Plan):
    """The answer is unknown at the resolution that was tried."""

    __slots__ = ()
    __match_args__: ClassVar[tuple[str, ...]] = ("reason",)


def _outcome(request: dict[str, Any], progress: Callable[[str], object] | None = None) -> Any:
    """Returns a plan as an object of the class of its outcome."""
    handle = Handle(request, progress)
    plan = object.__new__({"found": Found, "infeasible": Infeasible, "unknown": Unknown}[handle.answer["status"]])
    plan._handle = handle
    return plan


def plan(problem: Problem, options: Options | None = None, progress: Callable[[str], object] | None = None) -> Any:
    """Plans. `progress` is called with a line of text from time to time during long work."""
    return _outcome({"do": "plan", "problem": problem._handle, "options": options or []}, progress)


def restored(data: bytes) -> Any:
    """Restores a pickled plan: it plans again, and raises if the result differs."""
    return _outcome({"do": "plan_restored", "data": data.decode()})


def seconds_in_rust(problem: Problem, options: Options | None = None, count: int = 1) -> float:
    """Returns the average time of `count` plans in seconds, without Python. The overhead of `plan` is measured against
    it.
    """
    request = {"do": "seconds_in_rust", "problem": problem._handle, "options": options or [], "count": count}
    seconds: float = ask(request)
    return seconds

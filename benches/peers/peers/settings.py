"""How long, how often, and where things are."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


class NotRunError(Exception):
    """A peer is not here, or failed: why."""


@dataclass(frozen=True)
class Settings:
    """Of one run of the harness."""

    cplan: str
    work: Path
    quick: bool

    def choose(self, full: int, quick: int) -> int:
        """How often."""
        return quick if self.quick else full

    def missing(self, peer: str) -> str | None:
        """Why the `run` script could not provide a peer; nothing if it could."""
        file = self.work / "missing"
        if file.exists():
            for line in file.read_text().splitlines():
                name, reason = line.split("\t", 1)
                if name == peer:
                    return reason
        return None

    def demand(self, peer: str) -> None:
        """Raises the reason why a peer is missing."""
        if reason := self.missing(peer):
            raise NotRunError(reason)

    def rust(self, *arguments: str, timeout: float = 300.0, given: str | None = None) -> Any:  # noqa: ANN401
        """What the Rust peers' program reports."""
        self.demand("rust")
        return called([str(self.work / "cplan-peers"), *arguments], timeout, given)


def called(command: Sequence[str], timeout: float, given: str | None = None) -> Any:  # noqa: ANN401
    """Runs a program and reads the JSON that it prints."""
    try:
        run = subprocess.run(command, input=given, capture_output=True, text=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired as error:
        raise NotRunError(f"no answer within {timeout:g} s") from error
    if run.returncode != 0:
        words = run.stderr.strip().splitlines() or [f"exit code {run.returncode}"]
        raise NotRunError(words[-1])
    return json.loads(run.stdout)


def say(text: str) -> None:
    """Progress."""
    print(text, file=sys.stderr, flush=True)

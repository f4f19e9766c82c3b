"""The program `cplan`."""

import signal
import sys

from cplan._cplan import run


def main() -> int:
    """Runs the program with the arguments of the process; returns its exit code."""
    # Python's own handler would wait until the program ends.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run(["cplan", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())

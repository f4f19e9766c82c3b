"""The program `cplan`."""

import sys

from cplan._cplan import run


def main() -> int:
    """Runs the program with the arguments of the process; returns its exit code."""
    return run(["cplan", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())

"""Reads programs in RAPID by the grammar of the package rapidchecker, which follows ABB's manual of the language's kernel.

    python tests/python/read_rapid.py PROGRAM.mod ...

ANTLR's public grammar (antlr/grammars-v4, abb) cannot read any such program: it has no ENDMODULE, and no targets in instructions.
"""

import sys

from rapidchecker.check import check_format

# Damages that the grammar must find, so that its silence means something.
DAMAGES = [
    ("ENDPROC", "END"),
    ("PROC main()", "PROC main"),
    (", fine,", " fine,"),
    ("]], vmax", "], vmax"),
    (", 7000;", ", 7000"),
    ("MODULE ", "MODULE my "),
    ("  ! ", "  "),
]


def main(files):
    for file in files:
        with open(file) as opened:
            text = opened.read()
        errors = check_format(text)
        assert not errors, f"{file}: {errors[0]}"
        assert text.count("MoveAbsJ") > 3, f"{file} has no moves"
        for is_right, is_wrong in DAMAGES:
            assert is_right in text, f"{file}: no {is_right!r}"
            assert check_format(text.replace(is_right, is_wrong, 1)), f"{file}: {is_wrong!r} is not found"


if __name__ == "__main__":
    assert sys.argv[1:], "no files"
    main(sys.argv[1:])

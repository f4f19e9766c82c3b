"""The check that all tests of the grader share."""

from typing import Any

import cplan


def is_graded(exercise: str, answer: Any, reason: str) -> None:
    """Asserts the reason of a grade, that it is explained, and that a wrong answer is drawn with the place of its fault."""
    grade = cplan.grade(exercise, answer)
    assert (grade.reason, bool(grade)) == (reason, reason == "right"), f"{grade.message} {grade.figures}"
    assert len(grade.message) > 10
    picture = grade.svg()
    assert picture.startswith("<svg") and (reason == "right") == ("wrong: " not in picture)

"""A drawn campaign through the stages, and how its diagnosis compares with what was hidden."""

import time
from functools import cache
from pathlib import Path
from typing import Any

import chain
from campaigns import diagnosed
from diagnosis_draws import Drawn, drawn
from judge import at_reference, judge, parameters_of
from resumable import code_of_outcomes

HERE = Path(__file__).parent
DRAWN_BY = ("campaigns", "cases", "judge", "diagnosis_draws", "diagnosis_faults")
HIDDEN_BY = ("plans", "sizes", "ways", "draws", "elsewhere")
UNKNOWN_TRUTH = {"absorbed", "reported"}  # the 24 parameters take up what is hidden

Outcome = dict[str, Any]


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    stages = [name for name in chain.up_to("diagnosis") if name not in chain.BESIDE]
    own = [HERE / f"{name}.py" for name in DRAWN_BY]
    own += [HERE.parent / f"hidden/hidden_{name}.py" for name in HIDDEN_BY]
    return code_of_outcomes(stages, own)


def outcome(name: str) -> Outcome:
    """What was hidden and what was said, as plain numbers and text; or the error it ended with."""
    told = drawn(name)
    row = {
        "name": name,
        "code": code(),
        "part": told.part,
        "plan": told.plan,
        "what": told.what,
        "size": told.size,
        "ratio": told.ratio,
    }
    start = time.process_time()
    try:
        said = _said(told)
    except Exception as error:  # it is counted, and the others go on
        said = {"error": f"{type(error).__name__}: {error}"}
    return row | said | {"seconds": time.process_time() - start}


def _said(told: Drawn) -> Outcome:
    tables = diagnosed(told.document)
    truth = None
    if told.part not in UNKNOWN_TRUTH:
        truth = at_reference(parameters_of(told.document), told.document, tables["result"])
    found = judge(tables, told.causes, None, truth)
    return {
        "rows": len(tables["causes"]),
        "right": list(found.right),
        "missing": list(found.missing),
        "extra": list(found.extra),
        "flawed": list(found.flawed),
        "verdicts": {
            str(row["sensor"]): str(row["verdict"]) for row in tables["verdict"].to_dict("records")
        },
        "pulls": dict(found.pulls),
    }

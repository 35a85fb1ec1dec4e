"""The document as JSON: every number to the last bit, one row of a matrix on one line."""

import json
import re

from inertial.campaign.records import Row

# A list of numbers alone, as json.dumps breaks it over lines. A text holds no raw line break, and
# so is never taken for one.
_ROW = re.compile(r'\[\n([^\[\]{}"]*)\n\s*\]')


def calibration_json(document: Row) -> str:
    """`document` as JSON text."""
    text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
    return _ROW.sub(lambda row: f"[{' '.join(row[1].split())}]", text) + "\n"

"""Plain values as YAML that readers of version 1.1 and of version 1.2 understand alike.

Every text is quoted, so that none is taken for a date, a number or a truth value; every number
with an exponent has a point, for `1e-05` is a text to readers of version 1.1.
"""

from io import StringIO
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedSeq
from ruamel.yaml.representer import RoundTripRepresenter
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

FLOAT, NULL = "tag:yaml.org,2002:float", "tag:yaml.org,2002:null"
WIDTH = 1_000_000  # no line is broken


class _Representer(RoundTripRepresenter):
    """Numbers and nulls as both versions read them."""

    def represent_plain_float(self, value: float) -> Any:
        text = repr(value)
        return self.represent_scalar(FLOAT, text if "." in text else text.replace("e", ".0e"))

    def represent_plain_null(self, _: None) -> Any:
        return self.represent_scalar(NULL, "null")


_Representer.add_representer(float, _Representer.represent_plain_float)
_Representer.add_representer(type(None), _Representer.represent_plain_null)


def yaml_text(document: Any) -> str:
    """`document`, of dicts, lists, texts, finite numbers, truth values and None, as YAML."""
    writer = YAML()
    writer.Representer = _Representer
    writer.width = WIDTH
    writer.indent(mapping=2, sequence=4, offset=2)
    text = StringIO()
    writer.dump(_styled(document), text)
    return text.getvalue()


def _styled(node: Any) -> Any:
    """The same with every text quoted, and with lists of numbers on one line."""
    if isinstance(node, dict):
        return {key: _styled(value) for key, value in node.items()}
    if isinstance(node, list):
        styled = CommentedSeq(_styled(value) for value in node)
        if all(value is None or isinstance(value, float | int) for value in node):
            styled.fa.set_flow_style()
        return styled
    return DoubleQuotedScalarString(node) if isinstance(node, str) else node

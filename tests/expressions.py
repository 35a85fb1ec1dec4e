"""Values of the equations that files and effects state as text, as C and Python read them alike."""

import ast
import operator
from collections.abc import Mapping
from typing import Any

import numpy as np

OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.USub: operator.neg,
    ast.Gt: operator.gt,
}
FUNCTIONS = {"abs": np.abs, "exp": np.exp}


def value_of(text: str, names: Mapping[str, Any]) -> Any:
    """The value of an expression; a name with a point in it is one name."""
    return _value(ast.parse(text, mode="eval").body, names)


def _value(node: ast.expr, names: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value):
            return value
        case ast.Name() | ast.Attribute():
            return names[ast.unparse(node)]
        case ast.BinOp(left, op, right):
            return OPERATORS[type(op)](_value(left, names), _value(right, names))
        case ast.UnaryOp(op, operand):
            return OPERATORS[type(op)](_value(operand, names))
        case ast.Compare(left, [op], [right]):
            return OPERATORS[type(op)](_value(left, names), _value(right, names)) * 1.0
        case ast.Call(ast.Name(name), [argument]):
            return FUNCTIONS[name](_value(argument, names))
    raise ValueError(f"{ast.unparse(node)} is no expression of an equation")

"""Faults of physics in a module, one at a time: a sign, a transpose, an index, a factor, a term.

Each replaces one expression of the source and leaves the rest as it is. Other faults, such as a
changed message or default, are no physics and are not made; nor are those of typical sizes and of
types.
"""

import ast
from collections.abc import Iterator
from dataclasses import dataclass

SWAPPED: dict[type[ast.operator], tuple[str, str]] = {
    ast.Add: ("sign", "-"),
    ast.Sub: ("sign", "+"),
    ast.Mult: ("factor", "/"),
    ast.Div: ("factor", "*"),
}
# What an effect declares of its parameters and their typical sizes.
DECLARED = {"parameters", "sizes", "UNIT"}


@dataclass(frozen=True)
class Mutation:
    """One fault: the bytes from `start` to `end` of a source are replaced.

    `kind`: sign, transpose, index, factor or term; `line`: of its start, from 1; `before`, `after`:
    the expression.
    """

    kind: str
    line: int
    start: int
    end: int
    before: str
    after: str

    def applied(self, source: bytes) -> bytes:
        """The source with the fault in it."""
        return source[: self.start] + self.after.encode() + source[self.end :]


def mutations(source: bytes) -> list[Mutation]:
    """All faults of a module, in the order of the source."""
    found = set(_Finder(source).every(ast.parse(source)))
    return sorted(found, key=lambda one: (one.start, one.end, one.kind, one.after))


class _Finder:
    def __init__(self, source: bytes) -> None:
        self.source = source
        lines = source.splitlines(keepends=True)
        self.starts = [0]
        for line in lines:
            self.starts.append(self.starts[-1] + len(line))

    def every(self, node: ast.AST) -> Iterator[Mutation]:
        """The faults of a node and of all below it, but for annotations and strings."""
        if isinstance(node, ast.AnnAssign):
            if node.value is not None:
                yield from self.every(node.value)
            return
        if isinstance(node, ast.Assign) and _declares(node):
            return
        if isinstance(node, ast.FunctionDef):
            for part in (*node.args.defaults, *node.body):
                yield from self.every(part)
            return
        if isinstance(node, ast.expr):
            yield from self._of(node)
        for below in ast.iter_child_nodes(node):
            if not isinstance(below, ast.JoinedStr):
                yield from self.every(below)

    def _of(self, node: ast.expr) -> Iterator[Mutation]:
        match node:
            case ast.BinOp(left, operator, right) if not _of_text(left, right):
                yield from self._operator(node, left, operator, right)
            case ast.UnaryOp(ast.USub(), operand) if not isinstance(operand, ast.Constant):
                yield self._fault("sign", node, self._text(operand))
            case ast.Attribute(value, "T" | "mT"):
                yield self._fault("transpose", node, self._text(value))
            case ast.Subscript(value, ast.Tuple([first, second])) if not _is_slice(first, second):
                swapped = f"[{self._text(second)}, {self._text(first)}]"
                yield self._fault("index", node, f"({self._text(value)}){swapped}")
            case ast.Subscript(value, ast.Constant(int() as place)):
                other = 1 if place == 0 else 0
                yield self._fault("index", node, f"({self._text(value)})[{other}]")

    def _operator(
        self, node: ast.expr, left: ast.expr, operator: ast.operator, right: ast.expr
    ) -> Iterator[Mutation]:
        one, two = self._text(left), self._text(right)
        if type(operator) in SWAPPED:
            kind, sign = SWAPPED[type(operator)]
            yield self._fault(kind, node, f"({one}) {sign} ({two})")
        if isinstance(operator, ast.Add | ast.Sub):
            yield self._fault("term", node, one)
        if isinstance(operator, ast.Mult):
            yield self._fault("factor", node, f"2 * ({one}) * ({two})")
        if isinstance(operator, ast.Pow) and isinstance(right, ast.Constant):
            yield self._fault("factor", node, f"({one}) ** ({two} + 1)")
        if isinstance(operator, ast.MatMult) and not one.endswith(".T"):
            yield self._fault("transpose", node, f"({one}).T @ ({two})")

    def _fault(self, kind: str, node: ast.expr, after: str) -> Mutation:
        start, end = self._place(node)
        before = self.source[start:end].decode()
        return Mutation(kind, node.lineno, start, end, before, f"({after})")

    def _text(self, node: ast.expr) -> str:
        start, end = self._place(node)
        return self.source[start:end].decode()

    def _place(self, node: ast.expr) -> tuple[int, int]:
        assert node.end_lineno is not None and node.end_col_offset is not None
        return (
            self.starts[node.lineno - 1] + node.col_offset,
            self.starts[node.end_lineno - 1] + node.end_col_offset,
        )


def _declares(node: ast.Assign) -> bool:
    """Whether typical sizes are assigned, or a type, whose name has capitals and small letters."""
    names = [target.id for target in node.targets if isinstance(target, ast.Name)]
    return any(name in DECLARED or (name[0].isupper() and not name.isupper()) for name in names)


def _is_slice(*nodes: ast.expr) -> bool:
    return any(isinstance(node, ast.Slice) or _is_nothing(node) for node in nodes)


def _is_nothing(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value in (None, Ellipsis)


def _of_text(*nodes: ast.expr) -> bool:
    """Whether strings or lists are joined."""
    return any(
        isinstance(node, ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp)
        or (isinstance(node, ast.Constant) and isinstance(node.value, str))
        for node in nodes
    )

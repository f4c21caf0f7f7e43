"""Code fingerprints: the syntax of a function and of everything of its package that it reaches.

Comments, docstrings, annotations and formatting do not count; a changed helper, constant or class does.
"""

from __future__ import annotations

import ast
import hashlib
from collections.abc import Callable, Collection, Iterator

Definition = tuple[str, str]  # module, name


class SourceTree:
    """The modules of one package, parsed when first needed.

    read: source text of a module of the package, or None where there is no such module.
    packages: modules that are packages (an `__init__.py`), from where relative imports start inside.
    """

    def __init__(self, read: Callable[[str], str | None], packages: Collection[str] = ()) -> None:
        self._read, self._packages = read, packages
        self._modules: dict[str, _Module | None] = {}
        self._hashes: dict[Definition, str] = {}
        self._needs: dict[Definition, list[Definition]] = {}

    def functions(self, module: str, *names: str) -> dict[str, str]:
        """`module:name` -> hash, for the named definitions and everything they reach, sorted."""
        reached: dict[Definition, str] = {}
        todo: list[Definition] = [(module, name) for name in names]
        while todo:
            definition = todo.pop()
            if definition not in reached and self._examine(definition):
                reached[definition] = self._hashes[definition]
                todo += self._needs[definition]
        return {f"{where}:{name}": reached[where, name] for where, name in sorted(reached)}

    def _module(self, name: str) -> _Module | None:
        if name not in self._modules:
            source = self._read(name)
            self._modules[name] = (
                None if source is None else _Module(name, ast.parse(source), name in self._packages)
            )
        return self._modules[name]

    def _examine(self, definition: Definition) -> bool:
        """Hash one definition and note what it needs. False where the package has no such definition."""
        if definition in self._hashes:
            return True
        module = self._module(definition[0])
        statements = module.definitions.get(definition[1]) if module else None
        if not module or not statements:
            return False
        text = "\n".join(ast.unparse(_Stripped().visit(_copy(statement))) for statement in statements)
        self._hashes[definition] = hashlib.blake2b(text.encode(), digest_size=8).hexdigest()
        self._needs[definition] = [
            found
            for statement in statements
            for used in _uses(statement)
            if (found := self._resolve(module, statement, used))
        ]
        return True

    def _resolve(self, module: _Module, statement: ast.stmt, used: tuple[str, ...]) -> Definition | None:
        """Where a (dotted) name used in a statement is defined, if in this package."""
        head, *rest = used
        local = dict(_imports(statement, module.base))
        if head not in local and head in module.definitions:
            return module.name, head
        target = local.get(head) or module.imports.get(head)
        return self._follow(target, rest) if target else None

    def _follow(self, target: tuple[str, ...], rest: list[str]) -> Definition | None:
        """Follow an imported dotted target, then attributes, to a definition; re-exports are followed too."""
        path = [*target, *rest]
        for size in range(len(path), 0, -1):
            module = self._module(".".join(path[:size]))
            if module is None:
                continue
            if size == len(path):
                return None
            name = path[size]
            if name in module.definitions:
                return module.name, name
            again = module.imports.get(name)
            return (
                self._follow(again, path[size + 1 :]) if again and again != tuple(path[: size + 1]) else None
            )
        return None


class _Module:
    def __init__(self, name: str, tree: ast.Module, is_package: bool) -> None:
        self.name = name
        # where relative imports start
        self.base = tuple(name.split(".") if is_package else name.split(".")[:-1])
        self.definitions: dict[str, list[ast.stmt]] = {}
        self.imports: dict[str, tuple[str, ...]] = {}
        for statement in _top_level(tree.body):
            for defined in _defines(statement):
                self.definitions.setdefault(defined, []).append(statement)
            if isinstance(statement, ast.Import | ast.ImportFrom):
                self.imports |= dict(_imports(statement, self.base))


def _top_level(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Statements of a module, those under `if` and `try` too."""
    for statement in body:
        if isinstance(statement, ast.If | ast.Try):
            for inner in (statement.body, statement.orelse, getattr(statement, "finalbody", [])):
                yield from _top_level(inner)
            for handler in getattr(statement, "handlers", []):
                yield from _top_level(handler.body)
        else:
            yield statement


def _defines(statement: ast.stmt) -> Iterator[str]:
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        yield statement.name
    elif isinstance(statement, ast.Assign | ast.AnnAssign | ast.AugAssign):
        targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
        for target in targets:
            # X[k] = v and X.a = v define X a little further
            yield from (n.id for n in ast.walk(target) if isinstance(n, ast.Name))


def _imports(statement: ast.stmt, base: tuple[str, ...]) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Names bound by imports anywhere in a statement: local name -> dotted target."""
    for inner in ast.walk(statement):
        if isinstance(inner, ast.Import):
            for alias in inner.names:
                whole = tuple(alias.name.split("."))
                yield (alias.asname, whole) if alias.asname else (whole[0], whole[:1])
        elif isinstance(inner, ast.ImportFrom):
            above = base[: len(base) - inner.level + 1] if inner.level else ()
            source = (*above, *(inner.module.split(".") if inner.module else ()))
            for alias in inner.names:
                yield alias.asname or alias.name, (*source, alias.name)


def _uses(statement: ast.stmt) -> set[tuple[str, ...]]:
    """Names and dotted names that a statement reads; of a.b.c also its heads, whichever is a module."""
    used: set[tuple[str, ...]] = set()
    skip = _annotations(statement)
    for inner in ast.walk(statement):
        if id(inner) in skip:
            continue
        if isinstance(inner, ast.Name):
            used.add((inner.id,))
        elif isinstance(inner, ast.Attribute):
            path, value = [inner.attr], inner.value
            while isinstance(value, ast.Attribute):
                path.append(value.attr)
                value = value.value
            if isinstance(value, ast.Name):
                used.add((value.id, *reversed(path)))
    return used


def _annotations(statement: ast.stmt) -> set[int]:
    """Ids of all syntax inside annotations of functions."""
    inside: set[int] = set()
    for inner in ast.walk(statement):
        notes: list[ast.expr | None] = []
        if isinstance(inner, ast.FunctionDef | ast.AsyncFunctionDef):
            notes.append(inner.returns)
        elif isinstance(inner, ast.arg):
            notes.append(inner.annotation)
        for note in notes:
            if note is not None:
                inside |= {id(part) for part in ast.walk(note)}
    return inside


def _copy(statement: ast.stmt) -> ast.stmt:
    return ast.parse(ast.unparse(statement)).body[0]


class _Stripped(ast.NodeTransformer):
    """Removes docstrings, annotations and the @node declaration."""

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        node.returns = None
        if any(map(_is_declaration, node.decorator_list)):
            # the defaults of a node's parameters are in its canonical parameters already
            node.args.kw_defaults = [None] * len(node.args.kw_defaults)
        node.decorator_list = [d for d in node.decorator_list if not _is_declaration(d)]
        return self._body(node)

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.AST:
        return self._body(node)

    def visit_arg(self, node: ast.arg) -> ast.AST:
        node.annotation = None
        return node

    def _body(self, node: ast.FunctionDef | ast.ClassDef) -> ast.AST:
        self.generic_visit(node)
        first = node.body[0]
        if (
            isinstance(first, ast.Expr)
            and isinstance(first.value, ast.Constant)
            and isinstance(first.value.value, str)
        ):
            node.body = node.body[1:] or [ast.Pass()]
        return node


def _is_declaration(decorator: ast.expr) -> bool:
    called = decorator.func if isinstance(decorator, ast.Call) else decorator
    name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
    return name == "node"

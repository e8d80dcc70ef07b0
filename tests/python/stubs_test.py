"""The types of the package (*.pyi beside it): every public name has one, and signatures are those of the module."""
import ast
import inspect
import os
import re
import unittest

import bough
from bough import _bough, reader

FOLDER = os.path.dirname(bough.__file__)


def read_stub(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as f:
        return ast.parse(f.read())


def collect(body):
    """Names that a stub (or a class in it) declares, without private ones."""
    found = {}
    for node in body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            found[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            found[node.target.id] = node
        elif isinstance(node, ast.ImportFrom):
            found.update({alias.asname: node for alias in node.names if alias.asname})
    return {name: node for name, node in found.items() if name.startswith("__") or not name.startswith("_")}


def describe_stub(node, skip=0):
    """[(name, kind, has a default)] of a def."""
    a = node.args
    plain = [*a.posonlyargs, *a.args]
    first = len(plain) - len(a.defaults)
    found = [(arg.arg, "plain", i >= first) for i, arg in enumerate(plain)][skip:]
    found += [(a.vararg.arg, "list", False)] if a.vararg else []
    found += [(arg.arg, "keyword", default is not None) for arg, default in zip(a.kwonlyargs, a.kw_defaults)]
    return found + ([(a.kwarg.arg, "dict", False)] if a.kwarg else [])


# Functions whose options go to the compiled one as they are.
PASSED_ON = {"reduce": "reduce", "frequency": "solve_response", "transient": "solve_response"}
NOT_PASSED_ON = {("frequency", "linear")}


def list_keywords(node):
    return [option for option in describe_stub(node) if option[1] == "keyword"]


def describe_function(function, skip=0):
    kinds = {inspect.Parameter.POSITIONAL_OR_KEYWORD: "plain", inspect.Parameter.POSITIONAL_ONLY: "plain",
             inspect.Parameter.VAR_POSITIONAL: "list", inspect.Parameter.KEYWORD_ONLY: "keyword",
             inspect.Parameter.VAR_KEYWORD: "dict"}
    return [(p.name, kinds[p.kind], p.default is not p.empty) for p in
            inspect.signature(function).parameters.values()][skip:]


def parse_doc(doc):
    """The def that a compiled function says it is, in the first line of its docstring."""
    line = re.sub(r"^\(", "f(", doc.splitlines()[0])
    line = re.sub(r"=\s*<[^>]*>", "= None", line)
    return ast.parse(f"def {line}: ...").body[0]


def get_type(annotation):
    text = ast.unparse(annotation).replace("bough._bough.", "").replace("List[", "list[").replace("Tuple[", "tuple[")
    text = re.sub(r"Optional\[(\w+)\]", r"\1 | None", text)
    text = re.sub(r"list\[(\w+)\[\d+\]\]", r"list[\1]", text)  # of a fixed size
    return re.sub(r"Annotated\[(list\[\w+\]).*\]$", r"\1", text)


def get_read_only(node):
    """The T of a property `name: _Read[T]` of a stub; None for others."""
    annotation = node.annotation if isinstance(node, ast.AnnAssign) else None
    is_read_only = isinstance(annotation, ast.Subscript) and annotation.value.id == "_Read"
    return annotation.slice if is_read_only else None


VAGUE = {"object", "list", "tuple", "numpy.ndarray", "array", "iterator", "Iterator"}


class Stubs(unittest.TestCase):
    def test_they_are_installed_with_the_marker(self):
        for name in ("py.typed", "__init__.pyi", "_bough.pyi", "reader.pyi"):
            self.assertTrue(os.path.exists(os.path.join(FOLDER, name)), name)

    def test_every_public_name_has_one(self):
        for module, stub, names in ((bough, "__init__.pyi", bough.__all__), (_bough, "_bough.pyi", dir(_bough)),
                                    (reader, "reader.pyi", ("File", "read"))):
            declared = collect(read_stub(stub).body)
            public = {name for name in names if not name.startswith("_")}
            self.assertEqual(public, {name for name in declared if not name.startswith("_")}, stub)
            for name in public:
                self.assertTrue(hasattr(module, name), f"{stub}: {name}")

    def test_members_of_compiled_classes(self):
        for name, node in collect(read_stub("_bough.pyi").body).items():
            if not isinstance(node, ast.ClassDef) or issubclass(getattr(_bough, name), BaseException):
                continue
            members, declared = vars(getattr(_bough, name)), collect(node.body)
            self.assertEqual({m for m in members if not m.startswith("_")},
                             {m for m in declared if not m.startswith("_")}, name)
            for member, own in declared.items():
                with self.subTest(f"{name}.{member}"):
                    self.assertIn(member, members)
                    self.compare_member(members[member], own)

    def compare_member(self, member, stub):
        if isinstance(member, property):
            read_only = get_read_only(stub)
            self.assertEqual(member.fset is None, read_only is not None)
            if read_only:
                self.compare_type(parse_doc(member.fget.__doc__), read_only)
            return
        said = parse_doc(member.__doc__)
        if not any(arg.arg.startswith("arg") for arg in said.args.args):  # without a name there
            self.assertEqual(describe_stub(said, 1), describe_stub(stub, 1))
        else:
            self.assertEqual(len(describe_stub(said, 1)), len(describe_stub(stub, 1)))
        self.compare_type(said, stub.returns)

    def compare_type(self, said, annotation):
        if get_type(said.returns) not in VAGUE:
            self.assertEqual(get_type(said.returns), get_type(annotation))

    def test_compiled_functions(self):
        for name, node in collect(read_stub("_bough.pyi").body).items():
            if isinstance(node, ast.FunctionDef):
                with self.subTest(name):
                    said = parse_doc(getattr(_bough, name).__doc__)
                    self.assertEqual(describe_stub(said), describe_stub(node))
                    self.compare_type(said, node.returns)

    def test_python_functions(self):
        compiled = collect(read_stub("_bough.pyi").body)
        for module, stub in ((bough, "__init__.pyi"), (reader, "reader.pyi")):
            for name, node in collect(read_stub(stub).body).items():
                own = getattr(module, name)
                with self.subTest(name):
                    if name in PASSED_ON:
                        own = [option for option in list_keywords(compiled[PASSED_ON[name]])
                               if (name, option[0]) not in NOT_PASSED_ON]
                        self.assertEqual(list_keywords(node), own)
                    elif isinstance(node, ast.FunctionDef):
                        self.assertEqual(describe_function(own), describe_stub(node))
                    elif isinstance(node, ast.ClassDef):
                        self.compare_class(own, node)

    def compare_class(self, own, node):
        declared = collect(node.body)
        methods = {name: member for name, member in vars(own).items()
                   if inspect.isfunction(member) or isinstance(member, (property, classmethod))}
        public = {name for name in methods if not name.startswith("_")}
        self.assertEqual(public, {name for name, d in declared.items() if not name.startswith("_") and
                                  (isinstance(d, ast.FunctionDef) or get_read_only(d))})
        for name, member in methods.items():
            if name not in declared:
                continue
            with self.subTest(name):
                decorators = [d.id for d in getattr(declared[name], "decorator_list", [])]
                is_read_only = get_read_only(declared[name]) is not None or "property" in decorators
                self.assertEqual(isinstance(member, property), is_read_only)
                if isinstance(member, property):
                    continue
                self.assertEqual("classmethod" in decorators, isinstance(member, classmethod))
                function = member.__func__ if isinstance(member, classmethod) else member
                self.assertEqual(describe_function(function), describe_stub(declared[name]))


if __name__ == "__main__":
    unittest.main()

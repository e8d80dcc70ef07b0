"""Text of TOML files: systems, bodies and campaigns, one call for each table."""
import json
import os


class Bare(str):
    """A value that is written without quotes: a word which the test replaces, or a number in its own notation."""


def write_value(value):
    """TOML of a string, a number, a list or an inline table."""
    if isinstance(value, Bare):
        return str(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return repr(float(value)).replace("e-0", "e-")
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(write_value, value))}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key} = {write_value(entry)}' for key, entry in value.items())}}}"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else str(value)


def write_keys(keys):
    """One line for each key; an underscore at the end, which avoids a word of Python, is left out."""
    return "".join(f"{key.removesuffix('_')} = {write_value(value)}\n" for key, value in keys.items())


def table(array, name=None, kind=None, **keys):
    """One [[array]] table with its name, its type (`kind`) and its keys in this order."""
    first = {key: value for key, value in (("name", name), ("type", kind)) if value is not None}
    return f"[[{array}]]\n{write_keys({**first, **keys})}"


def section(path, **keys):
    """A [path] table, as [simulation]."""
    return f"[{path}]\n{write_keys(keys)}"


def toml(*tables, **keys):
    """A file: the keys of its root, then its tables; a part may be any text."""
    return write_keys(keys) + "".join(tables)


def read_toml(name):
    """Text of a file of this folder, where comments and notation matter."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), name), encoding="utf-8") as f:
        return f.read()

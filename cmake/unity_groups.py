#!/usr/bin/env python3
"""Sorts sources into unity groups: neighbours that hide no name from each other. Reads paths, prints GROUP:PATH.

usage: unity_groups.py ROOT MAX_LINES < paths

Names of anonymous namespaces are those that collide when two files become one translation unit: with each other, with
what a later file means by the same word and finds in a header, or with a function that the header of an earlier file
declares. A file joins none that defines a name it uses, or whose headers declare one that it defines.
"""
import os
import re
import sys

QUOTED = re.compile(r'"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)\'')
ANONYMOUS = re.compile(r"^namespace \{\n", re.M)
TYPE = re.compile(r"(?:template\s*<[^>]*>\s*)?(?:struct|class|enum class|enum|union)\s+(\w+)")
ALIAS = re.compile(r"using\s+(\w+)\s*=")
NAME = re.compile(r"(\w+)\s*(?:\(|=|\{|;|\[)")
CONSTANT = re.compile(r"\bk[A-Z]\w*")
WORD = re.compile(r"\b[A-Za-z_]\w*")
COMMENT = re.compile(r"//[^\n]*")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)
DECLARED = re.compile(r"^(?!using |namespace |#|//|struct |class |enum |template )[A-Za-z_][\w:<>,&* ]*?[ &*](\w+)\(", re.M)
TEST = re.compile(r"^(?:TEST|TEST_F|TEST_P|TYPED_TEST)\((\w+),", re.M)


def get_anonymous(text):
    """The insides of the anonymous namespaces."""
    text = QUOTED.sub('""', text)
    for start in ANONYMOUS.finditer(text):
        depth = 1
        for brace in re.finditer(r"[{}]", text[start.end():]):
            depth += 1 if brace.group() == "{" else -1
            if depth == 0:
                yield text[start.end():start.end() + brace.start()]
                break


def find_names(text):
    """The names that the file defines for itself alone."""
    names = set()
    for body in get_anonymous(text):
        for line in body.split("\n"):
            if not line or line[0] in " }/#)":
                continue
            found = TYPE.match(line) or ALIAS.match(line)
            if not found and line.startswith(("using ", "namespace ")):
                continue  # the same declaration twice is none the worse
            found = found or NAME.search(line)
            if found:
                names.add(found.group(1))
            names.update(CONSTANT.findall(line.split("(")[0]))
    return names - set(TEST.findall(text)) - {"TEST", "TEST_F", "TEST_P", "INSTANTIATE_TEST_SUITE_P", "using", "if"}


def find_words(text):
    """Every word of the file: what a neighbour before it defines for itself under one of these would hide it."""
    return set(WORD.findall(COMMENT.sub("", QUOTED.sub('""', text))))


def find_declared(root, text, known):
    """The functions that headers of the project declare for this text, and those that they include."""
    names = set()
    for header in INCLUDE.findall(text):
        if header not in known:
            known[header] = set()
            path = os.path.join(root, header)
            if os.path.exists(path):
                inside = open(path, encoding="utf-8").read()
                known[header] = set(DECLARED.findall(inside)) | find_declared(root, inside, known)
        names |= known[header]
    return names


def sort_into_groups(root, paths, max_lines):
    """First fit among the groups of the same upper folder, in the order of paths: neighbours first."""
    groups, known = [], {}
    for path in sorted(paths):
        text = open(path, encoding="utf-8").read()
        names, words, lines = find_names(text), find_words(text), text.count("\n")
        room = os.path.relpath(path, root).split(os.sep)[0]
        for group in groups:
            if group["room"] == room and group["lines"] + lines <= max_lines and not group["names"] & words \
                    and not group["declared"] & names:
                break
        else:
            group = {"room": room, "lines": 0, "names": set(), "declared": set(), "paths": []}
            groups.append(group)
        group["lines"] += lines
        group["names"] |= names
        group["declared"] |= find_declared(root, text, known)
        group["paths"].append(path)
    return groups


def main():
    root, max_lines = sys.argv[1], int(sys.argv[2])
    paths = [line.strip() for line in sys.stdin if line.strip()]
    number = {}
    for group in sort_into_groups(root, paths, max_lines):
        room = group["room"]
        number[room] = number.get(room, -1) + 1
        if len(group["paths"]) > 1:
            for path in group["paths"]:
                print(f"{room}_{number[room]}:{path}")


if __name__ == "__main__":
    main()

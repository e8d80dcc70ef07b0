"""Software Design Document out of the sources: for each function its purpose, file, inputs and outputs, callers and
callees, a page for each folder; for each command a flow chart from main() down.

    /usr/bin/python3 tools/design_document.py build/html/design
    /usr/bin/python3 tools/design_document.py --undocumented      functions of headers without a line of text

Needs doxygen, and graphviz for the charts. The text is that of the comments; relations are what doxygen finds by name.
"""
import collections
import html
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ROOMS = "base formats fe modal stiffening solver embed cosim report analysis cli python".split()
SETTINGS = """INPUT = {rooms}
RECURSIVE = YES
FILE_PATTERNS = *.hpp *.h *.cpp
STRIP_FROM_PATH = {root}
EXTRACT_ALL = YES
EXTRACT_STATIC = YES
EXTRACT_PRIVATE = YES
EXTRACT_ANON_NSPACES = YES
JAVADOC_AUTOBRIEF = YES
MARKDOWN_SUPPORT = NO
REFERENCED_BY_RELATION = YES
REFERENCES_RELATION = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
OUTPUT_DIRECTORY = {output}
QUIET = YES
WARNINGS = NO
HAVE_DOT = NO
"""
# Flow charts: levels below the command, callees of a function, functions in all.
MAX_LEVELS, MAX_CALLEES, MAX_NODES = 4, 8, 60
STYLE = """body { font: 15px/1.45 sans-serif; max-width: 72em; margin: 2em auto; padding: 0 1em; }
h3 { margin-bottom: .2em; font-family: monospace; font-size: 1em; overflow-wrap: anywhere; }
dl { margin: 0 0 1em 1.5em; } dt { float: left; width: 6em; color: #555; } dd { margin-left: 7em; }
svg, img { max-width: 100%; height: auto; }
"""


class Function:
    """A function or method: where its body is, or else its declaration."""

    def __init__(self, node, owner):
        self.id = node.get("id")
        self.owner = re.sub(r"^bough::", "", re.sub(r"anonymous_namespace\{[^}]*\}(::)?", "", owner)).rstrip(":")
        self.name = node.findtext("name")
        self.type = get_text(node.find("type"))
        self.arguments = node.findtext("argsstring") or "()"
        self.purpose = " ".join(filter(None, (get_text(node.find("briefdescription")),
                                              get_text(node.find("detaileddescription"), skip="parameterlist"))))
        self.parameters = read_parameters(node.find("detaileddescription"))
        where = node.find("location")
        self.declared = where.get("declfile") or where.get("file")
        self.file = where.get("bodyfile") or where.get("file")
        self.declared_line = int(where.get("declline") or where.get("line") or 0)
        self.line = int(where.get("bodystart") or where.get("line") or 0)
        self.is_local = "anonymous_namespace" in owner or node.get("static") == "yes" and self.declared.endswith(".cpp")
        self.is_public = node.get("prot") == "public" and not self.is_local and self.declared.endswith((".hpp", ".h"))
        self.overrides = [r.get("refid") for r in node.findall("reimplements")]
        self.callees = [r.get("refid") for r in node.findall("references")]
        self.callers = [r.get("refid") for r in node.findall("referencedby")]

    def get_title(self):
        return f"{self.owner}::{self.name}" if self.owner else self.name


def get_text(node, skip=""):
    if node is None:
        return ""

    def collect(item):
        if item.tag == skip:
            return
        if item.text:
            yield item.text
        for child in item:
            yield from collect(child)
            if child.tail:
                yield child.tail

    return " ".join("".join(collect(node)).split())


def read_parameters(node):
    """[(names, text)] of \\param and \\return."""
    found = []
    for item in node.iter("parameteritem") if node is not None else ():
        names = [get_text(name) for name in item.iter("parametername")]
        found.append((", ".join(names), get_text(item.find("parameterdescription"))))
    return found


def read_functions():
    """{id: Function} of the sources."""
    folder = tempfile.mkdtemp(prefix="bough-design-")
    try:
        rooms = " ".join(os.path.join(ROOT, room) for room in ROOMS)
        subprocess.run(["doxygen", "-"], input=SETTINGS.format(rooms=rooms, root=ROOT, output=folder), text=True,
                       check=True, stderr=subprocess.DEVNULL)
        functions = {}
        xml = os.path.join(folder, "xml")
        for name in sorted(os.listdir(xml)):
            if not name.endswith(".xml") or name == "index.xml":
                continue
            for compound in ET.parse(os.path.join(xml, name)).getroot().iter("compounddef"):
                if compound.get("kind") not in ("class", "struct", "namespace", "file"):
                    continue
                owner = compound.findtext("compoundname") if compound.get("kind") != "file" else ""
                about = get_text(compound.find("briefdescription"))
                for member in compound.iter("memberdef"):
                    if member.get("kind") == "function" and member.get("id") not in functions:
                        function = Function(member, owner)
                        if not function.purpose and function.owner.split("::")[-1] == function.name:
                            function.purpose = about  # a constructor makes what its class is
                        if not re.search(r"=\s*(default|delete)", function.arguments):
                            functions[function.id] = function
        for function in functions.values():
            for base in function.overrides:
                if not function.purpose and base in functions:
                    function.purpose = functions[base].purpose
        share_comments(functions)
        return {i: f for i, f in functions.items() if not f.name.startswith("~")}
    finally:
        shutil.rmtree(folder)


def share_comments(functions):
    """One comment above several declarations without a blank line between them belongs to all of them."""
    by_file = collections.defaultdict(list)
    for function in functions.values():
        by_file[function.declared].append(function)
    for file, members in by_file.items():
        path = os.path.join(ROOT, file)
        if not os.path.isfile(path):
            continue
        with open(path, encoding="utf-8") as f:
            lines = f.read().split("\n")
        members.sort(key=lambda f: f.declared_line)
        for before, function in zip(members, members[1:]):
            between = lines[before.declared_line:function.declared_line - 1]
            if not function.purpose and before.purpose and all(line.strip() for line in between):
                function.purpose = before.purpose


def get_page(function):
    return os.path.dirname(function.file).replace("/", "-") + ".html"


def make_link(function, page):
    target = "" if get_page(function) == page else get_page(function)
    return f'<a href="{target}#{function.id}">{html.escape(function.get_title())}</a>'


def describe(function, functions, page):
    def list_links(ids):
        known = sorted({functions[i] for i in ids if i in functions}, key=lambda f: f.get_title())
        return ", ".join(make_link(f, page) for f in known)

    title = f"{function.type} {function.get_title()}{function.arguments}"
    rows = [("purpose", html.escape(function.purpose or "-")),
            ("file", html.escape(f"{function.file}:{function.line}"))]
    rows += [(html.escape(names), html.escape(text)) for names, text in function.parameters]
    rows += [("callers", list_links(function.callers) or "-"), ("callees", list_links(function.callees) or "-")]
    return (f'<h3 id="{function.id}">{html.escape(title)}</h3>\n<dl>' +
            "".join(f"<dt>{key}</dt><dd>{value}</dd>" for key, value in rows) + "</dl>\n")


def write_page(path, title, body):
    with open(path, "w", encoding="utf-8") as f:
        f.write(f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>\n<style>{STYLE}</style>\n'
                f"<h1>{title}</h1>\n{body}</html>\n")


def list_commands():
    with open(os.path.join(ROOT, "cli/verbs.hpp"), encoding="utf-8") as f:
        return re.findall(r"\bX\((\w+)\)", f.read().split("#define BOUGH_DECLARE_COMMAND")[0])


def make_chart(command, functions):
    """Graphviz text: main, the command, and what it calls, level by level."""
    start = [f for f in functions.values() if f.name == f"add_{command}" and f.file.endswith(".cpp")]
    main = [f for f in functions.values() if f.name == "main" and f.file == "cli/main.cpp"]
    levels, edges, queue = {}, [], collections.deque()
    for f in start:
        levels[f.id] = 0
        queue.append(f)
        edges += [(m.id, f.id) for m in main]
    while queue:
        f = queue.popleft()
        if levels[f.id] == MAX_LEVELS:
            continue
        # The order of the body is that of the work; helpers for text and options are left out.
        callees = [functions[i] for i in f.callees if i in functions and functions[i].file.split("/")[0] != "base"]
        callees = [c for c in callees if not c.file.startswith("cli/common/") and c.id != f.id][:MAX_CALLEES]
        for callee in callees:
            if callee.id not in levels:
                if len(levels) >= MAX_NODES:
                    continue
                levels[callee.id] = levels[f.id] + 1
                queue.append(callee)
            edges.append((f.id, callee.id))
    nodes = [*main, *(functions[i] for i in levels)]
    lines = [f'"{f.id}" [label="{f.get_title()}\\n{f.file}", URL="{get_page(f)}#{f.id}"];' for f in nodes]
    lines += [f'"{a}" -> "{b}";' for a, b in dict.fromkeys(edges)]
    return ('digraph { rankdir=LR; ranksep=0.6; node [shape=box, fontname="sans-serif", fontsize=10, height=0.3];\n' +
            "\n".join(lines) + "\n}\n")


def write_document(output):
    functions = read_functions()
    shutil.rmtree(output, ignore_errors=True)
    os.makedirs(output)
    pages = collections.defaultdict(list)
    for function in functions.values():
        pages[get_page(function)].append(function)
    for page, members in pages.items():
        members.sort(key=lambda f: (f.file, f.line))
        body = '<p><a href="index.html">Software design</a></p>\n'
        body += "".join(describe(f, functions, page) for f in members)
        write_page(os.path.join(output, page), os.path.dirname(members[0].file), body)
    charts = []
    for command in list_commands():
        drawn = subprocess.run(["dot", "-Tsvg"], input=make_chart(command, functions), text=True, capture_output=True)
        if drawn.returncode == 0:
            svg = drawn.stdout[drawn.stdout.index("<svg"):]
            write_page(os.path.join(output, f"command-{command}.html"), f"bough {command}",
                       '<p><a href="index.html">Software design</a></p>\n' + svg)
            charts.append(command)
    rows = "".join(f'<li><a href="{page}">{os.path.dirname(members[0].file)}</a>: {len(members)} functions</li>\n'
                   for page, members in sorted(pages.items()))
    body = ("<p>For whoever reviews or takes over the sources: every function with its purpose, file, inputs and outputs, "
            "callers and callees, and the way of each command from main() down. Made of the sources and their comments "
            "by tools/design_document.py. Dimensions are those of the comments: M mass, L length, T time, F force.</p>\n"
            "<h2>Commands</h2>\n<ul>" +
            "".join(f'<li><a href="command-{c}.html">bough {c}</a></li>\n' for c in charts) +
            "</ul>\n<h2>Folders</h2>\n<ul>" + rows + "</ul>\n")
    write_page(os.path.join(output, "index.html"), "Software design", body)
    print(f"design: {output}/index.html; {len(functions)} functions in {len(pages)} pages, {len(charts)} flow charts")


def list_undocumented(functions):
    """Public functions of headers without a line of text."""
    return sorted((f.declared, f.line, f.get_title()) for f in functions.values()
                  if f.is_public and not f.purpose and not f.parameters)


def main():
    if "--undocumented" in sys.argv:
        functions = read_functions()
        found = list_undocumented(functions)
        for file, _, title in found:
            print(f"{file}: {title}")
        print(f"{len(found)} of {sum(f.is_public for f in functions.values())} public functions have no text")
        return 0
    write_document(os.path.abspath(sys.argv[1]))
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Builds the manual as web pages with search: every .md of the repository by Sphinx, the C++ headers by Doxygen, the
Python module from its types, the software design by design_document.py; then follows every link inside it.

    /usr/bin/python3 tools/build_docs.py build/html [--no-cpp]
    /usr/bin/python3 tools/build_docs.py build/site --site
    /usr/bin/python3 tools/build_docs.py build/manual --pdf

--site: a folder for a web server, with the manual of this version in a folder of that name next to those of other
versions, which each page offers, and an index that leads to the newest one.
--pdf: build/manual.pdf, the pages as one document to print, without the C++ headers and the software design.
Exit 1 when a page has a warning or a link that leads nowhere.
"""
import ast
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CONF = """project = "Bough"
author = copyright = "The Bough authors"
release = version = "{version}"
extensions = ["myst_parser"]
myst_heading_anchors = 4
master_doc = "README"
html_theme = "classic"
html_theme_options = {{"body_max_width": "60em", "collapsiblesidebar": "true"}}
html_copy_source = html_show_sourcelink = False
html_title = "Bough {version}"
html_static_path = ["_static"]
html_css_files = ["tables.css"]
html_js_files = {scripts}
# Python, TOML and C++ blocks are coloured where they parse; shell sessions and output stay as they are.
highlight_language = "none"
suppress_warnings = ["myst.header", "toc.not_readable", "misc.highlighting_failure"]
"""


# Narrow cells are not stretched to both sides, pictures not wider than their page.
CSS = "div.body td, div.body td p, div.body th p { text-align: left; }\ndiv.body img { max-width: 100%; }\n"


# Above the search box: the versions that the site has. They are read from its folder, so that old pages know new versions.
CHOICE = """(function () {
  const root = DOCUMENTATION_OPTIONS.URL_ROOT + "../", list = document.createElement("script");
  list.src = root + "versions.js";
  list.onload = function () {
    const choice = document.createElement("select");
    choice.setAttribute("aria-label", "version");
    for (const version of BOUGH_VERSIONS)
      choice.add(new Option("version " + version, version, false, version === DOCUMENTATION_OPTIONS.VERSION));
    choice.onchange = function () { location.href = root + choice.value + "/README.html"; };
    const bar = document.querySelector("div.sphinxsidebarwrapper");
    if (bar) bar.prepend(choice);
  };
  document.head.append(list);
})();
"""


def get_version():
    with open(os.path.join(ROOT, "CMakeLists.txt"), encoding="utf-8") as f:
        return re.search(r"project\(Bough VERSION ([\d.]+)", f.read()).group(1)


SITE = os.path.abspath(sys.argv[1]) if "--site" in sys.argv else None
OUTPUT = os.path.join(SITE, get_version()) if SITE else os.path.abspath(sys.argv[1])
STAGE = os.path.abspath(sys.argv[1]) + "-source"


def list_files():
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"], check=True, text=True,
                            capture_output=True).stdout.split("\n")
    # Forms of a forge (.github) are no pages.
    return [path for path in listed if path and path[0] != "." and os.path.isfile(os.path.join(ROOT, path))]


def find_title(text, path):
    found = re.search(r"(?m)^# (.+)$", text)
    return found.group(1) if found else path


def describe_python():
    """A page of the module's types: each class and function with its signature and docstring."""
    out = ["# Python reference", "", "Out of the types of the module (`*.pyi`); how it is used: [Python](python.md).", ""]
    folder = os.path.join(ROOT, "python/bough")
    for name in sorted(os.listdir(folder)):
        if not name.endswith(".pyi"):
            continue
        with open(os.path.join(folder, name), encoding="utf-8") as f:
            tree = ast.parse(f.read())
        module = "bough" if name == "__init__.pyi" else "bough." + name[:-4]
        out += [f"## {module}", ""]
        for node in tree.body:
            out += describe_node(node, 3)
    return "\n".join(out) + "\n"


def describe_node(node, level):
    if isinstance(node, ast.ClassDef):
        out = ["#" * level + f" class {node.name}", "", ast.get_docstring(node) or "", ""]
        for child in node.body:
            out += describe_node(child, level + 1)
        return out
    if isinstance(node, ast.FunctionDef):
        returns = f" -> {ast.unparse(node.returns)}" if node.returns else ""
        lines = ["```", f"{node.name}({ast.unparse(node.args)}){returns}", "```", ""]
        return lines + [ast.get_docstring(node) or "", ""]
    if isinstance(node, ast.AnnAssign):
        return ["```", ast.unparse(node), "```", ""]
    return []


def stage(files):
    """The pages in a folder of their own, with an index of each folder that a page links as a whole."""
    shutil.rmtree(STAGE, ignore_errors=True)
    texts = {path: open(os.path.join(ROOT, path), encoding="utf-8").read() for path in files if path.endswith(".md")}
    texts["docs/python-reference.md"] = describe_python()
    folders = {}
    for path, text in texts.items():
        if path.startswith("tests/"):
            continue
        folders.setdefault(os.path.dirname(path), []).append((path, find_title(text, path)))
    for folder, pages in list(folders.items()):
        if folder.startswith("docs/") and folder + "/README.md" not in texts:
            lines = [f"* [{title}]({os.path.basename(path)})" for path, title in sorted(pages)]
            texts[folder + "/index.md"] = f"# {os.path.basename(folder).capitalize()}\n\n" + "\n".join(lines) + "\n"
    known = set(files) | set(texts)

    def mend(path, text):
        def replace(match):
            target, hash_sign, anchor = match.group(2).partition("#")
            if "://" in target or target.startswith("mailto:") or not target:
                return match.group(0)
            where = os.path.normpath(os.path.join(os.path.dirname(path), target))
            for page in (where + "/README.md", where + "/index.md"):
                if page in known:
                    return f"{match.group(1)}{os.path.relpath(page, os.path.dirname(path) or '.')}{hash_sign}{anchor})"
            return match.group(0)
        return re.sub(r"(\]\()([^)\s]+)\)", replace, text)

    named = set()
    for path, text in texts.items():
        if path.startswith("tests/"):
            continue
        text = mend(path, text)
        if path == "README.md":
            others = sorted(p[:-3] for p in texts if p != path and not p.startswith("tests/"))
            text += "\n```{toctree}\n:hidden:\n\n" + "\n".join("/" + p for p in others) + "\n```\n"
        os.makedirs(os.path.dirname(os.path.join(STAGE, path)), exist_ok=True)
        with open(os.path.join(STAGE, path), "w", encoding="utf-8") as f:
            f.write(text)
        for target in re.findall(r"\]\(([^)\s#]+)", text):
            named.add(os.path.normpath(os.path.join(os.path.dirname(path), target)))
    for path in sorted(named - set(texts)):
        if path in known:
            os.makedirs(os.path.dirname(os.path.join(STAGE, path)), exist_ok=True)
            shutil.copy(os.path.join(ROOT, path), os.path.join(STAGE, path))
    version = get_version()
    os.makedirs(os.path.join(STAGE, "_static"), exist_ok=True)
    with open(os.path.join(STAGE, "_static/tables.css"), "w") as f:
        f.write(CSS)
    with open(os.path.join(STAGE, "conf.py"), "w") as f:
        f.write(CONF.format(version=version, scripts=["versions.js"] if SITE else []))
    if SITE:
        with open(os.path.join(STAGE, "_static/versions.js"), "w") as f:
            f.write(CHOICE)
    return version


def describe_cpp(version):
    rooms = " ".join(os.path.join(ROOT, room) for room in "base formats fe modal stiffening solver".split())
    settings = f"""PROJECT_NAME = "Bough, C++"
PROJECT_NUMBER = {version}
INPUT = {rooms}
RECURSIVE = YES
FILE_PATTERNS = *.hpp *.h
EXCLUDE_PATTERNS = */detail/*
STRIP_FROM_PATH = {ROOT}
EXTRACT_ALL = YES
JAVADOC_AUTOBRIEF = YES
MARKDOWN_SUPPORT = NO
GENERATE_LATEX = NO
HTML_OUTPUT = cpp
OUTPUT_DIRECTORY = {OUTPUT}
QUIET = YES
WARNINGS = NO
SEARCHENGINE = YES
HAVE_DOT = NO
HTML_TIMESTAMP = NO
"""
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, stderr=subprocess.DEVNULL)


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.names, self.links = set(), []
        with open(path, encoding="utf-8", errors="replace") as f:
            self.feed(f.read())

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.names.add(value)
            elif name in ("href", "src") and value:
                self.links.append(value)


def check_links():
    """Links of the pages that lead nowhere: to files that are missing, to headings that are not there."""
    pages = {}
    for folder, _, names in os.walk(OUTPUT):
        if os.path.relpath(folder, OUTPUT).split(os.sep)[0] not in ("cpp", "design", "_static"):
            for name in names:
                if name.endswith(".html"):
                    pages[os.path.join(folder, name)] = Page(os.path.join(folder, name))
    found, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            target, _, anchor = link.partition("#")
            target = urllib.parse.unquote(target.partition("?")[0])
            where = os.path.normpath(os.path.join(os.path.dirname(path), target)) if target else path
            count += 1
            if not os.path.exists(where):
                found.append(f"{os.path.relpath(path, OUTPUT)}: no {link}")
            elif anchor and where in pages and urllib.parse.unquote(anchor) not in pages[where].names:
                found.append(f"{os.path.relpath(path, OUTPUT)}: no heading {link}")
    return found, count


def write_redirect(index, target):
    with open(index, "w") as f:
        f.write('<!DOCTYPE html>\n<meta charset="utf-8"><title>Bough</title>\n'
                f'<meta http-equiv="refresh" content="0; url={target}">\n<a href="{target}">Bough</a>\n')


def finish_site():
    """The list of versions, the newest first, and the way to it."""
    versions = [name for name in os.listdir(SITE) if os.path.isfile(os.path.join(SITE, name, "README.html"))]
    versions.sort(key=lambda name: [int(part) for part in name.split(".")], reverse=True)
    with open(os.path.join(SITE, "versions.js"), "w") as f:
        f.write(f"const BOUGH_VERSIONS = {json.dumps(versions)};\n")
    write_redirect(os.path.join(SITE, "index.html"), versions[0] + "/README.html")
    print(f"site: {SITE}/index.html; versions {', '.join(versions)}")


# Pages in the order in which a book has them; others follow.
PARTS = ["README", "docs/README", "docs/install", "docs/tutorial", "docs/tutorials/", "docs/guide", "docs/your-deck",
         "docs/command-line", "docs/commands", "docs/formats/", "docs/elements/", "docs/theory/", "docs/errors/",
         "docs/verification/"]
PRINT = """@page { size: A4; margin: 20mm 18mm; @bottom-center { content: counter(page); font: 9pt sans-serif; } }
body { font: 9.5pt/1.35 sans-serif; } h1 { page-break-before: always; }
h1, h2, h3 { page-break-after: avoid; } pre, td, th, code { font-size: 8pt; }
pre { white-space: pre-wrap; border-left: 2pt solid #bbb; padding-left: 6pt; }
table { border-collapse: collapse; width: 100%; } td, th { border: 0.5pt solid #aaa; padding: 2pt 4pt;
vertical-align: top; text-align: left; overflow-wrap: break-word; }
code, code span.pre { white-space: pre-wrap !important; overflow-wrap: anywhere; }
img { max-width: 100%; } a { color: #024; } div.body, div.document, div.bodywrapper { border: 0; margin: 0; }
div.sphinxsidebar, div.related, div.footer, a.headerlink { display: none; }
"""


def write_pdf():
    """One document of all pages, printed by chromium: weasyprint takes more than eight minutes for them."""
    pages = OUTPUT + "-pages"
    index = os.path.join(STAGE, "README.md")
    with open(index, encoding="utf-8") as f:
        text = f.read()
    head, _, tail = text.partition("```{toctree}\n:hidden:\n\n")
    names = [line[1:] for line in tail.split("```")[0].split() if not re.match("/(python-reference|CHANGELOG|docs/adr|"
                                                                           "docs/developer|bench)", line)]
    rank = lambda name: next((k for k, part in enumerate(PARTS) if name == part or part[-1] == "/" and
                              name.startswith(part)), len(PARTS))
    names.sort(key=lambda name: (rank(name), name))
    with open(index, "w", encoding="utf-8") as f:
        f.write(head + "```{toctree}\n:hidden:\n\n" + "\n".join("/" + name for name in names) + "\n```\n")
    subprocess.run(["/usr/bin/sphinx-build", "-q", "-b", "singlehtml", "-d", STAGE + "-doctrees-pdf", STAGE, pages],
                   check=True, stderr=subprocess.DEVNULL)
    page = os.path.join(pages, "README.html")
    with open(page, encoding="utf-8") as f:
        text = f.read()
    with open(page, "w", encoding="utf-8") as f:
        f.write(text.replace("</head>", f"<style>{PRINT}</style></head>", 1))
    with tempfile.TemporaryDirectory() as profile:
        subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}",
                        "--no-pdf-header-footer", f"--print-to-pdf={OUTPUT}.pdf", page], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    print(f"manual: {OUTPUT}.pdf, {os.path.getsize(OUTPUT + '.pdf') >> 10} kB")


def main():
    shutil.rmtree(OUTPUT, ignore_errors=True)
    version = stage(list_files())
    if "--pdf" in sys.argv:
        write_pdf()
        return 0
    built = subprocess.run(["/usr/bin/sphinx-build", "-q", "-b", "html", "-d", STAGE + "-doctrees", STAGE, OUTPUT],
                           text=True, stderr=subprocess.PIPE)
    warnings = [line for line in built.stderr.split("\n") if "WARNING" in line or "ERROR" in line]
    for name in (".buildinfo", "objects.inv"):
        if os.path.exists(os.path.join(OUTPUT, name)):
            os.remove(os.path.join(OUTPUT, name))
    write_redirect(os.path.join(OUTPUT, "index.html"), "README.html")
    if "--no-cpp" not in sys.argv:
        describe_cpp(version)
        subprocess.run([sys.executable, "-B", os.path.join(ROOT, "tools/design_document.py"),
                        os.path.join(OUTPUT, "design")], check=True)
    if SITE:
        finish_site()
    found, count = check_links()
    for line in [*warnings, *found]:
        print(line.replace(STAGE + os.sep, ""))
    print(f"manual: {OUTPUT}/index.html; {count} links, {len(found)} lead nowhere, {len(warnings)} warnings")
    return 1 if built.returncode or warnings or found else 0


if __name__ == "__main__":
    sys.exit(main())

"""Every public function of a header has a sentence of text: what it computes, its frame, unit or errors.

A light reading of the headers that finds what tools/design_document.py --undocumented finds with doxygen, in a second.
A function has text if a comment is before it or, with ///<, after it; if it follows a function with text without a
blank line between them; if it overrides another one; or if it is a constructor of a class with text.

At most MAX_SHARED functions have no text but that of the function before, as overloads and inverses may; lower the
number where it has fallen.
"""
import re

from common import ROOMS, finish, line_of, list_files, read

TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"'
                   r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])*'", re.S)
MAX_SHARED = 75
NO_FUNCTION = re.compile(r"(using|typedef|friend|static_assert|extern\s+template|template\s+(class|struct))\b")
OPERATOR = re.compile(r"operator\s*(?:\(\)|\[\]|[^\s\w(]+|[\w:<>,\s*&]+?)\s*(?=\()")
CLASS = re.compile(r"(?:typedef\s+)?(?:class|struct|union)\b\s*(?:alignas\([^)]*\)\s*)?(\w*)")


class Scope:
    def __init__(self, kind, name="", is_public=True, has_text=False):
        self.kind, self.name, self.is_public, self.has_text = kind, name, is_public, has_text


class Comments:
    """Comments of a header: where text for what follows ends, where text for what precedes begins."""

    def __init__(self, text):
        self.before, self.after, blocks = [], [], []
        for match in TOKEN.finditer(text):
            token = match.group(0)
            if token.startswith(("///<", "/**<")):
                self.after.append(match.start())
            elif token.startswith("///") or token.startswith("/**") and token != "/**/":
                if blocks and not text[blocks[-1][1]:match.start()].strip(" \t").replace("\n", "", 1):
                    blocks[-1][1] = match.end()
                else:
                    blocks.append([match.start(), match.end()])
        for start, end in blocks:
            if not re.search(r"\\file\b", text[start:end]):
                self.before.append((start, end))

    def has_between(self, start, end):
        return any(start <= at and stop <= end for at, stop in self.before)

    def has_after(self, code, end):
        """Returns true if the next thing after `end` is text for what precedes, on its line or on the next ones."""
        return any(at >= end and not code[end:at].strip() for at in self.after)


def blank(text):
    """Code without comments, strings and directives; positions and lines stay."""
    hide = lambda m: re.sub(r"[^\n]", " ", m.group(0))
    return re.sub(r"(?m)^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", hide, TOKEN.sub(hide, text))


def skip_pair(code, at, pair="{}"):
    """Position after the bracket that closes the one at `at`."""
    depth = 0
    for i in range(at, len(code)):
        depth += (code[i] == pair[0]) - (code[i] == pair[1])
        if depth == 0:
            return i + 1
    return len(code)


def skip_head(code, start):
    """Position after blanks, attributes and template parameters."""
    while True:
        start = re.compile(r"\s*").match(code, start).end()
        if code.startswith("[[", start):
            start = skip_pair(code, start, "[]")
        elif match := re.compile(r"template\s*(?=<)").match(code, start):
            start = skip_pair(code, match.end(), "<>")
        elif match := re.compile(r"requires\b[^;{]*?(?=\b(?:void|auto|inline|bool|int|double)\b)").match(code, start):
            start = match.end()
        else:
            return start


def find_name(text, owner):
    """(position, name) of the function that a declaration declares; None: it declares something else."""
    if NO_FUNCTION.match(text) or CLASS.match(text) and "(" not in text:
        return None
    if match := OPERATOR.search(text):
        return match.start(), " ".join(match.group(0).split())
    angle = 0
    for i, c in enumerate(text):
        angle += (c == "<") - (c == ">" and text[i - 1] != "-")
        if angle:
            continue
        if c == "=":
            return None
        if c == "(":
            match = re.search(r"([\w:~]+)\s*$", text[:i])
            if match and (text[:match.start()].strip() or match.group(1).lstrip("~") == owner):
                return match.start(), match.group(1)
            return None
    return None


def list_functions(text):
    """[(line, name, arguments, is public, has text)] of the functions that a header declares, without overriding ones.
    Raises ValueError if the braces of the header do not match."""
    code, comments = blank(text), Comments(text)
    scopes, found, start, at = [Scope("namespace")], [], 0, 0

    def add(end, body_end):
        head = skip_head(code, start)
        scope = scopes[-1]
        named = find_name(code[head:end], scope.name)
        if named is None:
            return False
        at_name, name = head + named[0], named[1]
        opening = code.index("(", at_name + len(name))
        rest = code[opening:end]
        if "::" in name.split("operator")[0] or name.startswith("~") or re.search(r"=\s*(default|delete)\s*$", rest):
            return True
        if re.search(r"\)[^()]*\b(override|final)\b", rest):
            return True  # the text is that of the function overridden
        has_text = (comments.has_between(start, head) or comments.has_after(code, body_end) or
                    (name == scope.name and scope.has_text))
        path = "::".join([s.name for s in scopes if s.name] + [name])
        found.append((line_of(code, at_name), path, " ".join(rest.split()), scope.is_public, has_text))
        return True

    while at < len(code):
        c = code[at]
        if c == "(":
            at = skip_pair(code, at, "()")
            continue
        statement = code[start:at].strip()
        if c == "{":
            head = skip_head(code, start)
            declared = code[head:at].strip()
            kind = CLASS.match(declared)
            if re.match(r"(inline\s+)?namespace\b|extern\s*$", declared):
                scopes.append(Scope("namespace"))
                start = at = at + 1
            elif kind and "(" not in re.sub(r"alignas\([^)]*\)", "", declared):
                scopes.append(Scope("class", kind.group(1), not declared.startswith("class"),
                                    comments.has_between(start, head)))
                start = at = at + 1
            elif not re.match(r"enum\b", declared) and find_name(declared, scopes[-1].name):
                is_initializer = re.search(r"\)[^()]*(?<!:):(?!:)", declared) and re.search(r"[\w>]\s*$", declared)
                end = skip_pair(code, at)
                if not is_initializer:
                    add(at, end)
                    start = end
                at = end
            else:
                at = skip_pair(code, at)
            continue
        if c == "}":
            if len(scopes) > 1:
                scopes.pop()
            start = at + 1
        elif c == ";":
            add(at, at + 1)
            start = at + 1
        elif c == ":" and statement in ("public", "private", "protected"):
            scopes[-1].is_public = statement == "public"
            start = at + 1
        at += 1
    if len(scopes) != 1:
        raise ValueError("the braces do not match")
    return found


def share_text(text, functions):
    """The functions, where a comment also counts for those that follow without a blank line between."""
    lines, shared, last = text.split("\n"), [], None
    for line, name, arguments, is_public, has_text in sorted(functions):
        if not has_text and last and last[4] and all(row.strip() for row in lines[last[0]:line - 1]):
            has_text = True
        last = (line, name, arguments, is_public, has_text)
        shared.append(last)
    return shared


def list_undocumented(functions):
    """[(line, name)] of the public ones of the functions without text, and the number of public functions."""
    public, texts = {}, {}
    for line, name, arguments, is_public, has_text in functions:
        key = (name, re.sub(r"\s*=[^,)]*", "", arguments))
        texts[key] = texts.get(key, False) or has_text
        if is_public:
            public.setdefault(key, line)
    return sorted((line, key[0]) for key, line in public.items() if not texts[key]), len(public)


# Functions named bad have no text.
SAMPLE = """#pragma once
/// \\file About the file, not about a function.
namespace a {
int bad_first(std::function<void(int)> f = {}, char c = '(');
/// Text.
template <class T = std::vector<int>>
T good(const T& x) { return x > 0 ? T{} : x; }
T good_by_sharing(T x);

inline int bad_second() { return 1; }
struct Data {
  Data(int n) : x{n}, y_(n) { y_ = 0; }  ///< text
  bool operator<(const Data& d) const;   ///< text

  std::function<int()> no_function;
  int operator()(int bad) const;
  int x{0}, y = f(1);
};
/// Class.
class Base : public Data {
 public:
  Base(int constructor_of_a_class_with_text);
  ~Base();
  Base(const Base&) = delete;

  int calc() const override;
  static Base bad_third(int n);
  friend int no_member(int n);

 private:
  int hidden(int n);
};
}  // namespace a
"""


def main():
    findings, count, shared = [], 0, []
    of_sample = list_undocumented(share_text(SAMPLE, list_functions(SAMPLE)))[0]
    if [name for _, name in of_sample] != ["bad_first", "bad_second", "Data::operator()", "Base::bad_third"]:
        findings.append("the sample of this test is read in another way than it must be")
    for path in list_files(ROOMS, (".hpp", ".h")):
        text = read(path)
        try:
            functions = list_functions(text)
        except ValueError as error:
            findings.append(f"{path}: {error}")
            continue
        missing, number = list_undocumented(share_text(text, functions))
        alone = list_undocumented(functions)[0]
        shared += [f"{path}:{line}: {name}" for line, name in alone if (line, name) not in missing]
        count += number
        findings += [f"{path}:{line}: {name} has no text; write what it computes, with frame, dimensions and errors"
                     for line, name in missing]
    if len(shared) > MAX_SHARED:
        findings += [f"{one} has the text of the function before; write one, if it is among the new ones"
                     for one in shared]
        findings.append(f"{len(shared)} functions have the text of another one, at most {MAX_SHARED} may")
    elif len(shared) < MAX_SHARED:
        print(f"{len(shared)} functions have the text of another one; lower MAX_SHARED")
    print(f"{count} public functions")
    finish(findings, "docstrings")


if __name__ == "__main__":
    main()

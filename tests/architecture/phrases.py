"""Counts banned words and phrases; the sums by room in phrases.txt may fall and never rise. RULES has the replacements.
A line with "style: keep" is exempt.

python3 tests/architecture/phrases.py . --lower     writes the counts of today into phrases.txt, if no room has more
python3 tests/architecture/phrases.py . --list RULE [ROOM]     prints the hits of a rule
"""
import collections
import os
import re
import sys

from common import ROOMS, ROOT, line_of, list_files, read

TABLE = os.path.join("tests", "architecture", "phrases.txt")
# docs/commands.md has the strings of cli, which are counted there.
EXEMPT = {"CHANGELOG.md", "docs/developer/unreleased.md", "docs/developer/changes-0.3.0.md",
          "docs/developer/changes-0.2.0.md", "docs/commands.md", "tests/architecture/phrases.py"}

# Rule: (where it is searched, regular expression, what to write).
# prose: comments, strings and pages; start: the first word of a line of a comment; code: identifiers.
NOUNS = ("Bough|programs?|functions?|solvers?|files?|decks?|cards?|tables?|pages?|reports?|librar(?:y|ies)|callers?|"
         "messages?|headers?|lines?|models?|runs?|readers?")
VERBS = "says?|tells?|knows?|asks?|wants?|forgets?|sees?|hears?"
RULES = {
    "no-subject": ("start", r"(?:What|Of|The same|Those|That|Whether|How|Which|As|By)\b",
                   "the subject first: a noun, or a verb and its object; Returns true if"),
    "k-most": ("code", r"\bk(?:Most|Least|Few|Many|Much|Faint|Quick|Tremble|ShortCut)\w*", "kMaxX, kMinX"),
    "most-least": ("code", r"\b(?:most|least)\b", "max_x, min_x"),
    "said": ("code", r"\b(?:said|unheard|blame|innocent|restless|indifferent|wishes_?|strangers|asked|wanted)\b",
             "diagnostics, requested, options, unrelated"),
    "is-fine": ("code", r"\bis_(?:fine|good|clean|sound)_?\b", "the condition: is_definite, is_valid"),
    "is-told": ("prose", r"\b(?:is|are|was|were) (?:told|said)\b|, (?:and |which is )?(?:told|said)\b", "is reported"),
    "speaking": ("prose", rf"\b(?:{NOUNS}) (?:{VERBS})\b", "contains, specifies, supports, requests"),
    "silence": ("prose", r"\bwithout a word\b|\ba word about\b|\bno word of\b|\bin silence\b", "silently; a message"),
    "goes-before": ("prose", r"\bgo(?:es)? before\b", "takes precedence over"),
    "without-strain": ("prose", r"\bmotions? without strain\b", "zero-energy modes"),
    "rigid-motion": ("prose", r"\brigid motions?\b", "rigid-body mode, rigid-body motion"),
    "rows-between": ("prose", r"\brows? between\b|\bhanded over\b", "separator rows; zero-copy"),
    "mass-centre": ("prose", r"\bmass cent(?:re|er)\b", "centre of mass"),
    "anew": ("prose", r"\banew\b|\bonce more\b|\bfor ever\b", "again; recomputed; without end"),
    "next-to-none": ("prose", r"\bnext to (?:none|nothing|no)\b", "negligible, with its bound"),
    "so-many": ("prose", r"\bso many\b|\b(?:dofs?|rows?|bytes|columns?|evaluations?|times?) an? "
                         r"(?:dof|step|rank|body|mode|column|row|node|second)\b", "N; per"),
    "whoever": ("prose", r"\b(?:[Ww]hoever|[Nn]obody|[Ss]omebody|anybody)\b", "the caller, no caller, a user"),
    "of-its-own": ("prose", r"\bof (?:its|their|one's) own\b", "separate, private; or nothing"),
    "stands-in": ("prose", r"\bstands? (?:in|at|on|where|beside|behind|before|after|there)\b|\bhangs? on\b",
                  "is; depends on"),
    "beside": ("prose", r"\bbeside\b|\bbehind\b", "next to, in addition to; after"),
    "take-off": ("prose", r"\btake[ns]? (?:off|out|away)\b", "subtract, project out, remove"),
    "b-less-a": ("prose", r"\bless (?:the|that|those|its|their|gravity)\b", "minus; a formula"),
    "what-it-has": ("prose", r"\bwhat (?:it|they|the \w+|a \w+) (?:has|have|had|lacks?|leaves?|left|makes?|holds?|"
                             r"carries|needs?)\b", "the noun"),
    "as-it-stands": ("prose", r"\bas (?:it|they) (?:stands?|comes?)\b", "unchanged"),
    "comes-to-rest": ("prose", r"\bcomes? (?:to rest|loose)\b|\bthrown? (?:each other )?back\b|\btrembl\w+",
                      "sticks, slips, rebounds, is noise"),
    "mend": ("prose", r"\bmends?\b|\bspoil(?:s|ed|t)?\b|\bdear(?:er|est)?\b", "fix; corrupt; expensive"),
    "held-by-tests": ("prose", r"\bheld by (?:the )?tests?\b|\bbalance lacks\b|\bwhat decays\b|\bliving views\b",
                      "verified by; error; stable part"),
    "a-tenth-less": ("prose", r"\b(?:third|quarter|fifth|sixth|seventh|eighth|tenth|twelfth|fifteenth|twentieth) "
                              r"(?:to a \w+ )?(?:less|more|faster)\b", "percent, of what"),
    # Names in quotes (controller 'law', law:2, law@1, law.fmu) and constitutive laws are no hits.
    "laws": ("prose", r"(?<![Cc]ontrol )(?<![Ff]orce )(?<![Ff]riction )(?<![Cc]onstitutive )(?<!Sylvester's )(?<![\"'`/])"
                      r"\blaws?\b(?!['\"`:@]|\.\w| = |\(| of)", "controller, control law"),
}

C_TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])*\'', re.S)
PY_TOKEN = re.compile(r'#[^\n]*|"""(?:\\.|[^\\])*?"""|\'\'\'(?:\\.|[^\\])*?\'\'\'|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'',
                      re.S)
# The whole of an opening of a comment: //, ///, ///<, with \file; in Python # and the quotes of a docstring.
C_OPENING, PY_OPENING = r"(?:///<?|//) (?:\\file )?", r"(?:# ?|^\"\"\"(?:\S+: )?)"


def blank(text):
    return " " + "\n" * text.count("\n")


def split(path, text):
    """Text of the three kinds, each with the other two blanked; line numbers stay."""
    if path.endswith(".md"):
        text = re.sub(r"(?ms)^```diff$.*?^```$", lambda diff: blank(diff.group()), text)  # counted in the sources
        return {"prose": text, "start": "", "code": ""}
    is_python = path.endswith(".py")
    opening = PY_OPENING if is_python else C_OPENING
    code, prose, start, end = [], [], [], 0
    for match in (PY_TOKEN if is_python else C_TOKEN).finditer(text):
        between, token = text[end:match.start()], match.group(0)
        is_comment = token.startswith(("//", "/*", "#", '"""', "'''"))
        first = re.match(opening, token) if is_comment else None
        code += [between, blank(token)]
        prose += [blank(between), token]
        # A start is marked so that the rule matches there only.
        start += [blank(between), blank(token) if not first else
                  "\x01" * first.end() + token[first.end():]]
        end = match.end()
    rest = text[end:]
    return {"prose": "".join(prose + [blank(rest)]), "start": "".join(start + [blank(rest)]), "code": "".join(code + [rest])}


def list_texts():
    """Paths of the product, the tests and the pages."""
    suffixes = (".hpp", ".cpp", ".h", ".c", ".py")
    paths = list_files(ROOMS, suffixes + (".md",)) + list_files(["tests"], suffixes + (".md",))
    paths += list_files(["docs"], (".md",)) + ["README.md", "CONTRIBUTING.md"]
    return [p for p in sorted(set(paths)) if p not in EXEMPT and not p.startswith("docs/adr/")]  # decisions quote their time


def room_of(path):
    folders = path.split("/")[:-1]
    if not folders or folders[0] == "docs":
        return "docs"
    return "/".join(folders[:2]) if folders[0] == "tests" else folders[0]


def find_hits():
    """{(rule, room): [(path, line, text of the hit)]}"""
    hits = collections.defaultdict(list)
    for path in list_texts():
        text = read(path)
        kinds, lines = split(path, text), text.split("\n")
        for rule, (kind, pattern, _) in RULES.items():
            for match in re.finditer((r"(?<=\x01)" if kind == "start" else "") + pattern, kinds[kind]):
                line = line_of(kinds[kind], match.start())
                if "style: keep" not in lines[line - 1]:
                    hits[rule, room_of(path)].append((path, line, match.group(0)))
    return hits


def read_counts():
    """{(rule, path): count}, and the rooms that were counted."""
    rows = [row.split() for row in read(TABLE).splitlines()]
    counts = {}
    for path, *items in rows[1:]:
        for item in items:
            rule, n = item.split("=")
            counts[rule, path] = int(n)
    return counts, rows[0][1:]


def write_counts(counts, rooms):
    rows = collections.defaultdict(list)
    for rule in RULES:
        for (found, path), n in counts.items():
            if found == rule and n:
                rows[path].append(f"{rule}={n}")
    with open(os.path.join(ROOT, TABLE), "w", encoding="utf-8") as f:
        f.write("\n".join([" ".join(["rooms:"] + rooms)] + [" ".join([path] + rows[path]) for path in sorted(rows)]) + "\n")


def count_files(hits):
    return collections.Counter((rule, path) for (rule, _), found in hits.items() for path, _, _ in found)


def sum_rooms(counts):
    sums = collections.Counter()
    for (rule, path), n in counts.items():
        sums[rule, room_of(path)] += n
    return sums


def check():
    """Findings, as lines of text: the hits of a rule in a room that has more of them than the table allows, in the files
    that have more; and the number of files whose counts may be lowered."""
    hits, (allowed, rooms) = find_hits(), read_counts()
    counts = count_files(hits)
    allowed_in, totals, allowed_totals = sum_rooms(allowed), collections.Counter(), collections.Counter()
    for (rule, _), n in counts.items():
        totals[rule] += n
    for (rule, _), n in allowed.items():
        allowed_totals[rule] += n
    findings = []
    for (rule, room), found in sorted(hits.items()):
        # A room that was not counted has been moved out of others: the sum over all rooms is what counts.
        n = allowed_in[rule, room]
        if len(found) <= n or (room not in rooms and totals[rule] <= allowed_totals[rule]):
            continue
        new = [hit for hit in found if counts[rule, hit[0]] > allowed.get((rule, hit[0]), 0)]
        findings += [f'{path}:{line}: "{text}"; write: {RULES[rule][2]}' for path, line, text in new]
        findings.append(f"{room}: {len(found)} of {rule}, allowed {n}")
    return findings, len({path for (rule, path), n in allowed.items() if counts[rule, path] < n})


def main():
    hits = find_hits()
    if "--list" in sys.argv:
        rule, *room = sys.argv[sys.argv.index("--list") + 1:]
        for (found_rule, found_room), found in sorted(hits.items()):
            if found_rule == rule and (not room or found_room == room[0]):
                print("\n".join(f"{path}:{line}: {text}" for path, line, text in found))
        return 0
    if findings := check()[0]:
        print("\n".join(findings))
        return 1
    write_counts(count_files(hits), sorted({room_of(path) for path in list_texts()}))
    return 0


if __name__ == "__main__":
    sys.exit(main())

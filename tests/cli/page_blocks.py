"""Commands, output and files in the text of a page of the manuals."""
import re

COMMAND = re.compile(r"(?:(?:\.\./|\./)dev )?bough |cd [\w-]+$")


def list_blocks(text):
    """("toml", its name and text), ("python", text) and ("lines", lines of a block of four blanks), in order."""
    lines, at, blocks = text.split("\n"), 0, []
    while at < len(lines):
        line = lines[at]
        if line.startswith("```"):
            end = next(k for k in range(at + 1, len(lines)) if lines[k].startswith("```"))
            blocks.append((line[3:].strip(), lines[at + 1:end]))
            at = end + 1
        elif line.startswith("    ") and (at == 0 or not lines[at - 1].strip()):
            end = at
            while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
                end += 1
            blocks.append(("lines", [part[4:] for part in lines[at:end]]))
            at = end
        else:
            at += 1
    return blocks


def split_lines(lines):
    """Commands of a block, with lines that end in a backslash joined; the other lines."""
    commands, others, joined = [], [], ""
    for line in lines:
        whole = joined + line.strip() if joined else line
        joined = ""
        if COMMAND.match(whole) and whole.endswith("\\"):
            joined = whole[:-1]
        elif COMMAND.match(whole):
            commands.append(re.split(r"\s{3,}|  \(", whole)[0])
        elif line.strip():
            others.append(line)
    return commands, others


def list_commands(text):
    return [command for kind, lines in list_blocks(text) if kind == "lines" for command in split_lines(lines)[0]]

"""Cards as text: small, large and free field, their continuations, and the ways a number can be written."""


def round_to(x, digits=4):
    """x with as many digits, up to `digits`, as eight columns hold."""
    for fewer in range(digits, 0, -1):
        rounded = float(f"{x:.{fewer}g}") + 0.0
        if spellings(rounded, 8):
            return rounded
    return 0.0


def spellings(x, width):
    """Ways to write the real x in `width` columns, each read back as exactly x."""
    texts = set()
    for digits in range(1, 18):
        short = f"{x:.{digits}g}"
        mantissa, _, exponent = short.partition("e")
        if "." not in mantissa:
            mantissa += "."
        if not exponent:
            texts |= {mantissa, mantissa + "0"}
            mantissa, exponent = f"{x:.{digits - 1}e}".split("e")
            if "." not in mantissa:
                mantissa += "."
        power = int(exponent)
        texts |= {f"{mantissa}E{power}", f"{mantissa}{power:+d}", f"{mantissa}e{power:+03d}", f"{mantissa}D{power}"}
    texts |= {t.replace("0.", ".", 1) for t in texts if t.startswith(("0.", "-0."))}
    fits = []
    for text in sorted(t for t in texts if any(c.isdigit() for c in t.lstrip("-")[:2])):
        plain = text.replace("D", "e").replace("E", "e")
        if "e" not in plain and any(sign in plain[1:] for sign in "+-"):
            at = max(plain.rfind("+"), plain.rfind("-"))
            plain = plain[:at] + "e" + plain[at:]
        if len(text) <= width and float(plain) == x:
            fits.append(text)
    return fits


def spell(value, width, rng):
    if value is None:
        return ""
    if isinstance(value, float):
        found = spellings(value, width)
        if not found:
            raise ValueError(f"{value!r} does not fit in {width} columns")
        return rng.choice(found)
    return str(value)


class Writer:
    """Writes each card in a format and with continuations of the generator's choice."""

    def __init__(self, rng, formats=("small", "large", "free")):
        self.rng, self.formats, self.tag = rng, formats, 0

    def write(self, name, fields):
        fields = list(fields)
        while fields and fields[-1] is None:
            fields.pop()
        style = self.rng.choice(self.formats)
        if style == "free":
            return self.free(name, fields)
        return self.fixed(name, fields, 8 if style == "small" else 16)

    def fixed(self, name, fields, width):
        rng, per_line = self.rng, 64 // width
        star = "*" if width == 16 else ""
        lines = [fields[i:i + per_line] for i in range(0, max(len(fields), 1), per_line)]
        kind = rng.choice(["blank", "plus", "tag"])
        head, text = f"{name + star:<8}", []
        for k, line in enumerate(lines):
            body = "".join(self.place(spell(v, width, rng), width) for v in line)
            tail = ""
            if kind == "tag" and k + 1 < len(lines):
                self.tag += 1
                tail = f"{'*' if star else '+'}T{self.tag}"
                body = f"{body:<64}" + tail
            text.append((head + body).rstrip())
            if kind == "blank" and not star and not any(v is not None for v in line):
                text[-1] = "+"      # an empty line would count as none
            mark = star or {"blank": "", "plus": "+", "tag": tail}[kind]
            head = f"{tail if kind == 'tag' else mark:<8}"
        return "\n".join(text)

    def place(self, text, width):
        return self.rng.choice([f"{text:<{width}}", f"{text:>{width}}"])

    def free(self, name, fields):
        rng = self.rng
        lines = [fields[i:i + 8] for i in range(0, max(len(fields), 1), 8)]
        kind = rng.choice(["", "+"])
        gap = rng.choice(["", "", " "])
        text, head = [], name
        for line in lines:
            text.append(head + "".join("," + gap + spell(v, 8, rng) for v in line))
            head = kind
        return "\n".join(text) if len(fields) else name + ","

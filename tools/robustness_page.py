"""The page docs/verification/robustness.md: each script puts its table between its two marks."""
import os
import re

PAGE = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "docs", "verification",
                    "robustness.md")


def write_table(mark, heads, rows, below=""):
    """Rows of words and numbers between <!-- mark --> and <!-- end of mark -->; `below`: lines behind the table."""
    lines = [heads, ["---"] * len(heads), *rows]
    text = "\n".join("| " + " | ".join(str(x) for x in row) + " |" for row in lines) + ("\n\n" + below if below else "")
    with open(PAGE, encoding="utf-8") as f:
        page = f.read()
    begin, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    if begin not in page or end not in page:
        raise SystemExit(f"error: {PAGE} has no marks {begin} and {end}")
    page = re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: f"{begin}\n{text}\n{end}", page, flags=re.S)
    with open(PAGE, "w", encoding="utf-8") as f:
        f.write(page)

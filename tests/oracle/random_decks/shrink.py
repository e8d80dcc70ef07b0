"""Cuts a deck that breaks a rule down to the cards that it needs for it."""
import re

def kind_of(report):
    """What is broken, without its numbers: of the first verb."""
    if report.kind != "wrong":
        return report.kind
    verb, what = next(iter(report.what.items()))
    return verb, re.sub(r"[-+0-9.e\[\]]+", "#", what)[:30]


LOADS = {"LOAD", "FORCE", "MOMENT", "GRAV"}


def shrink(examination, report, budget=250):
    """Removes cards in halves, then one by one, while the same rule is broken; loads together."""
    kind, cards, best = kind_of(report), examination.cards, report
    eigrl = getattr(examination, "eigrl", None)

    def tries(fewer):
        nonlocal cards, best, budget
        budget -= 1
        try:
            tried = examination.run(eigrl, fewer)
        except (KeyError, AssertionError):     # a constraint on a grid that is gone, a point that is left
            return False
        if kind_of(tried) != kind:
            return False
        cards, best = fewer, tried
        return True

    tries([c for c in cards if c[0] not in LOADS])
    step = max(1, len(cards) // 2)
    while step and budget > 0:
        at = 0
        while at < len(cards) and budget > 0:
            part = cards[at:at + step]
            if part[0][0] in LOADS or not tries(cards[:at] + cards[at + step:]):
                at += step
        step //= 2
    return best

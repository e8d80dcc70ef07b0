"""Spoils the cards of a sound structure: what a hand, a script or a translator does to a deck."""
TIES = {"RBE1", "RBE2", "RBE3", "RBAR", "RROD", "MPC"}
PLACES = {"GRID", "SPOINT", "SPC", "SPC1", "CORD1R", "CORD2R", "CORD2C", "CORD2S"} | TIES
BEAM, SHELL = ("CBEAM",), ("CQUAD4", "CTRIA3", "CQUADR", "CTRIAR", "CQUAD8", "CTRIA6")
PROPERTIES = {"PBAR": ("CBAR",), "PBARL": ("CBAR",), "PBEAM": BEAM, "PBEAML": BEAM, "PBCOMP": BEAM, "PROD": ("CROD",),
              "PTUBE": ("CTUBE",), "PSHELL": SHELL, "PCOMP": SHELL, "PSOLID": ("CHEXA", "CPENTA", "CTETRA"),
              "PSHEAR": ("CSHEAR",), "PELAS": ("CELAS1", "CELAS3"), "PBUSH": ("CBUSH",), "PMASS": ("CMASS1", "CMASS3")}


class Spoiled:
    """cards; what was done; the error ids that it must lead to (None: any answer that keeps the rules); whether the
    generator's grids and constraints are still those of the deck."""

    def __init__(self, cards, what, ids=None, keeps_truth=False):
        self.cards, self.what, self.ids, self.keeps_truth = cards, what, ids, keeps_truth


def pick(rng, cards, wanted):
    chosen = [k for k, (name, fields) in enumerate(cards) if wanted(name, fields)]
    return rng.choice(chosen) if chosen else None


def replace(cards, k, fields):
    return cards[:k] + [(cards[k][0], fields)] + cards[k + 1:]


def reals(fields, start=1):
    return [i for i, v in enumerate(fields) if i >= start and isinstance(v, float) and v]


def change_field(rng, cards, change, what):
    k = rng.randrange(len(cards))
    fields = list(cards[k][1])
    used = [i for i, v in enumerate(fields) if v is not None and i > 0] or [0]
    i = rng.choice(used)
    fields[i] = change(fields[i])
    text = f"{what} of {cards[k][0]} {cards[k][1][0]} field {i + 1}"
    return Spoiled(replace(cards, k, fields), text, None, cards[k][0] not in PLACES)


def change_real(rng, cards, change, what):
    k = pick(rng, cards, lambda name, fields: reals(fields))
    if k is None:
        return None
    fields = list(cards[k][1])
    i = rng.choice(reals(fields))
    fields[i] = change(fields[i])
    return Spoiled(replace(cards, k, fields), f"{what} {cards[k][0]} {fields[0]} field {i + 1}", None,
                   cards[k][0] not in PLACES)


def drop_card(rng, cards):
    k = rng.randrange(len(cards))
    return Spoiled(cards[:k] + cards[k + 1:], f"without {cards[k][0]} {cards[k][1][0]}", None,
                   cards[k][0] not in PLACES)


def duplicate_grid(rng, cards):
    k = pick(rng, cards, lambda name, _: name == "GRID")
    if k is None:
        return None
    fields = list(cards[k][1])
    fields[2] = round((fields[2] or 0.0) + 1.0, 3)
    return Spoiled(cards + [("GRID", fields)], f"GRID {fields[0]} twice", {"deck.duplicate-id"})


def drop_property(rng, cards):
    used = {(name, fields[1]) for name, fields in cards if len(fields) > 1}
    k = pick(rng, cards, lambda name, f: any((user, f[0]) in used for user in PROPERTIES.get(name, ())))
    if k is None:
        return None
    return Spoiled(cards[:k] + cards[k + 1:], f"without {cards[k][0]} {cards[k][1][0]}", {"fe.missing-property"}, True)


def drop_material(rng, cards):
    k = pick(rng, cards, lambda name, _: name in ("MAT1", "MAT8"))
    if k is None:
        return None
    mid = cards[k][1][0]
    of_springs = {"PELAS", "PBUSH", "PMASS", "PCOMP"}
    used = {(name, fields[1]) for name, fields in cards if len(fields) > 1}
    users = [n for n, f in cards if n in PROPERTIES and n not in of_springs and f[1] == mid
             and any((user, f[0]) in used for user in PROPERTIES[n])]
    users += [n for n, f in cards if n == "CONROD" and f[3] == mid]
    ids = {"fe.missing-material"} if users else None
    return Spoiled(cards[:k] + cards[k + 1:], f"without material {mid}", ids, True)


def no_length(rng, cards):
    k = pick(rng, cards, lambda name, f: name in ("CROD", "CTUBE", "CBAR", "CBEAM"))
    if k is None:
        return None
    fields = list(cards[k][1])
    fields[3] = fields[2]
    return Spoiled(replace(cards, k, fields), f"{cards[k][0]} {fields[0]} with one grid at both ends",
                   {"fe.zero-length", "deck.field-range"}, True)


def drop_grid(rng, cards):
    k = pick(rng, cards, lambda name, _: name == "GRID")
    if k is None:
        return None
    return Spoiled(cards[:k] + cards[k + 1:], f"without GRID {cards[k][1][0]}")


def tie_twice(rng, cards):
    k = pick(rng, cards, lambda name, _: name in ("RBE2", "RROD"))
    if k is None:
        return None
    fields = [987654, *cards[k][1][1:]]
    return Spoiled(cards + [(cards[k][0], fields)], f"{cards[k][0]} {cards[k][1][0]} twice", {"fe.dependent-twice"})


def fix_dependent(rng, cards):
    k = pick(rng, cards, lambda name, _: name == "RBE2")
    if k is None:
        return None
    grid, component = cards[k][1][3], cards[k][1][2][0]
    return Spoiled([*cards, ("SPC1", [3, component, grid])], f"SPC1 on dependent grid {grid}", {"fe.dependent-fixed"})


def free_it(rng, cards):
    left = [c for c in cards if c[0] not in ("SPC", "SPC1")]
    return Spoiled(left, "without supports") if len(left) < len(cards) else None


def turn_round(rng, cards):
    k = pick(rng, cards, lambda name, _: name in ("CQUAD4", "CQUADR", "CSHEAR", "CHEXA", "CPENTA", "CTETRA", "CTRIA3"))
    if k is None:
        return None
    fields = list(cards[k][1])
    fields[2], fields[3] = fields[3], fields[2]
    return Spoiled(replace(cards, k, fields), f"two corners of {cards[k][0]} {fields[0]} swapped", None, True)


def spoil(rng, cards):
    """Cards with one fault."""
    junk = ["ABC", "1.2.3", "-", "0", "-1", "999999"]
    while True:
        kind = rng.randrange(15)
        made = [
            lambda: change_field(rng, cards, lambda v: None, "blank in place"),
            lambda: change_field(rng, cards, lambda v: None, "blank in place"),
            lambda: change_field(rng, cards, lambda v: rng.choice(junk), "junk in place"),
            lambda: change_real(rng, cards, lambda v: -v, "negative"),
            lambda: change_real(rng, cards, lambda v: -v, "negative"),
            lambda: change_real(rng, cards, lambda v: rng.choice([1e30, 1e-30, 1e15, 0.0]), "far off"),
            lambda: drop_card(rng, cards), lambda: duplicate_grid(rng, cards), lambda: drop_property(rng, cards),
            lambda: drop_material(rng, cards), lambda: no_length(rng, cards), lambda: drop_grid(rng, cards),
            lambda: rng.choice([tie_twice, fix_dependent])(rng, cards), lambda: free_it(rng, cards),
            lambda: turn_round(rng, cards)][kind]()
        if made is not None:
            return made

"""One seed: its structure, valid or with a fault, through the commands; faults of the results."""
import os
import random

import numpy as np

import judge_body
import judge_modes
import judge_static
import pencil
import simple
import spoil
from generate import generate
from truth import Truth, Unclear, Wrong
from writer import round_to

FORMATS = [("small",), ("large",), ("free",), ("small", "large", "free")]


class Report:
    """kind: ok, refused, unclear or wrong; what: why unclear, or what is wrong by command; deck: the text."""

    def __init__(self, kind, what="", deck=""):
        self.kind, self.what, self.deck = kind, what, deck


def choose_eigrl(rng, spectrum):
    """A number of modes, a range, or both; the limits of a range lie in gaps."""
    number = rng.choice([1, 3, 6, 10, 10, 20])
    if spectrum is None or spectrum.grey or len(spectrum.lam) < 2 or rng.random() < 0.5:
        return [5, None, None, number]
    hz = np.sqrt(np.maximum(np.where(spectrum.is_zero(), 0, spectrum.lam), 0)) / (2 * np.pi)
    gaps = [k for k in range(1, min(len(hz), 25)) if hz[k] > 1.01 * hz[k - 1] + 1e-6 * hz.max()]
    if not gaps:
        return [5, None, None, number]
    limits = sorted(rng.sample(gaps, min(len(gaps), 2)))
    between = [round_to(0.5 * (hz[k] + hz[k - 1]), 5) for k in limits]
    if any(not hz[k - 1] < v < hz[k] for k, v in zip(limits, between)):
        return [5, None, None, number]
    kind = rng.randrange(4)
    if kind == 0:
        return [5, None, between[-1]]
    if kind == 1:
        return [5, between[0], None, number]
    if kind == 2 and len(between) > 1:
        return [5, *between]
    return [5, between[0] if len(between) > 1 else 0.0, between[-1], number]


class Examination:
    def __init__(self, program, seed, spoiled, verbs):
        self.program, self.seed, self.verbs = program, seed, verbs
        rng = random.Random(f"deck {seed} {spoiled}")
        self.rng, self.model = rng, generate(seed)
        self.whole = self.model
        self.cards, self.formats = self.model.list_cards(), rng.choice(FORMATS)
        self.fault = None
        if spoiled:
            self.fault = spoil.spoil(rng, self.cards)
            self.cards = self.fault.cards
        if rng.random() < 0.3:
            rng.shuffle(self.cards)

    def write(self, eigrl, cards=None):
        text = self.model.text(self.cards if cards is None else cards, eigrl, self.seed, self.formats)
        with open(os.path.join(self.program.folder, "deck.bdf"), "w", encoding="ascii") as f:
            f.write(text)
        return text

    def run(self, eigrl=None, cards=None):
        """Writes, solves, compares; `eigrl` and `cards` overrule the drawn ones (to cut a deck down)."""
        if cards is not None:
            self.model = self.whole.restrict(cards)
        text = self.write(eigrl or [5, None, None, 10], cards)
        ran, matrices = self.program.matrices("deck.bdf")
        truth = spectrum = unclear = None
        if matrices is None:
            wrong = ran.broken_rule() or self.judge_refusal(ran)
            if wrong:
                return Report("wrong", {"matrices": wrong}, text)
        elif self.fault is None or self.fault.keeps_truth:
            try:
                truth = Truth(self.model, *matrices, self.program.autospc("deck.bdf"))
                wrong = self.fault is None and simple.judge(self.model, truth)
                if wrong:
                    return Report("wrong", {"matrices": wrong}, text)
                spectrum = pencil.solve(truth.K, truth.M, truth.K_size, truth.M_size)
                unclear = spectrum.grey
            except Wrong as e:
                return Report("wrong", {"autospc": str(e)}, text)
            except Unclear as e:
                truth, unclear = None, str(e)
        if eigrl is None:
            eigrl = choose_eigrl(self.rng, spectrum)
            text = self.write(eigrl, cards)
        self.eigrl = eigrl
        wrong, code = self.try_verbs(matrices, truth, spectrum, eigrl)
        if wrong:
            return Report("wrong", wrong, text)
        unclear = unclear or (spectrum and spectrum.grey)
        if unclear:
            return Report("unclear", unclear, text)
        return Report("ok" if code == 0 else "refused", self.refusal, text)

    def judge_refusal(self, ran):
        """Of a deck that `matrices` refuses."""
        if self.fault is None:
            return f"a sound deck is refused: {ran.first_error()}"
        if self.fault.ids and not self.fault.ids & set(ran.ids()):
            return f"{self.fault.what}: expected {' or '.join(sorted(self.fault.ids))}, found {ran.first_error()}"
        return None

    def try_verbs(self, matrices, truth, spectrum, eigrl):
        """Faults by command, and the worst exit code: of modes, or of the other commands if modes is not run."""
        code, found, self.refusal = 0, {}, ""
        for verb in self.verbs:
            wrong = None
            if verb == "matrices":      # has been run
                continue
            if verb == "modes":
                ran, answer = self.program.modes("deck.bdf")
                code, self.refusal = ran.code, ran.first_error() if ran.code else ""
                if matrices is None:
                    wrong = ran.broken_rule() or (code == 0 and "modes answers a deck that matrices refuses")
                else:
                    wrong = judge_modes.judge(ran, answer, truth, spectrum, eigrl)
            elif verb == "static":
                ran = self.program.run("static", "deck.bdf", "-o", "static.h5")
                wrong = ran.broken_rule() or (
                    self.model.loads and judge_static.judge(ran, self.program.folder, self.model, truth))
            elif verb == "reduce":
                is_free = not self.model.fixed
                ran = self.program.run("reduce", "deck.bdf", "--modes", 5, "--full", "-o", "body.h5",
                                       *["--free"] * is_free)
                wrong = judge_body.judge(ran, self.program.folder, self.model, truth, spectrum, is_free)
            else:
                ran = self.program.run(verb, "deck.bdf")
                wrong = ran.broken_rule()
                if not wrong and (ran.code == 0) != (matrices is not None):
                    wrong = f"{verb} ends with {ran.code}, matrices with {0 if matrices is not None else 1}"
            if "modes" not in self.verbs and ran.code:
                code, self.refusal = max(code, ran.code), ran.first_error()
            if wrong:
                found[verb] = wrong
        if self.fault and self.fault.ids and matrices is not None:
            found["matrices"] = f"exit 0, expected {' or '.join(sorted(self.fault.ids))}"
        return found, code

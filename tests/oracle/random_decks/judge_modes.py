"""Is the answer of `modes` the dense solution, or a refusal that the structure explains?"""
import numpy as np

RELATIVE = 2e-6      # of the eigenvalue: 1e-6 of the frequency
RESIDUAL = 1e-5
NOISE = 40           # times the estimate of round-off

# Warnings that modes lack digits or may be missing.
DOUBT = {"modal.lost-digits", "modal.uncertain-count"}

# What may be said of a structure with a motion that has neither strain nor mass, of one without mass.
SINGULAR = {"modal.singular-shift", "fe.mechanism", "modal.missed-modes"}
NO_MASS = {"modal.no-mass", "modal.no-dofs", "fe.no-free-dofs"}


class BeyondDoubt(Exception):
    """More is asked for than is certain."""


def choose_expected(spectrum, eigrl):
    """Positions of the λ that the range and number of the card ask for, ascending. Raises BeyondDoubt."""
    _, v1, v2, nd = (list(eigrl) + [None] * 4)[:4]
    lam = np.where(spectrum.is_zero(), 0, spectrum.lam)
    hz = np.sqrt(np.maximum(lam, 0)) / (2 * np.pi)
    inside = np.ones(len(lam), bool)
    if v1 is not None and v1 > 0:
        inside &= hz >= v1
    if v2 is not None:
        inside &= hz <= v2
    if v2 is None and nd is None:
        nd = 1
    places = np.flatnonzero(inside)
    has_enough = nd is not None and len(places) >= nd
    if spectrum.is_cut and not has_enough and not (v2 is not None and len(hz) and hz[-1] > v2):
        raise BeyondDoubt
    return places if nd is None else places[:nd]


def judge(ran, found, truth, spectrum, eigrl):
    """None, or what is wrong."""
    broken = ran.broken_rule()
    if broken:
        return broken
    if ran.code != 0:
        return judge_refusal(ran, truth, spectrum, eigrl)
    lam, residual = np.array(found["eigenvalue"], float), np.array(found["residual"], float)
    if not np.all(np.isfinite(lam)):
        return "eigenvalues that are not finite, exit 0"
    if len(residual) and residual.max() > RESIDUAL:
        return f"residual {residual.max():.1e} with exit 0"
    if spectrum is None:
        return None
    if spectrum.grey is None:
        try:
            wrong = compare(lam, spectrum, eigrl)
        except BeyondDoubt:
            spectrum.grey = "the rank of the mass"
            wrong = None
        if wrong and DOUBT & set(ran.warnings()) and is_vague(spectrum, eigrl):
            spectrum.grey = "round-off, which the program names"
        elif wrong:
            return wrong
    return judge_shapes(lam, found, truth)


def is_vague(spectrum, eigrl):
    """Whether round-off may take more from an eigenvalue that is asked for than a residual is allowed to."""
    try:
        places = choose_expected(spectrum, eigrl)
    except BeyondDoubt:
        return True
    return bool(np.any(NOISE * spectrum.noise[places] > RESIDUAL * np.abs(spectrum.lam[places])))


def judge_refusal(ran, truth, spectrum, eigrl):
    if spectrum is None or spectrum.grey:
        return None
    ids = set(ran.ids())
    if len(spectrum.lam) == 0 and ids & NO_MASS:
        return None
    if spectrum.num_null > 0 and ids & SINGULAR:
        return None
    if ids == {"fe.residual"} and is_vague(spectrum, eigrl):
        return None
    return f"a sound structure is refused (exit {ran.code}): {ran.first_error()}"


def compare(lam, spectrum, eigrl):
    places = choose_expected(spectrum, eigrl)
    # a neighbour of the limits, or one of a repeated root, may be in or out
    expected = spectrum.lam[places]
    if len(lam) != len(places):
        return f"{len(lam)} modes, expected {len(places)}: {show(lam)} for {show(expected)}"
    for k, place in enumerate(places):
        allowed = RELATIVE * abs(expected[k]) + NOISE * spectrum.noise[place]
        if abs(lam[k] - expected[k]) > allowed:
            return (f"mode {k + 1}: eigenvalue {lam[k]:.9g}, expected {expected[k]:.9g} +- {allowed:.1e}: "
                    f"{show(lam)} for {show(expected)}")
    return None


def show(lam):
    return "[" + " ".join(f"{v:.6g}" for v in lam[:12]) + (" ..." if len(lam) > 12 else "") + "]"


def judge_shapes(lam, found, truth):
    """The shapes obey the constraints and the equation; only where grids alone carry the model."""
    if len(lam) == 0 or truth is None or len(found["ids"]) * 6 != len(truth.index):
        return None
    rows = [truth.index[int(g), c] for g in found["ids"] for c in range(1, 7)]
    Phi = np.zeros((len(rows), len(lam)))
    Phi[rows] = found["phi"].reshape(len(rows), -1)
    X = (truth.R.T @ Phi)[truth.free]
    largest = np.abs(Phi).max(0)
    off = np.abs(Phi - truth.T @ X).max(0) / largest
    if off.max() > 1e-7:
        return f"mode {off.argmax() + 1} breaks the constraints by {off.max():.1e}"
    KX, MX = truth.K @ X, truth.M @ X
    kd = truth.K.diagonal() + max(lam.max(), 0) * truth.M.diagonal()
    s = np.where(kd > 0, 1 / np.sqrt(np.where(kd > 0, kd, 1)), 0)
    size, is_zero = np.abs(X), lam == 0
    noise = 2.2e-16 * (truth.K_size @ size + np.abs(lam) * (truth.M_size @ size))
    norm = lambda A: np.sqrt(((s[:, None] * A) ** 2).sum(0))
    # of a motion without strain: against the forces that its parts would take
    allowed = RESIDUAL * norm(np.abs(KX) + np.abs(MX * lam)) + 100 * norm(noise)
    allowed = allowed + np.where(is_zero, 1e-8 * norm(truth.K_size @ size), 0)
    r = norm(KX - MX * lam)
    worst = int((r - allowed).argmax())
    if r[worst] > allowed[worst]:
        return f"mode {worst + 1}: true residual {r[worst]:.1e}, allowed {allowed[worst]:.1e}, exit 0"
    gram = np.abs(X.T @ MX - np.eye(len(lam)))
    if gram.max() > 1e-6:
        return f"modes are not orthonormal by {gram.max():.1e}"
    return None

"""Theorem 1, Lemma 3, Theorem 2 and its first case: bounds, found again by the audit and compared with
the run (paper, sections 3.3 and 4.3)."""

from __future__ import annotations

from exactacq.numbers.length import Length
from exactacq.study.claims.model import SILENT, Case, Claim, Finding, Statement, Subject, flaw, found
from exactacq.study.claims.tallies import Tally, bounds_of, sweep_flaw, tour_flaw

SIGHTSEER, SPREADER = Subject.SIGHTSEER, Subject.SEED_SPREADER


def _within(length: Length, value: Length) -> Finding:
    ratio = float(length) / float(value) if value.sign() else None
    return found(length <= value, f"{float(length):.8g} against {float(value):.8g}", ratio)


def keeps_theorem_1(case: Case) -> Finding:
    """P is at most (1), in model (a)."""
    return _keeps(case, "(1)")


def keeps_corrected_theorem_1(case: Case) -> Finding:
    """P is at most the corrected (1), in model (a)."""
    return _keeps(case, "T1 corrected")


def _keeps(case: Case, name: str) -> Finding:
    if not case.is_mutually_visible:
        return SILENT
    run, wrong = case.sightseer, case.shared(tour_flaw)
    return flaw(wrong) if wrong else _within(run.length, bounds_of(run)[name])


def keeps_lemma_3(case: Case) -> Finding:
    """The visits are at most (4)."""
    return _visits(case, bounds_of(case.spreader)["(4)"])


def keeps_corrected_lemma_3(case: Case) -> Finding:
    """The visits are at most (4), what is met again and overtaken aims; a wider form across strips."""
    return _visits(case, case.shared(Tally).proved_visits())


def _visits(case: Case, most: Length) -> Finding:
    wrong = case.shared(sweep_flaw)
    return flaw(wrong) if wrong else _within(Length(case.shared(Tally).visits), most)


def keeps_theorem_2(case: Case) -> Finding:
    """P is at most (5) and (6), and (9)-(11) in the cases they are for.

    (9) and (11) are for diversions that meet no known obstacle, (10) and (11) for obstacles clear of the
    border.
    """
    if (wrong := case.shared(sweep_flaw)) is not None:
        return flaw(wrong)
    run, names = case.spreader, {"(5)", "(6)", "(9)", "(10)", "(11)"}
    if not case.shared(Tally).is_clear:
        names -= {"(10)", "(11)"}
    if case.shared(Tally).diversions_meet_known:
        names -= {"(9)", "(11)"}
    values = {name: value for name, value in bounds_of(run).items() if name in names}
    broken = [name for name, value in values.items() if run.length > value]
    worst = max(float(run.length) / float(value) for value in values.values() if value.sign())
    return found(not broken, f"broken: {', '.join(broken)}" if broken else "", worst)


def keeps_corrected_theorem_2(case: Case) -> Finding:
    """P is at most (6), or (10) clear of the border, with what is met again and what far diversions add."""
    wrong = case.shared(sweep_flaw)
    return flaw(wrong) if wrong else _within(case.spreader.length, case.shared(Tally).proved_length())


def is_the_m_line(case: Case) -> Finding:
    """If no obstacle is hit and none diverted to, P is A + B + rA."""
    run = case.spreader
    if not case.shared(Tally).is_plain:
        return SILENT
    if (wrong := case.shared(sweep_flaw)) is not None:
        return flaw(wrong)
    value = bounds_of(run)["(8)"]
    return found(run.length == value, f"P = {run.length}, (8) is {value}")


CLAIMS = (
    Claim(
        "T1",
        "Theorem 1, bounds (1) and (2)",
        Statement(
            r"In model (a), $P \le 2(n - 1) \min(R, d_{\max}) + 1.5 \sum p_i + (n - 2) p_{\max} / 2$.",
            SIGHTSEER,
            keeps_theorem_1,
            counterexamples=("m9",),
        ),
        Statement(
            r"In model (a), $P \le \lvert S S_1 \rvert + (2n - 3) \min(R, v_{\max}) + 1.5 \sum p_i - "
            r"p_{\text{last}} / 2 + (n - 2) p_{\max} / 2$ for $n \ge 2$; $P = \lvert S S_1 \rvert + p$ for "
            "$n = 1$.",
            SIGHTSEER,
            keeps_corrected_theorem_1,
            argument="T1",
        ),
        r"What is visible only past something can be farther than any two obstacles are apart. $\lvert S "
        r"S_1 \rvert$ is the way from a free start to the first obstacle, $v_{\max}$ the longest tree edge. "
        r"As both are at most $R$, (2) is true as printed for $n \ge 2$.",
    ),
    Claim(
        "L3",
        "Lemma 3, bound (4)",
        Statement(
            r"The visits are at most $n + n\,n_0 + \tfrac{1}{2} \sum n_j (n_j - 1)$.",
            SPREADER,
            keeps_lemma_3,
            counterexamples=("m20-3",),
        ),
        Statement(
            r"The visits are at most $n + n\,n_0 + \tfrac{1}{2} \sum n_j (n_j - 1) + \sum \mathit{re}_i + "
            r"s$, $\mathit{re}_i$ the number of times that obstacle $i$ blocks the M-line after it was "
            "acquired, $s$ the number of aims that are acquired on the way to them and still in the way; "
            r"$n + n(n - 1)/2 + \sum \mathit{re}_i + s$ if a diversion meets obstacles of another strip.",
            SPREADER,
            keeps_corrected_lemma_3,
            argument="L3",
        ),
        "One obstacle can block the M-line once for every line that it crosses. The last two amendments are "
        "for what could not be excluded: no scene is known that needs them.",
    ),
    Claim(
        "T2",
        "Theorem 2, bounds (5), (6) and (9)-(11)",
        Statement(
            "$P$ is at most (5) and (6); at most (9) if diversions meet no known obstacle, (10) if none "
            "meets the border, (11) if both.",
            SPREADER,
            keeps_theorem_2,
            counterexamples=("m20-3", "m20-6", "m20-8", "m20-16", "relay"),
        ),
        Statement(
            r"$P \le A + B + rA + 2nR + 2 \sum \max(0, \lvert DQ \rvert - R) + a \sum p_i + k "
            r"(2n\,n_0\,p_{\max} + p_{\max} \sum n_j (n_j - 1)) + k \sum \mathit{re}_i\,p_i + k \sum$ of "
            "$p$ over overtaken aims; $a = 3/2$ and $k = 1/2$ if no obstacle meets the border, else 3 and "
            r"1; with $n^2 p_{\max}$ for the bracket if a diversion meets obstacles of another strip.",
            SPREADER,
            keeps_corrected_theorem_2,
            argument="T2",
        ),
        "Two things are not counted: meeting a known obstacle again on the M-line (m20), and diversions "
        "longer than R (relay), to obstacles that were first seen on another diversion and are out of "
        "reach from D. Without the term for these the corrected bound fails on relay, by 1115.08 to 1046.71.",
    ),
    Claim(
        "C8",
        "section 4.3, Case 1, equation (8)",
        Statement(
            "If nothing blocks the M-line and nothing is diverted to, $P = A + B + rA$.",
            SPREADER,
            is_the_m_line,
            argument="C8",
        ),
    ),
)

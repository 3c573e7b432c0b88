"""Tables of the repeated sessions: the paper's box plots, the tails of its t tests, and one person's sessions."""

import math
import statistics

from pilot_study import paper
from pilot_study.first_tables import table
from pilot_study.records import places
from pilot_study.t_tests import paired, tail_p, two_tailed_p, without_one

COUNTED = ("bridge", "terrain", "water")


def print_homogeneity(cohort):
    head = ["score", "TASBID paper", "chi-squared", "degrees of freedom", "p", f"p below {paper.HOMOGENEITY_LEVEL}"]
    rows = []
    for one in cohort["homogeneity"]:
        low = "yes" if one["p"] < paper.HOMOGENEITY_LEVEL else "no"
        rows.append([one["score"], f"p not below {paper.HOMOGENEITY_LEVEL}", f"{one['chi_squared']:.2f}", one["df"], f"{one['p']:.2f}", low])
    table("The eight compared with the others", head, rows)


def print_boxes(sessions, cohort):
    """Prints mean, standard deviation and quartiles of each score and session."""
    head = ["score", "session", "mean", "sd", "lowest", "lower quartile", "median", "upper quartile", "highest", "outliers"]
    rows = []
    for one in cohort["boxes"]:
        plot, score = one["plot"], one["score"]
        values = [record["scores"][score] for record in repeating(sessions)[one["repetition"] - 1]]
        cells = [statistics.fmean(values), statistics.stdev(values), min(values), plot["q1"], plot["median"], plot["q3"], max(values)]
        rows.append([score, one["repetition"], *(f"{cell:.1f}" for cell in cells), len(plot["outliers"])])
    table("Scores of the eight by session", head, rows)


def repeating(sessions):
    """Returns the three sessions of the people who flew all three."""
    names = {record["trainee"] for record in sessions[2]}
    return [[record for record in session if record["trainee"] in names] for session in sessions]


def changes(sessions, score, early, late):
    flown = repeating(sessions)
    return [b["scores"][score] - a["scores"][score] for a, b in zip(flown[early - 1], flown[late - 1])]


def print_tails(sessions, cohort):
    """Prints p values of the tails that the paper tested."""
    holm = {(one["score"], one["earlier"], one["later"]): one["p_holm"] for one in cohort["tests"]}
    head = ["score", "sessions", "tail", "paper's p", "p of the paper's t", "p", "difference", "p after Holm"]
    rows = []
    for (score, early, late), (paper_t, paper_p, tail) in paper.TESTS.items():
        own = changes(sessions, score, early, late)
        _, t, _ = paired(own)
        start = [score, f"{early}, {late}", tail, f"{paper_p:.3f}", f"{tail_p(paper_t, paper.REPEATING - 1, tail):.3f}"]
        if t is None:
            rows.append([*start, "none", "", ""])
            continue
        p = tail_p(t, len(own) - 1, tail)
        rows.append([*start, f"{p:.3f}", f"{p - paper_p:+.3f}", f"{holm[score, early, late][tail]:.3f}"])
    table("Tails of the t tests", head, rows)


def print_influence(sessions):
    """Prints how much a test depends on a single person."""
    head = ["score", "sessions", "paper's d_z", "d_z", "without one person", "person whose absence changes it most", "d_z without", "p two-tailed without"]
    rows = []
    for (score, early, late), t in paper.T.items():
        own = changes(sessions, score, early, late)
        _, _, dz = paired(own)
        others = without_one(own)
        if dz is None or any(other is None for _, other in others):
            continue
        k = max(range(len(own)), key=lambda k: abs(others[k][1] - dz))
        span = f"{min(other for _, other in others):.2f} to {max(other for _, other in others):.2f}"
        p = two_tailed_p(others[k][0], len(own) - 2)
        rows.append([score, f"{early}, {late}", f"{t / math.sqrt(paper.REPEATING):.2f}", f"{dz:.2f}", span, k + 1, f"{others[k][1]:.2f}", f"{p:.3f}"])
    table("Influence of single people", head, rows)


def person_like_18(sessions):
    """Returns the index of the person among those with three sessions whose first flight took longest: participant 18 was close to the paper's
    longest flight."""
    first = repeating(sessions)[0]
    return max(range(len(first)), key=lambda k: first[k]["seconds"])


def print_person(sessions):
    """Prints one person's three sessions beside those of the paper's participant 18."""
    k = person_like_18(sessions)
    flown = [session[k] for session in repeating(sessions)]
    text = lambda values: " → ".join("not given" if value is None else f"{value:.0f}" for value in values)
    rows = [[score, text(values), text([one["scores"][score] for one in flown])] for score, values in paper.PERSON_SCORES.items()]
    rows.append(["safety", "rises, then stays", text([one["scores"]["safety"] for one in flown])])
    rows.append(["minutes", f"{paper.PERSON_MINUTES}; 24 in the second session", " → ".join(f"{one['seconds'] / 60:.1f}" for one in flown)])
    words = ["rises in session 2", "rises in session 2", "skipped in session 2, much higher in 3", "not given"]
    for task, (place, word) in enumerate(zip(paper.PLACES, words)):
        rows.append([f"on path at the {place}, %", word, text([100 * one["tasks"][task]["on_path"] for one in flown])])
    counts = [[sum(place[kind] for place in places(one)) for kind in COUNTED] for one in flown]
    rows.append(["crashes into the bridge", text(paper.PERSON_BRIDGE_CRASHES), text([own[0] for own in counts])])
    rows.append(["crashes into ground or water", "fewer each time", text([own[1] + own[2] for own in counts])])
    table("One person", ["sessions 1 → 2 → 3", f"participant {paper.PERSON}", f"synthetic person {k + 1}"], rows)


def print_changes_of_spread(sessions):
    """Prints how the mean and the spread of each score change."""
    rows = []
    for score in (*paper.SCORES, "overall"):
        values = [[record["scores"][score] for record in session] for session in repeating(sessions)]
        means, spreads = [statistics.fmean(own) for own in values], [statistics.stdev(own) for own in values]
        better = "yes" if max(means[1:]) > means[0] else "no"
        narrower = ["yes" if spread < spreads[0] else "no" for spread in spreads[1:]]
        rows.append([score, better, f"{spreads[1] / spreads[0]:.2f} ({narrower[0]})", f"{spreads[2] / spreads[0]:.2f} ({narrower[1]})"])
    head = ["score", "higher mean in session 2 or 3", "sd of session 2 / session 1 (narrower)", "sd of session 3 / session 1 (narrower)"]
    table("What the paper reads off its box plots", head, rows)

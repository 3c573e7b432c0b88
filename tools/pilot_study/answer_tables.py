"""Tables of the questionnaire. The synthetic people's answers are generated from their measurements, so they are no evidence about people."""

from pilot_study import paper
from pilot_study.first_tables import table

OVERALL = {"time_pressure": "time pressure", "frustration": "frustration", "feedback": "in-task feedback"}
PHASES = {
    "calibration": "calibration", "taking_off": "takeoff", **{f"task_{k + 1}": place for k, place in enumerate(paper.PLACES[:-1])}, "landing": "landing",
}  # fmt: skip
ASPECTS = {"performance": "performance", "mental_demand": "mental demand", "physical_demand": "physical demand"}


def question_name(key):
    phase, _, aspect = key.partition(".")
    return f"{PHASES[phase]}: {ASPECTS[aspect]}" if aspect else OVERALL[key]


def counts_of(cohort, repetition):
    """Returns each question's numbers of answers from "strongly agree" to "strongly disagree"; repetition None: first sessions of all."""
    return {one["question"]: one["counts"] for one in cohort["likert"] if one["repetition"] == repetition}


def print_agreement(cohort):
    """Prints how many agreed, for the questions of which the paper gives numbers."""
    counts = counts_of(cohort, None)
    rows = []
    for key, theirs in paper.AGREED.items():
        ours = sum(counts[key][:2])
        rows.append([question_name(key), f"{theirs} of {paper.PEOPLE} ({100 * theirs / paper.PEOPLE:.1f}%)", f"{ours} of {sum(counts[key])}"])
    table("Answers in the text", ["agree or strongly agree, first sessions", "TASBID paper", "generated"], rows)


def print_answers(cohort):
    """Prints the answers of the first sessions, and how many of the eight agreed in each session."""
    every, sessions = counts_of(cohort, None), [counts_of(cohort, number) for number in (1, 2, 3)]
    head = ["question", "strongly agree", "agree", "neutral", "disagree", "strongly disagree", "of the eight, agree in sessions 1, 2, 3"]
    rows = [[question_name(key), *counts, ", ".join(str(sum(one[key][:2])) for one in sessions)] for key, counts in every.items()]
    table("Generated answers", head, rows)


def print_self_rating(cohort):
    """Prints the rank correlations of self-rating and measurement."""
    rated = cohort["self_rating"]
    rows = [["whole session: overall score", f"{rated['overall']['r']:.2f}", rated["overall"]["n"]]]
    rows += [[f"{paper.PLACES[task - 1]}: on-path share", f"{one['r']:.2f}", one["n"]] for task, one in rated["tasks"]]
    table("Generated self-ratings and measurements", ["self-rating and", "rank correlation", "people"], rows)

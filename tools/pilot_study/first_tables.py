"""Tables of the first sessions: the paper's figures of the scores, of conformity by task and of crashes, with what its text says about them."""

import collections
import statistics

from pilot_study import paper
from pilot_study.records import crashes_by_place


def table(title, head, rows):
    """Prints a Markdown table; `head` are its column titles."""
    print(f"\n## {title}\n\n| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for cells in rows:
        print(f"| {' | '.join(str(cell) for cell in cells)} |")


def numbers(name, theirs, ours, digits=0):
    """Returns a row with the paper's number, the synthetic people's and the difference."""
    return [name, f"{theirs:g}", f"{ours:.{digits}f}", f"{ours - theirs:+.{digits}f}"]


def names(name, theirs, ours):
    return [name, theirs, ours, "same" if theirs == ours else "differs"]


def print_score_facts(first, summaries):
    """Prints the numbers that the paper's text gives for its figure of the score distributions."""
    minutes = [one["seconds"] / 60 for one in first]
    scores = {score: summaries[score] for score in paper.SCORES}
    means = sorted(scores, key=lambda score: scores[score]["mean"])
    ranges = sorted(scores, key=lambda score: scores[score]["range"])
    low, high = paper.OVERALL_ENDS
    skewness = summaries["overall"]["skewness"]
    table("The figure's numbers in the text", ["first sessions", "TASBID paper", "synthetic", "difference"], [
        numbers("lowest overall score", low, summaries["overall"]["min"], 1),
        numbers("highest overall score", high, summaries["overall"]["max"], 1),
        ["skewness of the overall score", "to the low end", f"{skewness:+.2f}", "same sign" if skewness < 0 else "differs"],
        numbers("range of efficiency", paper.EFFICIENCY_RANGE, summaries["efficiency"]["range"], 1),
        numbers("range of safety", paper.SAFETY_RANGE, summaries["safety"]["range"], 1),
        names("score with the largest mean", "efficiency", means[-1]),
        names("score with the smallest mean", "safety", means[0]),
        names("score with the largest range", "safety", ranges[-1]),
        names("score with the second smallest range", "efficiency", ranges[1]),
        numbers("shortest flight, minutes", paper.SHORTEST_MIN, min(minutes), 1),
        numbers("longest flight, minutes", paper.LONGEST_MIN, max(minutes), 1),
    ])  # fmt: skip


def print_quartiles(summaries):
    head = ["score", "lowest", "lower quartile", "median", "upper quartile", "highest", "range", "skewness"]
    keys = ["min", "q1", "median", "q3", "max", "range"]
    rows = [[score, *(f"{one[key]:.1f}" for key in keys), f"{one['skewness']:+.2f}"] for score, one in summaries.items()]
    table("Quartiles of the first sessions", head, rows)


def print_conformity_by_task(first):
    """Prints quartiles of the shares of the task's time on its path, and the points lost to speeding."""
    head = ["task", "on path, mean", "lowest", "lower quartile", "median", "upper quartile", "highest", "speeding term, mean"]
    rows = []
    for k, place in enumerate(paper.PLACES[:-1]):
        shares = [record["tasks"][k]["on_path"] for record in first]
        cuts = statistics.quantiles(shares, n=4, method="inclusive")
        cells = [statistics.fmean(shares), min(shares), *cuts, max(shares)]
        speeding = statistics.fmean(record["tasks"][k]["speeding"] for record in first)
        rows.append([place, *(f"{100 * cell:.0f}%" for cell in cells), f"{speeding:.2f}"])
    table("Conformity by task", head, rows)


def print_conformity_facts(first, summaries):
    lowest = 100 * min(record["tasks"][2]["on_path"] for record in first)
    weakest = collections.Counter(min(range(4), key=lambda k, record=record: record["tasks"][k]["on_path"]) for record in first)
    people = ", ".join(f"{place} {weakest[k]}" for k, place in enumerate(paper.PLACES[:-1]))
    table("Conformity in the text", ["first sessions", "TASBID paper", "synthetic", "difference"], [
        numbers("low on-path share in the interlayer (participant 2; here the lowest), %", 100 * paper.LOW_INTERLAYER_SHARE, lowest),
        numbers("high conformity (participant 13; here the highest)", paper.HIGH_CONFORMITY, summaries["conformity"]["max"], 1),
        ["people by the task in which they are least on the path", "7: slab side, 9: pier", people, ""],
    ])  # fmt: skip


def print_crash_facts(first):
    """Prints the numbers that the paper's text gives for its figure of crashes by participant and task."""
    places = [crashes_by_place(record) for record in first]
    totals = [sum(own) for own in places]
    by_place = dict(zip(paper.PLACES, (sum(counts) for counts in zip(*places))))
    total = sum(totals)

    def share(name, theirs, ours):
        return [
            name, f"{theirs} ({100 * theirs / paper.CRASHES:.0f}%)", f"{ours} ({100 * ours / total:.0f}%)",
            f"{ours - theirs:+} ({100 * ours / total - 100 * theirs / paper.CRASHES:+.0f} points)",
        ]  # fmt: skip

    known = paper.CRASHES_BY_PLACE
    tasks = sorted(paper.PLACES[:-1], key=by_place.get)
    most = max(first, key=lambda record: sum(crashes_by_place(record)))
    # People with the same number of crashes, but not the same places; of groups of equal size, the one with most crashes.
    groups = [(sum(n == own for own in totals), n) for n in set(totals) if len({tuple(p) for p in places if sum(p) == n}) > 1]
    people, equal = max(groups, default=(0, 0))
    traffic = sum(record["end_reason"] in ("person", "vehicle") for record in first)
    table("Crashes in the text", ["first sessions", "TASBID paper", "synthetic", "difference"], [
        numbers("all crashes", paper.CRASHES, total),
        *(share(f"crashes at the {place}", known[place], by_place[place]) for place in known),
        share("crashes at the other places together", paper.CRASHES - sum(known.values()), total - sum(by_place[place] for place in known)),
        names("task with most crashes", "arch bottom", tasks[-1]),
        names("task with fewest crashes", "pier", tasks[0]),
        numbers("fewest crashes of a person", paper.FEWEST_CRASHES, min(totals)),
        numbers("people with that number", paper.PEOPLE_WITH_FEWEST, totals.count(min(totals))),
        numbers("most crashes of a person", paper.MOST_CRASHES, max(totals)),
        numbers("safety score of that person", paper.SAFETY_OF_MOST, most["scores"]["safety"]),
        [
            "largest group with equal numbers of crashes at different places", f"{paper.PEOPLE_WITH_EQUAL} people ({paper.EQUAL_CRASHES} each)",
            f"{people} people ({equal} each)", f"{people - paper.PEOPLE_WITH_EQUAL:+}",
        ],
        numbers("sessions that a crash into traffic ended", paper.TRAFFIC_CRASHES, traffic),
    ])  # fmt: skip


def print_people(first):
    """Prints one row per person: scores, flight time, on-path share of each task, and crashes."""
    head = ["person", *paper.SCORES, "overall", "minutes", "on path, % (four tasks)", "crashes (four tasks, outside)"]
    rows = []
    for k, record in enumerate(first):
        scores = [f"{record['scores'][score]:.1f}" for score in (*paper.SCORES, "overall")]
        shares = ", ".join(f"{100 * task['on_path']:.0f}" for task in record["tasks"])
        crashes = ", ".join(map(str, crashes_by_place(record)))
        rows.append([k + 1, *scores, f"{record['seconds'] / 60:.1f}", shares, crashes])
    table("Each person's first session", head, rows)

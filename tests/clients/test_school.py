"""The defect school in the window: a round with right and wrong answers, its record, and its erasure."""

import json

import pytest

import spandrel
from test_flow import DOWN, ENTER, ESCAPE, FOCUS, LIMIT_S, NIGHT, Training, count, focus, is_page, is_start_page, screen  # noqa: F401  (the fixture)

# Color of the verdict on a right and on a wrong answer (crates/view/src/hud/mod.rs).
RIGHT, WRONG = (0, 190, 130), (240, 228, 66)
# Row of the defect school on the start page of a trainee without sessions, from the row of the pseudonym.
ROWS_DOWN = 8
# Number of cards in a round.
CARDS = 10


def has_picture(photograph):
    """Returns whether a picture covers the left half below the title; a page has only its background there, and rows."""
    left = photograph[100:520, 40:600]
    # A dark spot of a picture may have the color of the background.
    return count(left, NIGHT) < 0.02 * left.shape[0] * left.shape[1]


def is_question(photograph):
    """Returns whether a picture of the school is shown beside its answers."""
    return count(photograph, FOCUS) > 500 and has_picture(photograph)


def has_verdict(photograph):
    """Returns whether the school has answered."""
    return verdict_pixels(photograph, RIGHT) + verdict_pixels(photograph, WRONG) > 40


def verdict_pixels(photograph, color):
    """Returns the number of pixels of a color beside the picture."""
    return count(photograph[:, 640:], color)


def progress(training):
    """Returns the trainee's record; none before the first answer."""
    path = training.sessions / "school-nina" / "progress.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


@pytest.mark.timeout(1800)
def test_wire_school_asks_a_round_and_keeps_the_record(screen, tmp_path):  # noqa: F811
    """Answers every picture with the first answer; what was missed is asked again; the record counts first answers only."""
    training = Training(screen, tmp_path, "--trainee", "nina", "--scenario", "drill-hover", "--choose", "--no-sound")
    try:
        page = training.wait_for_screenshot("start", is_start_page)
        for _ in range(ROWS_DOWN):
            row = focus(page)[1]
            page = training.wait_for_screenshot("next-row", lambda photograph, row=row: is_page(photograph) and focus(photograph)[1] > row + 0.03, DOWN)
        training.wait_for_screenshot("school-question-1", is_question, ENTER)
        pictures = list(training.sessions.glob(".school-*/1.png"))
        assert len(pictures) == 1, "the picture is in a hidden folder"
        answered, right = 0, 0
        # Missed pictures come again, so the round takes more questions than cards. The test stops after the last new card.
        while answered < CARDS:
            # The window has the focus, and a repeated key would answer the next question.
            screen.tap(ENTER)
            verdict = training.wait_for_screenshot("school-verdict", has_verdict)
            cards = progress(training)["cards"].values()
            if sum(card["asked"] for card in cards) > answered:
                answered += 1
                right += verdict_pixels(verdict, RIGHT) > verdict_pixels(verdict, WRONG)
            assert (sum(card["asked"] for card in cards), sum(card["right"] for card in cards)) == (answered, right), "a repetition does not count"
            if answered < CARDS:
                screen.tap(ENTER)
                training.wait_for_screenshot("school-question", lambda photograph: is_question(photograph) and not has_verdict(photograph))
        kept = progress(training)
        assert kept["format"] == 1 and kept["rounds"] == 1 and sum(card["asked"] for card in kept["cards"].values()) == CARDS
        assert all(card["box"] == (2 if card["right"] else 1) for card in kept["cards"].values()), kept
        training.wait_for_screenshot("start-again", lambda photograph: is_page(photograph) and not has_picture(photograph), ESCAPE)
        spandrel.wait_for("the pictures are deleted", lambda: not list(training.sessions.glob(".school-*")), LIMIT_S)
    finally:
        training.close()
    sessions = str(training.sessions)
    exported = json.loads(spandrel.run("records", "export", "--trainee", "nina", "--sessions", sessions))
    assert exported["school"] == [kept]
    spandrel.run("records", "erase", "--trainee", "nina", "--yes", "--sessions", sessions)
    assert not (training.sessions / "school-nina").exists()

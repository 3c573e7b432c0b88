"""Pages of the web server in each size and language, compared with committed pictures (`committed_pictures.py`)."""

import datetime
import json

import pytest
from PIL import Image

import spandrel
import webserver
from committed_pictures import BLOCK_LIMIT, MEAN_LIMIT, SCHEMES, compare_sizes, decoded, differences, encoded
from test_web import BrowserUser, browser  # noqa: F401 (`browser` is a fixture)

# The sessions of this test, with the same name and start at each run. They are so old that plans begin with a refresher flight.
SESSION = "20240506T09000{seed}Z-{trainee}-drill-hover"
STARTED = datetime.datetime(2024, 5, 6, 9, 0, tzinfo=datetime.timezone.utc)
FIRST = SESSION.format(seed=7, trainee="anna")
# Days after which the assignments are due.
DUE_DAYS = 7
# What the pictures show instead of the due date, the days since the last flight, and the folder.
DUE_SHOWN = "2024-06-03"
DAYS_SHOWN = " 100 "
FOLDER_SHOWN = "/srv/sessions"
# Name of the picture, user, path, and what appears only after the page has loaded. `test_report.py` has the report and the
# comparison.
PAGES = [
    ("login", None, "/login", None),
    ("sessions", "anna", "/sessions", None),
    ("session", "anna", f"/sessions/{FIRST}", None),
    ("questionnaire", "anna", f"/sessions/{FIRST}/questions", None),
    ("trainee", "anna", "/trainees/anna", None),
    ("flight", "anna", "/flight", None),
    ("account", "anna", "/account", None),
    ("briefing", "anna", "/scenarios/two-bridges/briefing", None),
    ("scenarios", "ida", "/scenarios", None),
    ("scenario", "ida", "/scenarios/practice", None),
    ("new-scenario", "ida", "/scenarios/new", None),
    ("editor", "ida", "/scenarios/new?from=practice&name=lake-crossing", "#preview svg >> nth=3"),
    ("classes", "ida", "/classes", None),
    ("class", "ida", "/classes/spring-2027", None),
    ("assignment", "ida", "/assign?class=spring-2027", None),
    ("trainees", "ida", "/trainees", None),
    ("trainee-rubric", "ida", "/trainees/anna/rubric", None),
    ("cohort", "ida", "/cohort", None),
    ("upload", "ida", "/upload", None),
    ("live", "ida", "/live", None),
    ("live-all", "ida", "/live/all", None),
    ("plan-rules", "ida", "/plan-rules", None),
    ("rubric", "ida", "/rubric", None),
    ("stations", "ida", "/stations", None),
    ("settings", "ada", "/settings", None),
]


def date_fixed(folder):
    """Renames a session's folder and changes its start so that both are the same at each run."""
    path = folder / "session.json"
    session = json.loads(path.read_text(encoding="utf-8"))
    started = STARTED + datetime.timedelta(seconds=session["seed"])
    session.update(started_unix_us=int(started.timestamp()) * 1_000_000, started_utc=started.strftime("%Y-%m-%dT%H:%M:%SZ"))
    path.write_text(json.dumps(session), encoding="utf-8")
    # The server writes the report again, with these dates.
    (folder / "report.html").unlink()
    folder.rename(folder.with_name(SESSION.format(**session)))


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """A novice's flight by Anna and Ben each, and a better one by Anna."""
    folder = tmp_path_factory.mktemp("pictures") / "sessions"
    webserver.flown(folder, "anna", "ben")
    for session in webserver.flown(folder, "anna", seed=9, skill="expert"):
        date_fixed(session)
    spandrel.run("records", "import", "--sessions", str(folder))
    webserver.set_passwords(folder, "anna")
    return folder


@pytest.fixture(scope="module")
def texts(server, sessions):
    """Makes a class with an assignment and a mark. Returns the texts that differ between runs, with those that the pictures show."""
    ida = webserver.Browser(server.address)
    assert ida.log_in("ida") == 303
    now = datetime.datetime.now(datetime.timezone.utc)
    due = (now + datetime.timedelta(days=DUE_DAYS)).strftime("%Y-%m-%d")
    for page, path, form in [
        ("/classes", "/classes", {"name": "spring-2027"}),
        ("/classes", "/classes/spring-2027/members", {"trainees": "anna, newcomer"}),
        ("/classes", "/assign", {"class": "spring-2027", "scenario": "drill-gap", "due": due}),
        (f"/sessions/{FIRST}", f"/sessions/{FIRST}/marks", {"time": "0:12", "text": "look at the wind"}),
    ]:
        assert ida.post(page, path, form)[0] == 303, path
    # The page rounds to whole days.
    days = (now - STARTED) / datetime.timedelta(days=1)
    return {str(sessions): FOLDER_SHOWN, due: DUE_SHOWN, f" {days:.0f} ": DAYS_SHOWN}


@pytest.mark.parametrize("locale", SCHEMES)
def test_regress_pages_look_as_committed(browser, server, texts, tmp_path, locale):
    people = {name: BrowserUser(browser, server, name, scheme=SCHEMES[locale], locale=locale) for name in (None, "anna", "ida", "ada")}
    wrong = []
    for name, user, path, late in PAGES:
        person = people[user]
        assert person.go(path).status == 200, path
        if late:
            person.page.locator(late).wait_for()
        wrong += compare_sizes(person.page, name, locale, tmp_path, texts)
    assert not wrong, "\n".join(wrong)


def test_exact_comparison_detects_a_missing_line_and_tolerates_compression():
    plain = Image.new("RGB", (320, 240), "white")
    written = plain.copy()
    # A line of text covers about a quarter of its area.
    written.paste("black", (40, 100, 200, 102))
    assert differences(plain, written)[1] > BLOCK_LIMIT
    mean, worst = differences(written, decoded(encoded(written)))
    assert mean <= MEAN_LIMIT and worst <= BLOCK_LIMIT

"""An instructor starts flights at training stations from the web, in a real browser."""

import base64
import json
import pathlib
import subprocess

import pytest
from playwright.sync_api import expect

import spandrel
import webserver
from test_flow import ENTER, ESCAPE, Training, in_flight, is_start_page, other_page, screen  # noqa: F401 (a fixture)
from test_web import BrowserUser, browser  # noqa: F401 (a fixture)

KEY = "0123456789abcdef-stations"
# A white pixel (PNG).
PICTURE = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg==")
# Time limit for a change on the page on a busy machine: a check-in and an update of the page take 4 s, ms.
PATIENCE_MS = 120_000
LIMIT_S = PATIENCE_MS / 1000


class Station:
    """`train` without a window, which waits for orders."""

    def __init__(self, folder, name, address, key):
        self.sessions = folder / name / "sessions"
        self.sessions.parent.mkdir()
        key_file = folder / name / "key"
        key_file.write_text(key + "\n", encoding="utf-8")
        self.log = folder / name / "log.txt"
        self.out = open(self.log, "w", encoding="utf-8")
        self.process = subprocess.Popen(
            [spandrel.PROGRAM, "train", "--no-view", "--ports", "ephemeral", "--web", "none", "--sessions", str(self.sessions),
             "--server", address, "--station", name, "--station-key", str(key_file)],
            stdin=subprocess.DEVNULL, stdout=self.out, stderr=self.out,
        )

    def output(self):
        return self.log.read_text(encoding="utf-8")

    def close(self):
        spandrel.end(self.process)
        self.out.close()


@pytest.fixture
def server(tmp_path):
    """A server with an instructor, a trainee, and an own scenario with a picture."""
    sessions = tmp_path / "sessions"
    (sessions / "scenarios").mkdir(parents=True)
    text = (spandrel.ROOT / "scenarios" / "practice.toml").read_text(encoding="utf-8")
    text = text.replace('name = "practice"', 'name = "windy"') + '\n[[briefing_pictures]]\nfile = "windy/gate.png"\ncaption = "The gate"\n'
    (sessions / "scenarios" / "windy.toml").write_text(text, encoding="utf-8")
    (sessions / "scenarios" / "windy").mkdir()
    (sessions / "scenarios" / "windy" / "gate.png").write_bytes(PICTURE)
    key = tmp_path / "station.key"
    key.write_text(KEY, encoding="utf-8")
    webserver.set_passwords(sessions, "zoe")
    opened = webserver.Server(sessions, "--station-key", str(key))
    yield opened
    opened.close()


@pytest.mark.timeout(600)
def test_instructor_starts_flights_at_a_station(browser, server, tmp_path):
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/stations")
    expect(page.locator("main")).to_contain_text("No station has checked in")
    stations = [Station(tmp_path, "s1", server.address, KEY), Station(tmp_path, "stranger", server.address, "another-key-of-a-stranger")]
    try:
        # The page shows the station without a reload by hand.
        expect(page.locator("#station-table")).to_contain_text("ready", timeout=PATIENCE_MS)
        spandrel.wait_for("the refusal", lambda: "wrong station key" in stations[1].output(), LIMIT_S)
        expect(page.locator("#station-table tbody tr")).to_have_count(1)
        ida.check()
        ida.save_screenshot("stations")
        page.fill("[name=trainee]", "zoe")
        page.select_option("[name=scenario]", "windy")
        page.click("button:has-text('Start a flight')")
        table = page.locator("#station-table")
        expect(table).to_contain_text("started: zoe: practice of windy", timeout=PATIENCE_MS)
        expect(table).to_contain_text("flying", timeout=PATIENCE_MS)
        spandrel.wait_for("a session", lambda: sessions_of(stations[0].sessions), LIMIT_S)
        (session,) = sessions_of(stations[0].sessions)
        facts = json.loads((session / "session.json").read_text(encoding="utf-8"))
        assert (facts["trainee"], facts["purpose"]) == ("zoe", "practice")
        assert 'name = "windy"' in (session / "scenario.toml").read_text(encoding="utf-8")
        received = stations[0].sessions / "scenarios" / "from-server" / "windy" / "gate.png"
        assert received.read_bytes() == PICTURE and "shown without" not in stations[0].output()
        # A station with a flight in progress cannot be selected, and a late form is refused.
        expect(page.locator("[name=station] option[value=s1]")).to_be_disabled(timeout=PATIENCE_MS)
        form = {"station": "s1", "trainee": "zoe", "scenario": "drill-hover", "purpose": "practice"}
        desk = webserver.Browser(server.address)
        desk.log_in("ida")
        status, _, text = desk.post("/stations", "/stations", form)
        assert status == 409 and "A flight is in progress" in text
        status, _, text = desk.post("/stations", "/stations", form | {"trainee": "a b"})
        assert status == 409 and "pseudonym" in text
        status, _, text = desk.post("/stations", "/stations", form | {"scenario": "../etc"})
        assert status == 422 and "unknown name" in text
        stations[0].close()
        expect(table).to_contain_text("no connection", timeout=PATIENCE_MS)
    finally:
        for station in stations:
            station.close()


def sessions_of(folder):
    """Returns the session folders that have their scenario already."""
    return [path.parent for path in pathlib.Path(folder).glob("*/scenario.toml")] if folder.is_dir() else []


def test_only_stations_with_the_key_check_in(server):
    stranger = webserver.Browser(server.address)
    body = json.dumps({"station": "s1", "instance": 1}).encode()
    for headers in ({}, {"Authorization": "Bearer wrong"}, {"Authorization": KEY}):
        assert stranger.ask("/stations/check-in", body=body, headers=headers)[0] == 403
    known = {"Authorization": f"Bearer {KEY}"}
    status, answer, text = stranger.ask("/stations/check-in", body=body, headers=known)
    assert (status, text) == (200, "{}") and not answer.get_all("Set-Cookie", [])
    # The name belongs to the first station until it is lost.
    status, _, text = stranger.ask("/stations/check-in", body=json.dumps({"station": "s1", "instance": 2}).encode(), headers=known)
    assert status == 409 and "another station with this name" in json.loads(text)["error"]
    for bad in (b"", b"{}", b'{"station": "../x"}', b'{"station": 3}', b"\xff" * 100):
        assert stranger.ask("/stations/check-in", body=bad, headers=known)[0] == 422, bad
    assert stranger.ask("/stations/check-in", body=b"x" * 100_000, headers=known)[0] == 413
    assert stranger.ask("/stations/check-in", headers=known)[0] in (403, 404, 405)
    # Stations receive the pictures of briefings, and nobody else receives them without a login.
    address = "/stations/pictures/windy/gate.png"
    status, answer, _ = stranger.ask(address, headers=known)
    assert (status, answer["Content-Type"], answer["Content-Length"]) == (200, "image/png", str(len(PICTURE)))
    for headers in ({}, {"Authorization": "Bearer wrong"}):
        assert stranger.ask(address, headers=headers)[0] == 404
    for other in ("windy/other.png", "practice/gate.png", "windy/..%2F..%2Fwindy.toml"):
        assert stranger.ask(f"/stations/pictures/{other}", headers=known)[0] == 404, other
    # Trainees see no stations, and instructors only on a server that accepts stations.
    zoe, ida = webserver.Browser(server.address), webserver.Browser(server.address)
    zoe.log_in("zoe")
    assert zoe.ask("/stations")[0] == 403 and 'href="/stations"' not in zoe.ask("/sessions")[2]
    ida.log_in("ida")
    assert 'href="/stations"' in ida.ask("/sessions")[2]


def test_server_without_a_key_has_no_page_for_stations_in_the_navigation(tmp_path):
    sessions = tmp_path / "sessions"
    webserver.set_passwords(sessions, "zoe")
    opened = webserver.Server(sessions)
    try:
        ida = webserver.Browser(opened.address)
        ida.log_in("ida")
        assert 'href="/stations"' not in ida.ask("/sessions")[2]
        assert "does not accept stations" in ida.ask("/stations")[2]
    finally:
        opened.close()


@pytest.mark.timeout(1800)
def test_flight_ordered_at_a_station_with_a_window_waits_for_the_briefing(server, screen, tmp_path):  # noqa: F811
    """The window leads to the ordered flight: controller check and briefing. Going back declines it."""
    folder = tmp_path / "station"
    folder.mkdir()
    key = folder / "key"
    key.write_text(KEY, encoding="utf-8")
    training = Training(screen, folder, "--no-sound", "--server", server.address, "--station", "s1", "--station-key", str(key))
    desk = webserver.Browser(server.address)
    desk.log_in("ida")

    def order(purpose):
        form = {"station": "s1", "trainee": "zoe", "scenario": "windy", "purpose": purpose}
        status, _, text = desk.post("/stations", "/stations", form)
        assert status == 303, text

    def wait_for_state(words):
        spandrel.wait_for(words, lambda: words in desk.ask("/stations/now")[2], LIMIT_S, pause_s=0.2)

    try:
        start = training.wait_for_screenshot("start", is_start_page)
        wait_for_state("ready")
        order("assessment")
        controls = training.wait_for_screenshot("ordered", other_page(start))
        wait_for_state("in briefing: zoe: assessment of windy")
        declined = training.wait_for_screenshot("declined", other_page(controls), ESCAPE)
        wait_for_state("the trainee declined the flight")
        assert sessions_of(training.sessions) == []
        order("assessment")
        controls = training.wait_for_screenshot("ordered-again", other_page(declined))
        training.wait_for_screenshot("briefing", other_page(controls), ENTER)
        wait_for_state("in briefing")
        assert sessions_of(training.sessions) == [], "nothing starts before the briefing is confirmed"
        training.wait_for_screenshot("flight", in_flight, ENTER)
        wait_for_state("started: zoe: assessment of windy")
        (session,) = sessions_of(training.sessions)
        facts = json.loads((session / "session.json").read_text(encoding="utf-8"))
        assert (facts["trainee"], facts["purpose"]) == ("zoe", "assessment")
    finally:
        training.close()


def test_bad_station_options_are_reported(tmp_path):
    short = tmp_path / "short.key"
    short.write_text("short", encoding="utf-8")
    good = tmp_path / "good.key"
    good.write_text(KEY, encoding="utf-8")
    for args, words in [
        (["train", "--server", "http://127.0.0.1:9", "--no-view"], "--station"),
        (["train", "--server", "127.0.0.1:9", "--station", "s1", "--station-key", str(short), "--no-view"], "is not the address of a server"),
        (["train", "--server", "http://127.0.0.1:9", "--station", "s1", "--station-key", str(short), "--no-view"], "short.key: not a station key"),
        (["serve", "--station-key", str(tmp_path / "missing")], "missing"),
        (["train", "--server", "https://127.0.0.1:9", "--station", "s1", "--station-key", str(good), "--server-ca", str(short), "--no-view"],
         "short.key: contains no certificate"),
    ]:
        done = subprocess.run([spandrel.PROGRAM, *args], capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 2 and words in done.stderr, (args, done.stderr)

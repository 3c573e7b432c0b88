"""`spandrel serve` with PostgreSQL, as in a training center: several programs share one database."""

import json
import pathlib
import subprocess

import pytest

import postgres
import spandrel
import webserver


@pytest.fixture(scope="module")
def database():
    """A shared PostgreSQL for these tests."""
    database = postgres.Postgres()
    yield database
    database.remove()


@pytest.fixture(scope="module")
def sessions(tmp_path_factory, database):
    """Sessions of Anna and Ben, and the instructor Ida."""
    folder = tmp_path_factory.mktemp("stations") / "sessions"
    webserver.flown(folder, "anna", "ben")
    spandrel.run("records", "import", "--sessions", str(folder), "--database", database.url)
    for name, role in [("anna", "trainee"), ("ida", "instructor"), ("ada", "administrator")]:
        webserver.set_password(folder, name, role, "--database", database.url)
    return folder


def serve(sessions, database):
    return webserver.Server(sessions, "--database", database.url)


def listed_sessions(browser):
    status, _, text = browser.ask("/sessions")
    assert status == 200, text
    return {name for name in ("anna", "ben", "carl") if f"/trainees/{name}" in text}


def test_users_see_only_their_own_data(sessions, database):
    server = serve(sessions, database)
    try:
        wrong = webserver.Browser(server.address)
        assert wrong.ask("/login", {"token": wrong.token("/login"), "name": "anna", "password": "not hers at all"})[0] == 403
        anna, ida = webserver.Browser(server.address), webserver.Browser(server.address)
        assert anna.log_in("anna") == 303 and ida.log_in("ida") == 303
        hers = next(path.name for path in sessions.iterdir() if "-anna-" in path.name)
        his = next(path.name for path in sessions.iterdir() if "-ben-" in path.name)
        assert anna.ask(f"/sessions/{hers}")[0] == 200 and anna.ask(f"/sessions/{his}")[0] == 404
        assert ida.ask(f"/sessions/{his}")[0] == 200
        assert listed_sessions(ida) == {"anna", "ben"}
        assert not (sessions / "records.sqlite").exists(), "records must be stored only in PostgreSQL"
    finally:
        server.close()


def test_servers_and_stations_share_one_database(sessions, database, tmp_path):
    """A server in another classroom has the same users and shows the sessions that a third program imported."""
    elsewhere = tmp_path / "sessions"
    elsewhere.mkdir()
    first, second = serve(sessions, database), serve(elsewhere, database)
    try:
        here, there = webserver.Browser(first.address), webserver.Browser(second.address)
        assert here.log_in("ada") == 303 and there.log_in("ada") == 303
        station = tmp_path / "station"
        webserver.flown(station, "carl")
        spandrel.run("records", "import", "--sessions", str(station), "--database", database.url)
        assert listed_sessions(here) == listed_sessions(there) == {"anna", "ben", "carl"}
        status, _, _ = there.post("/trainees/carl", "/trainees/carl/erase", {"again": "carl"})
        assert status == 303 and listed_sessions(here) == {"anna", "ben"}
        records = json.loads(spandrel.run("records", "list", "--json", "--sessions", str(station), "--database", database.url))
        assert {record["trainee"] for record in records} == {"anna", "ben"}
        # The station still has Carl's folder, but neither its import nor its rebuild nor a server restores the session.
        place = ["--sessions", str(station), "--database", database.url]
        assert "0 new or changed, 0 unchanged, 0 skipped, 1 not imported" in spandrel.run("records", "import", *place)
        assert "2 sessions, 0 skipped, 1 not imported" in spandrel.run("records", "rebuild", "--yes", "--sessions", str(station), "--sessions", str(sessions), "--database", database.url)
        third = serve(station, database)
        try:
            told = lambda: "was erased" in pathlib.Path(third.log.name).read_text(encoding="utf-8")
            spandrel.wait_for("the third server notices the erasure", told)
            assert listed_sessions(here) == listed_sessions(there) == {"anna", "ben"}
        finally:
            third.close()
        assert "erased 'carl': 0 sessions" in spandrel.run("records", "erase", "--trainee", "carl", "--yes", *place)
        assert not any("-carl-" in path.name for path in station.iterdir())
        # A new password ends the browser sessions on other servers.
        webserver.set_password(sessions, "ada", "administrator", "--database", database.url, password="quite another one")
        assert here.ask("/sessions")[0] == there.ask("/sessions")[0] == 303
        webserver.set_password(sessions, "ada", "administrator", "--database", database.url)
    finally:
        first.close()
        second.close()


def test_server_reports_and_survives_a_database_outage(sessions, database):
    server = serve(sessions, database)
    try:
        ida = webserver.Browser(server.address)
        assert ida.log_in("ida") == 303
        database.stop()
        try:
            status, _, text = ida.ask("/sessions")
            assert status == 500 and "spandrel@" not in text, (status, text)
        finally:
            database.start()
        assert listed_sessions(ida) >= {"anna", "ben"}, "the browser session must survive the outage"
    finally:
        server.close()


def test_database_errors_are_reported(tmp_path):
    def refused(url):
        done = subprocess.run(
            [spandrel.PROGRAM, "serve", "--sessions", str(tmp_path), "--listen", "127.0.0.1:0", "--vehicle", "none", "--database", url],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=webserver.PATIENCE_S, check=False,
        )
        return done.returncode, done.stderr

    code, said = refused("postgres://ada:secret@127.0.0.1:1/none?sslmode=sometimes")
    assert code == 2 and "sslmode = 'sometimes' (allowed: disable" in said and "secret" not in said, said
    code, said = refused("postgres://ada:secret@127.0.0.1:1/none?sslmode=verify-full&sslrootcert=/none.pem")
    assert code == 2 and "sslrootcert = '/none.pem'" in said, said
    code, said = refused("postgres://ada:secret@127.0.0.1:1/none")
    assert code == 1 and "cannot open" in said and "secret" not in said, said

"""The instructor's tools on the web server in a real browser: classes, assignments, rubric, marks on the timeline,
all live flights on one page."""

import datetime
import html
import json
import re
import subprocess
import threading

import pytest
from playwright.sync_api import expect

import spandrel
import webserver
from test_web import LIVE_LOOKS, LOOKS, BrowserUser, browser, session_ids  # noqa: F401 (`browser` is a fixture)

# Days after which the tests' assignments are due.
DUE_DAYS = 7


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """One complete flight each by Anna and Ben."""
    folder = tmp_path_factory.mktemp("instructor") / "sessions"
    webserver.flown(folder, "anna", "ben", skill="expert")
    spandrel.run("records", "import", "--sessions", str(folder))
    webserver.set_passwords(folder, "anna", "ben")
    return folder


def due_date():
    return (datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(days=DUE_DAYS)).strftime("%Y-%m-%d")


def check_everywhere(person, name, path):
    """Checks a page and photographs it in all sizes, languages and themes."""
    for size, scheme, locale in [*LOOKS[1:], LOOKS[0]]:
        person.show_in(size, scheme, locale)
        person.go(path)
        person.save_screenshot(f"{name}-{size}-{scheme}-{locale[:2]}")
        person.check()


def tab_to(page, label, presses=40):
    """Presses Tab until the element with this text or label has the focus."""
    for _ in range(presses):
        page.keyboard.press("Tab")
        if page.evaluate("document.activeElement.textContent.trim() || document.activeElement.getAttribute('aria-label')") == label:
            return
    raise AssertionError(f"{label}: not reached with the keyboard")


def test_class_is_made_and_a_job_assigned_with_the_keyboard(browser, server, sessions):
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/classes")
    page.focus("[name=name]")
    page.keyboard.type("spring-2027")
    page.keyboard.press("Enter")
    page.wait_for_url("**/classes/spring-2027")
    expect(page.locator("main")).to_contain_text("No trainees in this class yet")
    page.focus("[name=trainees]")
    # The newcomer has neither flown nor a password.
    page.keyboard.type("anna, ben newcomer")
    tab_to(page, "Add to class")
    page.keyboard.press("Enter")
    expect(page.locator("#members table")).to_contain_text("newcomer")
    rows = page.locator("#members tbody tr")
    assert rows.count() == 3
    expect(rows.nth(0)).to_contain_text("drill-hover")
    expect(rows.nth(0).locator("td").nth(1)).to_contain_text("ertified")
    expect(rows.nth(2)).to_contain_text("not flown yet")
    # A job for the whole class.
    page.focus("text=Assign a job to this class")
    page.keyboard.press("Enter")
    page.wait_for_url("**/assign?class=spring-2027")
    page.focus("[name=scenario]")
    page.keyboard.press("Home")
    for _ in range(page.locator("[name=scenario] option").count()):
        if page.input_value("[name=scenario]") == "drill-hover":
            break
        page.keyboard.press("ArrowDown")
    assert page.input_value("[name=scenario]") == "drill-hover" and page.input_value("[name=due]") == due_date()
    tab_to(page, "Assign")
    page.keyboard.press("Enter")
    page.wait_for_url("**/classes/spring-2027")
    # An individual one: the recommended job of the class page needs one click.
    first = rows.nth(0).locator("a:text-is('Assign')")
    first.click()
    page.wait_for_url("**/assign?trainee=anna&*")
    chosen = page.input_value("[name=scenario]")
    page.click("button:text-is('Assign')")
    page.wait_for_url("**/trainees/anna")
    expect(page.locator("#assignments table")).to_contain_text(chosen)
    ida.go("/classes/spring-2027")
    counts = page.locator("#assignments tbody td.number").all_inner_texts()
    assert counts == ["0", "3", "0"], "done, open, overdue: earlier flights do not count"
    expect(rows.nth(2)).to_contain_text(f"drill-hover, due {due_date()}")
    check_everywhere(ida, "class", "/classes/spring-2027")
    check_everywhere(ida, "classes", "/classes")
    check_everywhere(ida, "assign", "/assign?class=spring-2027")
    # The trainee's own page begins with the assignments.
    anna = BrowserUser(browser, server, "anna")
    anna.go("/trainees/anna")
    first = anna.page.locator("main section").first
    expect(first).to_contain_text("2 open assignments")
    # Trainees read where to click, instructors the command.
    expect(first).to_contain_text("On the start page of the simulator window: Assigned, due")
    expect(first).not_to_contain_text("spandrel train")
    ida.go("/trainees/anna")
    expect(page.locator("#assignments table").first).to_contain_text("spandrel train --trainee anna --scenario drill-hover")
    assert anna.page.locator("a[href^='/assign'], form[action*=assign], a[href^='/classes']").count() == 0
    check_everywhere(anna, "trainee-assignments", "/trainees/anna")
    kept = json.loads(webserver_export(server, "anna"))
    assert kept["classes"] == ["spring-2027"] and len(kept["assignments"]) == 2
    # A complete flight is what finishes an assignment.
    webserver.flown(sessions, "newcomer", seed=41, skill="expert")
    done = lambda: ida.go("/classes/spring-2027") and page.locator("#assignments tbody td.number").all_inner_texts() == ["1", "2", "0"]
    spandrel.wait_for("the flight that finishes the assignment", done)
    ida.go("/trainees/newcomer")
    page.click("summary:has-text('Done (1)')")
    page.click("#assignments a:text-is('done')")
    page.wait_for_url("**/sessions/*-newcomer-*")
    assert ida.wrong == [] and anna.wrong == []


def webserver_export(server, name):
    """Returns the trainee's own export."""
    visitor = webserver.Browser(server.address)
    assert visitor.log_in(name) == 303
    status, _, text = visitor.ask(f"/trainees/{name}/export.json")
    assert status == 200
    return text


def test_classes_and_assignments_can_be_removed_and_are_validated(server):
    ida = webserver.Browser(server.address)
    assert ida.log_in("ida") == 303
    post = lambda page, path, **fields: ida.post(page, path, fields)
    for name in ["", "a b", "../x", "x" * 33, "<b>"]:
        status, _, text = post("/classes", "/classes", name=name)
        assert status == 422 and f'name="name" value="{html.escape(name)}"' in text and 'id="name-problem"' in text, (name, text)
    assert post("/classes", "/classes", name="autumn")[0] == 303
    status, _, text = post("/classes", "/classes", name="autumn")
    assert status == 422 and "already a class" in text
    for trainees in ["", " , ", "anna ../x", " ".join(f"t{k}" for k in range(101))]:
        status, _, text = post("/classes", "/classes/autumn/members", trainees=trainees)
        assert status == 422 and f"{trainees}</textarea>" in text and 'id="trainees-problem"' in text, (trainees, text)
    assert "0</td>" in ida.ask("/classes")[2], "an invalid list adds nobody"
    assert post("/classes", "/classes/autumn/members", trainees="anna\n ben")[0] == 303
    assert post("/classes", "/classes/nothing/members", trainees="anna")[0] == 404
    job = {"class": "autumn", "scenario": "drill-hover", "due": due_date()}
    for change, said in [
        ({"scenario": "none"}, "scenario: unknown"), ({"variant": "99"}, "unknown level or form of drill-hover (allowed: 1, 2"),
        ({"scenario": "two-bridges", "variant": "1"}, "no levels or forms"), ({"due": "2020-01-01"}, "invalid date"), ({"due": "soon"}, "invalid date"),
        ({"trainee": "anna"}, "either trainee or class"),
    ]:
        status, _, text = post("/classes", "/assign", **{**job, **change})
        assert status == 422 and said in text, (change, text)
        if "trainee" not in change:
            assert 'name="class" value="autumn"' in text and f'value="{change.get("due", due_date())}"' in text, (change, text)
    assert post("/classes", "/assign", **{**job, "class": "nothing"})[0] == 404
    assert ida.ask("/assign?trainee=nobody")[0] == 404 and ida.ask("/assign")[0] == 404
    assert post("/classes", "/assign", **job, variant="6")[0] == 303
    text = ida.ask("/trainees/ben")[2]
    assert "level 6 or harder" in text
    # Ben may have other assignments; the button is at the end of the row.
    row = text.split("level 6 or harder")[1]
    removal = next(part.split('"')[0] for part in row.split('action="')[1:] if part.startswith("/assignments/"))
    assert post("/classes", removal)[0] == 303 and post("/classes", removal)[0] == 404
    assert "level 6 or harder" not in ida.ask("/trainees/ben")[2]
    assert post("/classes", "/classes/autumn/members/remove", trainee="ben")[0] == 303
    assert post("/classes", "/classes/autumn/members/remove", trainee="ben")[0] == 404
    assert post("/classes", "/classes/autumn/remove")[0] == 303
    assert ida.ask("/classes/autumn")[0] == 404 and ida.ask("/trainees/anna")[0] == 200


def test_trainees_cannot_change_classes_and_assignments(server):
    anna = webserver.Browser(server.address)
    assert anna.log_in("anna") == 303
    for path in ["/classes", "/classes/spring-2027", "/assign?trainee=anna"]:
        assert anna.ask(path)[0] == 403, path
    for path in ["/classes", "/classes/x/members", "/classes/x/members/remove", "/classes/x/remove", "/assign", "/assignments/x/remove"]:
        assert anna.post("/sessions", path, {"name": "x", "trainee": "anna"})[0] == 403, path
    assert anna.ask("/trainees/ben")[0] == 404


def test_rubric_is_signed_off_withdrawn_and_printed(browser, server):
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/trainees/anna")
    page.click("text=0 of 8 criteria signed off")
    path = page.locator("li#criterion-path")
    path.locator("[name=note]").fill("calm in gusts <b>")
    tab_to(page, "Sign off", presses=2)
    page.keyboard.press("Enter")
    page.wait_for_url("**/trainees/anna/rubric#criterion-path")
    today = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d")
    expect(path).to_contain_text(f"Signed off {today} by ida: calm in gusts <b>")
    expect(page.locator("main")).to_contain_text("1 of 8 criteria signed off")
    check_everywhere(ida, "rubric", "/trainees/anna/rubric")
    page.emulate_media(media="print", color_scheme="light")
    assert page.locator("form").evaluate_all("forms => forms.every(form => getComputedStyle(form).display === 'none')")
    ida.save_screenshot("rubric-print")
    page.emulate_media(media="screen")
    # A withdrawal needs a reason, and the history keeps both.
    ida.go("/trainees/anna/rubric")
    path.locator("summary").click()
    path.locator("button").click()
    assert page.url.endswith("/trainees/anna/rubric"), "the browser asks for the reason first"
    path.locator("[name=note]").fill("left the path twice")
    path.locator("button").click()
    expect(path).to_contain_text("Not signed off")
    history = page.locator("#history tbody tr")
    assert history.count() == 2
    expect(history.nth(0)).to_contain_text("left the path twice")
    expect(history.nth(1)).to_contain_text("calm in gusts <b>")
    # Trainees see their rubric and its history, but cannot sign.
    anna = BrowserUser(browser, server, "anna")
    anna.go("/trainees/anna/rubric")
    expect(anna.page.locator("#history")).to_contain_text("withdrawn")
    assert anna.page.locator("main form").count() == 0
    visitor = webserver.Browser(server.address)
    assert visitor.log_in("anna") == 303
    form = {"criterion": "path", "action": "signed_off", "note": "by myself"}
    assert visitor.post("/sessions", "/trainees/anna/rubric", form)[0] == 403 and visitor.ask("/trainees/ben/rubric")[0] == 404
    kept = json.loads(webserver_export(server, "anna"))["sign_offs"]
    assert [(one["action"], one["by"]) for one in kept] == [("signed_off", "ida"), ("withdrawn", "ida")]
    boss = webserver.Browser(server.address)
    assert boss.log_in("ida") == 303
    for change in [{"criterion": "none"}, {"action": "none"}, {"action": "withdrawn"}, {"note": "x" * 301}, {"note": "two\nlines"}]:
        status, _, _ = boss.post("/trainees/anna", "/trainees/anna/rubric", {**form, **change})
        assert status == 422, change
    assert boss.post("/trainees/anna", "/trainees/nobody/rubric", form)[0] == 404
    assert ida.wrong == [] and anna.wrong == []


def test_instructors_bring_their_own_rubric(browser, server):
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    check_everywhere(ida, "rubric-editor", "/rubric")
    ida.go("/rubric")
    shipped = page.input_value("[name=rubric]")
    page.fill("[name=rubric]", shipped.replace('id = "control"', 'id = "path"'))
    page.click("text=Validate and save")
    line = 1 + shipped[: shipped.index('id = "path"')].count("\n")
    expect(page.locator(".message.bad")).to_contain_text(f"rubric.toml:{line}: criteria[].id = path: duplicate criterion")
    ida.wrong = [wrong for wrong in ida.wrong if "422" not in wrong]
    page.fill("[name=rubric]", 'format = 1\n[[criteria]]\nid = "night"\ntitle = "Flies at night"\n')
    page.click("text=Validate and save")
    expect(page.locator(".message.good")).to_contain_text("saved")
    ida.go("/trainees/ben/rubric")
    assert page.locator("ol.rubric h3").all_inner_texts() == ["Flies at night"]
    ida.go("/rubric")
    page.click("text=Delete own rubric")
    ida.go("/trainees/ben/rubric")
    assert page.locator("ol.rubric h3").count() == 8 and ida.wrong == []


def test_marks_appear_on_the_timeline_and_change_no_score(browser, server, sessions):
    folder = sessions / session_ids(sessions, "anna")[0]
    before = {name: (folder / name).read_bytes() for name in ("telemetry.tlog", "assessment.json", "events.jsonl", "scenario.toml")}
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go(f"/sessions/{folder.name}")
    plain = (folder / "report.html").read_bytes()
    for time, text in [("0:12", "look at the wind <b>"), ("0:05", "good take-off")]:
        page.fill("#marks [name=time]", time)
        page.fill("#marks [name=text]", text)
        page.keyboard.press("Enter")
        expect(page.locator("#marks ol")).to_contain_text(text)
    assert [text.split(" ")[0] for text in page.locator("#marks ol > li").all_inner_texts()] == ["0:05", "0:12"]
    check_everywhere(ida, "marks", f"/sessions/{folder.name}")
    ida.go(f"/sessions/{folder.name}")
    page.click("#marks a:text-is('0:12')")
    page.wait_for_selector("body.live")
    expect(page.locator("#moment-text")).to_have_text("0:12")
    assert page.locator("svg.strips .mark-dot").count() == 2
    expect(page.locator("#flight ol.marks")).to_contain_text("look at the wind <b> (ida)")
    page.locator("#flight ol.marks a").first.click()
    expect(page.locator("#moment-text")).to_have_text("0:05")
    ida.save_screenshot("report-marks")
    # The trainee sees them, too, but cannot change them.
    anna = BrowserUser(browser, server, "anna")
    anna.go(f"/sessions/{folder.name}")
    expect(anna.page.locator("#marks")).to_contain_text("good take-off")
    assert anna.page.locator("#marks form").count() == 0
    visitor, boss = webserver.Browser(server.address), webserver.Browser(server.address)
    assert visitor.log_in("anna") == 303 and boss.log_in("ida") == 303
    there = f"/sessions/{folder.name}"
    mark = {"time": "0:01", "text": "x"}
    assert visitor.post("/sessions", f"{there}/marks", mark)[0] == 403
    for change in [{"time": "99:00"}, {"time": "1:75"}, {"time": "soon"}, {"text": ""}, {"text": "x" * 201}]:
        assert boss.post(there, f"{there}/marks", {**mark, **change})[0] == 422, change
    assert boss.post(there, "/sessions/none/marks", mark)[0] == 404
    assert boss.post(there, f"{there}/marks/remove", {"mark": "1"})[0] == 404
    for name, content in before.items():
        assert (folder / name).read_bytes() == content, name
    kept = json.loads((folder / "marks.json").read_text(encoding="utf-8"))
    assert [one["t_s"] for one in kept["marks"]] == [5.0, 12.0] and kept["format"] == 1
    # Without marks, the report is the original one again.
    ida.go(there)
    for _ in range(2):
        page.locator("#marks button:text-is('Remove')").first.click()
        page.wait_for_load_state()
    expect(page.locator("#marks")).to_contain_text("No marks yet")
    assert boss.ask(f"{there}/report")[0] == 200 and (folder / "report.html").read_bytes() == plain
    assert ida.wrong == [] and anna.wrong == []


def test_two_live_flights_have_a_tile_each(browser, tmp_path):
    """One flight with a picture, which is normally written by a window, and one without, which shows its map."""
    picture = tmp_path / "camera.jpg"
    photograph = (spandrel.ROOT / "docs" / "src" / "images" / "window.jpg").read_bytes()
    folders = [tmp_path / "one", tmp_path / "two"]
    for folder in folders:
        folder.mkdir()
    flights = [spandrel.Flight(folders[0], scenario="drill-hover", speed=1), spandrel.Flight(folders[1], speed=2)]
    ports = [flight.payload_port for flight in flights]
    server = webserver.Server(
        flights[0].sessions, "--vehicle", f"127.0.0.1:{ports[1]}", "--picture", str(picture), vehicle=f"127.0.0.1:{ports[0]}"
    )
    pilot = subprocess.Popen(
        [spandrel.PROGRAM, "pilot", "--scenario", "two-bridges", "--skill", "novice", "--seed", "7", "--port", str(flights[1].client_port)],
        stdin=subprocess.DEVNULL, stdout=flights[1].log, stderr=flights[1].log,
    )
    ended = threading.Event()

    def keep_picture_current():
        while not ended.wait(1.0):
            # The window replaces its file whole, too.
            part = picture.with_suffix(".part")
            part.write_bytes(photograph)
            part.replace(picture)

    window = threading.Thread(target=keep_picture_current)
    window.start()
    try:
        person = BrowserUser(browser, server)
        page = person.page
        person.go("/")
        page.click("nav >> text=Live")
        page.wait_for_url("**/live/all")
        tiles = page.locator("[data-tile]")
        page.wait_for_function("() => document.querySelectorAll('.tile.live').length === 2")
        # The trainee's name is known from the session in this server's folder.
        expect(tiles.nth(0).locator("h2 a")).to_have_text("client-test")
        expect(tiles.nth(1).locator("h2 a")).to_have_text("Vehicle 2")
        expect(tiles.nth(1).locator("[data-state]")).to_have_text("live, motors armed")
        page.wait_for_function("() => document.querySelector('[data-tile=\"1\"] img').naturalWidth > 0")
        assert tiles.nth(0).locator("[data-map]").is_hidden() and tiles.nth(1).locator("svg.map").is_visible()
        place = "document.querySelector('[data-tile=\"2\"] .drone').getAttribute('transform')"
        first = page.evaluate(place)
        page.wait_for_function(f"before => {place} !== before", arg=first)
        expect(tiles.nth(1).locator("[data-now=battery]")).to_contain_text("%")
        expect(tiles.nth(1).locator("[data-now=task]")).to_contain_text("Task")
        expect(tiles.nth(1).locator("[data-hazards]")).to_have_text("none")
        for size, scheme, locale in LIVE_LOOKS[::-1]:
            person.show_in(size, scheme, locale)
            page.reload()
            page.wait_for_function("() => document.querySelectorAll('.tile.live').length === 2")
            person.save_screenshot(f"tiles-{size}-{scheme}-{locale[:2]}")
            person.check()
        tiles.nth(1).locator("h2 a").focus()
        page.keyboard.press("Enter")
        page.wait_for_url("**/live?vehicle=2")
        page.wait_for_selector(".live-page.live")
        expect(page.locator("[data-now=wind]")).to_contain_text("m/s from")
        expect(page.locator("[data-now=gnss]")).to_contain_text("satellites, HDOP")
        # The job simulates neither a compass error nor the radio.
        expect(page.locator("[data-now=compass]")).to_have_text(re.compile("off by"))
        expect(page.locator("[data-now=radio]")).to_have_text("–")
        person.check()
        page.click("text=All flights")
        page.wait_for_url("**/live/all")
        tiles.nth(0).locator("h2 a").click()
        page.wait_for_url("**/live?vehicle=1")
        page.wait_for_function("() => document.querySelector('[data-camera] img')?.naturalWidth > 0")
        assert person.wrong == []
    finally:
        ended.set()
        window.join()
        server.close()
        spandrel.end(pilot)
        for flight in flights:
            flight.close()

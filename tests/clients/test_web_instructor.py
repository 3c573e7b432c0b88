"""The instructor's tools on the web server in a real browser: classes, assignments."""

import datetime
import json

import pytest
from playwright.sync_api import expect

import spandrel
import webserver
from test_web import SIZES, BrowserUser, browser  # noqa: F401 (`browser` is a fixture)

# Days after which the tests' assignments are due.
DUE_DAYS = 7


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """One complete flight each by Anna and Ben."""
    folder = tmp_path_factory.mktemp("instructor") / "sessions"
    webserver.flown(folder, "anna", "ben", skill="expert")
    spandrel.run("records", "import", "--sessions", str(folder))
    for name, role in [("anna", "trainee"), ("ben", "trainee"), ("ida", "instructor"), ("ada", "administrator")]:
        webserver.set_password(folder, name, role)
    return folder


@pytest.fixture(scope="module")
def server(sessions):
    """A shared server for these sessions."""
    server = webserver.Server(sessions)
    yield server
    server.close()


def due_date():
    return (datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(days=DUE_DAYS)).strftime("%Y-%m-%d")


def check_everywhere(person, name, path):
    """Checks a page and photographs it in both sizes and themes."""
    person.go(path)
    for size, (width, height) in SIZES.items():
        for scheme in ("light", "dark"):
            person.page.set_viewport_size({"width": width, "height": height})
            person.page.emulate_media(color_scheme=scheme)
            person.save_screenshot(f"{name}-{size}-{scheme}")
            person.check()
    person.page.set_viewport_size({"width": SIZES["desktop"][0], "height": SIZES["desktop"][1]})


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
    page.keyboard.type("drill-hover")
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
    expect(first).to_contain_text("spandrel train --trainee anna --scenario drill-hover")
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
        assert post("/classes", "/classes", name=name)[0] == 422, name
    assert post("/classes", "/classes", name="autumn")[0] == 303
    status, _, text = post("/classes", "/classes", name="autumn")
    assert status == 422 and "already a class" in text
    for trainees in ["", " , ", "anna ../x", " ".join(f"t{k}" for k in range(101))]:
        assert post("/classes", "/classes/autumn/members", trainees=trainees)[0] == 422, trainees
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
    assert post("/classes", "/assign", **{**job, "class": "nothing"})[0] == 404
    assert ida.ask("/assign?trainee=nobody")[0] == 404 and ida.ask("/assign")[0] == 404
    assert post("/classes", "/assign", **job, variant="6")[0] == 303
    text = ida.ask("/trainees/ben")[2]
    assert "level 6 or harder" in text
    removal = next(part.split('"')[0] for part in text.split('action="')[1:] if part.startswith("/assignments/"))
    assert post("/classes", removal)[0] == 303 and post("/classes", removal)[0] == 404
    assert "level 6" not in ida.ask("/trainees/ben")[2]
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

"""`spandrel serve` in a real browser: tasks of trainees, instructors and administrators, with wide and narrow windows
and light and dark themes."""

import json
import os
import pathlib
import re
import shutil
import subprocess

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect, sync_playwright

import spandrel
import webserver
from committed_pictures import SIZES

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
# The pages need no WebGL. Without it, Chromium spends a third less time on drawing.
FLAGS = ["--no-sandbox", "--disable-gpu"]
# Folder for screenshots, if set.
PICTURES = os.environ.get("SPANDREL_PICTURES")
# Time limit for any action on a busy two-core machine, ms (many times the usual time).
PATIENCE_MS = 300_000
expect.set_options(timeout=PATIENCE_MS)


@pytest.fixture(scope="module")
def browser():
    """Debian's Chromium."""
    assert CHROMIUM, "no chromium: apt-get install chromium"
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Two flights by Anna, one by Ben, four by Lena."""
    folder = tmp_path_factory.mktemp("web") / "sessions"
    # Experts complete the drill, and learning curves are made of complete sessions.
    webserver.flown(folder, "anna", "anna", "ben", "lena", "lena", "lena", "lena", skill="expert")
    spandrel.run("records", "import", "--sessions", str(folder))
    webserver.set_passwords(folder, "anna", "ben", "lena")
    return folder


def session_ids(sessions, trainee):
    """Returns a trainee's sessions by start time; the names of flights in the same second have random parts."""
    folders = [path for path in sessions.iterdir() if f"-{trainee}-" in path.name]
    started = lambda path: json.loads((path / "session.json").read_text(encoding="utf-8"))["started_unix_us"]
    return [path.name for path in sorted(folders, key=started)]


def catalog_text(locale, file, name):
    """Returns a text from the catalog of the language."""
    catalog = (spandrel.ROOT / "crates/text/catalog" / locale[:2] / f"{file}.ftl").read_text(encoding="utf-8")
    return re.search(rf"^{name} = (.+)$", catalog, re.MULTILINE).group(1)


class BrowserUser:
    """A user with a browser that collects all problems on the pages."""

    def __init__(self, browser, server, name=None, size="desktop", scheme="light", locale="en-GB"):
        width, height = SIZES[size]
        self.context = browser.new_context(
            viewport={"width": width, "height": height}, color_scheme=scheme, accept_downloads=True, locale=locale
        )
        self.context.set_default_timeout(PATIENCE_MS)
        self.page = self.context.new_page()
        self.wrong = []
        self.address = server.address
        self.page.on("console", lambda m: self.wrong.append(f"{m.type}: {m.text}") if m.type in ("error", "warning") else None)
        self.page.on("pageerror", lambda error: self.wrong.append(str(error)))
        own = (server.address, "data:", "blob:")
        self.page.on("request", lambda r: self.wrong.append(r.url) if not r.url.startswith(own) else None)
        if name:
            self.log_in(name)

    def go(self, path):
        return self.page.goto(self.address + path)

    def show_in(self, size, scheme, locale):
        """Changes size, color scheme and language. The language changes with the next page."""
        width, height = SIZES[size]
        self.page.set_viewport_size({"width": width, "height": height})
        self.page.emulate_media(color_scheme=scheme)
        self.context.add_cookies([{"name": "spandrel-language", "value": locale[:2], "url": self.address}])

    def log_in(self, name, password=webserver.PASSWORD):
        self.go("/login")
        self.page.fill("[name=name]", name)
        self.page.fill("[name=password]", password)
        self.page.click("main button[type=submit]")

    def save_screenshot(self, name):
        if PICTURES:
            folder = pathlib.Path(PICTURES)
            folder.mkdir(parents=True, exist_ok=True)
            self.page.screenshot(path=str(folder / f"{name}.png"), full_page=True)

    def check(self):
        """Checks that the content fits the page, that there were no problems, and that axe finds none."""
        page = self.page
        assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth"), page.url
        page.evaluate("document.querySelectorAll('details').forEach(details => { details.open = true; })")
        found = Axe().run(page)
        assert found.violations_count == 0, page.url + "\n" + found.generate_report()
        assert self.wrong == []


# Sizes, color schemes and languages in which all pages are checked.
LOOKS = [("desktop", "light", "en-GB"), ("phone", "light", "es-ES"), ("desktop", "dark", "de-DE"), ("tablet", "dark", "en-GB")]
# Those in which pages with a flight are checked.
LIVE_LOOKS = [("desktop", "light", "en-GB"), ("phone", "dark", "de-DE"), ("tablet", "light", "es-ES")]
# Routes that end in these words are files, fragments of pages, or reports, which test_report.py checks in every language.
NOT_PAGES = re.compile(r"\.\w+$|/now$|/report$|^/compare$|^/tiles/|/pictures/|/tables/")


def page_routes():
    """Returns the server's pages: paths with placeholders, those without any first."""
    table = (pathlib.Path(__file__).parents[2] / "src/web/routes.rs").read_text(encoding="utf-8")
    routes = [route for route in re.findall(r'(?:show|compute)\("([^"]+)"', table) if not NOT_PAGES.search(route)]
    assert "/sessions/{id}" in routes and len(routes) > 20, routes
    return sorted(routes, key=lambda route: route.count("{"))


def crawl(person, starts):
    """Follows all links from these paths, to one page of each route. Yields the route when its page is open."""
    routes = {route: re.compile(re.sub(r"\{\w+\}", "[^/]+", route)) for route in page_routes()}
    waiting, seen, visited = list(starts), set(starts), set()
    while waiting:
        path = waiting.pop(0)
        route = next((route for route, pattern in routes.items() if pattern.fullmatch(path.partition("?")[0])), None)
        if route is None or route in visited:
            continue
        visited.add(route)
        assert person.go(path).status == 200, path
        yield route
        for address in person.page.eval_on_selector_all("a[href]:not([download])", "links => links.map(link => link.href)"):
            link = address.removeprefix(person.address).partition("#")[0]
            if link.startswith("/") and link not in seen:
                seen.add(link)
                waiting.append(link)


def check_pages(person, starts, look):
    """Checks all pages that links lead to, saves their pictures, and returns their routes."""
    visited = set()
    for route in crawl(person, starts):
        assert person.page.evaluate("document.documentElement.lang") == look[-2:], route
        name = re.sub(r"\W+", "-", route).strip("-") or "start"
        person.save_screenshot(f"{name}-{look}")
        person.check()
        visited.add(route)
    return visited


@pytest.mark.parametrize(("size", "scheme", "locale"), LOOKS)
def test_every_page_passes_axe(browser, server, size, scheme, locale):
    """All pages of the server, in every language."""
    look = f"{size}-{scheme}-{locale[:2]}"
    ida = webserver.Browser(server.address)
    ida.log_in("ida")
    assert ida.post("/classes", "/classes", {"name": look})[0] == 303
    assert ida.post(f"/classes/{look}", f"/classes/{look}/members", {"trainees": "anna, newcomer"})[0] == 303
    ada = BrowserUser(browser, server, "ada", size, scheme, locale)
    # Buttons, or links that other servers have, lead to some of these. Lena has enough repetitions for learning curves.
    starts = ["/", "/trainees/lena", "/flight", "/live/all", "/stations", "/scenarios/two-bridges/edit"]
    assert check_pages(ada, starts, f"administrator-{look}") == set(page_routes()) - {"/login"}
    own = check_pages(BrowserUser(browser, server, "anna", size, scheme, locale), ["/"], f"trainee-{look}")
    assert "/sessions/{id}/questions" in own and "/trainees" not in own, own
    ada.go("/sessions/none")
    ada.save_screenshot(f"missing-{look}")
    # The browser treats a missing page as an error, but this test intends it.
    ada.wrong = [wrong for wrong in ada.wrong if "404" not in wrong]
    ada.check()
    stranger = BrowserUser(browser, server, None, size, scheme, locale)
    stranger.go("/sessions")
    assert stranger.page.url.endswith("/login")
    stranger.save_screenshot(f"login-{look}")
    stranger.check()


def test_progress_page_shows_repetitions_and_tables_download(browser, server, tmp_path):
    """Like participant 18 in the TASBID paper: scores, on-path share by task, and crashes over the repetitions, with
    learning curves from the fourth repetition on."""
    person = BrowserUser(browser, server, "lena")
    page = person.page
    person.go("/trainees/lena")
    progress = page.locator("#progress")
    assert progress.locator("svg.lines").count() == 2 and progress.locator("svg.practice").count() >= 3
    # The drill has one task, so there is one point for each of the four repetitions.
    assert progress.locator("svg.lines").nth(1).locator("circle").count() == 4
    with page.expect_download() as download:
        progress.locator("summary", has_text="crashes by repetition").click()
        progress.locator("details[open] a[download]").first.click()
    download.value.save_as(tmp_path / "progress.csv")
    lines = (tmp_path / "progress.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("repetition,scenario,conformity") and [line.split(",")[0] for line in lines[1:]] == ["1", "2", "3", "4"]
    assert person.wrong == []
    ida = BrowserUser(browser, server, "ida")
    ida.go("/trainees/anna")
    assert ida.page.locator("#progress svg.practice").count() == 0, "two repetitions are not enough for a curve"
    ida.go("/cohort?scenario=drill-hover&repetitions=2")
    assert ida.page.locator("#learning svg.practice").count() >= 3
    with ida.page.expect_download() as download:
        ida.page.click("a:text-is('learning_of_the_group.csv')")
    download.value.save_as(tmp_path / "group.csv")
    assert (tmp_path / "group.csv").read_text(encoding="utf-8").startswith("score,people,repetition,mean,fitted")
    assert ida.wrong == []


def test_questionnaire_answers_persist_after_leaving(browser, server, sessions):
    session = sessions / session_ids(sessions, "anna")[0]
    person = BrowserUser(browser, server, "anna")
    person.page.click("table a >> nth=-1")
    person.page.click("text=Answer the questionnaire")
    person.page.click("fieldset >> nth=0 >> label >> nth=1")
    expect(person.page.locator("[data-status]")).to_contain_text("1 of", timeout=PATIENCE_MS)
    person.page.focus("fieldset >> nth=1 >> input >> nth=0")
    person.page.keyboard.press("ArrowRight")
    expect(person.page.locator("[data-status]")).to_contain_text("2 of", timeout=PATIENCE_MS)
    given = json.loads((session / "answers.json").read_text(encoding="utf-8"))["answers"]
    assert sorted(given.values()) == [2, 2]
    # The answers must persist after leaving the page, logging out and returning.
    person.page.click("text=Log out")
    person.log_in("anna")
    person.go(f"/sessions/{session.name}/questions")
    assert person.page.locator("input:checked").count() == 2
    person.page.locator("fieldset").evaluate_all("sets => sets.forEach(set => set.querySelectorAll('input')[3].checked = true)")
    person.page.click("button:text-is('Save')")
    expect(person.page.locator("main")).to_contain_text("Saved.")
    given = json.loads((session / "answers.json").read_text(encoding="utf-8"))["answers"]
    assert set(given.values()) == {4} and len(given) == person.page.locator("fieldset").count()
    # The database is updated automatically.
    heard = lambda: json.loads(spandrel.run("records", "list", "--json", "--sessions", str(sessions)))
    spandrel.wait_for("answers in the records", lambda: next(r for r in heard() if r["id"] == session.name)["answers"]["answers"] == given)
    assert person.wrong == []


def test_questionnaire_works_without_scripts(browser, server, sessions):
    session = sessions / session_ids(sessions, "ben")[0]
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(server.address + "/login")
    page.fill("[name=name]", "ben")
    page.fill("[name=password]", webserver.PASSWORD)
    page.click("main button[type=submit]")
    page.goto(f"{server.address}/sessions/{session.name}/questions")
    page.check("fieldset >> nth=2 >> input >> nth=4")
    page.click("button:text-is('Save')")
    assert list(json.loads((session / "answers.json").read_text(encoding="utf-8"))["answers"].values()) == [5]


def test_questionnaire_language_follows_browser_and_selection(browser, sessions, tmp_path):
    """German from Accept-Language, Spanish by selection, a site's own Swiss texts; answers persist through all of
    them."""
    swiss = (spandrel.ROOT / "crates/training/src/questionnaire/de.toml").read_text(encoding="utf-8")
    swiss = swiss.replace('language = "de"', 'language = "de-CH"').replace('"Deutsch"', '"Schwiizerdütsch"').replace("Gespeichert.", "Gspeicheret.")
    (tmp_path / "ch.toml").write_text(swiss, encoding="utf-8")
    server = webserver.Server(sessions, "--wording", str(tmp_path / "ch.toml"))
    try:
        session = sessions / session_ids(sessions, "anna")[1]
        given = lambda: json.loads((session / "answers.json").read_text(encoding="utf-8"))
        person = BrowserUser(browser, server, locale="es-MX")
        person.log_in("anna")
        page = person.page
        person.go(f"/sessions/{session.name}/questions")
        assert page.get_attribute("html", "lang") == "es" and page.inner_text("h1") == "Después del vuelo"
        assert page.get_attribute("header.bar", "lang") is None and "Sesiones" in page.inner_text("header.bar")
        assert page.locator("select[name=language] option").all_inner_texts() == ["Schwiizerdütsch", "English", "Deutsch", "Español"]
        page.click("fieldset >> nth=0 >> label:has-text('de acuerdo') >> nth=0")
        expect(page.locator("[data-status]")).to_contain_text("1 de", timeout=PATIENCE_MS)
        assert given()["language"] == "es" and list(given()["answers"].values()) == [1]
        person.save_screenshot("questions-spanish")
        person.check()
        page.select_option("select[name=language]", "de")
        page.click("text=Cambiar")
        page.wait_for_selector("html[lang=de]")
        assert page.get_attribute("header.bar", "lang") == "es", "only the questionnaire is in German"
        assert page.locator("input:checked").count() == 1, "answers must not depend on the language"
        page.click("fieldset >> nth=1 >> label:has-text('stimme gar nicht zu')")
        expect(page.locator("[data-status]")).to_contain_text("2 von", timeout=PATIENCE_MS)
        page.click("text=Speichern")
        expect(page.locator("main")).to_contain_text("Gespeichert.")
        assert given()["language"] == "de" and sorted(given()["answers"].values()) == [1, 5]
        person.save_screenshot("questions-german")
        person.check()
        # A returning user continues in the language of the saved answers, regardless of the browser.
        person.go(f"/sessions/{session.name}/questions")
        assert page.get_attribute("html", "lang") == "de"
        person.go(f"/sessions/{session.name}/questions?language=de-CH")
        page.click("text=Speichern")
        expect(page.locator("main")).to_contain_text("Gspeicheret.")
        assert person.go(f"/sessions/{session.name}/questions?language=tlh").status == 422
        expect(page.locator("main")).to_contain_text("de-CH, en, de, es")
    finally:
        server.close()


def test_invalid_questionnaire_text_is_reported_with_line_and_key(tmp_path):
    broken = (spandrel.ROOT / "crates/training/src/questionnaire/es.toml").read_text(encoding="utf-8").replace("neutral = ", "# neutral = ")
    (tmp_path / "es.toml").write_text(broken.replace("Tarea {number}", "Tarea"), encoding="utf-8")
    done = subprocess.run(
        [spandrel.PROGRAM, "serve", "--sessions", str(tmp_path / "s"), "--listen", "127.0.0.1:0", "--wording", str(tmp_path / "es.toml")],
        stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=webserver.PATIENCE_S, check=False,
    )
    line = 1 + broken.splitlines().index("[scale]")
    assert done.returncode == 2 and f"es.toml:{line}: scale.neutral: missing" in done.stderr, done.stderr
    assert "phases.task = Tarea: {name}" in done.stderr and "{number}" in done.stderr, done.stderr


def test_report_works_under_its_content_security_policy(browser, server, sessions):
    person = BrowserUser(browser, server, "anna")
    session = session_ids(sessions, "anna")[0]
    person.go(f"/sessions/{session}")
    person.page.click("text=Open the report")
    person.page.wait_for_selector("body.live")
    most = int(person.page.get_attribute("#moment", "max"))
    place = lambda: person.page.locator(".drone").first.get_attribute("transform")
    move = "i => { const s = document.getElementById('moment'); s.value = i; s.dispatchEvent(new Event('input', {bubbles: true})); }"
    person.page.evaluate(move, most // 3)
    first = place()
    person.page.evaluate(move, most // 2)
    assert first and place() != first
    person.check()
    # The report is sandboxed: it cannot read the site's cookie, and the site cannot access its scripts.
    assert person.page.evaluate("self.origin") == "null"
    # Links lead back to the session and to the list, although the sandboxed page has no cookies of its own.
    person.page.click("nav.back >> text=All sessions")
    person.page.wait_for_url("**/sessions")
    person.page.go_back()
    person.page.click("nav.back >> text=Back to the session")
    person.page.wait_for_url(f"**/sessions/{session}")
    assert (sessions / session / "report.html").read_text(encoding="utf-8").find('class="back"') < 0
    assert person.wrong == []


def test_report_of_another_version_is_regenerated(server, sessions):
    session = sessions / session_ids(sessions, "ben")[0]
    page = (session / "report.html").read_bytes()
    (session / "report.html").write_text("<script>alert('planted')</script>", encoding="utf-8")
    visitor = webserver.Browser(server.address)
    assert visitor.log_in("ben") == 303
    status, headers, text = visitor.ask(f"/sessions/{session.name}/report")
    assert status == 200 and "sandbox" in headers["Content-Security-Policy"] and "planted" not in text
    assert (session / "report.html").read_bytes() == page


def test_two_sessions_can_be_compared(browser, server, sessions):
    """Both flights in one drawing with one slider, aligned as the instructor selects."""
    first, second = session_ids(sessions, "anna")
    for size, scheme, locale in [("desktop", "light", "en-GB"), ("phone", "dark", "de-DE")]:
        person = BrowserUser(browser, server, "anna", size, scheme, locale)
        page = person.page
        person.go(f"/sessions/{first}")
        page.select_option("[name=second]", second)
        page.click("form[action='/compare'] button")
        page.wait_for_selector("body.live")
        assert page.locator(".shape-1").count() == 1 and page.locator(".shape-2").count() == 1
        # Top view and side view, each with two tracks and two drones.
        drawings = page.locator("svg.map").count()
        assert drawings >= 2
        for k in ("1", "2"):
            assert page.locator(f".overlaid.line-{k}").count() == page.locator(f".drone-{k}").count() == drawings
        assert page.locator(".chart canvas").count() == 4
        places = lambda: [page.locator(f".drone-{k}").first.get_attribute("transform") for k in (1, 2)]
        now = lambda: page.locator("[data-now=speed]").all_inner_texts()
        move = "i => { const s = document.getElementById('moment'); s.value = i; s.dispatchEvent(new Event('input', {bubbles: true})); }"
        most = int(page.get_attribute("#moment", "max"))
        page.evaluate(move, most // 3)
        before, said = places(), now()
        page.evaluate(move, most // 2)
        assert all(here != there for here, there in zip(places(), before)) and now() != said
        # Keys also move the slider, which announces its position.
        text = page.get_attribute("#moment", "aria-valuetext")
        page.focus("#moment")
        page.keyboard.press("PageUp")
        assert page.get_attribute("#moment", "aria-valuetext") != text
        # Aligned at the start of the task, both are at its path at 0:00.
        page.select_option("#line-up", label=catalog_text(locale, "compare", "compare-start-of-task").replace("{ $task }", "1"))
        assert page.inner_text("#moment-text") == "0:00"
        away = [float(text.split()[0]) for text in page.locator("[data-now=distance]").all_inner_texts()]
        assert max(away) <= 1.6, "the task starts within 1.5 m of its path, plus one step of the slider"
        assert page.locator("details.numbers table tr").count() > 4
        person.save_screenshot(f"compare-{size}-{scheme}")
        person.check()


def test_trainees_cannot_read_data_of_others(browser, server, sessions):
    person = BrowserUser(browser, server, "anna")
    ben = session_ids(sessions, "ben")[0]
    # The list is available, but does not contain Ben.
    expect(person.page.locator("table.list")).to_contain_text("drill-hover")
    assert "ben" not in person.page.inner_text("main")
    for path in [f"/sessions/{ben}", f"/sessions/{ben}/report", f"/sessions/{ben}/questions", f"/sessions/{ben}/frames.csv",
                 f"/sessions/{ben}/telemetry.tlog", f"/compare?first={session_ids(sessions, 'anna')[0]}&second={ben}", "/trainees/ben",
                 "/trainees/ben/export.json"]:
        assert person.go(path).status == 404, path
    for path in ["/trainees", "/cohort", "/live", "/live/all", "/live/all.json", "/upload", "/settings", "/live/stream", "/live/camera.jpg"]:
        assert person.go(path).status == 403, path
    assert person.go("/trainees/anna").status == 200


def test_trainee_can_be_exported_and_erased(browser, server, sessions, tmp_path):
    webserver.flown(sessions, "gone", seed=31)
    person = BrowserUser(browser, server, "ada")
    # The server finds the new session automatically.
    spandrel.wait_for("the new session", lambda: person.go("/sessions?trainee=gone") and person.page.locator("table.list").count())
    person.go("/trainees/gone")
    with person.page.expect_download() as download:
        person.page.click("text=Download all data")
    download.value.save_as(tmp_path / "gone.json")
    kept = json.loads((tmp_path / "gone.json").read_text(encoding="utf-8"))
    assert kept["trainee"]["pseudonym"] == "gone" and len(kept["sessions"]) == 1
    assert kept["folders"] == session_ids(sessions, "gone") and str(sessions) not in (tmp_path / "gone.json").read_text(encoding="utf-8")
    person.page.click("summary:has-text('Erase')")
    person.page.fill("[name=again]", "anna")
    person.page.click("text=Erase permanently")
    assert session_ids(sessions, "gone"), "a wrong name must not erase anything"
    person.go("/trainees/gone")
    person.page.click("summary:has-text('Erase')")
    person.page.fill("[name=again]", "gone")
    person.page.click("text=Erase permanently")
    assert person.page.url.endswith("/trainees") and session_ids(sessions, "gone") == []
    assert person.go("/trainees/gone").status == 404
    person.go("/trainees/ada")
    person.page.click("summary:has-text('Erase')")
    person.page.fill("[name=again]", "ada")
    person.page.click("text=Erase permanently")
    expect(person.page.locator("body")).to_contain_text("ask another administrator to erase you")
    assert person.go("/settings").status == 200, "administrators must not be able to erase themselves"


def test_briefing_and_map_tiles_are_served(browser, server):
    person = BrowserUser(browser, server, "anna")
    person.go("/scenarios/two-bridges")
    person.page.click("text=Briefing")
    expect(person.page.locator("#check")).to_contain_text("Landing place")
    assert person.page.locator("svg.map").count() == 3
    person.save_screenshot("briefing")
    # Ground stations cannot log in. This tile contains the job's origin.
    anonymous = webserver.Browser(server.address)
    status, headers, _ = anonymous.ask("/tiles/two-bridges/17/68587/46258.png")
    assert (status, headers["Content-Type"]) == (200, "image/png")
    for wrong in ["/tiles/two-bridges/99/1/1.png", "/tiles/two-bridges/3/8/0", "/tiles/no-such-job/3/0/0", "/tiles/two-bridges/3/0/x.png"]:
        assert anonymous.ask(wrong)[0] == 404, wrong


def test_scenario_can_be_uploaded_validated_and_deleted(browser, server, tmp_path):
    person = BrowserUser(browser, server, "ida")
    good = (spandrel.ROOT / "scenarios" / "drill-hover.toml").read_text(encoding="utf-8")
    name = "ours-hover"
    renamed = good.replace('name = "drill-hover"', f'name = "{name}"')
    assert renamed != good
    for text, said in [(renamed + "\nnonsense = 1\n", "nonsense"), (good, "name of a shipped"), (renamed, "was saved")]:
        (tmp_path / "job.toml").write_text(text, encoding="utf-8")
        person.go("/scenarios")
        person.page.set_input_files("[name=file]", tmp_path / "job.toml")
        person.page.click("text=Validate and save")
        expect(person.page.locator(".message")).to_contain_text(said)
        person.save_screenshot(f"upload-{said.split()[0]}")
    person.page.click(f"a:has-text('{name}')")
    # The file may contain defect positions, so a trainee sees the job but not the file.
    trainee = BrowserUser(browser, server, "anna")
    trainee.go(f"/scenarios/{name}")
    expect(trainee.page.locator("#facts")).to_be_visible()
    assert trainee.page.locator("pre").count() == 0 and person.page.locator("pre").count() == 1
    person.page.click("text=Delete this scenario")
    person.page.wait_for_url("**/scenarios")
    expect(person.page.locator("main")).to_contain_text("drill-hover")
    assert name not in person.page.inner_text("main")


def test_recorded_flight_can_be_imported(browser, server, sessions, tmp_path):
    source = sessions / session_ids(sessions, "anna")[1]
    # A new recording: the same flight without its last record.
    log = tmp_path / "telemetry.tlog"
    log.write_bytes((source / "telemetry.tlog").read_bytes()[:-1])
    person = BrowserUser(browser, server, "ida")
    person.go("/upload")
    person.page.fill("[name=trainee]", "carl")
    person.page.select_option("[name=scenario]", "drill-hover")
    person.page.set_input_files("[name=file]", log)
    person.page.click("text=Import >> nth=-1")
    person.page.wait_for_url("**/sessions/*-carl-*")
    taken = sessions / session_ids(sessions, "carl")[0]
    ours, theirs = (json.loads((folder / "assessment.json").read_text(encoding="utf-8")) for folder in (taken, source))
    assert ours["scores"] == theirs["scores"] and ours["tasks"] == theirs["tasks"]
    kept, sent = (taken / "telemetry.tlog").read_bytes(), log.read_bytes()
    assert sent.startswith(kept) and 0 < len(sent) - len(kept) < 400, "the recording must be stored up to its last complete record"
    assert "lift_off" in (taken / "events.jsonl").read_text(encoding="utf-8")
    # Importing it again must not create another session, but link to the existing one.
    for trainee in ("carl", "carlotta"):
        person.go("/upload")
        person.page.fill("[name=trainee]", trainee)
        person.page.select_option("[name=scenario]", "drill-hover")
        person.page.set_input_files("[name=file]", log)
        person.page.click("text=Import >> nth=-1")
        expect(person.page.locator(".message.good")).to_contain_text("already imported")
        person.save_screenshot("upload-again")
    person.page.click(".message a")
    person.page.wait_for_url("**/sessions/2*")
    assert len(session_ids(sessions, "carl")) == 1 and session_ids(sessions, "carlotta") == []
    # A flight of another job is rejected without leaving anything behind.
    log.write_bytes(log.read_bytes()[:-600])
    person.go("/upload")
    person.page.fill("[name=trainee]", "carl")
    person.page.select_option("[name=scenario]", "two-bridges")
    person.page.set_input_files("[name=file]", log)
    person.page.click("text=Import >> nth=-1")
    expect(person.page.locator(".message")).to_contain_text("cannot import this recording")
    assert len(session_ids(sessions, "carl")) == 1


def test_users_can_change_their_password(browser, server, sessions):
    webserver.set_password(sessions, "dora", "trainee")
    person, elsewhere = BrowserUser(browser, server, "dora"), BrowserUser(browser, server, "dora")
    person.go("/account")
    person.page.fill("[name=present]", webserver.PASSWORD)
    person.page.fill("[name=new]", "another long word")
    person.page.click("text=Change >> nth=-1")
    expect(person.page.locator(".message")).to_contain_text("Password changed")
    elsewhere.go("/sessions")
    assert elsewhere.page.url.endswith("/login"), "other browser sessions must have ended"
    assert person.go("/account").status == 200
    elsewhere.log_in("dora", "another long word")
    assert elsewhere.page.url.endswith("/sessions")
    # Another program sets the password on the command line, which ends all her browser sessions.
    webserver.set_password(sessions, "dora", "trainee", password="yet another long word")
    for one in (person, elsewhere):
        one.go("/sessions")
        assert one.page.url.endswith("/login")
    # Another role also requires a new login.
    person.log_in("dora", "yet another long word")
    assert person.page.url.endswith("/sessions")
    spandrel.run("records", "trainee", "dora", "--role", "instructor", "--sessions", str(sessions))
    person.go("/sessions")
    assert person.page.url.endswith("/login")


def test_concurrent_edits_are_not_lost(browser, server, sessions):
    """Two users edit one trainee at the same time. The second user is informed, and neither the first user's changes
    nor a new role are lost."""
    webserver.set_password(sessions, "emil", "trainee")
    first, second = BrowserUser(browser, server, "emil"), BrowserUser(browser, server, "ida")
    for one in (first, second):
        one.go("/trainees/emil")
    spandrel.run("records", "trainee", "emil", "--drone-experience", "some", "--sessions", str(sessions))
    first.page.select_option("[name=age_band]", "25-34")
    first.page.click("text=Save")
    expect(first.page.locator("main")).to_contain_text("changed elsewhere")
    second.go("/trainees/emil")
    second.page.select_option("[name=age_band]", "35-44")
    second.page.click("text=Save")
    second.page.wait_for_url("**/trainees/emil")
    assert second.page.input_value("[name=age_band]") == "35-44" and second.page.input_value("[name=drone_experience]") == "some"


def test_local_server_requires_login_only_after_a_password_is_set(browser, tmp_path):
    server = webserver.Server(tmp_path / "sessions")
    person = BrowserUser(browser, server)
    person.go("/")
    expect(person.page.locator("main")).to_contain_text("No sessions yet")
    person.save_screenshot("open")
    person.go("/settings")
    person.page.fill("[name=name]", "ada")
    person.page.select_option("[name=role]", "trainee")
    person.page.fill("[name=password]", webserver.PASSWORD)
    person.page.click("text=Save >> nth=-1")
    expect(person.page.locator("main")).to_contain_text("must be an administrator")
    person.go("/settings")
    person.page.fill("[name=name]", "ada")
    person.page.select_option("[name=role]", "administrator")
    person.page.fill("[name=password]", webserver.PASSWORD)
    person.page.click("text=Save >> nth=-1")
    assert person.page.url.endswith("/login")
    person.go("/sessions")
    assert person.page.url.endswith("/login")
    person.log_in("ada")
    assert person.page.url.endswith("/sessions")
    server.close()


def freeze_rewind_and_move(page, events):
    """Freezes a practice flight on the live page, continues it, rewinds it and moves it to a task."""
    said = page.locator("[data-said]")
    drone = page.locator(".drone").first
    place = lambda: drone.get_attribute("transform")
    moves = lambda before: page.wait_for_function(
        "before => document.querySelector('.drone').getAttribute('transform') !== before", arg=before, timeout=PATIENCE_MS)

    def counted(event):
        return sum(json.loads(line)["event"] == event for line in events.read_text(encoding="utf-8").splitlines())

    def press(button, report):
        page.get_by_role("button", name=button, exact=True).click()
        expect(said).to_contain_text(report, timeout=PATIENCE_MS)

    press("Freeze", "instructor: freeze")
    spandrel.wait_for("the freeze in the session", lambda: counted("freeze") == 1)
    frozen = place()
    # The note makes a round trip through server and session while the drone does not move.
    page.fill("[name=text]", "frozen")
    press("Add note", "note: frozen")
    assert place() == frozen
    press("Continue", "instructor: continue")
    moves(frozen)
    press("Rewind 10 s", "instructor: rewind 10 s")
    spandrel.wait_for("the rewind in the session", lambda: counted("rewind") == 1)
    press("Continue", "instructor: continue")
    before = place()
    press("Move to the start of this task", "instructor: move to task 1")
    spandrel.wait_for("the move in the session", lambda: counted("rewind") == 2)
    moves(before)


def test_instructor_can_watch_and_intervene(browser, tmp_path):
    """A complete flight of the synthetic trainee, observed on the server's page: the drone moves, cues arrive, and
    wind, a failure and a note are sent."""
    flight = spandrel.Flight(tmp_path, speed=2)
    server = webserver.Server(flight.sessions, vehicle=f"127.0.0.1:{flight.payload_port}")
    pilot = subprocess.Popen(
        [spandrel.PROGRAM, "pilot", "--scenario", "two-bridges", "--skill", "novice", "--seed", "7", "--port", str(flight.client_port)],
        stdin=subprocess.DEVNULL, stdout=flight.log, stderr=flight.log,
    )
    try:
        person = BrowserUser(browser, server)
        page = person.page
        person.go("/live")
        page.wait_for_selector(".live-page.live", timeout=PATIENCE_MS)
        expect(page.locator("[data-state]")).to_contain_text("motors armed", timeout=PATIENCE_MS)
        place = lambda: page.locator(".drone").first.get_attribute("transform")
        first = place()
        page.wait_for_function("before => document.querySelector('.drone').getAttribute('transform') !== before", arg=first)
        said = page.locator("[data-said]")
        page.fill("[name=text]", "watch the pier <b>")
        page.click("text=Note >> nth=-1")
        expect(said).to_contain_text("note: watch the pier <b>", timeout=PATIENCE_MS)
        page.fill("[name=speed]", "8")
        page.fill("[name=from]", "180")
        page.click("text=Set wind")
        expect(said).to_contain_text("instructor: wind 8 m/s from 180", timeout=PATIENCE_MS)
        page.click("text=Close bridges")
        expect(said).to_contain_text("instructor: the bridges are closed to traffic", timeout=PATIENCE_MS)
        expect(page.locator("[data-now=traffic]")).to_have_text("closed", timeout=PATIENCE_MS)
        page.click("text=Open bridges")
        expect(page.locator("[data-now=traffic]")).to_have_text("open", timeout=PATIENCE_MS)
        page.select_option("[name=unit]", "compass")
        page.click("text=Inject failure")
        expect(said).to_contain_text("instructor: compass fails", timeout=PATIENCE_MS)
        page.click("text=Clear failure")
        expect(said).to_contain_text("instructor: compass restored", timeout=PATIENCE_MS)
        events = next(path for path in flight.sessions.iterdir() if path.is_dir()) / "events.jsonl"
        freeze_rewind_and_move(page, events)
        for size, scheme, locale in LIVE_LOOKS:
            person.show_in(size, scheme, locale)
            page.reload()
            page.wait_for_selector(".live-page.live")
            assert page.get_attribute("html", "lang") == locale[:2]
            person.save_screenshot(f"live-flight-{size}-{scheme}-{locale[:2]}")
            person.check()
        noted = lambda: [e["text"] for e in map(json.loads, events.read_text(encoding="utf-8").splitlines()) if e["event"] == "note"]
        spandrel.wait_for("the notes in the session", lambda: noted() == ["watch the pier <b>", "frozen"])
        gates = lambda: [e["open"] for e in map(json.loads, events.read_text(encoding="utf-8").splitlines()) if e["event"] == "traffic"]
        spandrel.wait_for("the bridges closed and opened in the session", lambda: gates() == [False, True])
        assert person.wrong == []
    finally:
        server.close()
        spandrel.end(pilot)
        flight.close()


def test_trainee_sees_only_the_camera_of_their_own_flight(browser, tmp_path):
    """The picture is normally written by a window; here the test writes it."""
    picture = tmp_path / "camera.jpg"
    photograph = (spandrel.ROOT / "docs" / "src" / "images" / "window.jpg").read_bytes()
    flight = spandrel.Flight(tmp_path, scenario="drill-hover", speed=1)
    flight.sessions.mkdir(exist_ok=True)
    for name in ("client-test", "anna"):
        webserver.set_password(flight.sessions, name, "trainee")
    server = webserver.Server(flight.sessions, "--picture", str(picture), vehicle=f"127.0.0.1:{flight.payload_port}")
    try:
        pilot, anna = webserver.Browser(server.address), webserver.Browser(server.address)
        assert pilot.log_in("client-test") == 303 and anna.log_in("anna") == 303
        flying = lambda who: json.loads(who.ask("/flight/now.json")[2])
        spandrel.wait_for("the flight's owner", lambda: flying(pilot)["flying"])
        assert flying(pilot)["picture"] is None and pilot.ask("/flight/camera.jpg")[0] == 404
        picture.write_bytes(photograph)
        now = flying(pilot)
        status, headers, _ = pilot.ask(f"/flight/camera.jpg?v={now['picture']}")
        assert now["picture"] and status == 200 and headers["Content-Type"] == "image/jpeg"
        assert flying(anna) == {"flying": False, "picture": None} and anna.ask("/flight/camera.jpg")[0] == 404
        assert pilot.ask("/live")[0] == pilot.ask("/live/camera.jpg")[0] == 403, "only instructors may access the map and the actions"
        person = BrowserUser(browser, server, "client-test")
        page = person.page
        page.click("text=My flight")
        for size, scheme, locale in LIVE_LOOKS[::-1]:
            state = catalog_text(locale, "live", "live-own-flying")
            person.show_in(size, scheme, locale)
            picture.write_bytes(photograph)
            page.reload()
            page.wait_for_function("() => document.querySelector('[data-camera] img').naturalWidth > 0")
            expect(page.locator("[data-state]")).to_have_text(state)
            person.save_screenshot(f"own-flight-{size}-{scheme}-{locale[:2]}")
            person.check()
        # When the flight ends, its picture disappears.
        spandrel.end(flight.monitor)
        expect(page.locator("[data-state]")).to_contain_text("No flight in progress", timeout=PATIENCE_MS)
        assert pilot.ask("/flight/camera.jpg")[0] == 404
    finally:
        server.close()
        flight.close()


def test_train_prints_the_address_of_its_pages(tmp_path):
    process = subprocess.Popen(
        [spandrel.PROGRAM, "train", "--scenario", "drill-hover", "--ports", "ephemeral", "--sessions", str(tmp_path / "sessions")],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    )
    try:
        address = next(line for line in process.stdout if "web pages" in line).split()[-1]
        visitor = webserver.Browser(address)
        assert visitor.ask("/sessions")[0] == 200
        live = lambda: "Waiting for a flight" not in visitor.ask("/live")[2]
        spandrel.wait_for("the flight on the live page", live)
    finally:
        spandrel.end(process)

"""The scenario editor of the web server in a real browser: form, checks while typing, plan, saving, and its use without a script."""

import json
import re
import tomllib

import pytest
from playwright.sync_api import expect

import spandrel
import webserver
from test_web import LOOKS, BrowserUser, browser  # noqa: F401 (`browser` is a fixture)

# Places in `practice` (east, north, up, m): under the deck of the suspension bridge, and inside the rib of the arch bridge.
UNDERSIDE = (10.0, 150.0, 13.8)
RIB = (8.75, 0.0, 28.7)
PRACTICE = (spandrel.ROOT / "scenarios" / "practice.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """A folder without flights, and the passwords of all roles."""
    folder = tmp_path_factory.mktemp("editor") / "sessions"
    folder.mkdir()
    webserver.set_passwords(folder, "anna")
    return folder


def stored(sessions, name):
    """Returns the file of an uploaded scenario."""
    return sessions / "scenarios" / f"{name}.toml"


def upload(server, name, text=PRACTICE):
    """Uploads a copy of a scenario as the instructor Ida."""
    ida = webserver.Browser(server.address)
    assert ida.log_in("ida") == 303
    renamed = re.sub(r'(?m)^name = "[a-z-]+"$', f'name = "{name}"', text, count=1)
    assert ida.upload("/scenarios", "/scenarios", {}, renamed.encode(), "job.toml")[0] == 200
    return ida


def open_section(page, section):
    """Opens a section of the form."""
    page.locator(f"#section-{section}").evaluate("details => { details.open = true; }")


def wait_until_checked(page, words="No problems"):
    """Waits until the check of the latest change is shown."""
    expect(page.locator("#status")).to_contain_text(words)


def plan_point(page, east, north):
    """Returns the point of the window at a place on the site plan."""
    return page.locator("[data-plan] svg").evaluate(
        """(svg, [east, north]) => {
          const [m0, m1, , m3, m4, m5, , m7] = svg.querySelector("[data-matrix]").dataset.matrix.split(" ").map(Number);
          const at = new DOMPoint(m0 * east + m1 * north + m3, m4 * east + m5 * north + m7).matrixTransform(svg.getScreenCTM());
          return [at.x, at.y];
        }""",
        [east, north],
    )


def drawing_point(page, drawing, place):
    """Returns the point of the window at a place (east, north, up) on a drawing: the site plan, or the side view of a bridge."""
    return page.locator(f"[data-drawing='{drawing}'] svg").evaluate(
        """(svg, [east, north, up]) => {
          const [m0, m1, m2, m3, m4, m5, m6, m7] = svg.querySelector("[data-matrix]").dataset.matrix.split(" ").map(Number);
          const [x, y] = [m0 * east + m1 * north + m2 * up + m3, m4 * east + m5 * north + m6 * up + m7];
          const at = new DOMPoint(x, y).matrixTransform(svg.getScreenCTM());
          return [at.x, at.y];
        }""",
        place,
    )


def click_drawing(page, drawing, place):
    """Clicks a place on a drawing."""
    # Without animated scrolling, the place stays where it is.
    page.emulate_media(reduced_motion="reduce")
    page.locator(f"[data-drawing='{drawing}'] svg").scroll_into_view_if_needed()
    page.mouse.click(*drawing_point(page, drawing, place))


def placed_defects(page):
    """Returns the defects that the text of the editor places."""
    return tomllib.loads(page.input_value("#text"))["defects"].get("placed", [])


def test_wire_instructor_makes_a_job_from_practice(browser, server, sessions):
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/scenarios")
    page.click("text=New scenario")
    assert page.input_value("[name=from]") == "practice"
    page.fill("[name=name]", "lake-crossing")
    page.click("text=Edit the copy")
    wait_until_checked(page)
    expect(page.locator("#preview svg")).to_have_count(4)
    assert page.input_value("#field-name") == "lake-crossing"
    # The wind.
    open_section(page, "wind")
    page.select_option("#field-wind-level", "gentle")
    page.fill("#field-wind-from_deg", "400")
    wait_until_checked(page, "1 problem")
    problem = page.locator("#field-wind-from_deg-problem")
    expect(problem).to_have_text("out of range (allowed: 0 to 360)")
    expect(page.locator("#field-wind-from_deg")).to_have_attribute("aria-invalid", "true")
    expect(page.locator("#stale")).to_be_visible()
    expect(page.locator("#preview svg")).to_have_count(4)
    # The list of problems leads to the field and to the line.
    page.locator("#section-wind").evaluate("details => { details.open = false; }")
    page.click("#findings [data-element]")
    assert page.evaluate("document.activeElement.id") == "field-wind-from_deg"
    page.click("#findings [data-line]")
    assert page.evaluate("getSelection().toString() || document.activeElement.value.slice(document.activeElement.selectionStart, document.activeElement.selectionEnd)") == "from_deg = 400"
    page.fill("#field-wind-from_deg", "250")
    wait_until_checked(page)
    expect(problem).to_be_empty()
    expect(page.locator("#stale")).to_be_hidden()
    # The pad, by a click on the plan.
    open_section(page, "place")
    page.click("[data-place='ground_team.pad_m']")
    expect(page.locator("#placing")).to_contain_text("Click the site plan")
    page.locator("[data-plan]").scroll_into_view_if_needed()
    page.mouse.click(*plan_point(page, -100, 60))
    east, north, up = (page.locator(f"#field-ground_team-pad_m-part-{k}") for k in range(3))
    assert abs(float(east.input_value()) + 100) <= 1 and abs(float(north.input_value()) - 60) <= 1 and up.input_value() == "5.0"
    assert page.evaluate("document.activeElement.dataset.place") == "ground_team.pad_m"
    expect(page.locator("#text")).to_have_value(re.compile(r"pad_m = \[-\d+(\.\d)?, \d+(\.\d)?, 5\.0\]"))
    # The level ground moved with the pad, so the inspector's place is in the slope now.
    wait_until_checked(page, "1 problem")
    expect(page.locator("#field-ground_team-inspector_m-problem")).to_contain_text(re.compile(r"place 1 is \d\.\d m below the ground"))
    page.click("[data-place='ground_team.inspector_m']")
    page.mouse.click(*plan_point(page, -106, 56))
    wait_until_checked(page)
    # A task more, above the last one.
    open_section(page, "tasks")
    page.click("text=Add a task")
    expect(page.locator("#field-tasks-4-name")).to_be_focused()
    page.fill("#field-tasks-4-name", "Slab from the other side")
    page.fill("#field-tasks-4-stand_off_m", "6")
    wait_until_checked(page)
    page.locator("#field-tasks-4 button:text-is('Move up')").click()
    expect(page.locator("#field-tasks-3 > summary")).to_contain_text("Slab from the other side")
    wait_until_checked(page)
    ida.save_screenshot("editor-changed")
    page.click("button:text-is('Save')")
    page.wait_for_url("**/scenarios/lake-crossing/edit?saved=yes")
    expect(page.locator(".message").first).to_contain_text("was saved")
    ida.go("/scenarios")
    expect(page.locator("tr:has-text('lake-crossing')")).to_contain_text("uploaded")
    file = stored(sessions, "lake-crossing")
    text = file.read_text(encoding="utf-8")
    assert text.startswith(PRACTICE.splitlines()[0]), "the comment of the shipped file remains"
    assert 'level = "gentle"' in text and "from_deg = 250\n" in text and text.count("[[tasks]]") == 5
    assert text.index("Slab from the other side") < text.index("Pier of the suspension bridge")
    found = json.loads(spandrel.run("check", str(file), "--json"))
    assert found["problems"] == []
    # The second task has the same path as the first one: a warning for each of the two.
    assert len(found["warnings"]) == 2 and all("reduce threshold_m" in warning for warning in found["warnings"]), found["warnings"]
    assert ida.wrong == []


def test_wire_instructor_places_defects_on_the_drawings(browser, server, sessions):
    upload(server, "with-defects")
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/scenarios/with-defects/edit")
    wait_until_checked(page)
    marks = page.locator("#preview .placed-defect")
    expect(marks).to_have_count(0)
    page.click("#placer > summary")
    expect(page.locator("#placed-list")).to_contain_text("None. The defects are placed at random.")
    # The fields show the typical size of the chosen defect.
    expect(page.locator("#place-length")).to_have_attribute("placeholder", "0.95")
    page.select_option("#place-state", "3")
    expect(page.locator("#place-width")).to_have_attribute("placeholder", "2.14")
    # A crack in the underside of the deck of the suspension bridge, by a click on the plan. Escape ends the choice of the place.
    page.fill("#place-length", "0.5")
    page.select_option("#place-surface", "back")
    page.click("#place-on-drawing")
    expect(page.locator("#placed-result")).to_contain_text("Click the site plan or a side view")
    page.keyboard.press("Escape")
    expect(page.locator("#placed-result")).to_be_empty()
    page.click("#place-on-drawing")
    click_drawing(page, "", UNDERSIDE)
    expect(page.locator("#placed-result")).to_contain_text("Defect 1 was placed on suspension/")
    assert page.evaluate("document.activeElement.id") == "place-on-drawing"
    [crack] = placed_defects(page)
    assert (crack["kind"], crack["condition_state"], crack["length_m"], crack["line"]) == (1130, 3, 0.5, True)
    assert crack["normal"][2] < -0.99 and all(abs(crack["position_m"][k] - UNDERSIDE[k]) < 1 for k in (0, 1)), crack
    # The plan and the side view of its bridge show it.
    expect(marks).to_have_count(2)
    expect(page.locator("[data-drawing='arch'] .placed-defect")).to_have_count(0)
    wait_until_checked(page)
    # One on the outer side of each rib of the arch bridge, by clicks on its side view.
    normals = []
    for surface in ("front", "back"):
        page.select_option("#place-kind", label="delamination or spall")
        page.fill("#place-length", "0.2")
        page.select_option("#place-surface", surface)
        page.click("#place-on-drawing")
        click_drawing(page, "arch", RIB)
        expect(page.locator("#placed-result")).to_contain_text(f"Defect {len(normals) + 2} was placed on arch/")
        normals.append(placed_defects(page)[-1]["normal"])
    assert sum(a * b for a, b in zip(*normals)) < -0.99, normals
    # What is impossible has a reason, and changes nothing.
    page.select_option("#place-kind", label="corrosion")
    page.click("#place-on-drawing")
    click_drawing(page, "arch", RIB)
    expect(page.locator("#placed-result")).to_contain_text("Not placed: 'corrosion' does not occur on this element")
    page.fill("#place-length", "60")
    page.click("#place-at-coordinates")
    expect(page.locator("#placed-result")).to_contain_text("Not placed: Length (m): not a number from 0.0001 to 50")
    assert len(placed_defects(page)) == 3
    ida.save_screenshot("editor-placed")
    ida.check()
    # The defects are in the file, and trainees' pages show their number but not where they are.
    page.click("button:text-is('Save')")
    page.wait_for_url("**/scenarios/with-defects/edit?saved=yes")
    file = stored(sessions, "with-defects")
    assert file.read_text(encoding="utf-8").startswith(PRACTICE.splitlines()[0]), "the comment of the shipped file remains"
    found = json.loads(spandrel.run("check", str(file), "--json"))
    assert found["problems"] == [], found
    exported = json.loads(spandrel.run("export", str(file), "--scenario", "-"))
    assert [round(value, 3) for value in exported["defects"][0]["position_enu_m"]] == [round(value, 3) for value in crack["position_m"]]
    anna = BrowserUser(browser, server, "anna")
    anna.go("/scenarios/with-defects")
    assert anna.page.locator("dt:text-is('Defects to find') + dd").text_content().strip() == "3"
    assert anna.page.locator("svg.map").count() >= 1 and anna.page.locator(".placed-defect").count() == 0
    assert ida.wrong == [] and anna.wrong == []


def test_wire_defects_are_placed_and_removed_with_the_keyboard(browser, server):
    ida = BrowserUser(browser, server, "ida", locale="de-DE")
    page = ida.page
    ida.go("/scenarios/new?from=practice&name=by-hand")
    wait_until_checked(page, "Keine Probleme")
    page.focus("#placer > summary")
    page.keyboard.press("Enter")
    expect(page.locator("#placer > summary")).to_contain_text("Schäden platzieren")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "place-kind"
    for number, east in enumerate((UNDERSIDE[0], UNDERSIDE[0] + 3), start=1):
        for k, value in enumerate((east, *UNDERSIDE[1:])):
            page.focus(f"#place-at-{k}")
            page.keyboard.press("Control+A")
            page.keyboard.type(f"{value:.2f}".replace(".", ","))
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.id") == "place-at-coordinates"
        page.keyboard.press("Enter")
        expect(page.locator("#placed-result")).to_contain_text(f"Schaden {number} wurde auf suspension/")
        assert page.evaluate("document.activeElement.id") == "place-at-coordinates"
    assert [defect["id"] for defect in placed_defects(page)] == [1, 2]
    # An undo of the first one: its button has a name of its own.
    remove = page.get_by_role("button", name="Schaden 1 entfernen")
    remove.focus()
    page.keyboard.press("Enter")
    expect(page.locator("#placed-list li")).to_have_count(1)
    expect(page.locator("#placed-head")).to_be_focused()
    assert [defect["id"] for defect in placed_defects(page)] == [2]
    # Far from every bridge, and while the scenario has a problem.
    page.fill("#place-at-2", "900")
    page.click("#place-at-coordinates")
    expect(page.locator("#placed-result")).to_contain_text("Nicht platziert: Die nächste Fläche einer Brücke ist")
    open_section(page, "wind")
    page.fill("#field-wind-from_deg", "400")
    problem = page.locator("#field-wind-from_deg-problem")
    expect(problem).to_have_text("außerhalb des Bereichs (zulässig: 0 bis 360)")
    expect(problem.locator("span")).to_have_attribute("lang", "de")
    expect(page.locator("#findings .problems")).to_contain_text("wind.from_deg = 400: außerhalb des Bereichs")
    page.click("#place-at-coordinates")
    expect(page.locator("#placed-result")).to_contain_text("Das Szenario hat Probleme")
    ida.check()


def check_in_every_size_and_theme(person, name):
    for size, scheme, _ in LOOKS:
        # The page is not loaded again, because it would lose its state: it keeps its language.
        person.show_in(size, scheme, "en-GB")
        person.check()
        person.save_screenshot(f"{name}-{size}-{scheme}")


def test_wire_editor_passes_axe_in_every_size_and_theme(browser, server):
    ida = BrowserUser(browser, server, "ida")
    ida.go("/scenarios/new")
    check_in_every_size_and_theme(ida, "new")
    ida.go("/scenarios/new?from=practice&name=x")
    wait_until_checked(ida.page)
    ida.save_screenshot("editor")
    open_section(ida.page, "wind")
    ida.page.fill("#field-wind-from_deg", "north")
    wait_until_checked(ida.page, "1 problem")
    expect(ida.page.locator("#placer")).to_be_visible()
    check_in_every_size_and_theme(ida, "editor-all")


def test_wire_editor_is_usable_with_the_keyboard_alone(browser, server, sessions):
    upload(server, "by-keyboard")
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/scenarios/by-keyboard/edit")
    wait_until_checked(page)
    page.focus("#section-traffic > summary")
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.id") == "field-traffic-cars"
    page.keyboard.press("Control+A")
    page.keyboard.type("9")
    expect(page.locator("#text")).to_have_value(re.compile(r"cars = 9\n"))
    page.focus("#section-tasks > summary")
    page.keyboard.press("Enter")
    page.focus("#section-tasks > button")
    page.keyboard.press("Enter")
    expect(page.locator("#field-tasks-4-name")).to_be_focused()
    page.focus("button:text-is('Save')")
    page.keyboard.press("Enter")
    page.wait_for_url("**/scenarios/by-keyboard/edit?saved=yes")
    text = stored(sessions, "by-keyboard").read_text(encoding="utf-8")
    assert "cars = 9\n" in text and text.count("[[tasks]]") == 5
    assert ida.wrong == []


def test_wire_text_and_form_change_each_other(browser, server):
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/scenarios/new?from=practice&name=by-text")
    wait_until_checked(page)
    page.click("#file > summary")
    text = page.input_value("#text")
    page.fill("#text", text.replace("cars = 4", "cars = 12 # rush hour"))
    expect(page.locator("#field-traffic-cars")).to_have_value("12")
    # A syntax error has a line, disables the form, and keeps the drawings.
    page.fill("#text", text.replace("cars = 4", "cars = "))
    wait_until_checked(page, "1 problem")
    expect(page.locator("#findings")).to_contain_text("syntax")
    expect(page.locator("#field-title")).to_be_disabled()
    expect(page.locator("#stale")).to_be_visible()
    expect(page.locator("#preview svg")).to_have_count(4)
    page.fill("#text", text.replace("cars = 4", "cars = 12 # rush hour"))
    wait_until_checked(page)
    open_section(page, "traffic")
    page.fill("#field-traffic-cars", "3")
    expect(page.locator("#text")).to_have_value(re.compile("cars = 3 # rush hour\n"))
    with page.expect_download() as download:
        page.click("button:text-is('Download')")
    assert download.value.suggested_filename == "by-text.toml"
    # The browser asks before it leaves, and the answer "stay" keeps the changes.
    page.once("dialog", lambda dialog: dialog.dismiss())
    page.click("a:text-is('Back')", no_wait_after=True)
    expect(page.locator("#field-traffic-cars")).to_have_value("3")
    page.once("dialog", lambda dialog: dialog.accept())
    page.click("a:text-is('Back')")
    page.wait_for_url("**/scenarios")
    assert ida.wrong == []


def test_wire_changes_by_somebody_else_are_not_overwritten(browser, server, sessions):
    upload(server, "shared-job")
    ida, ada = BrowserUser(browser, server, "ida"), BrowserUser(browser, server, "ada")
    for person in (ida, ada):
        person.go("/scenarios/shared-job")
        person.page.click("main a:text-is('Edit')")
        wait_until_checked(person.page)
        open_section(person.page, "traffic")
    ida.page.fill("#field-traffic-cars", "5")
    ida.page.click("button:text-is('Save')")
    ida.page.wait_for_url("**saved=yes")
    ada.page.fill("#field-traffic-cars", "6")
    ada.page.click("button:text-is('Save')")
    expect(ada.page.locator(".message").first).to_contain_text("Somebody changed 'shared-job' since you opened it")
    assert "cars = 5\n" in stored(sessions, "shared-job").read_text(encoding="utf-8")
    wait_until_checked(ada.page)
    assert ada.page.input_value("#field-traffic-cars") == "6", "Ada's version is kept on her page"
    ada.wrong = [wrong for wrong in ada.wrong if "409" not in wrong]
    ada.check()
    # Under another name, and then over the other version.
    ada.page.fill("#new-name", "shared-job-2")
    ada.page.keyboard.press("Enter")
    ada.page.wait_for_url("**/scenarios/shared-job-2/edit?saved=yes")
    assert "cars = 6\n" in stored(sessions, "shared-job-2").read_text(encoding="utf-8")
    # A name that is taken is refused, even to somebody who opened another scenario.
    wait_until_checked(ada.page)
    ada.page.fill("#new-name", "shared-job")
    ada.page.click("button:text-is('Save as')")
    expect(ada.page.locator(".message").first).to_contain_text("There is already a scenario 'shared-job'")
    assert "cars = 5\n" in stored(sessions, "shared-job").read_text(encoding="utf-8")
    assert ida.wrong == []


def test_wire_save_follows_the_rules_of_uploads(server, sessions):
    ida = upload(server, "ruled-job")
    save = lambda text, **fields: ida.post("/scenarios", "/scenario-editor/save", {"text": text, **fields})
    named = lambda name: PRACTICE.replace('name = "practice"', f'name = "{name}"')
    for text, status, said in [
        (PRACTICE, 422, "name of a shipped scenario"), (named("new"), 422, "name of a page"), (named("../x"), 422, "invalid name"),
        (named("bad").replace("turbulence = 0.5", "turbulence = 50"), 422, "allowed: 0 to 5"), ("]]]", 422, "syntax"), (named("ruled-job"), 409, "already a scenario"),
    ]:
        got, _, page = save(text)
        assert got == status and said in page, (said, got, page)
    status, headers, _ = save(PRACTICE.replace("\n", "\r\n"), save_as="yes", new_name="windows-lines")
    assert status == 303 and headers["Location"] == "/scenarios/windows-lines/edit?saved=yes"
    assert "\r" not in stored(sessions, "windows-lines").read_bytes().decode()
    # The version of the opened file decides; "overwrite" replaces any version.
    version = re.search(r'name="version" value="([0-9a-f]{64})"', ida.ask("/scenarios/ruled-job/edit")[2]).group(1)
    assert save(named("ruled-job") + "# one\n", opened="ruled-job", version=version)[0] == 303
    assert save(named("ruled-job") + "# two\n", opened="ruled-job", version=version)[0] == 409
    assert save(named("ruled-job") + "# two\n", opened="ruled-job", version=version, overwrite="yes")[0] == 303
    assert stored(sessions, "ruled-job").read_text(encoding="utf-8").endswith("# two\n")
    assert ida.post("/scenarios/ruled-job", "/scenarios/ruled-job/remove", {})[0] == 303
    status, _, page = save(named("ruled-job"), opened="ruled-job", version=version)
    assert status == 409 and "deleted" in page
    status, headers, text = ida.post("/scenarios", "/scenario-editor/download", {"text": "name = '../../x'\r\n"})
    assert status == 200 and headers["Content-Disposition"] == 'attachment; filename="scenario.toml"' and text == "name = '../../x'\n"


def test_wire_instructor_adds_and_removes_pictures_of_the_briefing(browser, server, sessions):
    upload(server, "with-pictures")
    folder = sessions / "scenarios" / "with-pictures"
    ida = BrowserUser(browser, server, "ida")
    page = ida.page
    ida.go("/scenarios/with-pictures")
    for name, caption in [("Gate & road.PNG", "The gate, seen from the road"), ("pier.png", "Begin at this pier")]:
        page.set_input_files("input[type=file]", {"name": name, "mimeType": "image/png", "buffer": webserver.png()})
        page.fill("[name=caption]", caption)
        page.click("button:text-is('Add the picture')")
        expect(page.locator(f"#pictures figcaption:text-is('{caption}')")).to_be_visible()
    assert sorted(path.name for path in folder.iterdir()) == ["Gate---road.png", "pier.png"]
    text = stored(sessions, "with-pictures").read_text(encoding="utf-8")
    assert text.startswith(PRACTICE.splitlines()[0]), "the comment of the shipped file remains"
    assert 'file = "with-pictures/Gate---road.png"\ncaption = "The gate, seen from the road"\n' in text
    found = json.loads(spandrel.run("check", str(stored(sessions, "with-pictures")), "--json"))
    assert found["problems"] == []
    loaded = "images => images.map(image => image.complete ? image.naturalWidth : 0)"
    check_in_every_size_and_theme(ida, "pictures")
    # A trainee sees them in the briefing, and neither forms nor buttons for them.
    anna = BrowserUser(browser, server, "anna")
    anna.go("/scenarios/with-pictures/briefing")
    assert anna.page.locator("#pictures img").evaluate_all(loaded) == [40, 40]
    assert anna.page.locator("#pictures figcaption").all_inner_texts() == ["The gate, seen from the road", "Begin at this pier"]
    anna.check()
    anna.save_screenshot("briefing-pictures")
    anna.page.evaluate("() => { window.print = () => { window.prints = (window.prints || 0) + 1; }; }")
    anna.page.click("#print")
    assert anna.page.evaluate("window.prints") == 1
    printed = anna.page.pdf(format="A4", print_background=True)
    assert printed.startswith(b"%PDF") and printed.count(b"/Subtype /Image") >= 2, "the print must contain both pictures"
    anna.page.emulate_media(media="print")
    assert not anna.page.is_visible("#print") and not anna.page.is_visible("header.bar nav") and anna.page.is_visible("#check")
    anna.page.emulate_media(media="screen")
    anna.go("/scenarios/with-pictures")
    assert anna.page.locator("#pictures").count() == 0
    # The editor shows both, and a copy has files of its own.
    ida.go("/scenarios/with-pictures/edit")
    wait_until_checked(page)
    assert page.input_value("#field-briefing_pictures-1-file") == "with-pictures/pier.png"
    page.fill("#new-name", "pictures-copy")
    page.click("button:text-is('Save as')")
    page.wait_for_url("**/scenarios/pictures-copy/edit?saved=yes")
    assert 'file = "pictures-copy/pier.png"' in stored(sessions, "pictures-copy").read_text(encoding="utf-8")
    # A picture is removed with its file; the copy keeps its own.
    ida.go("/scenarios/with-pictures")
    page.click("#pictures button[aria-label='Remove the picture: Begin at this pier']")
    expect(page.locator("#pictures figcaption")).to_have_count(1)
    assert [path.name for path in folder.iterdir()] == ["Gate---road.png"]
    ida.go("/scenarios/pictures-copy/briefing")
    assert page.locator("#pictures img").evaluate_all(loaded) == [40, 40]
    ida.go("/scenarios/with-pictures")
    page.click("text=Delete this scenario")
    page.wait_for_url("**/scenarios")
    assert not folder.exists() and not stored(sessions, "with-pictures").exists()
    assert ida.wrong == [] and anna.wrong == []


def test_wire_pictures_of_a_scenario_that_somebody_changed_are_not_changed(server, sessions):
    ida = upload(server, "pictured")
    version = lambda: re.search(r'name="version" value="([0-9a-f]{64})"', ida.ask("/scenarios/pictured")[2]).group(1)
    add = lambda fields, file=webserver.png(), name="gate.png": ida.upload("/scenarios/pictured", "/scenarios/pictured/pictures", fields, file, name)
    opened = version()
    assert add({"version": opened, "caption": "The gate"})[0] == 303
    status, _, page = add({"version": opened, "caption": "The gate"})
    assert status == 409 and "Somebody changed" in page
    remove = lambda fields: ida.post("/scenarios/pictured", "/scenarios/pictured/pictures/remove", fields)
    assert remove({"version": opened, "file": "pictured/gate.png"})[0] == 409
    assert [path.name for path in (sessions / "scenarios" / "pictured").iterdir()] == ["gate.png"]
    # A text without the table removes the file.
    text = stored(sessions, "pictured").read_text(encoding="utf-8").split("\n[[briefing_pictures]]")[0] + "\n"
    fields = {"text": text, "opened": "pictured", "version": version()}
    assert ida.post("/scenarios", "/scenario-editor/save", fields)[0] == 303
    assert not (sessions / "scenarios" / "pictured").exists()
    for number in range(6):
        assert add({"version": version(), "caption": f"Picture {number}"})[0] == 303
    status, _, page = add({"version": version(), "caption": "One more"})
    assert status == 422 and "already 6 pictures" in page
    assert len(list((sessions / "scenarios" / "pictured").iterdir())) == 6
    # A missing file is named, and its entry can be removed.
    (sessions / "scenarios" / "pictured" / "gate-2.png").unlink()
    assert "The picture pictured/gate-2.png is missing." in ida.ask("/scenarios/pictured/briefing")[2]
    assert remove({"version": version(), "file": "pictured/gate-2.png"})[0] == 303
    assert "is missing" not in ida.ask("/scenarios/pictured/briefing")[2]


def test_wire_shipped_scenarios_are_copied_not_changed(browser, server):
    ida = BrowserUser(browser, server, "ida")
    ida.go("/scenarios/two-bridges")
    ida.page.click("text=Make a copy to edit")
    assert ida.page.input_value("[name=from]") == "two-bridges"
    ida.go("/scenarios/two-bridges/edit")
    assert ida.page.url.endswith("/scenarios/new?base=two-bridges")
    assert ida.wrong == []


def test_wire_trainees_and_strangers_are_refused(server):
    upload(server, "not-for-trainees")
    anna = webserver.Browser(server.address)
    assert anna.log_in("anna") == 303
    for path in ["/scenarios/new", "/scenarios/new?from=practice&name=x", "/scenarios/not-for-trainees/edit"]:
        assert anna.ask(path)[0] == 403, path
    for action in ["check", "save", "download"]:
        assert anna.post("/sessions", f"/scenario-editor/{action}", {"text": PRACTICE})[0] == 403, action
    page = anna.ask("/scenarios/not-for-trainees")[2]
    assert "/edit" not in page and "/scenarios/new" not in page and "/scenarios/new" not in anna.ask("/scenarios")[2]
    stranger = webserver.Browser(server.address)
    status, headers, _ = stranger.ask("/scenarios/new")
    assert (status, headers["Location"]) == (303, "/login")


def test_wire_editor_works_without_scripts(browser, server, sessions):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(server.address + "/login")
    page.fill("[name=name]", "ida")
    page.fill("[name=password]", webserver.PASSWORD)
    page.click("main button[type=submit]")
    page.goto(f"{server.address}/scenarios/new?from=practice&name=no-script")
    expect(page.locator("#fields")).to_be_hidden()
    text = page.input_value("#text")
    page.fill("#text", text.replace("cars = 4", "cars = 4000"))
    page.click("button:text-is('Check')")
    expect(page.locator("#findings")).to_contain_text("out of range (allowed: whole number 0 to 400)")
    page.fill("#text", text.replace("cars = 4", "cars = 40"))
    page.click("button:text-is('Check')")
    expect(page.locator("#status")).to_contain_text("No problems")
    assert page.locator("#preview svg").count() == 4
    page.click("button:text-is('Save')")
    assert page.url.endswith("/scenarios/no-script/edit?saved=yes")
    assert "cars = 40\n" in stored(sessions, "no-script").read_text(encoding="utf-8")


def test_wire_large_and_hostile_scenarios_end_in_time(server):
    ida = webserver.Browser(server.address)
    assert ida.log_in("ida") == 303
    json_answer = {"Accept": "application/json"}
    token = ida.token("/scenarios")
    check = lambda text, edits="[]": ida.ask("/scenario-editor/check", {"token": token, "text": text, "edits": edits}, json_answer)
    head = PRACTICE.split("[[bridges]]")[0].replace("size_m = 800.0", "size_m = 4000.0").replace("spacing_m = 4.0", "spacing_m = 2.0")
    bridges = "".join(
        f'[[bridges]]\nname = "b{k}"\ntype = "suspension"\ncentre_m = [0, {100 * k - 800}, 60]\n[bridges.suspension]\nmain_span_m = 1400\nsag_m = 100\n'
        "side_span_m = 400\nhanger_spacing_m = 3\n" for k in range(16)
    )
    tasks = "".join(f'[[tasks]]\nname = "t{k}"\nkind = "pier_circle"\nbridge = "b{k % 16}"\n' for k in range(64))
    rest = '[defects]\ncount = 200\ndetection_pct = 50\n[traffic]\ncars = 400\n'
    forms = "".join(f'[[forms]]\nname = "F{k}"\ndefect_seed = {k}\n' for k in range(26))
    hostile = {
        "large": head + bridges + tasks + rest + forms,
        "many tasks": head + bridges + '[[tasks]]\nname = "t"\nkind = "free"\npoints_m = [[-5000, 0, 50], [5000, 0, 50], [-5000, 0, 51]]\n' * 2500,
        "deep": "a = " + "[" * 20_000 + "]" * 20_000,
        "many tables": "[[x]]\n" * 40_000,
    }
    for name, text in hostile.items():
        status, _, answer = check(text)
        assert status == 200, (name, status)
        assert name == "large" or json.loads(answer)["problems"], name
    for edits in ["x", "[1]", json.dumps([{"add": "tasks"}] * 65)]:
        assert check(PRACTICE, edits)[0] == 422, edits
    unknown = json.loads(check(PRACTICE, json.dumps([{"set": "wind.x", "text": "1"}]))[2])
    assert unknown["text"] == PRACTICE and "wind.x" in unknown["rejected"]

"""The video of a flight in a real browser: beside the report, and on the session's page of the web server."""

import pytest
from playwright.sync_api import expect

import display
import spandrel
import webserver
from test_report import open_page, save_screenshot, set_slider
from test_web import BrowserUser, browser  # noqa: F401 (`browser` is a fixture)

# Small and slow, so that a software driver renders it quickly.
SIZE, FPS = "160x120", 2
# The slider and the video agree within one picture, s.
PICTURE_S = 1.0 / FPS
# Moment of the instructor's mark, s since lift-off.
MARK_S = 5


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    """A short flight with a video, photographs and a web login."""
    assert display.DRIVERS, "Mesa's software Vulkan is missing: apt-get install mesa-vulkan-drivers"
    sessions = tmp_path_factory.mktemp("video") / "sessions"
    arguments = ["--scenario", "drill-framing", "--skill", "expert", "--seed", "7", "--speed", "max", "--trainee", "anna"]
    spandrel.run("demo", *arguments, "--sessions", str(sessions))
    (folder,) = sessions.iterdir()
    small = ["--quality", "low", "--size", SIZE]
    spandrel.run("render", str(folder), "--snapshots", *small, program=spandrel.COCKPIT)
    spandrel.run("render", str(folder), "--video", "--fps", str(FPS), *small, program=spandrel.COCKPIT)
    spandrel.run("records", "import", "--sessions", str(sessions))
    webserver.set_passwords(sessions, "anna", "ben")
    return folder


@pytest.fixture(scope="module")
def sessions(session):
    """The folder that contains the flight."""
    return session.parent


def video(page, value):
    """Returns a value of the video element, such as its current time."""
    return page.evaluate(f"document.querySelector('video').{value}")


def slider_s(page):
    """The time that the slider shows, s since lift-off."""
    minutes, seconds = page.inner_text("#moment-text").split(":")
    return 60 * int(minutes) + int(seconds)


@pytest.mark.timeout(900)
def test_regress_video_and_slider_follow_each_other(browser, session):
    page, wrong = open_page(browser, session / "report.html")
    spandrel.wait_for("the video", lambda: video(page, "readyState") >= 1)
    last = int(page.get_attribute("#moment", "max"))
    set_slider(page, last)
    end_s = slider_s(page)
    duration_s = video(page, "duration")
    assert abs(duration_s - end_s) < 1.0 + PICTURE_S, (duration_s, end_s)
    set_slider(page, last // 2)
    middle_s = slider_s(page)
    spandrel.wait_for("the slider's moment", lambda: abs(video(page, "currentTime") - middle_s) < 1.0 + PICTURE_S)
    page.locator("#video").scroll_into_view_if_needed()
    save_screenshot(page, "report-video")
    video(page, "currentTime = 3.0")
    spandrel.wait_for("the slider at the video's moment", lambda: slider_s(page) == 3)
    video(page, "play()")
    spandrel.wait_for("the video to move the slider", lambda: slider_s(page) > 3)
    set_slider(page, 0)
    spandrel.wait_for("the start", lambda: video(page, "paused") and video(page, "currentTime") < PICTURE_S)
    assert not wrong, wrong


@pytest.mark.timeout(900)
def test_regress_session_page_shows_video_and_photographs(browser, server, session):
    ida, path = webserver.Browser(server.address), f"/sessions/{session.name}"
    ida.log_in("ida")
    assert ida.post(path, f"{path}/marks", {"time": f"0:{MARK_S:02}", "text": "Look here"})[0] == 303
    anna = BrowserUser(browser, server, "anna")
    page = anna.page
    expect(page.get_by_role("heading", name="Sessions")).to_be_visible()
    anna.go(path)
    spandrel.wait_for("the video", lambda: video(page, "readyState") >= 1)
    moment = page.locator("#video-moments button").first
    moment.click()
    spandrel.wait_for("the marked moment", lambda: abs(video(page, "currentTime") - MARK_S) < PICTURE_S)
    pictures = page.locator(".photographs img")
    pictures.last.scroll_into_view_if_needed()
    spandrel.wait_for("the photographs", lambda: pictures.last.evaluate("picture => picture.naturalWidth") > 0)
    assert pictures.count() == len(list((session / "snapshots").glob("*.jpg")))
    anna.save_screenshot("session-video")
    anna.check()
    page.locator(".photographs a").first.click()
    expect(page.locator("#picture-1")).to_be_visible()


@pytest.mark.timeout(900)
def test_regress_served_report_plays_its_video_until_logout(browser, server, session):
    """The sandboxed report sends no cookie; its own address of the video ends with the login that it was made for."""
    anna = BrowserUser(browser, server, "anna")
    page = anna.page
    expect(page.get_by_role("heading", name="Sessions")).to_be_visible()
    page.goto(server.address + f"/sessions/{session.name}/report")
    spandrel.wait_for("the video", lambda: video(page, "readyState") >= 1)
    assert page.locator("#video-missing").is_hidden()
    set_slider(page, 0)
    video(page, "play()")
    spandrel.wait_for("the video to move the slider", lambda: slider_s(page) > 0)
    assert not anna.wrong, anna.wrong
    address = page.get_attribute("#video", "src")
    stranger = webserver.Browser(server.address)
    assert stranger.ask(address)[0] == 200
    wrong = address[:-len("/video.mp4") - 1] + "x/video.mp4"
    assert stranger.ask(wrong)[0] == 404
    anna.go("/sessions")
    page.click("text=Log out")
    expect(page.get_by_label("Password")).to_be_visible()
    assert stranger.ask(address)[0] == 404


def test_wire_video_is_sent_in_parts_and_only_to_its_trainee(server, session):
    path, size = f"/sessions/{session.name}/video.mp4", (session / "video.mp4").stat().st_size
    anna, ben = webserver.Browser(server.address), webserver.Browser(server.address)
    assert ben.ask(path)[0] in (303, 401)
    anna.log_in("anna")
    ben.log_in("ben")
    status, headers, text = anna.ask(path, headers={"Range": "bytes=4-11"})
    assert (status, headers["Content-Range"], text[:4]) == (206, f"bytes 4-11/{size}", "ftyp")
    assert anna.ask(path, headers={"Range": f"bytes={size}-"})[0] == 416
    status, headers, _ = anna.ask(path)
    assert (status, headers["Accept-Ranges"], int(headers["Content-Length"])) == (200, "bytes", size)
    others = [path, f"/sessions/{session.name}/video.vtt", f"/sessions/{session.name}/pictures/0.jpg"]
    assert [ben.ask(other)[0] for other in others] == [404, 404, 404]
    assert anna.ask(f"/sessions/{session.name}/pictures/..%2Freport.jpg")[0] == 404

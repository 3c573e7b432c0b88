"""The camera view on the live page: a window on a virtual display provides it, and the server shows it to authorized
users."""

import shutil
import subprocess

import pytest
from playwright.sync_api import sync_playwright

import display
import spandrel
import webserver

# Time limit for a software driver on a busy machine to compile its shaders and render, ms (ten times the usual).
PATIENCE_MS = 400_000
# Minimum brightness range in the picture, out of 255, because it must show ground and sky rather than a single color.
BRIGHTNESS_RANGE = """image => {
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  const context = canvas.getContext('2d');
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
  let low = 255, high = 0;
  for (let k = 0; k < pixels.length; k += 4) { low = Math.min(low, pixels[k]); high = Math.max(high, pixels[k]); }
  return high - low;
}"""


@pytest.mark.timeout(900)
def test_wire_only_instructors_see_the_live_camera(tmp_path):
    sessions, picture = tmp_path / "sessions", tmp_path / "camera.jpg"
    sessions.mkdir()
    for name, role in [("ida", "instructor"), ("anna", "trainee")]:
        webserver.set_password(sessions, name, role)
    screen = display.Display(tmp_path)
    watcher, payload = spandrel.free_udp_port(), spandrel.free_udp_port()
    sim = spandrel.start_sim(tmp_path, watcher, speed=1, payload_port=payload)
    server = webserver.Server(sessions, "--picture", str(picture), vehicle=f"127.0.0.1:{payload}")
    log = open(tmp_path / "view.txt", "w", encoding="utf-8")
    window = subprocess.Popen(
        [spandrel.COCKPIT, "view", "--scenario", "drill-hover", "--seed", "7", "--size", "1280x360", "--picture", str(picture), "--leash",
         "--connect", f"127.0.0.1:{payload}"],
        stdin=subprocess.PIPE, stdout=log, stderr=log, env=screen.environment(),
    )
    try:
        with sync_playwright() as playwright:
            chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            page = chromium.new_page(viewport={"width": 1280, "height": 900})
            page.set_default_timeout(PATIENCE_MS)
            wrong = []
            page.on("console", lambda m: wrong.append(m.text) if m.type in ("error", "warning") else None)
            page.goto(server.address + "/login")
            page.fill("[name=name]", "ida")
            page.fill("[name=password]", webserver.PASSWORD)
            page.click("main button[type=submit]")
            page.goto(server.address + "/live")
            loaded = "() => { const image = document.querySelector('[data-camera] img'); return image && image.naturalWidth > 0; }"
            page.wait_for_function(loaded)
            image = page.locator("[data-camera] img")
            assert image.is_visible() and image.evaluate(BRIGHTNESS_RANGE) > 40, "the picture must not be blank"
            first = image.get_attribute("src")
            page.wait_for_function("before => document.querySelector('[data-camera] img').getAttribute('src') !== before", arg=first)
            page.wait_for_function(loaded)
            anna = webserver.Browser(server.address)
            assert anna.ask("/live/camera.jpg")[0] == 303 and anna.log_in("anna") == 303
            assert anna.ask("/live/camera.jpg")[0] == 403
            ida = webserver.Browser(server.address)
            assert ida.log_in("ida") == 303 and ida.ask("/live/camera.jpg?vehicle=2")[0] == 422
            status, headers, _ = ida.ask("/live/camera.jpg")
            assert status == 200 and headers["Content-Type"] == "image/jpeg" and headers["Cache-Control"] == "no-store"
            # When the window closes, its picture disappears.
            window.stdin.close()
            assert window.wait(timeout=webserver.PATIENCE_S) == 0, (tmp_path / "view.txt").read_text(encoding="utf-8")
            assert not picture.exists()
            page.wait_for_selector("[data-camera]", state="hidden")
            assert ida.ask("/live/camera.jpg")[0] == 404
            # Other content in the file is not a picture and must not be served.
            picture.write_text("<script>alert(1)</script>", encoding="utf-8")
            assert ida.ask("/live/camera.jpg")[0] == 404
            page.close()
            # The last picture may have been requested while it was being removed.
            assert [text for text in wrong if "404" not in text] == []
            chromium.close()
    finally:
        for process in (window, sim):
            spandrel.end(process)
        server.close()
        screen.close()

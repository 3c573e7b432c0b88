"""Attacks: other sites, stored scripts, paths, uploads, password guessing, planted cookies, floods, power cuts."""

import concurrent.futures
import json
import random
import re
import socket
import subprocess
import time
import urllib.parse

import pytest

import spandrel
import webserver

EVIL = "<script>alert(1)</script>"
# Number of times that the server is killed, each at a random moment.
KILLS = 200
SEED = 20260801


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """One session each by Anna and Ben."""
    folder = tmp_path_factory.mktemp("attacks") / "sessions"
    webserver.flown(folder, "anna", "ben")
    spandrel.run("records", "import", "--sessions", str(folder))
    webserver.set_passwords(folder, "anna", "ben")
    return folder


def logged_in(server, name):
    browser = webserver.Browser(server.address)
    assert browser.log_in(name) == 303
    return browser


def session_folder(sessions, trainee):
    return next(path.name for path in sessions.iterdir() if f"-{trainee}-" in path.name)


def forms(sessions):
    """Returns all forms of the server with page, target and fields. Add new forms here."""
    anna = session_folder(sessions, "anna")
    return {
        "/logout": ("/sessions", {}),
        "/language": ("/sessions", {"language": "de", "back": "/sessions"}),
        "/account": ("/account", {"present": "x" * 12, "new": "y" * 12}),
        f"/sessions/{anna}/questions": (f"/sessions/{anna}/questions", {"frustration": "3"}),
        "/trainees/anna/details": ("/trainees/anna", {"age_band": "25-34"}),
        "/trainees/nobody/erase": ("/trainees", {"again": "nobody"}),
        f"/sessions/{anna}/marks": (f"/sessions/{anna}", {"time": "0:01", "text": "x"}),
        f"/sessions/{anna}/marks/remove": (f"/sessions/{anna}", {"mark": "1"}),
        "/trainees/anna/rubric": ("/trainees/anna", {"criterion": "path", "action": "signed_off"}),
        "/rubric": ("/rubric", {"rubric": "format = 1"}),
        "/rubric/reset": ("/rubric", {}),
        "/classes": ("/classes", {"name": "x"}),
        "/classes/none/members": ("/classes", {"trainees": "anna"}),
        "/classes/none/members/remove": ("/classes", {"trainee": "anna"}),
        "/classes/none/remove": ("/classes", {}),
        "/assign": ("/assign?trainee=anna", {"trainee": "anna", "scenario": "drill-hover", "due": "2099-01-01"}),
        "/assignments/none/remove": ("/classes", {}),
        "/scenarios/none/remove": ("/scenarios", {}),
        "/scenarios/none/pictures/remove": ("/scenarios", {"file": "none/a.png", "version": "x"}),
        "/scenario-editor/check": ("/scenarios", {"text": "name = 'x'"}),
        "/scenario-editor/save": ("/scenarios", {"text": "name = 'x'"}),
        "/scenario-editor/download": ("/scenarios", {"text": "name = 'x'"}),
        "/plan-rules": ("/plan-rules", {"rules": "format = 1"}),
        "/plan-rules/reset": ("/plan-rules", {}),
        "/stations": ("/stations", {"station": "s1", "trainee": "anna", "scenario": "drill-hover", "purpose": "practice"}),
        "/live/act": ("/sessions", {"act": "note", "text": "x"}),
        "/settings/login": ("/settings", {"name": "eve", "role": "trainee", "password": webserver.PASSWORD}),
        "/settings/no-login": ("/settings", {"name": "nobody"}),
        "/settings/retention": ("/settings", {"days": "36525", "sure": "yes"}),
    }


def test_cross_site_requests_are_rejected(server, sessions):
    ada = logged_in(server, "ada")
    token = ada.token("/sessions")
    for path, (_, fields) in forms(sessions).items():
        for name, form, headers in [
            ("without a token", fields, {}),
            ("with a wrong token", {"token": "0" * 64, **fields}, {}),
            ("from another site's page", {"token": token, **fields}, {"Origin": "https://evil.example"}),
            ("from a hidden page", {"token": token, **fields}, {"Origin": "null"}),
            ("marked as cross-site by the browser", {"token": token, **fields}, {"Sec-Fetch-Site": "cross-site"}),
        ]:
            status, _, _ = ada.ask(path, form, headers)
            assert status == 403, (path, name, status)
    # A picture or a link on another site sends GET requests, which must not change anything.
    for path in forms(sessions):
        status, _, _ = ada.ask(path)
        assert status in (200, 404, 405), (path, status)
    status, _, text = ada.ask("/settings")
    assert status == 200 and "eve" not in text
    for path in ("/scenarios", "/upload", "/plan-rules/upload", "/scenarios/none/pictures"):
        status, _, _ = ada.upload("/sessions", path, {"trainee": "x", "scenario": "drill-hover", "vehicle": "phantom2"}, b"x", token="0" * 64)
        assert status == 403, path


def test_language_form_never_leads_to_another_site(server):
    ada = logged_in(server, "ada")
    token = ada.token("/sessions")
    select = lambda language, back: ada.ask("/language", {"token": token, "language": language, "back": back})
    for back in ("https://evil.example/", "//evil.example", "/\\evil.example", "\\\\evil.example", "/\t/evil.example", "javascript:alert(1)", ""):
        status, headers, _ = select("de", back)
        assert (status, headers["Location"]) == (303, "/"), back
    status, headers, _ = select("de", "/sessions?page=2")
    assert (status, headers["Location"]) == (303, "/sessions?page=2")
    cookie = headers["Set-Cookie"]
    assert cookie.startswith("spandrel-language=de;") and {"HttpOnly", "SameSite=Lax", "Path=/"} <= set(cookie.split("; ")), cookie
    german = lambda language: "<h1>Sitzungen</h1>" in ada.ask("/sessions", headers={"Cookie": f"{ada.cookie}; spandrel-language={language}"})[2]
    assert german("de") and not german("es") and not german(EVIL) and not german("de-AT-x")
    assert select(EVIL, "/")[0] == 422


def test_attack_tests_cover_every_form(sessions):
    """Compares the server's table of routes with the list above."""
    source = (spandrel.ROOT / "src" / "web" / "routes.rs").read_text(encoding="utf-8")
    changes = set(re.findall(r'(?:change|text)\(\s*"([^"]+)"', source)) - {"/login"}
    listed = {re.sub(r"/(sessions|trainees|scenarios|classes|assignments)/[^/]+/", r"/\1/{}/", path) for path in forms(sessions)}
    assert {re.sub(r"\{\w+\}", "{}", path) for path in changes} == listed


def test_script_in_any_field_is_escaped(server, sessions):
    ada = logged_in(server, "ada")
    anna = session_folder(sessions, "anna")
    tries = [
        ("/trainees/anna", "/trainees/anna/details", {"age_band": EVIL}),
        ("/settings", "/settings/login", {"name": EVIL, "role": "trainee", "password": webserver.PASSWORD}),
        ("/settings", "/settings/login", {"name": "eve", "role": EVIL, "password": webserver.PASSWORD}),
        ("/settings", "/settings/no-login", {"name": EVIL}),
        ("/settings", "/settings/retention", {"days": EVIL, "sure": EVIL}),
        (f"/sessions/{anna}/questions", f"/sessions/{anna}/questions", {"frustration": EVIL}),
        ("/trainees", f"/trainees/{urllib.parse.quote(EVIL)}/erase", {"again": EVIL}),
        ("/account", "/account", {"present": EVIL, "new": EVIL}),
        ("/sessions", "/live/act", {"act": EVIL, "text": EVIL}),
        (f"/sessions/{anna}", f"/sessions/{anna}/marks", {"time": EVIL, "text": EVIL}),
        (f"/sessions/{anna}", f"/sessions/{anna}/marks", {"time": "0:01", "text": EVIL}),
        (f"/sessions/{anna}", f"/sessions/{anna}/marks/remove", {"mark": EVIL}),
        ("/trainees/anna", "/trainees/anna/rubric", {"criterion": EVIL, "action": EVIL, "note": EVIL}),
        ("/trainees/anna", "/trainees/anna/rubric", {"criterion": "path", "action": "signed_off", "note": EVIL}),
        ("/rubric", "/rubric", {"rubric": EVIL}),
        ("/scenarios", "/scenario-editor/check", {"text": f"title = '{EVIL}'", "opened": EVIL, "version": EVIL}),
        ("/scenarios", "/scenario-editor/check", {"text": EVIL, "edits": json.dumps([{"set": EVIL, "text": EVIL}])}),
        ("/scenarios", "/scenario-editor/check", {"text": EVIL, "defect": EVIL}),
        ("/scenarios", "/scenario-editor/check", {"text": EVIL, "defect": json.dumps({"kind": 1130, "condition_state": 3, "length_m": EVIL, "width_mm": EVIL, "turn_deg": EVIL, "place": {"near": [EVIL] * 3}})}),
        ("/scenarios", "/scenario-editor/save", {"text": EVIL, "opened": EVIL, "version": EVIL, "save_as": "yes", "new_name": EVIL}),
        ("/stations", "/stations", {"station": EVIL, "trainee": EVIL, "scenario": EVIL, "purpose": EVIL}),
        ("/stations", "/stations", {"station": EVIL, "trainee": "anna", "scenario": "drill-hover", "purpose": "practice"}),
        ("/classes", "/classes", {"name": EVIL}),
        ("/classes", "/classes/none/members", {"trainees": EVIL}),
        ("/classes", "/assign", {"trainee": EVIL, "scenario": EVIL, "variant": EVIL, "due": EVIL}),
        ("/classes", "/assign", {"trainee": "anna", "scenario": "drill-hover", "variant": EVIL, "due": EVIL}),
    ]
    for page, path, fields in tries:
        status, headers, text = ada.post(page, path, fields)
        assert status != 500 and "<script>" not in text, (path, status)
        assert "script-src 'self'" in headers["Content-Security-Policy"]
    for path in [f"/sessions?trainee={urllib.parse.quote(EVIL)}", f"/cohort?scenario={urllib.parse.quote(EVIL)}", f"/trainees/{urllib.parse.quote(EVIL)}",
                 f"/scenarios/{urllib.parse.quote(EVIL)}", f"/compare?first={urllib.parse.quote(EVIL)}", f"/classes/{urllib.parse.quote(EVIL)}",
                 f"/scenarios/new?base={urllib.parse.quote(EVIL)}&name={urllib.parse.quote(EVIL)}", f"/scenarios/new?from=practice&name={urllib.parse.quote(EVIL)}",
                 f"/assign?trainee=anna&scenario={urllib.parse.quote(EVIL)}&variant={urllib.parse.quote(EVIL)}", f"/{urllib.parse.quote(EVIL)}"]:
        status, _, text = ada.ask(path)
        assert status != 500 and "<script>" not in text, (path, status)
    # The stored note and mark are shown as text.
    for path in ("/trainees/anna/rubric", f"/sessions/{anna}", f"/sessions/{anna}/report"):
        status, _, text = ada.ask(path)
        assert status == 200 and "alert(1)" in text and EVIL not in text, path
    # Names in files and the database may come from other sources: a scenario, a session, a login log.
    evil = (spandrel.ROOT / "scenarios" / "drill-hover.toml").read_text(encoding="utf-8")
    evil = re.sub(r'^title = .*$', f'title = "{EVIL}"', evil, count=1, flags=re.MULTILINE).replace('name = "drill-hover"', 'name = "evil-title"')
    status, _, text = ada.upload("/scenarios", "/scenarios", {}, evil.encode(), EVIL + ".toml")
    assert status == 200 and "<script>" not in text and "&lt;script&gt;" in text
    status, _, text = ada.ask("/scenarios/evil-title")
    assert status == 200 and "<script>" not in text and "&lt;script&gt;" in text
    stranger = webserver.Browser(server.address)
    status, _, text = stranger.post("/login", "/login", {"name": EVIL, "password": EVIL})
    assert status == 403 and "<script>" not in text
    ada.post("/scenarios/evil-title", "/scenarios/evil-title/remove", {})


def test_hostile_task_name_is_escaped_everywhere(server, sessions, tmp_path):
    """A task with a script as its name is flown several times. Every page that shows the name escapes it."""
    job = (spandrel.ROOT / "scenarios" / "drill-hover.toml").read_text(encoding="utf-8")
    evil = re.sub(r'(\[\[tasks\]\](?:\n(?!\[).*)*?\nname = )"[^"]*"', lambda found: f'{found.group(1)}"{EVIL}"', job)
    evil = evil.replace('name = "drill-hover"', 'name = "evil-task"')
    assert evil.count(EVIL) == 1 and 'name = "evil-task"' in evil, "the scenario has changed, so this test no longer plants its name"
    (tmp_path / "evil.toml").write_text(evil, encoding="utf-8")
    before = set(sessions.iterdir())
    for seed in ("1", "2", "3", "4"):
        spandrel.run("demo", "--scenario", str(tmp_path / "evil.toml"), "--skill", "novice", "--seed", seed, "--speed", "max",
                     "--trainee", "mallory", "--sessions", str(sessions))
    first, second, *_ = sorted(path.name for path in set(sessions.iterdir()) - before if (path / "telemetry.tlog").is_file())
    ida = logged_in(server, "ida")
    flown = lambda: ida.ask("/trainees/mallory")[2].count('href="/sessions/') >= 4
    spandrel.wait_for("the server imports the flights", flown)
    shown = {
        "session": f"/sessions/{first}", "report": f"/sessions/{first}/report", "questions": f"/sessions/{first}/questions",
        "comparison": f"/compare?first={first}&second={second}", "trainee": "/trainees/mallory",
        "cohort": "/cohort?scenario=evil-task&repetitions=2", "cohort's page": "/cohort/report.html?scenario=evil-task&repetitions=2",
    }
    for name, path in shown.items():
        status, _, text = ida.ask(path)
        assert status == 200 and "alert(1)" in text, f"{name}: the name is missing, so the test is pointless"
        assert EVIL not in text, name
    for path in ["/sessions?trainee=mallory", "/trainees/mallory/export.json", "/cohort/tables/conformity_by_task.csv?scenario=evil-task"]:
        status, headers, text = ida.ask(path)
        assert status == 200 and (EVIL not in text or headers.get_content_type() != "text/html"), path
    assert logged_in(server, "ada").post("/trainees/mallory", "/trainees/mallory/erase", {"again": "mallory"})[0] == 303


def test_path_traversal_is_rejected(server, sessions):
    secret = sessions.parent / "secret"
    secret.mkdir(exist_ok=True)
    for name in ("telemetry.tlog", "report.html", "secret.toml"):
        (secret / name).write_text("secret-secret", encoding="utf-8")
    ida = logged_in(server, "ida")
    ways = ["..%2Fsecret", "%2e%2e%2fsecret", "..", "%2e%2e", "....//secret", "..%5Csecret", "%00", f"{session_folder(sessions, 'anna')}%2F..%2F..%2Fsecret",
            urllib.parse.quote(str(secret), safe=""), ".%2e%2fsecret", "..%252fsecret"]
    routes = ["/sessions/{}", "/sessions/{}/report", "/sessions/{}/frames.csv", "/sessions/{}/telemetry.tlog", "/sessions/{}/questions",
              "/scenarios/{}", "/scenarios/{}/edit", "/scenarios/new?from={}", "/assets/{}", "/trainees/{}/export.json", "/compare?first={}&second={}"]
    for route in routes:
        for way in ways:
            status, _, text = ida.ask(route.replace("{}", way))
            assert status in (400, 404, 422) and "secret-secret" not in text, (route, way, status)
    # Sent without a client that would normalize the path.
    host, port = server.address.removeprefix("http://").split(":")
    for path in ["/../../../../etc/passwd", "/assets/../../../../etc/passwd", "/sessions/../../secret/report", "//etc/passwd", "/\\..\\secret"]:
        with socket.create_connection((host, int(port))) as raw:
            raw.sendall(f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nCookie: {ida.cookie}\r\nConnection: close\r\n\r\n".encode())
            answer = b"".join(iter(lambda: raw.recv(65536), b""))
        assert b"200 OK" not in answer.split(b"\r\n")[0] and b"root:" not in answer and b"secret-secret" not in answer, path


def test_invalid_and_oversized_uploads_are_rejected(server, sessions):
    ida = logged_in(server, "ida")
    fields = {"trainee": "mallory", "scenario": "drill-hover", "vehicle": "phantom2"}
    before = sorted(path.name for path in sessions.iterdir())
    real = (sessions / session_folder(sessions, "anna") / "telemetry.tlog").read_bytes()
    generator = random.Random(SEED)
    for name, body in {
        "nothing": b"", "text": b"no recording", "noise": generator.randbytes(200_000), "half a record": real[:15],
        "another's bytes": real[: len(real) // 2][::-1], "the ground alone": real[:20_000],
    }.items():
        status, _, text = ida.upload("/upload", "/upload", fields, body)
        assert status == 422 and "cannot import this recording" in text, (name, status)
    for key, value in [("trainee", "../../x"), ("trainee", ""), ("scenario", "../../x"), ("scenario", "/etc/passwd"), ("vehicle", "../x")]:
        status, _, _ = ida.upload("/upload", "/upload", {**fields, key: value}, real)
        assert status == 422, (key, value)
    for name, body in {
        "nothing": b"", "noise": generator.randbytes(50_000), "no TOML": b"]]]", "deep": b"a = " + b"[" * 20_000 + b"]" * 20_000,
        "another's file": b'name = "x"\n[terrain]\nfile = "/etc/passwd"\n',
    }.items():
        status, _, text = ida.upload("/scenarios", "/scenarios", {}, body, "x.toml")
        assert status == 422 and "root:" not in text, (name, status)
    assert ida.upload("/scenarios", "/scenarios", {}, b"#" * 400_000, "x.toml")[0] == 413
    text_form = lambda text: ida.post("/scenarios", "/scenario-editor/check", {"text": text})[0]
    assert (text_form("#" * 250_000), text_form("#" * 300_000)) == (200, 413)
    status, _, _ = ida.ask("/settings/login", body=b"a=" + b"x" * 200_000, headers={"Content-Type": "application/x-www-form-urlencoded"})
    assert status in (403, 413)
    # A length above the limit ends the request before the body is sent.
    host, port = server.address.removeprefix("http://").split(":")
    with socket.create_connection((host, int(port)), timeout=webserver.PATIENCE_S) as raw:
        raw.sendall(
            f"POST /upload HTTP/1.1\r\nHost: {host}:{port}\r\nCookie: {ida.cookie}\r\nContent-Type: multipart/form-data; boundary=b\r\n"
            f"Content-Length: {10**12}\r\n\r\n--b\r\nContent-Disposition: form-data; name=\"token\"\r\n\r\nwrong\r\n--b\r\n"
            "Content-Disposition: form-data; name=\"file\"; filename=\"f\"\r\n\r\n".encode()
        )
        assert raw.recv(64).split(b" ")[1] in (b"403", b"413")
    assert sorted(path.name for path in sessions.iterdir() if not path.name.startswith(".")) == [n for n in before if not n.startswith(".")]
    assert ida.ask("/sessions")[0] == 200


def test_hostile_pictures_are_rejected(server, sessions):
    ida = logged_in(server, "ida")
    job = (spandrel.ROOT / "scenarios" / "drill-hover.toml").read_text(encoding="utf-8")
    own = job.replace('name = "drill-hover"', 'name = "pictured"')
    assert ida.upload("/scenarios", "/scenarios", {}, own.encode(), "x.toml")[0] == 200
    folder = sessions / "scenarios" / "pictured"
    version = lambda: re.search(r'name="version" value="([0-9a-f]{64})"', ida.ask("/scenarios/pictured")[2]).group(1)
    add = lambda file, name="gate.png", caption="The gate", browser=ida: browser.upload(
        "/scenarios", "/scenarios/pictured/pictures", {"version": version(), "caption": caption}, file, name
    )
    good = webserver.png()
    svg = b'<svg xmlns="http://www.w3.org/2000/svg"><script>alert(1)</script></svg>'
    for name, file in {
        "nothing": b"", "text": b"no picture", "script": svg, "page": b"<!doctype html>" + EVIL.encode(), "GIF": b"GIF89a" + bytes(200),
        "noise": random.Random(SEED).randbytes(200_000), "only the head": good[:20], "too wide": good[:16] + b"\0\0\x20\x01" + good[20:],
    }.items():
        status, _, text = add(file)
        assert status == 422 and "<script>alert" not in text, (name, status)
    for name, caption in {"none": "", "too long": "x" * 201, "two lines": "a\nb"}.items():
        assert add(good, caption=caption)[0] == 422, name
    assert add(good + bytes(4 * 1024 * 1024))[0] == 413
    assert not folder.exists(), "nothing was saved"
    # The name of the file is only a suggestion.
    for name in ["../../../evil.png", "..\\..\\evil.png", "/etc/passwd", "evil.php", ".htaccess", "a/../../b.png", "%2e%2e%2fx.png"]:
        assert add(good, name)[0] == 303, name
        new = [path for path in sessions.parent.rglob("*") if path.is_file() and path.read_bytes() == good]
        assert len(new) == 1 and new[0].parent == folder and re.fullmatch(r"\w[\w-]*\.png", new[0].name), (name, new)
        entry = f"pictured/{new[0].name}"
        token = {"version": version(), "file": entry}
        assert ida.post("/scenarios", "/scenarios/pictured/pictures/remove", token)[0] == 303
    status, _, text = add(good, caption=EVIL)
    assert status == 303 and EVIL not in ida.ask("/scenarios/pictured")[2] and EVIL not in ida.ask("/scenarios/pictured/briefing")[2]
    # Pictures are for logged-in people only, have their own type, and cannot be framed or run.
    status, headers, _ = ida.ask("/scenarios/pictured/pictures/gate.png")
    assert status == 200 and headers.get_content_type() == "image/png" and headers["X-Content-Type-Options"] == "nosniff"
    assert "default-src 'none'" in headers["Content-Security-Policy"] and headers["Cache-Control"] == "no-store"
    anna = logged_in(server, "anna")
    assert anna.ask("/scenarios/pictured/pictures/gate.png")[0] == 200
    status, headers, _ = webserver.Browser(server.address).ask("/scenarios/pictured/pictures/gate.png")
    assert (status, headers["Location"]) == (303, "/login")
    # Trainees change nothing.
    assert add(good, browser=anna)[0] == 403
    fields = {"version": version(), "file": "pictured/gate.png"}
    assert anna.post("/scenarios", "/scenarios/pictured/pictures/remove", fields)[0] == 403
    # Other files in the folder and outside, and pictures of other scenarios, stay hidden.
    (folder / "hidden.png").write_bytes(good)
    (sessions / "scenarios" / "outside.png").write_bytes(good)
    for way in ["hidden.png", "..%2Foutside.png", "%2e%2e%2foutside.png", "..", "%00", "gate.png%00", "gate.png%2f..%2fhidden.png", "remove"]:
        assert ida.ask(f"/scenarios/pictured/pictures/{way}")[0] in (400, 404, 405), way
    for file in ["../outside.png", "/etc/passwd.png", "outside.txt"]:
        text = own.replace('name = "pictured"', 'name = "thief"') + f'\n[[briefing_pictures]]\nfile = "{file}"\ncaption = "x"\n'
        assert ida.upload("/scenarios", "/scenarios", {}, text.encode(), "x.toml")[0] == 422, file
    for file in ["outside.png", "pictured/hidden.png", "pictured/none.png"]:
        text = own.replace('name = "pictured"', 'name = "thief"') + f'\n[[briefing_pictures]]\nfile = "{file}"\ncaption = "x"\n'
        assert ida.upload("/scenarios", "/scenarios", {}, text.encode(), "x.toml")[0] == 200, file
        page = ida.ask("/scenarios/thief/briefing")[2]
        assert "<img" not in page and "is missing" in page, file
    assert not (sessions / "scenarios" / "thief").exists()
    # Shipped scenarios have none.
    assert ida.upload("/scenarios", "/scenarios/drill-hover/pictures", {"version": version(), "caption": "x"}, good, "a.png")[0] == 404
    for name in ("pictured", "thief"):
        assert ida.post("/scenarios", f"/scenarios/{name}/remove", {})[0] == 303
    assert not folder.exists() and (sessions / "scenarios" / "outside.png").exists()
    (sessions / "scenarios" / "outside.png").unlink()


def test_login_does_not_reveal_user_names(server, sessions):
    anna = logged_in(server, "anna")
    ben = session_folder(sessions, "ben")
    for route in ["/sessions/{}", "/sessions/{}/report", "/sessions/{}/questions", "/trainees/{}", "/trainees/{}/export.json"]:
        there = anna.ask(route.format("ben" if "trainees" in route else ben))
        nowhere = anna.ask(route.format("nobody"))
        assert there[0] == nowhere[0] == 404, route
        # Tokens differ, and the form for the language leads back to the requested page.
        scrubbed = [re.sub(r'value="([0-9a-f]{64}|/[^"]*)"', "", text) for text in (there[2], nowhere[2])]
        assert scrubbed[0] == scrubbed[1], route
    status, _, _ = anna.post("/sessions", f"/sessions/{ben}/questions", {"frustration": "1"})
    assert status == 404 and not (sessions / ben / "answers.json").exists()
    status, _, _ = anna.post("/sessions", "/trainees/ben/details", {"age_band": "65+"})
    assert status == 404
    # An unknown name and a wrong password must give the same message.
    told = []
    for name in ("ben", "no-such-person"):
        stranger = webserver.Browser(server.address)
        status, _, text = stranger.post("/login", "/login", {"name": name, "password": "not the password"})
        told.append((status, re.sub(r'value="[^"]*"', "", text)))
    assert told[0] == told[1]


def test_planted_cookies_are_rejected(server):
    victim = webserver.Browser(server.address)
    victim.ask("/login")
    planted = victim.cookie
    assert victim.log_in("anna") == 303
    assert victim.cookie != planted
    attacker = webserver.Browser(server.address)
    attacker.cookie = planted
    assert attacker.ask("/sessions")[0] == 303, "a cookie from before the login must be worthless"
    attacker.cookie = "spandrel=" + "a" * 64
    status, headers, _ = attacker.ask("/sessions")
    assert status == 303 and "a" * 64 not in headers["Set-Cookie"], "a made-up cookie must not be accepted"
    old = victim.cookie
    assert victim.post("/sessions", "/logout", {})[0] == 303
    attacker.cookie = old
    assert attacker.ask("/sessions")[0] == 303, "a logged-out cookie must stay invalid"
    _, headers, _ = webserver.Browser(server.address).ask("/login")
    assert "HttpOnly" in headers["Set-Cookie"] and "SameSite=Lax" in headers["Set-Cookie"]


def test_logins_are_throttled(sessions):
    server = webserver.Server(sessions)
    try:
        owner = webserver.Browser(server.address)
        assert owner.log_in("ben") == 303 and owner.device, "a login must register the browser"
        assert owner.post("/sessions", "/logout", {})[0] == 303
        browser = webserver.Browser(server.address)
        statuses = [browser.log_in("ben", f"guess number {k}") for k in range(8)]
        assert statuses == [403] * 5 + [429] * 3
        status, headers, _ = browser.ask("/login", {"token": browser.token("/login"), "name": "ben", "password": webserver.PASSWORD})
        assert status == 429 and int(headers["Retry-After"]) > 0, "the correct password must be throttled too"
        assert owner.log_in("ben") == 303, "a stranger at the same address must not lock out the owner's browser"
        assert browser.log_in("ben") == 429, "the owner's login must not end the throttling of others"
        assert browser.log_in("anna") == 303, "other users must be able to log in"

        def one(k):
            other = webserver.Browser(server.address)
            return other.log_in(f"name-{k}", "guess guess guess")

        with concurrent.futures.ThreadPoolExecutor(16) as pool:
            flood = list(pool.map(one, range(60)))
        # 503 if there are more requests at once than the hashing queue can hold.
        assert {403} < set(flood) <= {403, 429, 503} and flood.count(403) <= 20
    finally:
        server.close()


def test_security_headers_are_set_on_every_response(server, sessions):
    ada = logged_in(server, "ada")
    for path in ["/sessions", f"/sessions/{session_folder(sessions, 'anna')}/report", "/assets/style.css", "/none", "/login", "/trainees/anna/export.json"]:
        _, headers, _ = ada.ask(path)
        assert headers["X-Content-Type-Options"] == "nosniff" and headers["X-Frame-Options"] == "DENY", path
        assert headers["Referrer-Policy"] == "same-origin", path
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy and "unsafe" not in policy, path
        assert "no-store" in headers["Cache-Control"] or path.startswith("/assets"), path


def test_network_access_requires_passwords_and_tls(tmp_path):
    place = ["--sessions", str(tmp_path / "sessions"), "--vehicle", "none", "--leash"]

    def refused(*args):
        done = subprocess.run([spandrel.PROGRAM, "serve", *place, *args], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=webserver.PATIENCE_S, check=False)
        assert done.returncode == 2, (args, done.stderr)
        return done.stderr

    assert "--set-password" in refused("--listen", "0.0.0.0:0")
    assert "--set-password" in refused("--listen", "127.0.0.1:0", "--behind-proxy")
    webserver.set_password(tmp_path / "sessions", "ada", "administrator")
    assert "--tls-cert" in refused("--listen", "0.0.0.0:0")
    assert "--tls-cert" in refused("--listen", "0.0.0.0:0", "--tls-cert", "none.pem", "--tls-key", "none.pem")
    short = subprocess.run([spandrel.PROGRAM, "serve", "--sessions", str(tmp_path / "sessions"), "--set-password", "eve", "--role", "trainee"],
                           input="short\n", capture_output=True, text=True, timeout=webserver.PATIENCE_S, check=False)
    assert short.returncode == 2 and "12 to 256" in short.stderr and "short" not in short.stderr.replace("--set-password", "")


def test_dns_rebinding_is_rejected(tmp_path):
    """DNS rebinding: another site's domain that resolves to 127.0.0.1."""
    server = webserver.Server(tmp_path / "sessions")
    try:
        browser = webserver.Browser(server.address)
        port = server.address.rsplit(":", 1)[1]
        assert browser.ask("/sessions")[0] == 200
        assert browser.ask("/sessions", headers={"Host": f"evil.example:{port}"})[0] == 403
        assert browser.ask("/sessions", headers={"Host": f"localhost:{port}"})[0] == 200
    finally:
        server.close()


def test_server_uses_tls_certificate_files(tmp_path):
    import ssl
    import urllib.request

    cert, key = tmp_path / "cert.pem", tmp_path / "key.pem"
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-keyout", str(key), "-out", str(cert), "-days", "2", "-subj",
                    "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"], check=True, capture_output=True)
    webserver.set_password(tmp_path / "sessions", "ada", "administrator")
    server = webserver.Server(tmp_path / "sessions", "--tls-cert", str(cert), "--tls-key", str(key))
    try:
        assert server.address.startswith("https://")
        context = ssl.create_default_context(cafile=str(cert))
        answer = urllib.request.urlopen(server.address + "/login", context=context, timeout=webserver.PATIENCE_S)
        assert answer.headers["Strict-Transport-Security"] and "__Host-spandrel=" in answer.headers["Set-Cookie"]
        assert "Secure" in answer.headers["Set-Cookie"]
    finally:
        server.close()


def test_200_kills_lose_no_confirmed_data(tmp_path):
    """Kills the server at random times while answers are being saved and recordings imported. All data that the server
    has confirmed must exist, and all other data must be complete."""
    sessions = tmp_path / "sessions"
    flown = webserver.flown(sessions, "anna", "ben")
    spandrel.run("records", "import", "--sessions", str(sessions))
    before = json.loads(spandrel.run("records", "list", "--json", "--sessions", str(sessions)))
    log = (flown[0] / "telemetry.tlog").read_bytes()
    generator = random.Random(SEED)
    # By folder and question: the latest answer sent, the latest answer confirmed, and the answer that must exist after
    # the kill.
    sent, confirmed, held = {}, {}, {}
    taken, cut_off = set(), 0
    # Duration of an uninterrupted import. Kills occur around this time, so that some imports succeed and some do not.
    undisturbed = webserver.Server(tmp_path / "other")
    begin = time.monotonic()
    status, _, _ = webserver.Browser(undisturbed.address).upload(
        "/upload", "/upload", {"trainee": "carl", "scenario": "drill-hover", "vehicle": "phantom2"}, log)
    upload_s = time.monotonic() - begin
    assert status == 303
    undisturbed.close()
    keys = ["frustration", "feedback", "time_pressure", "calibration.performance", "landing.performance"]
    for kill in range(KILLS):
        server = webserver.Server(sessions)
        stop = generator.uniform(0.0, 0.06)

        def work():
            browser = webserver.Browser(server.address)
            page = f"/sessions/{flown[kill % 2].name}/questions"
            try:
                token = browser.token(page)
                # Occasionally import a recording, which takes longer than saving an answer.
                if kill % 10 == 0:
                    # Each recording is different, because importing the same recording twice yields a single session.
                    other = log[: len(log) - 300 * (1 + kill // 10)]
                    status, headers, _ = browser.upload(page, "/upload", {"trainee": "carl", "scenario": "drill-hover", "vehicle": "phantom2"}, other)
                    if status == 303:
                        taken.add(headers["Location"].rsplit("/", 1)[1])
                for k in range(40):
                    key, value = keys[(kill + k) % len(keys)], 1 + (kill + k) % 5
                    sent[(flown[kill % 2], key)] = value
                    status, _, _ = browser.ask(page, {"token": token, key: value}, {"Accept": "application/json"})
                    if status == 200:
                        confirmed[(flown[kill % 2], key)] = held[(flown[kill % 2], key)] = value
                    else:
                        return
            except (OSError, ValueError, AssertionError):
                return  # The server has been killed, as intended.

        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            working = pool.submit(work)
            if kill % 10 == 0:
                stop = generator.uniform(0.0, 2.5 * upload_s)
            before_kill = len(taken)
            time.sleep(stop)  # Random delay before the kill, not a wait for an event.
            server.kill()
            working.result()
            cut_off += kill % 10 == 0 and len(taken) == before_kill
        last = {}
        for folder in flown:
            path = folder / "answers.json"
            if path.exists():
                last[folder] = json.loads(path.read_text(encoding="utf-8"))["answers"]
        for (folder, key), value in sent.items():
            # An answer may have been written but not confirmed before the kill; from then on, it is the valid one.
            found = last.get(folder, {}).get(key)
            assert found in (held.get((folder, key)), value), (kill, key, found)
            held[(folder, key)] = sent[(folder, key)] = found
    assert len(confirmed) >= len(keys), "some answers must have been saved"
    assert taken and cut_off, f"{len(taken)} recordings were imported and {cut_off} interrupted; both must occur"
    spandrel.run("records", "import", "--sessions", str(sessions))
    after = {record["id"]: record for record in json.loads(spandrel.run("records", "list", "--json", "--sessions", str(sessions)))}
    for record in before:
        ours = after[record["id"]]
        assert {k: v for k, v in ours.items() if k not in ("answers", "fingerprint")} == {
            k: v for k, v in record.items() if k not in ("answers", "fingerprint")
        }
    assert taken <= set(after)
    for folder in sessions.iterdir():
        if (folder / "telemetry.tlog").is_file():
            assert folder.name in after and json.loads((folder / "assessment.json").read_text(encoding="utf-8")), folder


def test_instructors_bring_their_own_plan_rules(server):
    """Invalid rules are rejected with line and key; valid ones apply to every plan until they are deleted."""
    ida, anna = logged_in(server, "ida"), logged_in(server, "anna")
    assert anna.ask("/plan-rules")[0] == 403 and anna.post("/sessions", "/plan-rules", {"rules": "format = 1"})[0] == 403
    shipped = (spandrel.ROOT / "crates" / "training" / "src" / "plan" / "rules.toml").read_text(encoding="utf-8")
    wrong = shipped.replace('measure = "off_path"', f'measure = "{EVIL}"', 1)
    line = 1 + wrong[: wrong.index(EVIL)].count("\n")
    status, _, text = ida.post("/plan-rules", "/plan-rules", {"rules": wrong})
    assert status == 422 and f"rules.toml:{line}: rules[].measure" in text and EVIL not in text, text[:2000]
    own = shipped.replace("steps = 3", "steps = 1", 1)
    status, _, text = ida.upload("/plan-rules", "/plan-rules/upload", {}, own.encode(), "own.toml")
    assert status == 200 and "The rules were saved" in text and "Delete own rules" in text
    assert ida.post("/plan-rules", "/plan-rules/reset", {})[0] in (200, 303)
    assert "Delete own rules" not in ida.ask("/plan-rules")[2]

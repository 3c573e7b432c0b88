"""Many simultaneous, slow and proxied requests: memory must stay bounded, and other pages must remain available."""

import concurrent.futures
import http.client
import json
import os
import pathlib
import re
import socket
import sqlite3
import subprocess
import threading
import urllib.parse

import pytest

import spandrel
import webserver

# Number of simultaneous logins, each from a different address, so that throttling by address has no effect.
LOGINS = 300
# Limit for the server's peak memory, kB.
MAX_KB = 150_000


@pytest.fixture(name="sessions")
def fixture_sessions(tmp_path):
    """Users without flights, which these tests do not need."""
    folder = tmp_path / "sessions"
    for name, role in [("ida", "instructor"), ("ada", "administrator")]:
        webserver.set_password(folder, name, role)
    return folder


def host_of(server):
    host, port = server.address.split("://")[1].split(":")
    return host, int(port)


def peak_kb(process):
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmHWM:\s+(\d+) kB", status).group(1))


def log_in_from(server, k):
    """Sends a login with a wrong password from the k-th address of this machine. Returns the status."""
    source = f"127.0.{1 + k // 200}.{1 + k % 200}"
    connection = http.client.HTTPConnection(*host_of(server), timeout=webserver.PATIENCE_S, source_address=(source, 0))
    try:
        connection.request("GET", "/login")
        answer = connection.getresponse()
        token = re.search(r'name="token" value="([0-9a-f]{64})"', answer.read().decode()).group(1)
        cookie = answer.headers["Set-Cookie"].split(";")[0]
        form = urllib.parse.urlencode({"token": token, "name": f"guest-{k}", "password": "not the password"})
        connection.request("POST", "/login", form, {"Cookie": cookie, "Content-Type": "application/x-www-form-urlencoded"})
        return connection.getresponse().status
    finally:
        connection.close()


def test_300_simultaneous_logins_use_bounded_memory(sessions):
    server = webserver.Server(sessions)
    try:
        ida = webserver.Browser(server.address)
        assert ida.log_in("ida") == 303
        before_kb = peak_kb(server.process)
        over = threading.Event()
        pages = []

        def read_pages():
            while not over.is_set():
                pages.append(ida.ask("/sessions")[0])

        with concurrent.futures.ThreadPoolExecutor(LOGINS + 1) as pool:
            reading = pool.submit(read_pages)
            statuses = list(pool.map(lambda k: log_in_from(server, k), range(LOGINS)))
            over.set()
            reading.result()
        assert set(statuses) <= {403, 503} and statuses.count(403) > 0, sorted(set(statuses))
        assert 503 in statuses, "a full queue must reject requests"
        assert peak_kb(server.process) < MAX_KB, f"{peak_kb(server.process)} kB, {before_kb} kB before"
        # The list remained available during the logins, so it does not wait for them.
        assert set(pages) == {200} and len(pages) > 5, len(pages)
        assert webserver.Browser(server.address).log_in("ada") == 303
    finally:
        server.close()


def begin_upload(server, browser, token):
    """Sends the header of an upload and the first part of its file."""
    raw = socket.create_connection(host_of(server), timeout=webserver.PATIENCE_S)
    host, port = host_of(server)
    raw.sendall(
        f"POST /upload HTTP/1.1\r\nHost: {host}:{port}\r\nCookie: {browser.cookie}\r\nContent-Type: multipart/form-data; boundary=b\r\n"
        f"Content-Length: 1000000\r\n\r\n--b\r\nContent-Disposition: form-data; name=\"token\"\r\n\r\n{token}\r\n--b\r\n"
        "Content-Disposition: form-data; name=\"file\"; filename=\"f.tlog\"\r\n\r\nslowly".encode()
    )
    return raw


def test_slow_uploads_do_not_block_other_requests(sessions):
    server = webserver.Server(sessions)
    slow = []
    try:
        ida = webserver.Browser(server.address)
        assert ida.log_in("ida") == 303
        token = ida.token("/upload")
        slow = [begin_upload(server, ida, token) for _ in range(4)]
        fields = {"trainee": "x", "scenario": "drill-hover", "vehicle": "phantom2"}
        status, _, text = ida.upload("/upload", "/upload", fields, b"no recording")
        assert status == 422 and "cannot import this recording" in text
        # A large upload is stored in a temporary file, which must be removed when it is rejected.
        status, _, text = ida.upload("/upload", "/upload", fields, b"x" * 3_000_000)
        assert status == 422 and not list(sessions.glob(".taking-in/upload-*"))
    finally:
        for raw in slow:
            raw.close()
        server.close()


def test_server_behind_a_proxy_accepts_only_proxied_requests(sessions):
    server = webserver.Server(sessions, "--behind-proxy", "--trusted-proxy", "127.0.3.0/24", "--host", "trainer.example")
    host, port = host_of(server)

    def ask(source, name):
        connection = http.client.HTTPConnection(host, port, timeout=webserver.PATIENCE_S, source_address=(source, 0))
        try:
            connection.request("GET", "/login", headers={"Host": name, "X-Forwarded-For": "203.0.113.9"})
            answer = connection.getresponse()
            return answer.status, answer.read().decode()
        finally:
            connection.close()

    try:
        assert ask("127.0.3.7", "trainer.example")[0] == 200
        status, text = ask("127.0.0.1", "trainer.example")
        assert status == 403 and "--trusted-proxy" in text
        status, text = ask("127.0.3.7", "evil.example")
        assert status == 403 and "--host" in text
    finally:
        server.close()


def test_common_passwords_are_rejected(tmp_path):
    for password in ["password1234", "qwertyuiop12", "aaaaaaaaaaaa", "annabella2024"]:
        done = spandrel_set(tmp_path, password)
        assert done.returncode == 2 and "too easy to guess" in done.stderr and password not in done.stderr, (password, done.stderr)
    assert spandrel_set(tmp_path, webserver.PASSWORD).returncode == 0


def spandrel_set(folder, password):
    return subprocess.run(
        [spandrel.PROGRAM, "serve", "--sessions", str(folder), "--set-password", "annabella", "--role", "trainee"],
        input=password + "\n", capture_output=True, text=True, timeout=webserver.PATIENCE_S, check=False,
    )


# Number of sessions in the cohort, and number of simultaneous reloads of its page.
SESSIONS, RELOADS = 10_000, 16
# Maximum cost of the reloads as a multiple of one uncached reload: one reload, plus rendering the page for each reload.
MAX_COSTS = 4.0


def insert_sessions(database):
    """Inserts copies of the example study's records, under other names, directly into the tables."""
    lines = (spandrel.ROOT / "examples" / "cohort" / "records.jsonl").read_text(encoding="utf-8").splitlines()
    originals = [json.loads(line) for line in lines]
    columns = ["id", "trainee", "started_unix_us", "scenario", "scenario_sha256", "vehicle", "vehicle_sha256", "telemetry_sha256",
               "spandrel_version", "scorer_version", "end_reason", "seconds", "fingerprint"]
    scores = ["conformity", "efficiency", "safety", "accuracy", "overall", "overall_max"]
    insert = f"INSERT INTO sessions ({', '.join(columns + scores)}, record) VALUES ({', '.join('?' * (len(columns) + len(scores) + 1))})"
    with sqlite3.connect(database) as connection:
        for k in range(SESSIONS):
            one = dict(originals[k % len(originals)])
            one["trainee"] = f"{one['trainee']}-{k // len(originals)}"
            one["id"] = f"{one['id']}-{k}"
            connection.execute("INSERT OR IGNORE INTO trainees (pseudonym, role) VALUES (?, 'trainee')", [one["trainee"]])
            values = [one[column] for column in columns] + [one["scores"][score] for score in scores]
            connection.execute(insert, [*values, json.dumps(one)])


def processor_s(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def test_cohort_page_reloads_are_cached(tmp_path):
    sessions = tmp_path / "sessions"
    server = webserver.Server(sessions)
    try:
        insert_sessions(sessions / "records.sqlite")
        browser = webserver.Browser(server.address)

        def cost(reloads):
            """Returns the processor time of simultaneous reloads in seconds, and the number of list pages served
            meanwhile."""
            before, over, lists = processor_s(server.process), threading.Event(), []

            def read_lists():
                while not over.is_set():
                    lists.append(browser.ask("/trainees/nobody")[0])

            with concurrent.futures.ThreadPoolExecutor(reloads + 1) as pool:
                reading = pool.submit(read_lists)
                pages = list(pool.map(lambda _: webserver.Browser(server.address).ask("/cohort")[::2], range(reloads)))
                over.set()
                reading.result()
            assert {status for status, _ in pages} == {200} and all(text.count("<svg") > 3 for _, text in pages)
            return processor_s(server.process) - before, len(lists)

        once, _ = cost(1)
        # Another program changes the database, which invalidates the cache.
        with sqlite3.connect(sessions / "records.sqlite") as connection:
            connection.execute("UPDATE sessions SET seconds = seconds + 1")
        together, pages = cost(RELOADS)
        print(f"one: {once:.2f} s of processor time, {RELOADS} at once: {together:.2f} s; {pages} other pages meanwhile")
        assert together < MAX_COSTS * once, (together, once)
        # Other pages must not wait for the cohort page.
        assert pages > RELOADS
    finally:
        server.close()

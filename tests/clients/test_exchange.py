"""Sessions exported to other systems: Parquet read by Arrow, xAPI statements received by a store that checks the
standard's rules, and a SCORM package run with the interface of a learning management system."""

import csv
import http.server
import io
import json
import math
import re
import shutil
import subprocess
import threading
import uuid
import xml.etree.ElementTree as ElementTree
import zipfile

import pyarrow.parquet
import pytest
from playwright.sync_api import sync_playwright

import spandrel
import webserver

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
IRI = re.compile(r"^[a-z][a-z0-9+.-]*:\S+$")
DURATION = re.compile(r"^PT\d+(\.\d{1,2})?S$")


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Two real sessions with their records."""
    folder = tmp_path_factory.mktemp("exchange") / "sessions"
    webserver.flown(folder, "anna", "ben")
    spandrel.run("records", "import", "--sessions", str(folder))
    return folder


def session(sessions):
    return next(path for path in sorted(sessions.iterdir()) if "-anna-" in path.name)


def test_parquet_matches_the_csv(sessions, tmp_path):
    rows = list(csv.DictReader(io.StringIO(spandrel.run("export", str(session(sessions)), "--frames", "-"))))
    spandrel.run("export", str(session(sessions)), "--parquet", str(tmp_path / "frames.parquet"))
    table = pyarrow.parquet.read_table(tmp_path / "frames.parquet")
    assert table.column_names == list(rows[0]) and table.num_rows == len(rows) > 100
    for name in table.column_names:
        ours, theirs = table.column(name).to_pylist(), [row[name] for row in rows]
        if name == "contact":
            assert ours == theirs
        else:
            # Numbers are written with the fewest digits that round-trip exactly, so values must be equal. An empty cell is a
            # null.
            numbers = [None if value == "" else float(value) for value in theirs]
            assert [None if value is None else float(value) for value in ours] == numbers, name
    # A simulated flight contains all of these columns.
    for name in ("roll_deg", "gimbal_pitch_deg", "task", "path_distance_m", "clearance_m", "wind_north_m_s", "estimated_up_m"):
        known = [value for value in table.column(name).to_pylist() if value is not None]
        assert len(known) > 0.2 * table.num_rows, name
    off = [math.dist(true, estimated) for true, estimated in zip(value_paths(table, ""), value_paths(table, "estimated_")) if None not in estimated]
    assert 0 < max(off) < 5, "the estimate must be near the truth, but not equal"


def value_paths(table, prefix):
    return list(zip(*(table.column(f"{prefix}{axis}_m").to_pylist() for axis in ("east", "north", "up"))))


def test_parquet_fields_have_unit_frame_and_definition(sessions, tmp_path):
    spandrel.run("export", str(session(sessions)), "--parquet", str(tmp_path / "frames.parquet"))
    schema = pyarrow.parquet.read_schema(tmp_path / "frames.parquet")
    for field in schema:
        assert field.metadata[b"description"].endswith(b"."), field.name
    units = {field.name: field.metadata.get(b"unit") for field in schema}
    assert units["speed_m_s"] == b"m/s" and units["yaw_deg"] == b"deg" and units["battery_pct"] == b"%" and units["task"] is None
    assert schema.field("estimated_east_m").metadata[b"frame"] == b"east, north, up from the scenario's origin"
    kinds = {"frame": "int64", "t_s": "double", "missing": "bool", "contact": "string"}
    assert {name: str(schema.field(name).type) for name in kinds} == kinds
    assert schema.field("task").nullable and not schema.field("t_s").nullable


class Store(http.server.BaseHTTPRequestHandler):
    """The part of a learning record store that receives statements, with the rules of xAPI 1.0.3 that a client could
    violate."""

    def log_message(self, *_):
        pass

    def do_POST(self):
        store = self.server
        store.requests += 1
        body = self.rfile.read(int(self.headers["Content-Length"]))
        if store.busy > 0:
            store.busy -= 1
            return self.respond(503, "later")
        if self.headers["Authorization"] != "Basic dTpw":
            return self.respond(401, "who?")
        if self.path != "/xapi/statements" or self.headers["X-Experience-API-Version"] != "1.0.3" or self.headers["Content-Type"] != "application/json":
            return self.respond(400, "headers")
        statements = json.loads(body)
        for one in statements:
            fault = violated_rule(one)
            if fault:
                store.faults.append(fault)
                return self.respond(400, fault)
        # An existing statement with different contents is a conflict, and nothing in the request is stored.
        if any(one["id"] in store.kept and store.kept[one["id"]] != one for one in statements):
            return self.respond(409, "conflict")
        store.kept.update({one["id"]: one for one in statements})
        if store.lose_answer:
            store.lose_answer = False
            self.close_connection = True
            self.connection.close()
            return None
        return self.respond(200, json.dumps([one["id"] for one in statements]))

    def respond(self, status, text):
        self.send_response(status)
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text.encode())


def violated_rule(one):
    """Returns the first rule of the standard that a statement violates."""
    if set(one) - {"id", "actor", "verb", "object", "result", "context", "timestamp"}:
        return "unknown field"
    if str(uuid.UUID(one["id"])) != one["id"]:
        return "id"
    account = one["actor"]["account"]
    if set(account) != {"homePage", "name"} or not IRI.match(account["homePage"]) or not account["name"]:
        return "actor"
    if not IRI.match(one["verb"]["id"]) or not IRI.match(one["object"]["id"]):
        return "iri"
    score = one["result"].get("score")
    if score and not (-1 <= score["scaled"] <= 1 and score["min"] <= score["raw"] <= score["max"]):
        return "score"
    if "duration" in one["result"] and not DURATION.match(one["result"]["duration"]):
        return "duration"
    if not re.match(r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$", one["timestamp"]):
        return "timestamp"
    if str(uuid.UUID(one["context"]["registration"])) != one["context"]["registration"]:
        return "registration"
    if not all(IRI.match(key) for key in one["context"]["extensions"]):
        return "extension"
    return None


@pytest.fixture
def store():
    """A store on an unused port."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Store)
    server.kept, server.faults, server.requests, server.busy, server.lose_answer = {}, [], 0, 0, False
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield server
    server.shutdown()
    server.server_close()


def push(sessions, store, password="p"):
    url = f"http://127.0.0.1:{store.server_port}/xapi"
    environment = {"SPANDREL_LRS_USER": "u", "SPANDREL_LRS_PASSWORD": password, "PATH": "/usr/bin:/bin"}
    return subprocess.run([spandrel.PROGRAM, "records", "push", url, "--sessions", str(sessions)], env=environment, capture_output=True,
                          text=True, timeout=webserver.PATIENCE_S, check=False)


def test_statements_are_stored_once_despite_connection_failures(sessions, store):
    store.busy, store.lose_answer = 2, True
    done = push(sessions, store)
    assert done.returncode == 0 and store.faults == [], (done.stderr, store.faults)
    said = spandrel.run("export", str(session(sessions)), "--xapi", "-").splitlines()
    beside = (session(sessions) / "xapi.jsonl").read_text(encoding="utf-8").splitlines()
    assert said == beside
    sent = [json.loads(line) for line in said]
    assert all(store.kept[one["id"]] == one for one in sent) and len(store.kept) > len(sent)
    overall = json.loads((session(sessions) / "assessment.json").read_text(encoding="utf-8"))["scores"]["overall"]
    assert sent[0]["result"]["score"]["raw"] == overall
    before = dict(store.kept)
    assert push(sessions, store).returncode == 0
    assert store.kept == before, "repeated statements must be stored once"


def test_store_rejection_is_reported_and_not_retried(sessions, store):
    done = push(sessions, store, password="wrong")
    assert done.returncode == 1 and "401" in done.stderr and "wrong" not in done.stderr and store.requests == 1


SYSTEM = """<!DOCTYPE html><script>
window.told = {};
window.API = {
  LMSInitialize: () => "true", LMSSetValue: (name, value) => { window.told[name] = value; return "true"; },
  LMSCommit: () => "true", LMSFinish: () => "true",
};
</script><iframe src="/package/index.html" width="1000" height="600"></iframe>"""


def test_scorm_package_reports_its_result(sessions, tmp_path):
    spandrel.run("export", str(session(sessions)), "--scorm", str(tmp_path / "result.zip"))
    with zipfile.ZipFile(tmp_path / "result.zip") as archive:
        assert archive.testzip() is None
        archive.extractall(tmp_path / "package")
    manifest = ElementTree.parse(tmp_path / "package" / "imsmanifest.xml").getroot()
    space = {"c": "http://www.imsproject.org/xsd/imscp_rootv1p1p2"}
    assert manifest.findtext("c:metadata/c:schemaversion", namespaces=space) == "1.2"
    resource = manifest.find("c:resources/c:resource", space)
    assert resource.get("{http://www.adlnet.org/xsd/adlcp_rootv1p2}scormtype") == "sco"
    for file in resource.findall("c:file", space):
        assert (tmp_path / "package" / file.get("href")).is_file()
    assert manifest.find("c:organizations/c:organization/c:item", space).get("identifierref") == resource.get("identifier")
    (tmp_path / "system.html").write_text(SYSTEM, encoding="utf-8")
    handler = lambda *args: http.server.SimpleHTTPRequestHandler(*args, directory=str(tmp_path))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        with sync_playwright() as playwright:
            chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
            page = chromium.new_page()
            page.goto(f"http://127.0.0.1:{server.server_port}/system.html")
            page.wait_for_function("window.told['cmi.core.session_time']", timeout=webserver.PATIENCE_S * 1000)
            told = page.evaluate("window.told")
            assert page.frames[1].frame_locator("iframe").locator("h1").count() == 1, "the report must be visible"
            chromium.close()
    finally:
        server.shutdown()
        server.server_close()
    scores = json.loads((session(sessions) / "assessment.json").read_text(encoding="utf-8"))["scores"]
    assert 0 <= float(told["cmi.core.score.raw"]) <= 100 and told["cmi.core.lesson_status"] in ("passed", "failed")
    assert scores["overall"] > 0 and re.match(r"^\d{4}:\d\d:\d\d\.\d\d$", told["cmi.core.session_time"])

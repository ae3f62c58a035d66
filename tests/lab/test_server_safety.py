"""Whoever asks, from wherever, for whatever: the lab answers its own page, and nothing of the machine gets out."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient
from tests.lab.conftest import shipped

import trundle as tr
from trundle.cli import run as command
from trundle.lab import Settings, create_app
from trundle.lab.limits import MOST_LOADS, MOST_SAMPLES, MOST_SAVED

NAME = "level-turntable-nudged"


def error_of(answer: Any) -> dict[str, Any]:
    told = answer.json()
    assert set(told) == {"error"}
    assert set(told["error"]) == {"message", "key", "kind", "parts"}
    return told["error"]


@pytest.mark.parametrize(
    "host", ["evil.example", "127.0.0.1.evil.example", "evil.example:80", "", "[::2]", "a b", "x@"]
)
def test_another_host_is_refused(lab: TestClient, host: str) -> None:
    answer = lab.get("/api/scenarios", headers={"host": host})
    assert answer.status_code == 421
    assert "answers for" in error_of(answer)["message"]


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "LOCALHOST:1234", "[::1]:99"])
def test_its_own_names_are_answered(lab: TestClient, host: str) -> None:
    assert lab.get("/api/scenarios/tilted-turntable", headers={"host": host}).status_code == 200


def test_the_port_is_looked_at_where_it_is_known() -> None:
    with TestClient(
        create_app(Settings(port=8765, workers=1, slow_workers=1)), base_url="http://localhost:8765"
    ) as lab:
        assert lab.get("/").status_code != 421
        assert lab.get("/", headers={"host": "localhost:8766"}).status_code == 421
        assert lab.get("/", headers={"host": "localhost"}).status_code == 421


def test_on_a_network_an_address_is_answered_and_a_foreign_name_is_not() -> None:
    client = TestClient(create_app(Settings(host="0.0.0.0", exposed=True)))  # noqa: S104  nothing listens here
    for host, status in (("192.168.1.7", 404), ("evil.example", 421)):
        assert client.get("/no-such-page", headers={"host": host}).status_code == status


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "https://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:1"},
        {"origin": "https://127.0.0.1"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_a_page_of_another_origin_cannot_post(lab: TestClient, headers: dict[str, str]) -> None:
    for route in ("/api/simulate", "/api/open"):
        answer = lab.post(route, json={"scenario": shipped(NAME)}, headers=headers)
        assert answer.status_code == 403
        assert error_of(answer)
    assert "access-control-allow-origin" not in answer.headers


def test_its_own_page_can_post(lab: TestClient) -> None:
    for headers in ({"origin": "http://127.0.0.1"}, {"sec-fetch-site": "same-origin"}):
        answer = lab.post("/api/simulate", json={"scenario": shipped(NAME), "samples": 5}, headers=headers)
        assert answer.status_code == 200


@pytest.mark.parametrize(
    "path", ["/", "/api/scenarios/tilted-turntable", "/no-such-page", "/api/simulate", "/api/nothing"]
)
def test_every_answer_says_what_a_page_may_load(lab: TestClient, path: str) -> None:
    headers = lab.get(path).headers
    policy = dict(part.split(" ", 1) for part in headers["content-security-policy"].split("; "))
    assert policy["default-src"] == "'none'"
    assert policy["script-src"] == policy["style-src"] == policy["connect-src"] == "'self'"
    assert "unsafe" not in headers["content-security-policy"]
    assert "http" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["cross-origin-opener-policy"] == headers["cross-origin-resource-policy"] == "same-origin"
    assert "server" not in headers


def test_only_hosts_that_are_named_may_hold_it_in_a_frame(lab: TestClient) -> None:
    named = TestClient(create_app(Settings(embed_from=("moodle.example.org", "https://wiki.example.org:8443"))))
    for client, wanted in ((lab, "'none'"), (named, "moodle.example.org https://wiki.example.org:8443")):
        headers = client.get("/no-such-page", headers={"host": "localhost"}).headers
        policy = dict(part.split(" ", 1) for part in headers["content-security-policy"].split("; "))
        assert policy["frame-ancestors"] == wanted
        assert policy["default-src"] == "'none'"


@pytest.mark.parametrize("host", ["*", "https://*.example.org", "a b", "a;b", "'self'", "", "ftp://a", "https://a/b"])
def test_what_is_no_host_may_not_embed(host: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert command(["lab", "--embed-from", host]) == 2
    assert "must be a host" in capsys.readouterr().err


@pytest.mark.parametrize("path", ["/docs", "/redoc", "/openapi.json"])
def test_no_page_of_fastapis_is_served(lab: TestClient, path: str) -> None:
    assert lab.get(path).status_code == 404


@pytest.mark.parametrize(
    "name",
    [
        "../pyproject",
        "..%2f..%2fpyproject.toml",
        "%2e%2e/%2e%2e/etc/passwd",
        "/etc/passwd",
        "tilted-turntable%00",
        "x" * 5000,
    ],
)
def test_a_name_is_looked_for_in_the_list_only(lab: TestClient, name: str) -> None:
    answer = lab.get(f"/api/scenarios/{name}")
    assert answer.status_code in (404, 405)
    assert "root:" not in answer.text


def test_static_files_are_those_of_the_front_end(tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("secret")
    static = tmp_path / "static"
    (static / "assets").mkdir(parents=True)
    (static / "lab.html").write_text("<!doctype html><title>Lab</title>")
    (static / "assets" / "lab-1a2b3c.js").write_text("export {}" + " " * 2000)
    (static / "link").symlink_to(tmp_path / "secret.txt")
    client = TestClient(create_app(Settings(static=static)), base_url="http://localhost")
    page, script = client.get("/"), client.get("/assets/lab-1a2b3c.js")
    assert (page.status_code, page.headers["cache-control"]) == (200, "no-cache")
    assert page.headers["content-type"].startswith("text/html")
    assert "immutable" in script.headers["cache-control"]
    assert "javascript" in script.headers["content-type"]
    assert script.headers["content-encoding"] == "gzip"
    assert client.get("/", headers={"if-none-match": page.headers["etag"]}).status_code in (200, 304)
    for path in (
        "/../secret.txt",
        "/..%2fsecret.txt",
        "/%2e%2e/secret.txt",
        "/assets/../../secret.txt",
        "/link",
        "/assets/",
    ):
        answer = client.get(path)
        assert answer.status_code == 404
        assert "secret" not in answer.text


def test_a_copy_without_its_page_says_so(tmp_path: Path) -> None:
    answer = TestClient(create_app(Settings(static=tmp_path / "none")), base_url="http://localhost").get("/")
    assert answer.status_code == 503
    assert "has not been built" in answer.text


# --- how much ---------------------------------------------------------------------------------------------------


def changed(**tables: Any) -> dict[str, Any]:
    scenario = shipped(NAME)
    for table, keys in tables.items():
        scenario[table] = {**scenario[table], **keys} if isinstance(keys, dict) else keys
    return scenario


DEEP: Any = []
for _ in range(40):
    DEEP = [DEEP]

BAD: list[tuple[dict[str, Any], str | None, str]] = [
    ({"scenario": changed(run={"duration": "2 h"})}, "run.duration", "at most 3600 s"),
    ({"scenario": changed(run={"every": "50 us"})}, "run.every", f"at most {MOST_SAVED} samples"),
    ({"scenario": changed(loads=[{"kind": "drag", "coefficient": 1}] * (MOST_LOADS + 1))}, "loads", "at most 20"),
    ({"scenario": changed(notes=DEEP)}, "scenario", "nest"),
    ({"scenario": changed(support={"z": [[0.0] * 150] * 150})}, "scenario", "values"),
    ({"scenario": shipped(NAME), "samples": MOST_SAMPLES + 1}, "samples", "less than or equal to 10000"),
    ({"scenario": shipped(NAME), "samples": 1}, "samples", "greater than"),
    ({"scenario": shipped(NAME), "smaples": 5}, "smaples", "not permitted"),
    ({"scenario": "tilted-turntable"}, "scenario", "valid dictionary"),
    ({}, "scenario", "required"),
    ({"scenario": changed(body={"mass": "-1 kg"})}, "body.mass", "must be positive"),
    ({"scenario": changed(support={"file": "/etc/passwd"})}, "support.file", "is no key of"),
    ({"scenario": changed(body={"radius": float("nan")})}, "body.radius", "finite"),
    ({"scenario": changed(body={"radius": 10**400})}, "body.radius", "finite"),
    ({"scenario": changed(title="\ud800")}, "title", "without control characters"),
    ({"scenario": {"\ud800\n": 1, **shipped(NAME)}}, r"'\ud800\n'", r"is no key of the file; got '\ud800\n'. There"),
    (
        {"scenario": changed(body={"\ud800": 1})},
        r"body.'\ud800'",
        r"is no key of [body]; got '\ud800'. There are: kind",
    ),
    ({"scenario": changed(run={"method": "\ud800"})}, "run.method", r"got '\ud800'. There are: auto, exact"),
    ({"scenario": changed(body={"kind": "\ud800"})}, "body.kind", r"got '\ud800'. There are: solid-sphere"),
    ({"scenario": shipped(NAME), "\ud800": 1}, None, r"must be text of whole characters; got '\ud800'. Leave out"),
    (
        {"scenario": changed(loads=[{"kind": "force", "value": ["open('/etc/passwd')*t", 0, 0]}])},
        "loads[0].value[0]",
        "open",
    ),
    (
        {"scenario": changed(loads=[{"kind": "force", "value": ["().__class__ + t", 0, 0]}])},
        "loads[0].value[0]",
        "formula",
    ),
]


@pytest.mark.parametrize(("asked", "key", "said"), BAD, ids=[f"{key} {said}" for _, key, said in BAD])
def test_a_bad_request_is_answered_in_words_with_its_key(
    lab: TestClient, asked: dict[str, Any], key: str | None, said: str
) -> None:
    answer = lab.post("/api/simulate", content=json.dumps(asked), headers={"content-type": "application/json"})
    assert answer.status_code == 422
    error = error_of(answer)
    assert error["key"] == key
    assert said in error["message"]


def test_the_message_is_the_packages_own(lab: TestClient) -> None:
    wrong = changed(support={"tilt": "172 deg"})
    with pytest.raises(tr.ScenarioError) as caught:
        tr.Scenario.read(wrong, "")
    for route in ("simulate", "card", "derivation", "twin"):
        error = error_of(lab.post(f"/api/{route}", json={"scenario": wrong}))
        (part,) = error.pop("parts")
        assert error == {"message": str(caught.value), "key": "support.tilt", "kind": "ScenarioError"}
        assert all(words in error["message"] for words in part.values())


@pytest.mark.parametrize("content", [b"", b"{", b'{"scenario": ', b"[1, 2]", b"\xff", b"[" * 100_000, b"9" * 5000])
def test_what_is_no_json_is_refused(lab: TestClient, content: bytes) -> None:
    answer = lab.post("/api/simulate", content=content, headers={"content-type": "application/json"})
    assert answer.status_code == 422
    assert error_of(answer)


def test_too_long_a_body_is_not_read(lab: TestClient) -> None:
    long = b'{"scenario": {"notes": "' + b"x" * 600_000 + b'"}}'

    def told_nothing() -> Any:  # in pieces, without a Content-Length
        for start in range(0, len(long), 10_000):
            yield long[start : start + 10_000]

    for content in (long, told_nothing()):
        answer = lab.post("/api/simulate", content=content, headers={"content-type": "application/json"})
        assert answer.status_code == 413
        assert "512 KiB" in error_of(answer)["message"]


def test_a_roll_names_its_bad_key(lab: TestClient) -> None:
    for curve, key in (
        ({"kind": "straight", "length": "0 m"}, "path[0].length"),
        ({"path": [{"kind": "arc", "radius": "1 m"}]}, "path[0].angle"),
        ({"file": "/etc/passwd"}, "curve.file"),
        ({"\ud800": 1}, r"curve.'\ud800'"),
        ({"path": [{"kind": "straight", "turn": "90 deg", "\ud800": 1}]}, r"path[0].'\ud800'"),
        ({}, "curve.path"),
    ):
        asked = json.dumps({"radius": "25 mm", "curve": curve})
        answer = lab.post("/api/roll", content=asked, headers={"content-type": "application/json"})
        assert error_of(answer)["key"] == key


def test_no_name_that_came_reaches_the_file_system(tmp_path: Path) -> None:
    """Ask everything with a marked word in every text, and watch which files are opened, by an audit hook."""
    script = tmp_path / "watch.py"
    script.write_text(WATCHED)
    import subprocess
    import sys

    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=120, check=False)  # noqa: S603
    assert done.returncode == 0, done.stderr
    opened, leaked = json.loads(done.stdout)
    assert opened > 3  # the hook sees what is opened
    assert leaked == []


WATCHED = """
import json, sys, tempfile
from trundle.lab import answers, exports
from trundle.scenario import files
from trundle.views.viewer.exports import FORMATS

MARK = "marked-4711"
opened, leaked = [], []


def hook(event, arguments):
    if event in ("open", "os.open", "os.listdir", "os.scandir", "os.rename", "os.mkdir", "subprocess.Popen", "exec"):
        opened.append(event)
        if MARK in repr(arguments):
            leaked.append([event, repr(arguments)[:200]])


def tables(name):
    return files.parse(files.read(name), name)


def marked(value):
    if isinstance(value, dict):
        return {key: marked(part) for key, part in value.items()}
    return [marked(part) for part in value] if isinstance(value, list) else f"../../tmp/{MARK}"


sys.addaudithook(hook)
whole = tables("level-turntable-nudged")
named = {**whole, "title": f"../../tmp/{MARK}.nc", "notes": f"/tmp/{MARK}", "run": {"duration": 0.1, "every": 0.01}}
for scenario in (named, marked(whole), {**whole, "file": f"/tmp/{MARK}"}, {**whole, "support": f"/tmp/{MARK}"}):
    for function in (answers.simulate, answers.card, answers.derivation, answers.twin):
        function(scenario)
    for kind in (ending.removeprefix(".") for ending in FORMATS):
        with tempfile.TemporaryDirectory() as folder:
            exports.export(scenario, kind, folder)
answers.text_of(f"../{MARK}")
answers.roll(f"/tmp/{MARK}", {"title": MARK, "path": [{"kind": f"/tmp/{MARK}"}]})
with tempfile.TemporaryDirectory() as folder:
    for content in (f'title = "/tmp/{MARK}"', f"/tmp/{MARK}"):
        exports.opened(content.encode(), folder)
print(json.dumps([len(opened), leaked]))
"""

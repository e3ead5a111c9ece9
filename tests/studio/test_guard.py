"""Pages of others are not let in, and who comes from another machine shows the token."""

from __future__ import annotations

from pathlib import Path

import pytest

from onbeat.errors import OnbeatError
from onbeat.studio.serve import serve
from studio_house import ADDRESS, TestClient, house

TOKEN = "a-token-of-many-letters"


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory):
    with house(tmp_path_factory.mktemp("house")) as client:
        yield client


@pytest.fixture(scope="module")
def open_house(tmp_path_factory: pytest.TempPathFactory):
    with house(tmp_path_factory.mktemp("open"), host="0.0.0.0", token=TOKEN, port=8642) as client:
        yield client


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1.evil.example:8642", "", "192.168.1.9:8642"])
def test_another_name_that_points_here_is_refused(client: TestClient, host: str):
    answer = client.get("/api/project", headers={"Host": host})
    assert answer.status_code == 403
    assert "the address that it printed" in answer.json()["error"]


@pytest.mark.parametrize("host", ["127.0.0.1:8642", "localhost:8642", "[::1]:8642"])
def test_this_machines_own_names_are_answered(client: TestClient, host: str):
    assert client.get("/api/project", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:3000", "https://127.0.0.1:8642"])
@pytest.mark.parametrize(
    ("method", "path"),
    [("POST", "/api/songs?name=a"), ("PUT", "/api/songs/song/beats"), ("DELETE", "/api/songs/song"), ("PATCH", "/x")],
)
def test_what_pages_of_others_ask_for_is_refused(client: TestClient, origin: str, method: str, path: str):
    before = client.get("/api/project").json()["revision"]
    answer = client.request(method, path, headers={"Origin": origin}, content=b"x")
    assert answer.status_code == 403
    assert "another address" in answer.json()["error"]
    assert client.get("/api/project").json()["songs"][0]["id"] == "song"
    assert len(client.get("/api/project").json()["songs"]) == 1
    assert before <= client.get("/api/project").json()["revision"]


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_another_site_caused_is_refused_also_where_it_only_reads(client: TestClient, site: str):
    assert client.get("/api/songs/song/sound", headers={"Sec-Fetch-Site": site}).status_code == 403
    opened = {"Sec-Fetch-Site": site, "Sec-Fetch-Mode": "navigate", "Sec-Fetch-Dest": "document"}
    assert client.get("/", headers=opened).status_code == 200  # a link to the page is no harm
    assert client.get("/api/project", headers=opened).status_code == 403


def test_its_own_page_is_let_in(client: TestClient):
    own = {"Origin": ADDRESS, "Sec-Fetch-Site": "same-origin"}
    assert client.post("/api/jobs/none/cancel", headers=own).status_code == 404


def test_answers_cannot_be_framed_guessed_at_or_kept(client: TestClient):
    for path in ("/", "/api/project", "/nowhere"):
        headers = client.get(path).headers
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["cache-control"] == "no-store"
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
    page = client.get("/").headers["content-security-policy"]
    assert "script-src 'sha256-" in page
    scripts = page.split("script-src")[1].split(";")[0]
    assert "unsafe" not in scripts
    assert "http" not in page


def test_others_need_the_token(open_house: TestClient):
    open_house.cookies.clear()
    assert open_house.get("/").status_code == 401
    assert "token" in open_house.get("/api/project").json()["error"]
    assert open_house.get("/?token=wrong").status_code == 401
    assert open_house.get(f"/api/project?token={TOKEN}").status_code == 401  # in an address it opens the page alone
    assert open_house.get("/api/project", headers={"Authorization": f"Bearer {TOKEN}"}).status_code == 200


def test_the_page_is_opened_with_the_token_and_keeps_it_in_a_cookie(open_house: TestClient):
    open_house.cookies.clear()
    answer = open_house.get(f"/?token={TOKEN}")
    assert answer.status_code == 200
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert open_house.get("/api/project").status_code == 200
    assert "set-cookie" not in open_house.get("/api/project").headers


def test_a_server_that_others_reach_takes_no_weak_token(tmp_path: Path):
    with pytest.raises(OnbeatError, match="16 or more"):
        serve(tmp_path / "p", host="0.0.0.0", port=0, token="1234")

"""The server of ``molviz view``: whom it answers, what it refuses, and when it ends."""

import http.client
import json
import os
import shlex
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from tests.browser import served

SAMPLES = Path(__file__).parent.parent / "samples"
CAFFEINE = str(SAMPLES / "caffeine.xyz")


class Client:
    """Requests as any program on this machine may send them."""

    def __init__(self, process: subprocess.Popen[str], address: str) -> None:
        self.process, self.address = process, address
        self.port, self.base = int(urlsplit(address).port or 0), urlsplit(address).path

    def send(
        self, path: str | None = None, method: str = "GET", body: bytes = b"", **headers: str
    ) -> tuple[int, bytes, dict[str, str]]:
        """Return status, content and headers; names of headers have underscores here."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        named = {"Host": f"127.0.0.1:{self.port}"} | {name.replace("_", "-"): value for name, value in headers.items()}
        connection.putrequest(method, self.base if path is None else path, skip_host=True, skip_accept_encoding=True)
        for name, value in ({"Content-Length": str(len(body))} | named if body else named).items():
            connection.putheader(name, value)
        connection.endheaders(body)
        response = connection.getresponse()
        return response.status, response.read(), {name.lower(): value for name, value in response.getheaders()}

    def ask(self, question: Any) -> tuple[dict[str, Any], bytes]:
        """Return head and body of an answer."""
        body = json.dumps(question).encode()
        status, content, _ = self.send(f"{self.base}ask", "POST", body, Content_Type="application/json")
        assert status == 200
        length = int.from_bytes(content[:4], "little")
        return json.loads(content[4 : 4 + length]), content[4 + length :]

    @property
    def memory(self) -> int:
        """Bytes of memory of the server."""
        pages = int(Path(f"/proc/{self.process.pid}/statm").read_text().split()[1])
        return pages * os.sysconf("SC_PAGESIZE")


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with served(CAFFEINE) as (process, address):
        found = Client(process, address)
        yield found
        assert process.poll() is None and found.send()[0] == 200  # it lives, whatever was tried


def test_the_address_answers_by_itself_and_nothing_else_is_printed(client: Client) -> None:
    assert client.address.startswith("http://127.0.0.1:") and len(client.base) > 30
    status, content, headers = client.send()
    assert status == 200 and b"<title>molviz view</title>" in content
    assert "default-src 'none'" in headers["content-security-policy"] and "unsafe" not in str(headers)
    assert headers["referrer-policy"] == "no-referrer" and headers["x-content-type-options"] == "nosniff"


def test_it_listens_on_the_loopback_address_alone(client: Client) -> None:
    own = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    assert {line[1] for line in own if line[1].endswith(f":{client.port:04X}") and line[3] == "0A"} == {
        f"0100007F:{client.port:04X}"
    }
    with pytest.raises(OSError):
        socket.create_connection(("::1", client.port), timeout=1)


@pytest.mark.parametrize(
    "headers",
    [{"Host": "evil.example"}, {"Host": "127.0.0.1"}, {"Host": "evil.example:{port}"}, {"Host": ""},
     {"Host": "127.0.0.1:{port}.evil.example"}, {"Origin": "http://evil.example"}, {"Origin": "null"},
     {"Origin": "http://127.0.0.1:1"}, {"Origin": "https://127.0.0.1:{port}"}, {"Sec_Fetch_Site": "cross-site"},
     {"Sec_Fetch_Site": "same-site"}],
)  # fmt: skip
@pytest.mark.parametrize("method", ["GET", "POST"])
def test_other_hosts_and_origins_are_refused(client: Client, headers: dict[str, str], method: str) -> None:
    named = {name: value.format(port=client.port) for name, value in headers.items()}
    path, body = (client.base, b"") if method == "GET" else (f"{client.base}ask", b'{"ask": "start"}')
    more = {} if method == "GET" else {"Content_Type": "application/json"}
    assert client.send(path, method, body, **more)[0] == 200
    status, content, _ = client.send(path, method, body, **more | named)
    assert status in (400, 403) and b"caffeine" not in content


def test_its_own_origin_is_welcome(client: Client) -> None:
    for host in (f"127.0.0.1:{client.port}", f"localhost:{client.port}"):
        assert client.send(Host=host, Origin=f"http://{host}", Sec_Fetch_Site="same-origin")[0] == 200


@pytest.mark.parametrize(
    "path",
    ["/", "/ask", "/viewer.js", "/favicon.ico", "/{other}/", "/{other}/ask", "{token}", "{base}../", "{base}none.js",
     "{base}../../../../etc/passwd", "{base}..%2f..%2f..%2fetc%2fpasswd", "{base}%2e%2e/%2e%2e/etc/passwd",
     "{base}....//....//etc/passwd", "{base}/etc/passwd", "{base}//etc/passwd", "{base}viewer.js/../../server.py",
     "{base}viewer.js%00.html", "{base}\\..\\..\\etc\\passwd", "{base}.", "{base}server.py", "{base}file:///etc/passwd",
     "//{other}{base}", "/x{base}", "{upper}", "{base}alive/", "{base}ask/"],
)  # fmt: skip
def test_other_paths_are_refused(client: Client, path: str) -> None:
    names = {"base": client.base, "token": client.base[:-1], "other": "A" * 32, "upper": client.base.swapcase()}
    status, content, _ = client.send(path.format(**names))
    assert status == 403 and content == b"refused\n"


@pytest.mark.parametrize("method", ["PUT", "DELETE", "POST", "OPTIONS", "PATCH", "TRACE"])
def test_other_methods_are_refused(client: Client, method: str) -> None:
    assert client.send(None, method)[0] == 403


def test_what_is_no_question_is_refused(client: Client) -> None:
    ask = f"{client.base}ask"
    for body in (b"{", b"\xff\xfe", b"[" * 100_000, b"1" * 5000, b""):
        assert client.send(ask, "POST", body, Content_Type="application/json")[0] == 400
    assert client.send(ask, "POST", b"{}", Content_Type="text/plain")[0] == 415
    assert client.send(ask, "POST", b"ask=start", Content_Type="application/x-www-form-urlencoded")[0] == 415
    assert client.send(ask, "POST", b" " * 300_000, Content_Type="application/json")[0] == 413


def test_a_message_that_never_ends_is_refused(client: Client) -> None:
    with socket.create_connection(("127.0.0.1", client.port), timeout=60) as line:
        head = f"POST {client.base}ask HTTP/1.1\r\nHost: 127.0.0.1:{client.port}\r\n"
        line.sendall(f"{head}Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n".encode())
        sent = 0
        try:
            while sent < 100_000_000:
                sent += line.send(b"10000\r\n" + b" " * 65536 + b"\r\n")
        except OSError:
            pass
        assert sent < 20_000_000
    with socket.create_connection(("127.0.0.1", client.port), timeout=60) as line:
        line.sendall(b"GET / HTTP/1.1\r\n" + b"X: " + b"y" * 1_000_000)
        assert line.recv(100).startswith(b"HTTP/1.1 400")


@pytest.mark.parametrize(
    "question",
    [None, [], "start", {}, {"ask": "nothing"}, {"ask": []}, {"ask": {"a": 1}}, {"ask": "scene", "input": 1},
     {"ask": "scene", "input": -1}, {"ask": "scene", "input": True}, {"ask": "scene", "input": "/etc/passwd"},
     {"ask": "scene", "options": []}, {"ask": "picture", "options": {"radii": "/etc/passwd"}},
     {"ask": "picture", "options": {"style": "/etc/passwd"}}, {"ask": "picture", "options": {"palette": "/etc/passwd"}},
     {"ask": "picture", "options": {"style": ["/etc/passwd"]}},
     {"ask": "picture", "options": {"view_from": "/etc/passwd"}},
     {"ask": "picture", "options": {"method": "painter"}}, {"ask": "picture", "options": {"no_such": 1}},
     {"ask": "picture", "options": {"title": "\ud800"}}, {"ask": "picture", "options": {"title": 5}},
     {"ask": "picture", "options": {"legend": "yes"}}, {"ask": "picture", "options": {"view": "nan,0,0,1"}},
     {"ask": "picture", "options": {"view": [0, 0, 0, 0]}}, {"ask": "picture", "options": {"perspective": 1e400}},
     {"ask": "picture", "options": {"perspective": 0.001}}, {"ask": "picture", "options": {"model": "all"}},
     {"ask": "picture", "options": {"color": [[1, 2]]}}, {"ask": "picture", "options": {"select": "(" * 5000}},
     {"ask": "save", "format": "exe"}, {"ask": "save", "format": "../x"}, {"ask": "save"},
     {"ask": "load", "text": "x = "}, {"ask": "load", "text": 5}, {"ask": "load", "text": "style = '/etc/passwd'"},
     {"ask": "load", "text": "radii = '/etc/passwd'"}, {"ask": "load", "text": "view = " + "[" * 5000},
     {"ask": "count", "select": "elment C"}, {"ask": "count", "options": 5}],
)  # fmt: skip
def test_wrong_questions_are_answered_with_what_is_wrong(client: Client, question: Any) -> None:
    head, body = client.ask(question)
    assert set(head) == {"error"} and not body and "root:" not in head["error"]


def test_many_questions_at_once(client: Client) -> None:
    questions = [{"ask": "picture", "options": {"view": [1, k, 0, 0]}} for k in range(48)]
    with ThreadPoolExecutor(16) as pool:
        heads = list(pool.map(lambda question: client.ask(question)[0], questions))
    assert all(head["atoms"] == 24 for head in heads) and len({head["command"] for head in heads}) == 48


def test_an_older_picture_is_abandoned_for_a_newer_one_of_the_same_page() -> None:
    with served(str(SAMPLES / "2beg.cif.gz")) as (process, address):
        client = Client(process, address)

        def picture(number: int, page: str = "a") -> dict[str, Any]:
            time.sleep(0.05 * number)
            return client.ask({"ask": "picture", "page": page, "number": number})[0]

        with ThreadPoolExecutor(8) as pool:
            other = pool.submit(picture, 1, "b")
            heads = list(pool.map(picture, range(1, 7)))
        assert [bool(head.get("abandoned")) for head in heads] == [True] * 5 + [False]
        assert other.result()["atoms"] == heads[-1]["atoms"]


def test_pictures_are_those_of_the_command_line(client: Client, tmp_path: Path) -> None:
    """Options of each kind, through JSON and back to words."""
    options = {
        "style": "flat", "color": ["element N=navy", "element O=#ff8000"], "label": ["index 3=a \"b\" 'c' $d \\ é",
        "element O"], "title": "-- two\nlines", "scale_bar": "auto", "legend": True, "background": "#ffe",
        "view": [0.3, -0.2, 0.9, 0.1], "perspective": 41.7, "width": "9cm", "outline": 1.25, "crease": 0,
        "select": "not index 23", "no_hydrogens": False, "water": True, "scale_radii": 0.9, "page": "a4", "chain": None,
    }  # fmt: skip
    head, body = client.ask({"ask": "save", "format": "svg", "options": options})
    words = shlex.split(head["command"])
    subprocess.run([Path(sys.executable), "-m", *words], check=True, cwd=tmp_path, capture_output=True)
    assert (tmp_path / words[-1]).read_bytes() == body


@pytest.mark.parametrize(("number", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_signals_end_it(number: int, status: int) -> None:
    with served(str(SAMPLES / "1tii.pdb.gz")) as (process, address):
        client = Client(process, address)
        with ThreadPoolExecutor(2) as pool:
            pool.submit(client.ask, {"ask": "picture"})  # even while it draws
            pool.submit(client.send, f"{client.base}alive")
            time.sleep(0.3)
            process.send_signal(number)
            assert process.wait(10) == status


def test_a_thousand_requests_leave_memory_flat() -> None:
    with served(CAFFEINE) as (process, address):
        client = Client(process, address)

        def turn(count: int, first: int) -> None:
            for k in range(first, first + count):
                options = {"view": [1, k / 100, 0, 0], "select": f"index < {20 + k % 3}"}
                assert client.ask({"ask": "picture", "options": options, "page": str(k), "number": k})[0]["atoms"] > 19
                assert client.ask({"ask": "scene", "options": options})[0]["read"] == 24
                assert client.ask({"ask": "count", "select": f"index < {k}"})[0]["of"] == 24
                assert client.send()[0] == 200

        turn(50, 1)
        before = client.memory
        turn(250, 51)  # four requests each
        assert client.memory - before < 4_000_000


def test_without_the_packages_it_says_what_to_install(tmp_path: Path) -> None:
    code = "import sys; sys.modules['uvicorn'] = None; from molviz.cli import main; main(['view', sys.argv[1]])"
    done = subprocess.run([sys.executable, "-c", code, CAFFEINE], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and "pip install 'molviz[view]'" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("words", "status", "told"),
    [([CAFFEINE, "--select", "elment C"], 2, "did you mean"), (["no.pdb"], 1, "no.pdb"), ([], 2, "INPUT"),
     ([CAFFEINE, "--turntable", "3"], 2, "No such option"), ([CAFFEINE, "--view", "1,2"], 2, "four numbers")],
)  # fmt: skip
def test_what_cannot_be_shown_is_told_before_anything_is_served(words: list[str], status: int, told: str) -> None:
    command = [sys.executable, "-m", "molviz", "view", "--no-browser", *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == status and told in done.stderr and not done.stdout

"""The page's server: on this machine only, for whoever has its address, and for as long as the page is open.

Everything lies below a token that nobody can guess; other paths, hosts and origins are refused with 403. Files are
those of the folder ``page``, read once; nothing else of the disk can be asked for.
"""

import asyncio
import hmac
import json
import queue
import secrets
import socket
import threading
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import uvicorn
from starlette.applications import Starlette
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response, StreamingResponse
from starlette.routing import Mount, Route, Router
from starlette.types import ASGIApp, Receive, Scope, Send

from molviz.viewer.session import Answer, Session

PAGE = Path(__file__).parent / "page"
HOST = "127.0.0.1"
LONGEST = 256 * 1024  # bytes of a question: options with many colours and labels are a few thousand
DEEPEST_HEADER = 32 * 1024  # bytes
PATIENCE = 4.0  # seconds for a page to come back that is loaded anew
BEAT = 5.0  # seconds between signs of life
QUICK = ("start", "count", "state", "load")  # questions that need not wait for pictures
KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src blob: data:; "
    "connect-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Worker:
    """One thread for all long work, in the order in which it comes; the process does not wait for it at its end."""

    def __init__(self) -> None:
        self._jobs: queue.SimpleQueue[tuple[Future[Answer], Callable[[], Answer]]] = queue.SimpleQueue()
        threading.Thread(target=self._run, daemon=True, name="molviz pictures").start()

    def submit(self, job: Callable[[], Answer]) -> "Future[Answer]":
        """Return what will hold the answer."""
        future: Future[Answer] = Future()
        self._jobs.put((future, job))
        return future

    def _run(self) -> None:
        while True:
            future, job = self._jobs.get()
            if future.set_running_or_notify_cancel():
                future.set_result(job())


class Viewers:
    """How many pages are open; after the last one is closed, and none comes within PATIENCE, it is over."""

    def __init__(self, over: Callable[[], None]) -> None:
        self.count, self.over = 0, over

    async def presence(self) -> AsyncIterator[bytes]:
        """Yield signs of life to one page until it is closed."""
        self.count += 1
        try:
            while True:
                yield b": here\n\n"
                await asyncio.sleep(BEAT)
        finally:
            self.count -= 1
            asyncio.get_running_loop().call_later(PATIENCE, self._over_if_nobody_came)

    def _over_if_nobody_came(self) -> None:
        if self.count == 0:
            self.over()


class Guard:
    """Lets through what names this host, comes from no other page, and knows the token."""

    def __init__(self, app: ASGIApp, token: str, port: int) -> None:
        self.app, self.token = app, token
        self.hosts = {f"{name}:{port}" for name in (HOST, "localhost")}
        self.origins = {f"http://{host}" for host in self.hosts}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or refuse it."""
        if scope["type"] == "http":
            await (self.app if self._allowed(Request(scope)) else refusal())(scope, receive, send)

    def _allowed(self, request: Request) -> bool:
        token = request.url.path.split("/")[1:2]
        hosts, origins = request.headers.getlist("host"), request.headers.getlist("origin")
        return (
            len(hosts) == 1 and hosts[0] in self.hosts and set(origins) <= self.origins
            and request.headers.get("sec-fetch-site", "none") in ("none", "same-origin")
            and hmac.compare_digest("".join(token).encode(), self.token.encode())
        )  # fmt: skip


def refusal(status: int = 403) -> Response:
    """Return the answer to what nobody may ask; the line is closed, so that what follows is not even read."""
    return Response(b"refused\n", status, {**HEADERS, "Connection": "close"}, "text/plain")


def packed(answer: Answer) -> bytes:
    """Return an answer as bytes: the length of its head (4 bytes, little-endian), the head as JSON, the body."""
    head = json.dumps(answer.head).encode()
    return len(head).to_bytes(4, "little") + head + answer.body


async def question_of(request: Request) -> object:
    """Return the JSON of a request; raises ValueError where there is none, and OverflowError where it is too long."""
    body = b""
    async for part in request.stream():
        body += part
        if len(body) > LONGEST:
            raise OverflowError
    try:
        question: object = json.loads(body)
    except RecursionError:
        raise ValueError from None
    return question


class Pages:
    """What is below the token: the page's files, answers to its questions, and a stream for as long as it lives."""

    def __init__(self, session: Session, over: Callable[[], None]) -> None:
        self.session, self.viewers, self.worker = session, Viewers(over), Worker()
        self.files = {path.name: path.read_bytes() for path in PAGE.iterdir() if path.suffix in KINDS}

    def application(self, token: str, port: int) -> ASGIApp:
        """Return the server's answers to requests."""
        routes = [
            Route("/", self.file), Route("/ask", self.ask, methods=["POST"]), Route("/alive", self.alive),
            Route("/{name}", self.file),
        ]  # fmt: skip
        below = Mount(f"/{token}", Router(routes, redirect_slashes=False))
        app = Starlette(routes=[below], exception_handlers={404: _refused, 405: _refused})
        app.router.redirect_slashes = False
        return Guard(app, token, port)

    async def file(self, request: Request) -> Response:
        """Return a file of the page."""
        name = request.path_params.get("name", "index.html")
        if name not in self.files:
            return refusal()
        return Response(self.files[name], 200, HEADERS, KINDS[Path(name).suffix])

    async def ask(self, request: Request) -> Response:
        """Return the answer to a question."""
        if request.headers.get("content-type") != "application/json":
            return refusal(415)
        try:
            answer = await self._answer(await question_of(request))
        except ClientDisconnect:
            return refusal()
        except OverflowError:
            return refusal(413)
        except ValueError:
            return refusal(400)
        return Response(packed(answer), 200, HEADERS, "application/octet-stream")

    async def _answer(self, question: Any) -> Answer:
        self.session.heard(question)
        if isinstance(question, dict) and question.get("ask") in QUICK:
            return await asyncio.to_thread(self.session.answer, question)
        return await asyncio.wrap_future(self.worker.submit(lambda: self.session.answer(question)))

    async def alive(self, request: Request) -> Response:
        """Return signs of life; the server ends some time after the last of these streams."""
        return StreamingResponse(self.viewers.presence(), 200, HEADERS, "text/event-stream")


async def _refused(request: Request, wrong: Exception) -> Response:
    return refusal()


def serve(session: Session, tell: Callable[[str], None]) -> None:
    """Serve until the last page is closed, or a signal comes; ``tell`` is given the page's address once it is there."""
    listening = socket.create_server((HOST, 0))
    port, token = listening.getsockname()[1], secrets.token_urlsafe(24)

    def over() -> None:
        server.should_exit = True

    config = uvicorn.Config(
        Pages(session, over).application(token, port), log_level="critical", access_log=False, server_header=False,
        lifespan="off", ws="none", timeout_graceful_shutdown=1, h11_max_incomplete_event_size=DEEPEST_HEADER,
        http="h11", loop="asyncio",
    )  # fmt: skip
    server = uvicorn.Server(config)
    with listening:
        tell(f"http://{HOST}:{port}/{token}/")
        server.run(sockets=[listening])

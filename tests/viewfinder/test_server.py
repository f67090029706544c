"""The server: one turns, others watch; strangers are sent away."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import http.client
import json
import socket
import threading
import time
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.viewfinder import hub
from daguerre.viewfinder import server as serving
from daguerre.viewfinder.server import FILES, MOST_CLIENTS, PATIENCE_S

from .live import TOKEN, Live, Page, live, page
from .test_painter import scene

pytest.importorskip("websockets", reason="needs the extra view")
pytest.importorskip("simplejpeg", reason="needs the extra view")


@pytest.fixture
def server() -> Iterator[Live]:
    with served() as running:
        yield running


def served() -> contextlib.AbstractContextManager[Live]:
    """A server of a small picture."""
    from daguerre.viewfinder.stage import Stage

    made = scene()
    return live(Stage(made, made.camera(), dg.RenderSettings.of(resolution=(120, 80), spp=2)))


def closed(server: Live, token: Any = TOKEN, **more: Any) -> int:
    """Code with which a connection is closed, or the status that refuses it."""
    from websockets.exceptions import ConnectionClosed, InvalidStatus
    from websockets.sync.client import connect

    try:
        with connect(f"ws://{server.host}/live", **more) as line:
            if token is not None:
                line.send(token)
            line.recv(PATIENCE_S + 5)
    except InvalidStatus as error:
        return int(error.response.status_code)
    except ConnectionClosed as error:
        return int(error.rcvd.code) if error.rcvd is not None else 1006
    return 0


def closes(one: Page) -> bool:
    """Whether the server closes the connection of a page."""
    from websockets.exceptions import ConnectionClosed

    try:
        while True:
            one.step()
    except ConnectionClosed:
        return True


def get(server: Live, path: str, method: str = "GET", host: str | None = None) -> Any:
    """Answer to a plain request."""
    line = http.client.HTTPConnection("127.0.0.1", server.port, timeout=10)
    line.putrequest(method, path, skip_host=True)
    line.putheader("Host", host or server.host)
    line.endheaders()
    answer = line.getresponse()
    answer.body = answer.read()  # type: ignore[attr-defined]
    return answer


def test_a_page_gets_pictures_and_turns(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        assert one.role == "turns"
        assert one.heads[-1]["kind"] == "rgb"
        assert len(one.bytes) == 120 * 80 * 3
        one.send(turn={"f_stop": "2", "iso": "200"})
        one.until_rest(1)
        assert one.state["dials"] == {"f_stop": "2", "iso": "200"}
        assert one.state["readings"]["f_stop"] == 2
        assert one.state["command"].startswith("daguerre render scene.glb -o out.exr")
        assert "--f-stop=2" in one.state["command"]


def test_the_values_under_the_pointer_are_those_of_the_render(server: Live) -> None:
    with page(server) as one:
        one.send(turn={"focus_distance": "4"})
        one.until_rest(1)
        one.send(probe=[50, 60])
        while not one.values:
            one.step()
    made = scene()
    camera = made.camera().with_(focus_distance=4)
    alone = dg.render(made, camera, resolution=(120, 80), spp=2)
    assert np.array_equal(np.float32(one.values[0]["rgb"]), alone.rgb[60, 50])


def test_a_wrong_turn_is_said_and_nothing_changes(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        for wrong in ({"turn": {"lens": "/etc/passwd"}}, {"turn": {"nonsense": "1"}}, {"save": 1}):
            one.send(**wrong)
            before = len(one.refused)
            while len(one.refused) == before:
                one.step()
        assert one.state["turn"] == 0


def test_each_change_is_answered_once_also_when_refused(server: Live) -> None:
    """Pages count the answers: their rings stay where they were turned until the last one."""
    with page(server) as one:
        one.until_rest(0)
        changes: list[dict[str, Any]] = [
            {"turn": {"iso": "200"}},
            {"turn": {"lens": "none"}},
            {"undo": True},
            {"redo": True},
            {"redo": True},  # there is nothing to redo
            {"draw": 3},
            {"show": {"tint": "depth"}},
            {"show": {"models": True}},  # no lens of the library
            {"reload": True},
        ]
        for count, message in enumerate(changes, 1):
            one.send(save=1)  # refused, and changes nothing
            one.send(**message)
            while one.heard < count:
                one.step()
        one.send(save=1)
        while len(one.refused) < len(changes) + 4:
            one.step()
        assert one.heard == len(changes)


def test_a_dial_that_cannot_be_goes_back(server: Live) -> None:
    with page(server) as one:
        one.send(turn={"lens": "double-gauss-50mm-f2"})
        one.until_rest(1)
        one.send(turn={"f_stop": "0.7"})
        while not one.state["error"]:
            one.step()
        assert "f/2" in one.state["error"]
        assert one.state["dials"] == {"lens": "double-gauss-50mm-f2"}
        one.until_rest(3)


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (OSError(28, "No space left on device", "desk-1.png"), "desk-1.png: No space left"),
        (MemoryError(), "out of memory"),
        (
            RuntimeError("planted"),
            "internal error: RuntimeError: planted; this is a bug in daguerre",
        ),
    ],
    ids=["disk", "memory", "ours"],
)
def test_a_fault_of_any_kind_is_said_and_the_page_lives(
    server: Live, monkeypatch: pytest.MonkeyPatch, fault: Exception, said: str
) -> None:
    def fails(*_: object) -> None:
        raise fault

    monkeypatch.setattr(hub, "save", fails)
    with page(server) as one:
        one.until_rest(0)
        one.send(save="png")
        while not one.refused:
            one.step()
        assert one.refused[0].startswith(said)
        one.send(turn={"iso": "200"})
        one.until_rest(1)


def test_no_state_from_before_a_turn_follows_it(server: Live) -> None:
    """A page would put the ring back, and the next click would start from there."""
    told: list[dict[str, Any]] = []

    class Line:
        async def send(self, message: str | bytes) -> None:
            if isinstance(message, str):
                told.append(json.loads(message))

    async def tells_and_turns() -> int:
        client = server.hub.join(Line())
        picture = server.hub.picture
        assert picture is not None
        server.hub._report(picture.request, "")  # has the state told
        await server.hub.hear(client, json.dumps({"turn": {"f_stop": "8"}}))
        number = server.hub.number
        await asyncio.sleep(0)
        await server.hub.leave(client)
        return number

    with page(server) as one:
        one.until_rest(0)
    while server.hub._clients:
        time.sleep(0.01)
    number = asyncio.run_coroutine_threadsafe(tells_and_turns(), server.loop).result(30)
    answer = next(k for k, message in enumerate(told) if "heard" in message)
    after = told[answer:]
    assert len([message for message in after if "state" in message]) >= 2
    assert all(m["state"]["turn"] == number for m in after if "state" in m)


def test_others_watch_and_take_over(server: Live) -> None:
    with page(server) as second_first:
        second_first.until_rest(0)
        with page(server) as other:
            other.until_rest(0)
            assert (second_first.role, other.role) == ("turns", "watches")
            other.send(turn={"iso": "200"})
            while not other.refused:
                other.step()
            second_first.send(turn={"iso": "400"})
            other.until_rest(1)
            assert other.state["dials"] == {"iso": "400"}
            second_first.socket.close()
            while other.role != "turns":
                other.step()
            other.send(turn={"iso": "800"})
            other.until_rest(2)


def test_a_page_turns_on_while_a_picture_is_developed(
    server: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That picture is shown all the same."""
    develop = hub.image_of

    def developed_late(drawn: Any, **more: Any) -> Any:
        end = time.monotonic() + 5
        while drawn.request.number == 1 and server.hub.number < 2 and time.monotonic() < end:
            time.sleep(0.01)
        return develop(drawn, **more)

    with page(server) as one:
        one.until_rest(0)
        monkeypatch.setattr(hub, "image_of", developed_late)
        one.send(turn={"f_stop": "2"})
        while one.drawn < 1 and one.heads[-1]["turn"] == 0:
            one.step()
        assert (one.drawn, one.heads[-1]["turn"]) == (1, 0)
        one.send(turn={"f_stop": "4"})
        one.until_rest(2)
        assert 1 in {head["turn"] for head in one.heads}
        assert one.state["readings"]["f_stop"] == 4


def test_a_page_that_does_not_answer_gets_one_picture(server: Live) -> None:
    with page(server) as slow:
        slow.acknowledges = False
        while not slow.heads:
            slow.step()
        time.sleep(1)
        slow.send(probe=[1, 1])
        while not slow.values:
            slow.step()
        assert len(slow.heads) == 1
        slow.send(got=slow.heads[0]["picture"])
        slow.acknowledges = True
        slow.until_rest(0)


def test_files_of_the_page_and_their_headers(server: Live) -> None:
    for path, body in FILES.items():
        answer = get(server, path)
        assert answer.status == 200
        assert answer.body == body
        assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
        assert "unsafe" not in answer.headers["Content-Security-Policy"]
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
        assert answer.headers["Access-Control-Allow-Origin"] is None
        assert answer.headers["Set-Cookie"] is None
    assert get(server, "/").body == FILES["/index.html"]
    assert sum(map(len, FILES.values())) < 150_000


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml",
        "/..%2f..%2fetc/passwd",
        "//etc/passwd",
        "/%2e%2e/server.py",
        "/page/../../server.py",
        "/main.js/../server.py",
        "/server.py",
        "/.",
        "/index.html%00.js",
        "/lens/../../x.svg",
    ],
)
def test_no_other_file_is_served(server: Live, path: str) -> None:
    assert get(server, path).status == 404


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1", "localhost:1"])
def test_a_wrong_host_is_refused(server: Live, host: str) -> None:
    assert get(server, "/", host=host).status == 421
    answer = closed(server, additional_headers={"Host": host})
    assert answer in (400, 421)


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "PATCH"])
def test_other_methods_are_refused(server: Live, method: str) -> None:
    assert get(server, "/", method).status in (400, 405)


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1"])
@pytest.mark.parametrize("token", [TOKEN, "wrong"])
def test_a_socket_of_another_origin_is_refused(server: Live, origin: str, token: str) -> None:
    assert closed(server, token, origin=origin) == 403


@pytest.mark.parametrize(
    "token", ["", "wrong", TOKEN + " ", TOKEN[:-1], b"test-token", "x" * 60000]
)
def test_a_wrong_token_is_refused(server: Live, token: str | bytes) -> None:
    assert closed(server, token) == 4401
    assert closed(server, token, origin=f"http://{server.host}") == 4401


def test_no_token_is_refused_in_time(server: Live) -> None:
    began = time.monotonic()
    assert closed(server, None) == 4408
    assert time.monotonic() - began < PATIENCE_S + 3


def test_a_message_that_is_too_long_closes_the_connection(server: Live) -> None:
    assert closed(server, "x" * (1 << 17)) == 1009
    with page(server) as one:
        one.until_rest(0)
        one.socket.send(json.dumps({"turn": {"look": "x" * (1 << 17)}}))
        assert closes(one)


def test_hostile_messages_are_answered_and_the_page_lives(server: Live) -> None:
    with page(server) as one:
        one.until_rest(0)
        for text in ("{", "[" * 60000, '{"__proto__": {}}', '{"turn": {"constructor": "1"}}', "0"):
            one.socket.send(text)
        one.socket.send(b"\0\1\2")
        while len(one.refused) < 6:
            one.step()
        one.send(turn={"iso": "200"})
        one.until_rest(1)


def test_slow_and_many_connections_leave_the_page_alone(server: Live) -> None:
    lines = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(200)]
    for line in lines[::2]:
        line.send(b"GET / HT")
    with page(server) as one:
        one.until_rest(0)
    deadline = time.monotonic() + PATIENCE_S + 5
    for line in lines:
        line.settimeout(max(0.1, deadline - time.monotonic()))
        while line.recv(1024):
            pass
        line.close()


def test_messages_do_not_wait_for_each_other(server: Live, monkeypatch: pytest.MonkeyPatch) -> None:
    delays = []
    welcome = server.hub.welcome

    async def spied(client: Any) -> None:
        sock = client.line._connection.transport.get_extra_info("socket")
        delays.append(not sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        await welcome(client)

    monkeypatch.setattr(server.hub, "welcome", spied)
    with page(server) as one:
        one.step()
    assert delays == [False]


def test_pages_are_limited(server: Live) -> None:
    import contextlib

    with contextlib.ExitStack() as stack:
        for _ in range(MOST_CLIENTS):
            stack.enter_context(page(server)).until_rest(0)
        assert closed(server) == 4429
    with page(server) as one:
        one.until_rest(0)


def test_connections_of_the_last_moment_are_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(serving, "PATIENCE_S", 0.2)
    lines: list[socket.socket] = []
    begun = threading.Event()

    def connect(running: Live) -> None:
        begun.set()
        lines.extend(socket.create_connection(("127.0.0.1", running.port)) for _ in range(4))
        time.sleep(0.3)  # meanwhile the server is asked to end

    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        with served() as running:
            running.loop.call_soon_threadsafe(connect, running)
            assert begun.wait(30)
        for line in lines:
            line.close()
        del running
        gc.collect()
    assert len(lines) == 4
    assert [str(one.message) for one in found] == []


def test_a_page_that_is_stuck_does_not_hold_the_end(caplog: pytest.LogCaptureFixture) -> None:
    with socket.socket() as line:
        with served() as server:
            line.connect(("127.0.0.1", server.port))
            line.sendall(
                f"GET /live HTTP/1.1\r\nHost: {server.host}\r\nOrigin: http://{server.host}\r\n"
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode()
            )
            assert line.recv(12) == b"HTTP/1.1 101"
            text = TOKEN.encode()  # masked by zeros
            line.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)
            begun = time.monotonic()
            while not server.hub._clients and time.monotonic() - begun < 30:
                time.sleep(0.05)
            assert server.hub._clients
            begun = time.monotonic()
        assert time.monotonic() - begun < 8  # 10 s by websockets' default
    assert not [one for one in caplog.records if one.levelname == "ERROR"]

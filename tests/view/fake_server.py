"""A server of a live session made of the standard library: one page and its socket.

It keeps every message of the page, and tells of a crank that follows the mouse, and whose length
follows what the page asks for.
"""

import base64
import hashlib
import json
import math
import socket
import struct
import threading

GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


class FakeServer:
    """`mechanism` has poses(theta) and coordinates(theta); `writer` is what a new page may do."""

    def __init__(self, html, mechanism, writer=True, port=0):
        self.html, self.mechanism, self.writer = html.encode(), mechanism, writer
        self.messages, self.connections = [], []
        self.theta, self.time, self.hand, self.echo = 0.6, 0.0, None, None
        self.at_limit = []
        self.design = None    # {"values": [mm], "asked": [mm], "work": J} of the crank's length
        self.longest = 1e9    # mm, of the crank
        self.listener = socket.create_server(("127.0.0.1", port))
        self.port = self.listener.getsockname()[1]
        self.running = True
        threading.Thread(target=self._accept, daemon=True).start()

    @property
    def address(self):
        return f"http://127.0.0.1:{self.port}/?token=secret"

    def stop(self):
        self.running = False
        for connection in [self.listener, *self.connections]:
            try:
                connection.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # The page has left already.
            connection.close()

    def done(self, word):
        """The messages of one kind that have come."""
        return [message for message in list(self.messages) if message.get("do") == word]

    def _accept(self):
        while self.running:
            try:
                connection, _ = self.listener.accept()
            except OSError:
                return
            self.connections.append(connection)
            threading.Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection):
        try:
            head = b""
            while b"\r\n\r\n" not in head:
                more = connection.recv(4096)
                if not more:
                    return
                head += more
            lines = head.decode().split("\r\n")
            fields = dict(line.split(": ", 1) for line in lines[1:] if ": " in line)
            if lines[0].startswith("GET /socket?token=secret "):
                self._talk(connection, fields["Sec-WebSocket-Key"])
            else:
                connection.sendall(b"HTTP/1.1 200 OK\r\nContent-Type: text/html; charset=utf-8\r\n"
                                   b"Connection: close\r\nContent-Length: "
                                   + str(len(self.html)).encode() + b"\r\n\r\n" + self.html)
                connection.close()
        except OSError:
            pass  # The connection was closed from either side.

    def _talk(self, connection, key):
        accept = base64.b64encode(hashlib.sha1(key.encode() + GUID).digest())
        connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                           b"Connection: Upgrade\r\nSec-WebSocket-Accept: " + accept + b"\r\n\r\n")
        send_text(connection, {"hello": {"writer": self.writer, "version": "0.1.0",
                                         "session": "one"}})
        while (text := receive_text(connection)) is not None:
            message = json.loads(text)
            self.messages.append(message)
            if (answer := self._answer(message)) is not None:
                send_text(connection, answer)

    def _answer(self, message):
        kind = message["do"]
        if kind == "grab":
            self.hand = {"link": message["link"], "local": message["point"], "target": None}
        elif kind == "drag" and self.hand:
            x, y, _ = self.hand["target"] = message["to"]
            self.theta = math.atan2(y, x)
            self.echo = message["sent"]
        elif kind == "release":
            self.hand = None
        elif kind == "modes":
            return {"modes": [{"coordinates": self.mechanism.coordinates(t),
                               "poses": self.mechanism.poses(t)} for t in (0.6, 2.0)],
                    "note": "Two of them."}
        elif kind == "save":
            return {"save": message["what"],
                    "files": [{"name": "posed.yaml", "text": "name: four-bar\n"}]}
        elif kind == "vary" and self.design:
            self.design["asked"][message["parameter"]] = message["value"]
        elif kind == "next":
            fresh = self.design and self._follow()
            return {"state": self._state(), **({"scene": self.mechanism.scene(0)} if fresh else {})}
        return None

    def _follow(self):
        """One step towards the length that was asked for; says whether there was one."""
        (value,), (asked,) = self.design["values"], self.design["asked"]
        goal = min(asked, self.longest)
        self.design["stopped"] = (f"the loops do not close beyond crank = {goal} mm"
                                  if asked > goal == value else "")
        step = max(-1.0, min(1.0, goal - value))
        self.design["values"] = [value + step]
        self.mechanism.crank = 1e-3 * (value + step)
        return step != 0

    def _state(self):
        self.time += 1 / 60
        theta = self.theta
        state = {"time": self.time, "mode": "held" if self.hand else "frozen",
                 "poses": self.mechanism.poses(theta),
                 "coordinates": self.mechanism.coordinates(theta), "rates": [0, 0, 0, 0],
                 "wrenches": [[3, 4, 0, 0, 0, 0]] * 4, "at_limit": self.at_limit,
                 "closure": 1e-15, "stopped": False, "rows": len(self.messages)}
        if self.hand and self.hand["target"]:
            long = self.mechanism.crank
            tip = [long * math.cos(theta), long * math.sin(theta), 0]
            state["hand"] = {"link": 1, "point": tip, "target": self.hand["target"],
                             "force": [3, 4, 0], "moment": [0, 0, 0]}
        if self.design:
            state["design"] = self.design
        if self.echo is not None:
            state["echo"], self.echo = self.echo, None
        return state


def send_text(connection, message):
    data = json.dumps(message).encode()
    size = bytes([len(data)]) if len(data) < 126 else b"\x7e" + struct.pack(">H", len(data))
    connection.sendall(b"\x81" + size + data)


def receive_exactly(connection, count):
    data = b""
    while len(data) < count:
        more = connection.recv(count - len(data))
        if not more:
            return None
        data += more
    return data


def receive_text(connection):
    """The text of the next frame, or None when the page has left. The page's frames are masked."""
    head = receive_exactly(connection, 2)
    if head is None or head[0] & 0x0F == 8:
        return None
    count = head[1] & 0x7F
    if count == 126:
        count = struct.unpack(">H", receive_exactly(connection, 2))[0]
    mask = receive_exactly(connection, 4)
    data = receive_exactly(connection, count)
    return None if data is None else bytes(b ^ mask[i % 4] for i, b in enumerate(data)).decode()

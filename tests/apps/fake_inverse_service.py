"""A stand-in for Haply's Inverse Service: one Inverse3 that a hand moves.

Made of the standard library alone.
"""

import base64
import hashlib
import json
import math
import socket
import struct
import threading
import time

GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


class FakeInverseService:
    """Answers each message with one state of the device. The handle goes where the hand wants it,
    10 mm to both sides; `forces` is what it was asked to exert, one entry per message."""

    def __init__(self):
        self.forces = []
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._serve, daemon=True).start()

    def stop(self):
        self.listener.close()

    def _serve(self):
        try:
            connection, _ = self.listener.accept()
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            self._shake_hands(connection)
            self._send(connection, {"session_id": 1, "inverse3": [{
                "device_id": "049D", "config": {"handedness": "right"},
                "status": {"calibrated": True}, **self._state()}]})
            while (message := self._receive(connection)) is not None:
                command = json.loads(message)["inverse3"][0]["commands"]["set_cursor_force"]
                self.forces.append([command["vector"][axis] for axis in "xyz"])
                self._send(connection, {"inverse3": [{"device_id": "049D", **self._state()}]})
        except OSError:
            pass  # The listener was closed, or the other side is gone.

    def _state(self):
        x = 0.01 * math.sin(2 * math.pi * time.monotonic())
        force = self.forces[-1] if self.forces else [0, 0, 0]
        return {"state": {"cursor_position": {"x": x, "y": -0.12, "z": 0.15},
                          "cursor_velocity": {"x": 0, "y": 0, "z": 0},
                          "current_cursor_force": dict(zip("xyz", force))}}

    @staticmethod
    def _shake_hands(connection):
        head = b""
        while b"\r\n\r\n" not in head:
            head += connection.recv(4096)
        fields = dict(line.split(": ", 1) for line in head.decode().split("\r\n") if ": " in line)
        accept = hashlib.sha1(fields["Sec-WebSocket-Key"].encode() + GUID).digest()
        connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                           b"Connection: Upgrade\r\nSec-WebSocket-Accept: "
                           + base64.b64encode(accept) + b"\r\n\r\n")

    @staticmethod
    def _send(connection, message):
        data = json.dumps(message).encode()
        size = bytes([len(data)]) if len(data) < 126 else b"\x7e" + struct.pack(">H", len(data))
        connection.sendall(b"\x81" + size + data)

    def _receive(self, connection):
        """The next text; None at the end."""
        head = self._exactly(connection, 2)
        if head is None or head[0] & 15 == 8:
            return None
        size = head[1] & 127
        if size == 126:
            size = struct.unpack(">H", self._exactly(connection, 2))[0]
        mask, data = self._exactly(connection, 4), self._exactly(connection, size)
        return bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)).decode()

    @staticmethod
    def _exactly(connection, count):
        data = b""
        while len(data) < count:
            more = connection.recv(count - len(data))
            if not more:
                return None
            data += more
        return data

"""Reads MCAP files by their specification (https://mcap.dev/spec), with none of our code."""

import struct
import zlib

MAGIC = b"\x89MCAP0\r\n"


class Cursor:
    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, code):
        size = struct.calcsize("<" + code)
        value, = struct.unpack_from("<" + code, self.data, self.at)
        self.at += size
        return value

    def take(self, size):
        assert self.at + size <= len(self.data), "a record ends too early"
        self.at += size
        return self.data[self.at - size:self.at]

    def text(self):
        return self.take(self.number("I")).decode()

    def mapping(self, key, value):
        inside, found = Cursor(self.take(self.number("I"))), {}
        while inside.at < len(inside.data):
            name = getattr(inside, key)() if key == "text" else inside.number(key)
            found[name] = getattr(inside, value)() if value == "text" else inside.number(value)
        return found


def records(data, begin, end):
    """Yields (offset, opcode, content, whole length)."""
    while begin < end:
        opcode, length = struct.unpack_from("<BQ", data, begin)
        yield begin, opcode, data[begin + 9:begin + 9 + length], 9 + length
        begin += 9 + length
    assert begin == end


def read(data):
    """Checks magic, every CRC, index and count; returns (messages by topic, metadata, attachments).

    A message is (time, bytes)."""
    assert data.startswith(MAGIC) and data.endswith(MAGIC)
    footer = len(data) - 8 - 29
    opcode, length, summary, offsets, crc = struct.unpack_from("<BQQQI", data, footer)
    assert (opcode, length) == (2, 20)
    assert zlib.crc32(data[summary:footer + 25]) == crc

    topics, schemas, messages, metadata, attachments = {}, {}, {}, {}, {}
    chunks, places = [], {}
    for offset, opcode, content, size in records(data, 8, summary):
        cursor = Cursor(content)
        places[offset] = (opcode, size)
        if opcode == 6:
            chunks.append(read_chunk(offset, size, cursor, topics, schemas, messages))
        elif opcode == 7:
            channel, entries = cursor.number("H"), Cursor(cursor.take(cursor.number("I")))
            index = []
            while entries.at < len(entries.data):
                index.append((entries.number("Q"), entries.number("Q")))
            assert index == chunks[-1]["entries"][channel]
            chunks[-1]["indexes"][channel] = offset
        elif opcode == 0x0C:
            name = cursor.text()
            metadata[name] = cursor.mapping("text", "text")
        elif opcode == 9:
            cursor.take(16)
            name, kind = cursor.text(), cursor.text()
            attachments[name] = (kind, cursor.take(cursor.number("Q")))
            assert zlib.crc32(content[:-4]) == cursor.number("I")
        elif opcode == 0x0F:
            assert cursor.number("I") == zlib.crc32(data[:offset])
            assert offset + size == summary
    check_summary(data, summary, offsets, footer, chunks, places, messages)
    return {topics[c]: found for c, found in messages.items()}, metadata, attachments


def read_chunk(offset, size, cursor, topics, schemas, messages):
    start, end, plain = (cursor.number("Q") for _ in range(3))
    crc, compression = cursor.number("I"), cursor.text()
    body = cursor.take(cursor.number("Q"))
    assert compression == "" and len(body) == plain and zlib.crc32(body) == crc
    chunk = {"offset": offset, "size": size, "start": start, "end": end, "entries": {},
             "indexes": {}, "plain": plain}
    for place, opcode, content, _ in records(body, 0, len(body)):
        inside = Cursor(content)
        number = inside.number("H")
        if opcode == 3:
            schemas[number] = (inside.text(), inside.text(), inside.text())
            assert schemas[number][1] == "jsonschema"
        elif opcode == 4:
            assert inside.number("H") in schemas
            topics[number] = inside.text()
            assert inside.text() == "json"
        else:
            assert opcode == 5 and number in topics
            sequence, time = inside.number("I"), inside.number("Q")
            inside.number("Q")
            found = messages.setdefault(number, [])
            assert sequence == len(found) and start <= time <= end
            found.append((time, content[inside.at:]))
            chunk["entries"].setdefault(number, []).append((time, place))
    return chunk


def check_summary(data, summary, offsets, footer, chunks, places, messages):
    groups, seen = {}, 0
    for offset, opcode, content, size in records(data, summary, offsets):
        groups.setdefault(opcode, []).append((offset, size))
        cursor = Cursor(content)
        if opcode == 8:
            chunk = chunks[seen]
            seen += 1
            times = cursor.number("Q"), cursor.number("Q")
            assert times == (chunk["start"], chunk["end"])
            assert (cursor.number("Q"), cursor.number("Q")) == (chunk["offset"], chunk["size"])
            assert cursor.mapping("H", "Q") == chunk["indexes"]
            cursor.number("Q")
            assert cursor.text() == ""
            assert cursor.number("Q") == cursor.number("Q") == chunk["plain"]
        elif opcode == 0x0B:
            check_statistics(cursor, chunks, messages, places)
        elif opcode in (0x0A, 0x0D):
            place = cursor.number("Q")
            assert places[place] == ({0x0A: 9, 0x0D: 0x0C}[opcode], cursor.number("Q"))
    assert seen == len(chunks)
    for _, opcode, content, _ in records(data, offsets, footer):
        cursor = Cursor(content)
        assert opcode == 0x0E
        group = groups.pop(cursor.number("B"))
        assert cursor.number("Q") == group[0][0]
        assert cursor.number("Q") == sum(size for _, size in group)
    assert not groups


def check_statistics(cursor, chunks, messages, places):
    kinds = [opcode for opcode, _ in places.values()]
    assert cursor.number("Q") == sum(len(found) for found in messages.values())
    assert (cursor.number("H"), cursor.number("I")) == (len(messages), len(messages))
    assert (cursor.number("I"), cursor.number("I")) == (kinds.count(9), kinds.count(0x0C))
    assert cursor.number("I") == len(chunks)
    assert cursor.number("Q") == min(chunk["start"] for chunk in chunks)
    assert cursor.number("Q") == max(chunk["end"] for chunk in chunks)
    assert cursor.mapping("H", "Q") == {c: len(found) for c, found in messages.items()}

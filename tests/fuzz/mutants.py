"""Damage to files: what editors, transfers and faulty exporters do, and numbers nobody expects."""

from __future__ import annotations

import random
import re

NUMBER = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?")
NUMBERS = [
    b"nan",
    b"inf",
    b"-inf",
    b"1e400",
    b"-1e308",
    b"1e-320",
    b"0",
    b"-0.0",
    b"-1",
    b"1",
    b"2147483647",
    b"-2147483648",
    b"4294967296",
    b"9223372036854775808",
    b"1000000000000",
    b"1e12",
    b"7" * 400,
    b"3" * 5000,
    b"0x10",
    b"1_000",
    b"1,5",
    b"\xd9\xa3",
    b"",
    b"x",
]
BYTES = [b"\0", b"\xff", b"\x1b[2J", b"\r", b"\n", b"\n\n", b'"', b"'", b"\\", b"\xe2\x80\xae", b"[" * 2000, b"{" * 50]
BYTES += [b" " * 3000, b"\xef\xbb\xbf", b"%%255", b"\\U+0000", b"\\U+D800", b"#", b"-" * 30, b"1e9/1e9/1e9"]


def mutant(draw: random.Random, seeds: list[bytes], text: bool) -> bytes:
    """One of the seeds with one to four damages."""
    data = draw.choice(seeds)
    for _ in range(draw.choice((1, 1, 1, 2, 4))):
        data = _damaged(draw, data, seeds, text)
    return data


def _damaged(draw: random.Random, data: bytes, seeds: list[bytes], text: bool) -> bytes:
    if not data:
        return draw.choice(BYTES)
    kind = draw.randrange(10)
    if text and kind < 4:
        return _other_number(draw, data) if kind < 3 else _other_lines(draw, data)
    at = draw.randrange(len(data))
    if kind < 5:
        return data[:at] + bytes([draw.randrange(256)]) + data[at + 1 :]
    if kind == 5:
        return data[:at] + bytes([data[at] ^ 1 << draw.randrange(8)]) + data[at + 1 :]
    if kind == 6:
        return data[:at] + draw.choice(BYTES) + data[at:]
    length = min(draw.choice((1, 4, 40, 400)), len(data) - at)
    if kind == 7:
        return data[:at] + data[at + length :]
    if kind == 8:
        other = draw.choice(seeds)
        begin = draw.randrange(len(other)) if other else 0
        return data[:at] + other[begin : begin + length] + data[at + draw.choice((0, length)) :]
    if draw.random() < 0.3:
        return data[:at]
    # a number of a binary file
    width = draw.choice((1, 2, 4, 8))
    extreme = draw.choice((0, 1, 2 ** (8 * width) - 1, 2 ** (8 * width - 1), 2 ** (8 * width - 1) - 1, 10**width))
    return data[:at] + extreme.to_bytes(width, "little") + data[at + width :]


def _other_number(draw: random.Random, data: bytes) -> bytes:
    found = list(NUMBER.finditer(data))
    if not found:
        return data + draw.choice(NUMBERS)
    place = draw.choice(found)
    return data[: place.start()] + draw.choice(NUMBERS) + data[place.end() :]


def _other_lines(draw: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    one, other = draw.randrange(len(lines)), draw.randrange(len(lines))
    match draw.randrange(4):
        case 0:
            lines[one], lines[other] = lines[other], lines[one]
        case 1:
            lines.insert(other, lines[one])
        case 2:
            del lines[one]
        case _:
            lines[one:one] = [lines[one]] * draw.choice((3, 300))
    return b"\n".join(lines)

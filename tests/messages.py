"""What makes a message readable, as rules that a program can check."""

from __future__ import annotations

import re

from lamella import InputError

# characters of what is wrong, and of what to do about it
MOST = 500
# what Python or numpy print of themselves, and never what a user wrote
PYTHON = re.compile(
    r"array\(|\[ ?-?\d+\.\s|np\.\w+\(|<\w+ object|object at 0x|Traceback|\bNone\b|\bdtype\b|"
    r"[a-z]Error\b|\bself\b|lambda|\{\w+(?:[:!.]\w*)?\}"
)
# words that say little where the field has better ones
WEAK = re.compile(r"\b(please|sorry|oops|illegal|fatal|wished|wishes)\b", re.I)


def faults(error: InputError) -> list[str]:
    """What is wrong with a refusal as a text."""
    text = str(error)
    return ([] if "remedy: " in text else ["has no remedy"]) + text_faults(text)


def text_faults(text: str) -> list[str]:
    """What is wrong with a text for a user, line by line."""
    return [fault for line in text.splitlines() for fault in line_faults(line.strip())]


def line_faults(text: str) -> list[str]:
    """What is wrong with a sentence for a user."""
    found = []
    if len(text) > MOST:
        found.append(f"has a line of {len(text)} characters (limit {MOST})")
    if python := PYTHON.search(text):
        found.append(f"holds Python's own {python[0]!r}")
    if weak := WEAK.search(text):
        found.append(f"says {weak[0]!r}")
    if re.search(r"\s{2,}|\s[,;:.](\s|$)|\(\s|\s\)", text):
        found.append("has spaces where there are none in a text")
    if not text.isprintable():
        found.append("holds characters that do not print")
    return found

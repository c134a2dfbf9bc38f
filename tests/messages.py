"""What makes a message readable, as rules that a program can check."""

from __future__ import annotations

import re

from lamella import InputError

# characters of what is wrong, and of what to do about it
MOST = 600
# what Python or numpy print of themselves, and never what a user wrote
PYTHON = re.compile(
    r"array\(|np\.\w+\(|numpy|float64|int64|<\w+ object|object at 0x|Traceback|\bNone\b|\bdtype\b|\bnan\b(?! or)|"
    r"[a-z]Error\b|\bself\b|lambda|\{\w+(?:[:!.]\w*)?\}"
)
# words that say little where the field has better ones
WEAK = re.compile(r"\b(please|sorry|oops|invalid|illegal|fatal|wished|wishes)\b", re.I)


def faults(error: InputError) -> list[str]:
    """What is wrong with a refusal as a text."""
    found = [] if error.remedy.strip() else ["it has no remedy"]
    for what, text in (("message", error.message), ("remedy", error.remedy)):
        found += [f"its {what} {fault}" for fault in text_faults(text)]
    return found


def text_faults(text: str) -> list[str]:
    """What is wrong with a sentence for a user."""
    found = []
    if len(text) > MOST:
        found.append(f"has {len(text)} characters (limit {MOST})")
    if python := PYTHON.search(text):
        found.append(f"holds Python's own {python[0]!r}")
    if weak := WEAK.search(text):
        found.append(f"says {weak[0]!r}")
    if re.search(r"\s{2,}|\s[,.;:]|\(\s|\s\)", text.replace("\n", " ")):
        found.append("has spaces where there are none in a text")
    if not text.isprintable() and not text.replace("\n", "").isprintable():
        found.append("holds characters that do not print")
    return found

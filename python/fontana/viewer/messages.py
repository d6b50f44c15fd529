"""Sentences for the user, each for a while."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

_SECONDS = 6.0
_MOST = 4


@dataclass(frozen=True)
class Message:
    text: str
    is_error: bool
    until: float


@dataclass
class Messages:
    """The latest few; `history` keeps all that were said."""

    _shown: list[Message] = field(default_factory=list)
    history: list[str] = field(default_factory=list)

    def say(self, text: str, is_error: bool = False) -> None:
        now = time.monotonic()
        self.history.append(text)
        others = [message for message in self.current() if message.text != text]
        self._shown = [*others, Message(text, is_error, now + _SECONDS * (2 if is_error else 1))][-_MOST:]

    def current(self) -> list[Message]:
        now = time.monotonic()
        return [message for message in self._shown if message.until > now]

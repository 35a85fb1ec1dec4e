"""The language of a program that writes for people, before it imports what has sentences in it."""

import json
from collections.abc import Sequence

from inertial.text.messages import ENGLISH, speak


def speak_as_set(arguments: Sequence[str]) -> None:
    """Speak the `language` of `--settings JSON` among the arguments; English where it has none."""
    if "--settings" in arguments[:-1]:
        settings = json.loads(arguments[arguments.index("--settings") + 1])
        speak(settings.get("language", ENGLISH))

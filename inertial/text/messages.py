"""The sentences that a person reads: gettext, with values by name.

    _("{count} records are missing before record {record}", count=12, record=4711)

The English sentence is its own key. `messages.pot`, beside this file, lists all of them; `make
docs` writes it anew, and a test fails where it lacks one. Another language is a file
`<language>.po` beside it, chosen by the environment variable REPORT_LANGUAGE.
"""

import os
from gettext import GNUTranslations, NullTranslations
from io import BytesIO
from pathlib import Path
from typing import Any

CATALOGUE = Path(__file__).with_name("messages.pot")


def translations(language: str, folder: Path = CATALOGUE.parent) -> NullTranslations:
    """The sentences in a language; those that it lacks stay English."""
    file = folder / f"{language}.po"
    if not file.exists():
        return NullTranslations()
    from babel.messages.mofile import write_mo
    from babel.messages.pofile import read_po

    compiled = BytesIO()
    with file.open("rb") as source:
        write_mo(compiled, read_po(source))
    compiled.seek(0)
    return GNUTranslations(compiled)


_chosen = translations(os.environ.get("REPORT_LANGUAGE", "en"))


def _(message: str, **values: Any) -> str:
    """A sentence in the language of this process, its `{names}` replaced by the values."""
    sentence = _chosen.gettext(message)
    return sentence.format(**values) if values else sentence


def plural(one: str, many: str, count: int, **values: Any) -> str:
    """The same in the form that goes with a count, which the sentence names as `{count}`."""
    return _chosen.ngettext(one, many, count).format(count=count, **values)

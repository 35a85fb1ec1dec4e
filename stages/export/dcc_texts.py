"""Texts of a DCC, in its one language."""

from xml.etree.ElementTree import Element

from inertial.text.statements import NOT_STATED
from stages.export.d_si import add


def add_text(parent: Element, tag: str, text: str | None) -> None:
    """A name; `not stated` where there is none."""
    add(add(parent, tag), "dcc:content", text or NOT_STATED)


def add_rich(parent: Element, tag: str, *paragraphs: str) -> None:
    """A description of several paragraphs."""
    own = add(parent, tag)
    for paragraph in paragraphs:
        add(own, "dcc:content", paragraph)


def add_data(parent: Element, *paragraphs: str) -> Element:
    """The data of a result, which begin with a text."""
    data = add(parent, "dcc:data")
    add_rich(data, "dcc:text", *paragraphs)
    return data

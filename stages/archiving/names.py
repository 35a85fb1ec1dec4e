"""Names of IMUs and campaigns as names of folders and files."""

import hashlib
from urllib.parse import quote_plus

SIMULATED = "simulated"  # the folder of the simulated calibrations, so no instrument may have it
LONGEST = 100  # characters; a file's name holds a campaign, a date and a hash and has room for 255
HEX = 16  # digits of the hash that stands for the end of a longer name


def file_name(text: str) -> str:
    """A name for files: the same for the same text, another for any other, and never a way out.

    What is no letter, digit, '-', '_' or inner '.' is written as in a web address: `A/17 b` is
    `A%2F17+b`. A name that gets too long ends with '~' and a hash of all of it.
    """
    name = quote_plus(text, safe="").replace("~", "%7E")
    if name.startswith("."):
        name = f"%2E{name[1:]}"
    if name == SIMULATED:
        name = f"%{ord(name[0]):X}{name[1:]}"
    if len(name) > LONGEST:
        end = hashlib.sha256(text.encode()).hexdigest()[:HEX]
        name = f"{name[: LONGEST - 1 - HEX]}~{end}"
    return name

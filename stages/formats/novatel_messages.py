"""The eight messages in which a NovAtel receiver sends the increments of its IMU.

    name        number   text                                      binary body
    RAWIMU      268      #RAWIMUA, long header;    week, seconds,  u32 week, f64 seconds,
    RAWIMUS     325      %RAWIMUSA, short header;  status, counts  u32 status, 6 × i32
    RAWIMUX     1461     #RAWIMUXA, long header;   info, type, and u8 info, u8 type, u16 week, then
    RAWIMUSX    1462     %RAWIMUSXA, short header; the same        the same: 40 bytes either way

Counts: acceleration of z, −y, x, then rate of z, −y, x. Headers: text, long, ten fields after '#',
short, three after '%'; binary, long, 28 bytes from AA 44 12, short, 12 bytes from AA 44 13. All
little-endian, followed by the CRC-32 of header and body.

Source: NovAtel OEM7 Commands and Logs Reference Manual, "Message Format", "RAWIMU", "RAWIMUSX".
"""

from dataclasses import dataclass

import numpy as np

SYNC, LONG_SYNC, SHORT_SYNC = (0xAA, 0x44), 0x12, 0x13  # the first three bytes
LONG_BYTES, SHORT_BYTES, BODY_BYTES, CRC_BYTES = 28, 12, 40, 4
LONG_FIELDS, SHORT_FIELDS = 10, 3  # of a text header, the name among them


@dataclass(frozen=True)
class ImuMessage:
    """One of the eight: as text or binary, its name in the account, its number in a header."""

    name: str
    number: int
    extended: bool  # it tells the type of the IMU
    short: bool  # it has the short header
    text: bool

    @property
    def begins(self) -> bytes:
        """What each of them begins with; all binary ones with one kind of header begin alike."""
        if self.text:
            return (b"%" if self.short else b"#") + self.name.encode()
        return bytes([*SYNC, SHORT_SYNC if self.short else LONG_SYNC])


_NUMBERS = {"RAWIMU": 268, "RAWIMUS": 325, "RAWIMUX": 1461, "RAWIMUSX": 1462}
IMU_MESSAGES = tuple(
    ImuMessage(name + ("A" if text else "B"), number, "X" in name, "S" in name, text)
    for text in (True, False)
    for name, number in _NUMBERS.items()
)

# The same for compiled loops.
NAME_LENGTH, NUMBER, EXTENDED, SHORT, TEXT = range(5)  # columns of WANTED
WANTED = np.array(
    [[len(m.name), m.number, m.extended, m.short, m.text] for m in IMU_MESSAGES], np.int64
)
NAME_BYTES = np.array(
    [list(m.name.encode().ljust(int(WANTED[:, NAME_LENGTH].max()))) for m in IMU_MESSAGES], np.uint8
)

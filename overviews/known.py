"""Which campaigns have a result and which IMUs a history: what the workflow asks for its files."""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

from inertial.tables.errors import Refusal
from inertial.text.messages import _
from stages import ORDER

LAST = "history"  # stage by which a result is complete
SIMULATED, UNKNOWN = "simulated", "unknown"  # folders of the archive that are no instrument, no IMU
RESERVED = (
    "index",
    "compare-",
    "fleet-",
)  # what reports of a campaign cannot be called, or begin with


def with_result(campaigns: Sequence[str], derived: Path) -> list[str]:
    """The campaigns all of whose tables are there; whether they are current the workflow knows."""
    places = [
        f"{stage}/{name}.parquet"
        for stage in ORDER[: ORDER.index(LAST) + 1]
        for name in import_module(f"stages.{stage}.declared").DECLARED.writes
    ]
    return [c for c in campaigns if all((derived / c / place).is_file() for place in places)]


def serials(archive: Path) -> list[str]:
    """The folders of the archive that are named by a serial number, each once."""
    folders = [*archive.glob("*/*"), *(archive / SIMULATED).glob("*/*")]
    real = {f.name for f in folders if f.is_dir() and f.parent.name != SIMULATED}
    return sorted(real - {UNKNOWN})


def kept(archive: Path, serial: str = "*") -> list[str]:
    """The files of the archive, or those of one serial number, by their paths inside it."""
    own = [*archive.glob(f"*/{_literal(serial)}/*.parquet")]
    own += [*archive.glob(f"{SIMULATED}/*/{_literal(serial)}/*.parquet")]
    return sorted(path.relative_to(archive).as_posix() for path in own)


def _literal(serial: str) -> str:
    return serial if serial == "*" else serial.replace("[", "[[]")


def pair_of(text: str, campaigns: Sequence[str]) -> tuple[str, str]:
    """The two campaigns whose names a hyphen joins.

    Raises
    ------
    Refusal
        where they are not two known ones, or where that could be several pairs
    """
    parts = text.split("-")
    joined = [("-".join(parts[:n]), "-".join(parts[n:])) for n in range(1, len(parts))]
    pairs = [pair for pair in joined if set(pair) <= set(campaigns)]
    if len(pairs) == 1:
        return pairs[0]
    found = _("no two campaigns that are known") if not pairs else _("several pairs of campaigns")
    raise Refusal(
        f"reports/compare-{text}.html",
        "",
        found,
        _("the names of two campaigns, joined by a hyphen"),
        _("see the folders of data/raw; where names are ambiguous, rename one"),
    )


def refuse_reserved(campaigns: Sequence[str]) -> None:
    """Names that would be those of other pages.

    Raises
    ------
    Refusal
        for the first such campaign
    """
    for campaign in campaigns:
        if campaign == RESERVED[0] or campaign.startswith(RESERVED[1:]):
            raise Refusal(
                f"data/raw/{campaign}",
                "",
                _("a campaign named {campaign}", campaign=campaign),
                _("another name: reports/index.html, compare-… and fleet-… are other pages"),
                _("rename its folder"),
            )

"""What the tests share: the real recordings, and runs of the chain that several tests look at."""

import fcntl
import os
import shutil
from collections.abc import Callable
from pathlib import Path

# As in the Snakefile: for matrices as small as ours threads cost more than they bring. It must
# stand before numpy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import chain
import pytest
from hypothesis import settings
from recordings.known import RECORDINGS

from inertial.tables.campaign_files import logs_of

CAMPAIGNS = Path(__file__).parent / "campaigns"
# They take longest, so they stand first: all processes are then busy to the end.
FIRST = (
    "test_workflow",
    "test_recordings_by_hand",
    "test_drafts_of_recordings",
    "test_report",
    "test_browser",
)

settings.register_profile("untimed", deadline=None)  # a busy machine is no fault
settings.load_profile("untimed")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    order = {name: place for place, name in enumerate(FIRST)}
    items.sort(key=lambda item: order.get(item.path.stem, len(FIRST)))


@pytest.fixture(scope="session")
def made_once(tmp_path_factory) -> Callable[[str, Callable[[Path], None]], Path]:
    """A folder of this name, filled by the first process that needs it; the others wait for it."""
    place = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        place = place.parent  # which all processes of this run share

    def folder(name: str, fill: Callable[[Path], None]) -> Path:
        made = place / name
        with (place / f"{name}.lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not (place / f"{name}.made").exists():
                shutil.rmtree(made, ignore_errors=True)  # what a failure left
                made.mkdir()
                fill(made)
                (place / f"{name}.made").touch()
        return made

    return folder


@pytest.fixture(scope="session")
def recordings() -> Path:
    """The folder of real recordings, which are not part of the project."""
    beside = Path(__file__).parents[2] / "shared" / "recordings"
    folder = Path(os.environ.get("RECORDINGS", beside))
    if not folder.is_dir():
        pytest.skip(f"the real recordings are not at {folder}; set RECORDINGS to where they are")
    return folder


# Where the logs are of the campaigns that people wrote, and the last stage that tests look at.
WRITTEN = {
    "imucal-labelled": ("imucal_ferraris", "history"),
    "imucal-continuous": ("imucal_ferraris", "history"),
    "whu": ("whu_xwgi7681_excerpt", "history"),
    "softdream": ("softdream_sixpos", "history"),
    "cuyo": ("mpu6050_cuyo", "history"),
    "hipnuc": ("hipnuc_temp", "history"),
    "imu-tk": ("imu_tk_xsens", "diagnosis"),
    "sunsided": ("sunsided_mpu6050", "gyroscope"),
}


@pytest.fixture(scope="session")
def recorded(recordings, made_once) -> Callable[[str], chain.Results]:
    """By the name of a campaign in tests/campaigns its results; each is run once.

    The logs lie beside a copy of the campaign file.
    """

    def of(name: str) -> chain.Results:
        logs, until = WRITTEN[name]

        def run(place: Path) -> None:
            raw = place / "data/raw" / name
            raw.mkdir(parents=True)
            shutil.copy(CAMPAIGNS / f"{name}.yaml", raw / "campaign.yaml")
            for log in logs_of(raw / "campaign.yaml"):
                shutil.copy(recordings / logs / log, raw / log)
            chain.run(raw, place / "data/derived" / name, until)

        place = made_once(f"recorded-{name}", run)
        return chain.Results(place / "data/derived" / name)

    return of


@pytest.fixture(scope="session")
def drafted(recordings, made_once) -> Callable[..., tuple[Path, chain.Results]]:
    """By the name of a real recording its drafted campaign and its results; each is run once."""

    def of(name: str, until: str = "diagnosis") -> tuple[Path, chain.Results]:
        (recording,) = (one for one in RECORDINGS if one.name == name)

        def run(place: Path) -> None:
            campaign = recording.drafted(recordings, place / "data")
            chain.run(campaign, place / "derived", until, chain.BESIDE)

        place = made_once(f"drafted-{name}-{until}", run)
        return place / "data/raw" / name, chain.Results(place / "derived")

    return of


def simulated(folder: Path, document, until: str) -> None:
    """A campaign of the laboratory, and what the stages up to `until` make of it, in `derived`."""
    chain.run(chain.simulate(document, folder / "raw"), folder / "derived", until)


@pytest.fixture(scope="session")
def demo_criticised(made_once) -> chain.Results:
    """The demo campaign with all that it hides, through the chain up to the extension."""
    document = chain.laboratory.read(chain.ROOT / "data/simulated/demo.yaml").document
    folder = made_once("demo", lambda folder: simulated(folder, document, "extension"))
    return chain.Results(folder / "derived")


@pytest.fixture(scope="session")
def demo(demo_criticised) -> chain.Results:
    """The same; what the first stages make of it."""
    return demo_criticised


@pytest.fixture(scope="session")
def whole(made_once) -> Path:
    """A folder in which all stages up to the export have run on the short campaign `june`."""

    def run(folder: Path) -> None:
        raw = chain.simulate(chain.short(), folder / "data/raw/june")
        derived = folder / "data/derived/june"
        chain.run(raw, derived, "history")
        (folder / "data/derived/history").rename(folder / "data/history")
        (folder / "reports").mkdir()
        settings = chain.SETTINGS["export"]
        chain.stage_of("export").run(derived, {}, settings, folder / "reports/june")

    return made_once("whole", run)


@pytest.fixture(scope="session")
def coupled(made_once) -> chain.Results:
    """A short campaign whose x, y, z gyros read 14, −10 and 12 °/h per g along their own axes."""
    hidden = {"gyro_g_sensitivity": {"matrix_deg_h_g": [[14, 0, 0], [0, -10, 0], [0, 0, 12]]}}
    document = chain.short(effects=hidden)
    folder = made_once("coupled", lambda folder: simulated(folder, document, "compensation"))
    return chain.Results(folder / "derived")


@pytest.fixture(scope="session")
def clean(made_once) -> list[chain.Results]:
    """The demo campaign without effects and faults, three times with other noise."""

    def run(folder: Path) -> None:
        for seed in (11, 12, 13):
            simulated(folder / str(seed), chain.demo(seed=seed), "compensation")

    folder = made_once("clean", run)
    return [chain.Results(folder / str(seed) / "derived") for seed in (11, 12, 13)]

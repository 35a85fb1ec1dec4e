"""What the tests share: the real recordings, and runs of the chain that several tests look at."""

import os
from collections.abc import Callable
from pathlib import Path

import chain
import pytest

from stages.contracts.logs import logs_of

CAMPAIGNS = Path(__file__).parent / "campaigns"


@pytest.fixture(scope="session")
def recordings() -> Path:
    """The folder of real recordings, which are not part of the project."""
    beside = Path(__file__).parents[2] / "shared" / "recordings"
    folder = Path(os.environ.get("RECORDINGS", beside))
    if not folder.is_dir():
        pytest.skip(f"the real recordings are not at {folder}; set RECORDINGS to where they are")
    return folder


@pytest.fixture(scope="session")
def recorded(recordings, tmp_path_factory) -> Callable[..., chain.Results]:
    """Run the chain on a real recording: a campaign of tests/campaigns, its logs from `folder`."""
    done: dict[str, chain.Results] = {}

    def run(campaign: str, folder: str) -> chain.Results:
        if campaign not in done:
            place = tmp_path_factory.mktemp("recorded") / campaign
            place.mkdir()
            text = (CAMPAIGNS / f"{campaign}.yaml").read_text(encoding="utf-8")
            (place / "campaign.yaml").write_text(text, encoding="utf-8")
            for log in logs_of(place / "campaign.yaml"):
                (place / log).write_bytes((recordings / folder / log).read_bytes())
            done[campaign] = chain.run(place, place.with_name("derived"))
        return done[campaign]

    return run


@pytest.fixture(scope="session")
def demo(tmp_path_factory) -> chain.Results:
    """The demo campaign with all that it hides, through the chain."""
    folder = tmp_path_factory.mktemp("demo")
    document = chain.laboratory.read(chain.ROOT / "data/simulated/demo.yaml").document
    return chain.run(chain.simulate(document, folder / "demo"), folder / "derived")


@pytest.fixture(scope="session")
def clean(tmp_path_factory) -> list[chain.Results]:
    """The demo campaign without effects and faults, three times with other noise."""
    results = []
    for seed in (11, 12, 13):
        folder = tmp_path_factory.mktemp("clean")
        campaign = chain.simulate(chain.demo(seed=seed), folder / "clean")
        results.append(chain.run(campaign, folder / "derived"))
    return results

"""Fixtures for module tests. RIGCAL is the path of the command; PYTHONPATH contains the module."""

from __future__ import annotations

import os
import pathlib
import subprocess

import pytest

import rigcal

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
RIGCAL = os.environ["RIGCAL"]


def command(*arguments: object, cwd: pathlib.Path | None = None) -> str:
    """Runs the command and returns its output. Any verdict is accepted."""
    done = subprocess.run([RIGCAL, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stderr
    return done.stdout


@pytest.fixture(scope="session")
def data(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Folder with synthetic records from a known rig: campaign.toml, records/, truth.json."""
    folder = tmp_path_factory.mktemp("rig") / "data"
    command("synthesize", SOURCE / "docs" / "tutorial" / "known_rig.toml", "--seed", 1, "--out", folder)
    return folder


@pytest.fixture(scope="session")
def campaign(data: pathlib.Path) -> rigcal.Campaign:
    return rigcal.load(data / "campaign.toml")


@pytest.fixture(scope="session")
def fit(campaign: rigcal.Campaign) -> rigcal.Fit:
    return campaign.fit()

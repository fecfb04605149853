"""Many processes give what one gives, also when some of them die."""

from __future__ import annotations

import os
import pathlib
import pickle
import signal
import subprocess
from collections.abc import Iterator
from typing import Any

import pytest

import rodcal

dask = pytest.importorskip("dask")
pytest.importorskip("distributed")

from distributed import Client, LocalCluster  # noqa: E402

from rodcal import distributed  # noqa: E402

TX90 = "campaigns/tx90-5/campaign.toml"
#: 210 000 rods, of which a good part keeps all limits
DESIGN: dict[str, Any] = {
    "geometry": {
        "l1_mm": {"from": 100, "to": 400, "step": 10},
        "l2_mm": {"from": 300, "to": 700, "step": 10},
        "gamma_deg": [90, 100, 120],
    },
    "catalogue": {"file": "builtin"},
    "constraints": {"max_mass_g": 900, "min_reach_mm": 450},
    "objectives": {"minimise": ["c_rod_um", "mass_g"], "maximise": ["reach_mm"]},
}


@pytest.fixture(scope="module")
def client(folder: pathlib.Path) -> Iterator[Client]:
    """Two processes with a thread each."""
    one_thread = {"distributed.nanny.pre-spawn-environ.RAYON_NUM_THREADS": 1}
    os.chdir(folder)
    with dask.config.set(one_thread):
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                yield client


def same(one: Any, other: Any) -> None:
    assert one.to_dict() == other.to_dict()
    assert one.files == other.files and str(one) == str(other)


def test_parts_of_a_search_are_the_search(client: Client) -> None:
    told: list[tuple[int, int | None]] = []
    found = distributed.design_rod(
        client, DESIGN, base="rods/5.toml", rods_per_task=20_000, progress=lambda *step: told.append(step)
    )
    assert len(told) > 5 and told[-1] == (found.evaluated, found.evaluated)
    same(found, rodcal.design_rod(DESIGN, base="rods/5.toml"))
    # of a file with a catalogue of its own, and samples
    more: Any = {"samples": 30_000, "seed": 4, "refine": 1}
    of_parts = distributed.design_rod(client, "examples/design.toml", rods_per_task=1, **more)
    same(of_parts, rodcal.design_rod("examples/design.toml", **more))
    # where nothing keeps all limits, what is nearest
    none = {**DESIGN, "constraints": {"max_mass_g": 50, "max_c_rod_um": 100}}
    same(distributed.design_rod(client, none, rods_per_task=30_000), rodcal.design_rod(none))


def test_a_worker_that_is_killed_changes_nothing(client: Client) -> None:
    before = set(client.run(os.getpid).values())
    killed: list[int] = []

    def kill(done: int, _: int | None) -> None:
        if not killed:
            killed.append(min(before))
            os.kill(killed[0], signal.SIGKILL)

    found = distributed.design_rod(client, DESIGN, rods_per_task=4096, progress=kill)
    assert killed and killed[0] not in client.run(os.getpid).values()
    same(found, rodcal.design_rod(DESIGN))


def test_draws_and_folds_in_parts(client: Client) -> None:
    same(
        distributed.compare(client, TX90, draws=60, seed=3, draws_per_task=17),
        rodcal.compare(TX90, draws=60, seed=3),
    )
    ours = distributed.calibrate(client, TX90, folds=12, folds_per_task=5)
    theirs = rodcal.calibrate(TX90, folds=12)
    same(ours, theirs)
    assert (ours.deviations_um == theirs.deviations_um).all()
    # one without validation poses, from memory: workers need no file of it
    simulation = rodcal.simulate("rods/5.toml", poses=8, validation=20, seed=3)
    campaign = simulation.campaign()
    same(distributed.calibrate(client, campaign, "fea", folds=6), rodcal.calibrate(campaign, "fea", folds=6))


def test_a_trial_is_answered_as_by_one_process(client: Client, tmp_path: pathlib.Path) -> None:
    program = os.environ.get("RODCAL")
    if program is None:
        pytest.skip("no program rodcal: name it by RODCAL")
    trial = tmp_path / "trial"

    def run(*words: object) -> None:
        subprocess.run([str(program), *map(str, words)], check=True, capture_output=True)

    run("trial", "make", trial, "--rig", "--cases", 6, "--seed", 5)
    run("trial", "answer", trial, "--answers", tmp_path / "one.jsonl")
    one = (tmp_path / "one.jsonl").read_bytes()
    # it goes on where it was, and takes nothing from another trial
    kept = trial / "answers.jsonl.parts"
    kept.mkdir()
    first, second = one.splitlines(keepends=True)[:2]
    (kept / "0001-0002.jsonl").write_bytes(first + second.replace(b'"sha256":{"', b'"sha256":{"x'))
    file = distributed.answer_trial(client, trial, cases_per_task=2, program=str(program))
    assert file == trial / "answers.jsonl" and file.read_bytes() == one and not kept.exists()
    # nothing is left to do
    assert distributed.answer_trial(client, trial, program=str(program)).read_bytes() == one
    with pytest.raises(rodcal.FileError, match="cannot be started"):
        distributed.answer_trial(client, trial, answers=tmp_path / "x.jsonl", program="no-such-program")
    with pytest.raises(rodcal.InputError, match="manifest of a trial"):
        (tmp_path / "manifest.json").write_text("[]")
        distributed.answer_trial(client, tmp_path)


def test_what_workers_refuse_is_said_here(client: Client) -> None:
    with pytest.raises(rodcal.InputError, match="folds"):
        distributed.calibrate(client, TX90, folds=61)
    with pytest.raises(rodcal.InputError, match="draws_per_task"):
        distributed.compare(client, TX90, draws_per_task=0)
    # an exception of a worker keeps what it says
    future = client.submit(rodcal.Rod.from_toml, "[geometry]\nl1_mm = true\n")
    with pytest.raises(rodcal.InputError) as raised:
        future.result()
    assert (raised.value.file, raised.value.line, raised.value.expected) == ("<toml>", 2, "a number")


def test_no_more_parts_are_on_their_way_than_the_cluster_takes(client: Client) -> None:
    class Counted:
        """A client that counts what it is given; what comes back counts by progress."""

        waiting, most = 0, 0
        nthreads, cancel = client.nthreads, client.cancel

        def submit(self, *words: Any, **more: Any) -> Any:
            self.waiting += 1
            self.most = max(self.most, self.waiting)
            return client.submit(*words, **more)

        def back(self, *_: object) -> None:
            self.waiting -= 1

    counted: Any = Counted()
    distributed.design_rod(counted, DESIGN, samples=200_000, rods_per_task=4096, progress=counted.back)
    # two threads, and what all parts share
    assert counted.most == 4 * 2 + 1 and counted.waiting == 1


@pytest.mark.parametrize(
    "given",
    [
        lambda: rodcal.Rod.read("rods/5.toml"),
        lambda: rodcal.Readings.read("stiffness_data/5.csv"),
        lambda: rodcal.Robot.read("builtin:tx90"),
        lambda: rodcal.Campaign.read(TX90),
        lambda: rodcal.simulate("rods/5.toml", poses=4, validation=8).campaign(),
    ],
)
def test_inputs_travel_without_their_files(given: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: pathlib.Path) -> None:
    one = given()
    kept = pickle.dumps(one)
    monkeypatch.chdir(tmp_path)
    again = pickle.loads(kept)
    assert repr(again) == repr(one) and again.__reduce__()[1][1:] == one.__reduce__()[1][1:]

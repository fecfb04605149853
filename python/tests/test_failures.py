"""What cannot be done is said, where it is wrong, and what would be right; what runs can be stopped."""

from __future__ import annotations

import errno
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rodcal

TX90 = "campaigns/tx90-5/campaign.toml"


def test_an_error_in_a_file_says_where(tmp_path: pathlib.Path) -> None:
    text = pathlib.Path("rods/5.toml").read_text().replace("l1_mm = 150.0", "l1_mm = -150.0")
    file = tmp_path / "rod.toml"
    file.write_text(text)
    with pytest.raises(rodcal.InputError, match="l1_mm") as caught:
        rodcal.Rod.read(file)
    error = caught.value
    line = next(n for n, line in enumerate(text.splitlines(), start=1) if "-150.0" in line)
    assert (error.file, error.line, error.column) == (str(file), line, 9)
    assert error.found is not None and "-150.0" in error.found and error.expected
    assert isinstance(error, rodcal.Error) and isinstance(error, ValueError)


def test_an_error_in_memory_names_the_key_or_the_row() -> None:
    with pytest.raises(rodcal.InputError, match=r"^<rod>: .*\[geometry\]") as caught:
        rodcal.Rod({"name": "nothing"})
    assert (caught.value.file, caught.value.line, caught.value.column) == ("<rod>", None, None)
    with pytest.raises(rodcal.InputError) as caught:
        rodcal.Readings({"axis": ["y", "y", "q"], "load_n": [1, 2, 3], "dy_um": [1.0, 2.0, 3.0]})
    assert (caught.value.file, caught.value.line) == ("<readings>", 4)
    with pytest.raises(rodcal.InputError, match="different lengths"):
        rodcal.Readings({"axis": ["y", "y"], "load_n": [1, 2, 3], "dy_um": [1.0, 2.0, 3.0]})
    with pytest.raises(rodcal.InputError, match="a number, a text, a list or a dict"):
        rodcal.Rod({"geometry": object()})


WRONG: list[tuple[type[rodcal.Error], Callable[[], Any]]] = [
    (rodcal.FileError, lambda: rodcal.Rod.read("nowhere.toml")),
    (rodcal.FileError, lambda: rodcal.Robot.read("nowhere.urdf")),
    (rodcal.InputError, lambda: rodcal.Robot.read("builtin:nobody")),
    (rodcal.InputError, lambda: rodcal.compliance("rods/5.toml", "exact")),  # type: ignore[arg-type]
    (rodcal.InputError, lambda: rodcal.compliance("rods/5.toml", elements=0)),
    (rodcal.InputError, lambda: rodcal.compliance("rods/5.toml", elements=-1)),
    (rodcal.InputError, lambda: rodcal.compliance("rods/5.toml", elements=2.5)),  # type: ignore[arg-type]
    (rodcal.InputError, lambda: rodcal.compare(TX90, seed=2**70)),
    (rodcal.InputError, lambda: rodcal.simulate("rods/5.toml", poses=-1)),
    (rodcal.InputError, lambda: rodcal.predict("builtin:tx90", [[0] * 6], tool_mm=[1, 2])),
    (rodcal.InputError, lambda: rodcal.predict("builtin:tx90", [[0] * 6], tool_mm=5)),  # type: ignore[arg-type]
    (rodcal.InputError, lambda: rodcal.predict("builtin:tx90", [[1j] * 6])),
    (rodcal.InputError, lambda: rodcal.design_poses(TX90, 20, volume_mm=[0, 1])),
    (rodcal.InputError, lambda: rodcal.design_rig("rods/5.toml", 5)),  # type: ignore[arg-type]
    (rodcal.InputError, lambda: rodcal.design_rig("rods/5.toml", "frictio")),
    (rodcal.InputError, lambda: rodcal.design_rod("examples/design.toml", count=5)),
    (rodcal.InputError, lambda: rodcal.compliance("rods/5.toml").write("")),
    (rodcal.InputError, lambda: rodcal.Rod({"name": "\ud800"})),
    (rodcal.InputError, lambda: rodcal.compliance("rods/5.toml", contact_force_n=float("nan"))),
    (rodcal.InputError, lambda: rodcal.calibrate(TX90, folds=1)),
    (rodcal.InputError, lambda: rodcal.compare(TX90, draws=3)),
    (rodcal.InputError, lambda: rodcal.design_poses(TX90, 20, generate=10)),
    (rodcal.InputError, lambda: rodcal.design_poses(TX90, 20, volume_mm=(1, 0, 0, 1, 0, 1))),
    (rodcal.InputError, lambda: rodcal.design_rig("rods/5.toml")),
    (rodcal.InputError, lambda: rodcal.design_rig("rods/5.toml", ["magic"])),
    (rodcal.InputError, lambda: rodcal.predict("builtin:tx90", [[1.0, 2.0]])),
    (rodcal.InputError, lambda: rodcal.predict("builtin:tx90", np.full((1, 6), np.inf))),
    (rodcal.InputError, lambda: rodcal.simulate("rods/5.toml", r_rod=0.0)),
    (
        rodcal.NotApplicableError,
        lambda: rodcal.predict("builtin:tx90", np.zeros((2, 6)), aligned=True),
    ),
    (rodcal.InputError, lambda: rodcal.predict("builtin:tx90", np.full((1, 6), 1e300))),
    (rodcal.InputError, lambda: rodcal.design_poses(TX90, 20, at=np.zeros((3, 7)))),
    (rodcal.InputError, lambda: rodcal.design_poses(TX90, 20, at=np.zeros((3, 5)))),
    (rodcal.InputError, lambda: rodcal.Readings({"axis": ["x"], "load_n": [1.0], "dxyz_um": [[1.0] * 3], "dx_um": [2.0]})),
]


@pytest.mark.parametrize(("kind", "ask"), WRONG)
def test_what_cannot_be_is_refused(kind: type[rodcal.Error], ask: Callable[[], Any]) -> None:
    with pytest.raises(kind) as caught:
        ask()
    assert str(caught.value)


def test_a_file_error_is_an_os_error_of_python() -> None:
    with pytest.raises(rodcal.FileError) as caught:
        rodcal.Rod.read("nowhere.toml")
    assert (caught.value.errno, caught.value.filename) == (errno.ENOENT, "nowhere.toml")
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), again.errno) == (rodcal.FileError, str(caught.value), errno.ENOENT)


def test_what_a_terminal_would_obey_is_escaped() -> None:
    name = "\x1b[31m\u202e\x9b"
    with pytest.raises(rodcal.Error) as caught:
        rodcal.Rod.read(f"no{name}.toml")
    text = pathlib.Path("rods/5.toml").read_text().replace("5#", "\\u001b[31m\\u202e\\u009b")
    result = rodcal.compliance(rodcal.Rod.from_toml(text))
    for shown in (str(caught.value), str(result), repr(result), result.headline, result.title, result._repr_html_()):
        assert not any(mark in shown for mark in ("\x1b", "\u202e", "\x9b")), shown


def test_a_hint_speaks_of_the_package(tmp_path: pathlib.Path) -> None:
    result = rodcal.compliance("rods/5.toml")
    (tmp_path / "index.html").write_text("mine")
    with pytest.raises(rodcal.Error) as caught:
        result.write(tmp_path)
    assert "force=True" in str(caught.value) and "--" not in str(caught.value)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_work_after_a_fork_is_refused() -> None:
    code = (
        "import os, rodcal\n"
        "rodcal.compliance('rods/5.toml')\n"
        "if os.fork() == 0:\n"
        "    try: rodcal.compliance('rods/5.toml')\n"
        "    except RuntimeError as error: os._exit(7 if 'spawn' in str(error) else 8)\n"
        "    os._exit(9)\n"
        "print(os.waitstatus_to_exitcode(os.wait()[1]))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout == "7\n"


def test_a_table_needs_pandas_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    result = rodcal.compliance("rods/5.toml")
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match="pip install pandas"):
        result.to_dataframe()


def test_what_has_to_be_known_is_warned_of_at_the_callers_line() -> None:
    with pytest.warns(rodcal.RodcalWarning, match="the largest load") as caught:
        fit = rodcal.rig_fit("rods/2.toml", "stiffness_data/2.csv")
    assert caught[0].filename == __file__
    assert [str(warning.message) for warning in caught] == fit.warnings == fit.to_dict()["warnings"]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rodcal.compliance("rods/5.toml")


def test_progress_counts_up_to_all() -> None:
    told: list[tuple[int, int | None]] = []
    rodcal.compare(TX90, draws=60, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (60, 60)
    assert told == sorted(told)


def test_what_nobody_can_count_says_that_it_goes_on() -> None:
    arm = rodcal.Robot.read("builtin:tx90")
    asked: list[tuple[str, Callable[..., object]]] = [
        ("calibrate", lambda tell: rodcal.calibrate(TX90, folds=5, progress=tell)),
        ("diagnose_calibration", lambda tell: rodcal.diagnose_calibration(TX90, progress=tell)),
        ("diagnose_rig", lambda tell: rodcal.diagnose_rig("rods/5.toml", "stiffness_data/5.csv", progress=tell)),
        ("forecast", lambda tell: rodcal.forecast(TX90, progress=tell)),
        ("predict", lambda tell: rodcal.predict(arm, np.zeros((9000, 6)), progress=tell)),
    ]
    for name, ask in asked:
        told: list[tuple[int, int | None]] = []
        ask(lambda done, total: told.append((done, total)))
        assert told[-1][0] > 0 and told[-1][1] is None, name
        assert told == sorted(told), name


def test_what_is_held_whole_is_no_more_than_a_file_may_have() -> None:
    arm = rodcal.Robot.read("builtin:tx90")
    with pytest.raises(rodcal.InputError, match="at most 1000000"):
        rodcal.predict(arm, np.zeros((1_000_001, 6)), aligned=True)


def test_a_bar_is_drawn_and_wiped(capsys: pytest.CaptureFixture[str]) -> None:
    rodcal.compare(TX90, draws=50, progress=True)
    assert "comparing modes" in capsys.readouterr().err


def test_who_is_told_may_end_the_work() -> None:
    class Enough(Exception):
        pass

    def tell(done: int, total: int | None) -> None:
        raise Enough

    start = time.monotonic()
    with pytest.raises(Enough):
        rodcal.compare(TX90, draws=100_000, progress=tell)
    assert time.monotonic() - start < 10


def test_other_threads_run_meanwhile() -> None:
    counted, is_done = 0, threading.Event()

    def work() -> None:
        rodcal.compare(TX90, draws=100)
        is_done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not is_done.is_set():
        counted += 1
        time.sleep(0.001)
    thread.join()
    assert counted > 20


LONG = {
    "compare": f"rodcal.compare({TX90!r}, draws=100_000)",
    "design_rod": "rodcal.design_rod(space)",
    "design_poses": f"rodcal.design_poses({TX90!r}, 2000, 'd', generate=100_000)",
    "diagnose": f"[rodcal.diagnose_calibration({TX90!r}) for _ in range(1000)]",
    "simulate": "rodcal.simulate('rods/5.toml', poses=1000)",
}


@pytest.mark.skipif(os.name == "nt", reason="Ctrl-C is another thing there")
@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_ends_what_takes_long(what: str, tmp_path: pathlib.Path) -> None:
    program = f"""
        import signal, sys, rodcal
        space = {{"geometry": {{"l1_mm": {{"from": 100, "to": 500, "step": 1}}, "l2_mm": {{"from": 100, "to": 900, "step": 1}}}},
                "catalogue": {{"file": "builtin"}}, "objectives": {{"minimise": ["c_rod_um", "mass_g"]}}}}
        signal.signal(signal.SIGINT, signal.default_int_handler)
        print("begun", flush=True)
        try:
            {LONG[what]}
        except KeyboardInterrupt:
            print("stopped", flush=True)
            # and the package is as it was
            assert round(rodcal.compliance("rods/5.toml").c_rod_um) == 402
            sys.exit(7)
    """
    command = [sys.executable, "-W", "ignore", "-c", textwrap.dedent(program)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "begun\n"
        time.sleep(1.0)
        assert process.poll() is None, "it was done before it could be stopped"
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 7
        assert time.monotonic() - start < 10


def test_a_damping_gives_settling_times() -> None:
    assert rodcal.compliance("rods/5.toml").settling_times_s is None
    result = rodcal.compliance("rods/5.toml", damping_percent=1.0)
    times, frequencies = result.settling_times_s, result.natural_frequencies_hz
    assert times is not None and frequencies is not None
    # to 2 % of the swing
    assert np.allclose(times, -np.log(0.02) / (0.01 * 2 * np.pi * frequencies))
    for wrong in (0.0, 100.0, float("nan")):
        with pytest.raises(rodcal.InputError, match="damping_percent"):
            rodcal.compliance("rods/5.toml", damping_percent=wrong)

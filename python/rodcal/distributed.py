"""The same questions on many machines: searches, draws, folds and trials as tasks of a Dask cluster.

Each function takes a ``distributed.Client`` first and then what the function of the same name takes;
its answer is the same, to the last digit, whatever the number of workers, the size of the parts and
the workers that are lost on the way. Inputs travel with the tasks: workers need the package, and no
common disk (`answer_trial` alone does). Memory is bounded: no more than four parts for each thread of
the cluster are on their way, and they are taken in one after the other.

``docs/distributed.md`` has the arithmetic: how large a part should be, and what 10⁹ rods take.
"""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
import tempfile
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from . import _rodcal
from ._errors import Error, FileError, InputError, warn
from ._progress import Progress, Told
from .functions import CampaignLike, CompensationMode, RodLike, Weights, space_of
from .inputs import Campaign, PathLike, Table, as_campaign, as_rod
from .results import CalibrationResult, ComparisonResult, RodDesignResult

try:
    from distributed import Client, Future
except ImportError as _missing:
    raise ImportError(
        "rodcal.distributed needs Dask, which is not installed: pip install 'dask[distributed]'"
    ) from _missing

__all__ = ["answer_trial", "calibrate", "compare", "design_rod"]

#: Parts on their way for each thread of the cluster: one that is worked at, and some that wait.
_AHEAD = 4

_Part = tuple[int, int]


def design_rod(
    client: Client,
    design: Mapping[str, Any] | PathLike,
    *,
    catalogue: Table | None = None,
    base: RodLike | None = None,
    samples: int | None = None,
    refine: int | None = None,
    refine_goal: str | None = None,
    seed: int = 1,
    campaign: CampaignLike | None = None,
    count: int | None = None,
    rods_per_task: int = 4_194_304,
    progress: Progress = False,
) -> RodDesignResult:
    """As `rodcal.design_rod`: the front of the parts' fronts is the front.

    A part has ``rods_per_task`` rods (a multiple of 4096, to which it is rounded up): ten seconds to
    a minute of one processor. What follows the search (``refine``, the ranking for a robot) is done
    here.
    """
    space = space_of(design, catalogue)
    text, tubes, rods, unit = _rodcal.design_parts(space, samples, seed)
    size = unit * -(-_positive("rods_per_task", rods_per_task) // unit)
    native = None if campaign is None else as_campaign(campaign, plan=True)._native
    other = None if base is None else as_rod(base)._native
    with Told(progress, "looking at rods") as tell:
        shared = _shared(client, (text, tubes))
        looked_at = _in_order(client, _design_part, shared, (samples, seed), _parts(rods, size), tell, rods)
        found = ((first, last, kept) for (first, last), kept in looked_at)
        answer = _rodcal.design_rod(space, other, samples, refine, refine_goal, seed, native, count, found, None)
    warn(answer.warnings)
    return RodDesignResult(answer)


def compare(
    client: Client,
    campaign: CampaignLike,
    *,
    robust: Weights = "none",
    draws: int = 200,
    seed: int = 1,
    draws_per_task: int = 25,
    progress: Progress = False,
) -> ComparisonResult:
    """As `rodcal.compare`, its draws in parts.

    Each part calibrates every mode once before it draws, which takes about as long as a draw. Without
    a validation file draws cost nothing, and all is done here.
    """
    native = as_campaign(campaign)._native
    size = _positive("draws_per_task", draws_per_task)
    with Told(progress, "comparing modes") as tell:
        drawn: list[list[float] | None] | None = None
        if native.validation_poses > 0:
            shared = _shared(client, Campaign._of(native))
            asked = (robust, draws, seed)
            parts = _in_order(client, _compare_part, shared, asked, _parts(draws, size), tell, draws)
            drawn = [means for _, part in parts for means in part]
        answer = _rodcal.compare(native, robust, draws, seed, drawn, None)
    warn(answer.warnings)
    return ComparisonResult(answer)


def calibrate(
    client: Client,
    campaign: CampaignLike,
    mode: CompensationMode | None = None,
    *,
    robust: Weights = "none",
    prune: bool = False,
    folds: int = 10,
    folds_per_task: int = 4,
    progress: Progress = False,
) -> CalibrationResult:
    """As `rodcal.calibrate` with ``folds``, its folds in parts: up to one for every pose.

    Each part calibrates all poses once before it leaves folds out, which takes about as long as a
    fold.
    """
    native = as_campaign(campaign)._native
    size = _positive("folds_per_task", folds_per_task)
    with Told(progress, "leaving folds out") as tell:
        number = _rodcal.folds(native, folds)
        shared = _shared(client, Campaign._of(native))
        asked = (mode, robust, prune, folds)
        parts = _in_order(client, _calibrate_part, shared, asked, _parts(number, size), tell, number)
        held_out = [predicted for _, part in parts for predicted in part]
        answer, arrays = _rodcal.calibrate(native, mode, robust, prune, folds, held_out, None)
    warn(answer.warnings)
    return CalibrationResult(answer, arrays, native)


def answer_trial(
    client: Client,
    directory: PathLike,
    *,
    answers: PathLike | None = None,
    cases_per_task: int = 8,
    program: str = "rodcal",
    progress: Progress = False,
) -> pathlib.Path:
    """Diagnoses every case of a trial that has no answer yet, as ``rodcal trial answer DIR`` does.

    Returns the file of the answers (``DIR/answers.jsonl``), which is the one that the command writes,
    byte for byte. Workers run ``program`` and read ``directory``: both have to be there under the same
    names. What is answered is kept beside the file, so that the same call goes on where it was
    interrupted.
    """
    folder = pathlib.Path(directory)
    file = folder / "answers.jsonl" if answers is None else pathlib.Path(answers)
    kept = file.with_name(file.name + ".parts")
    sealed = _sealed(folder)
    before = _whole_lines(file)
    known = {_case(line) for line in before}
    new = {_case(line): line for part in sorted(kept.glob("*.jsonl")) for line in _whole_lines(part)}
    new = {case: line for case, line in new.items() if json.loads(line)["sha256"] == sealed.get(case)}
    is_open = {_number(case) for case in sealed if case not in known and case not in new}
    numbers = sorted(is_open)
    size = _positive("cases_per_task", cases_per_task)
    # what is answered already between two that are open is answered once more, to the same
    blocks = [numbers[k : k + size] for k in range(0, len(numbers), size)]
    ranges = [(block[0], block[-1] + 1) for block in blocks]
    kept.mkdir(exist_ok=True)
    with Told(progress, "cases") as tell:
        shared = _shared(client, (str(folder), program))
        most = ranges[-1][1] if ranges else 0
        for (first, end), text in _in_order(client, _answer_part, shared, (), ranges, tell, most):
            _write(kept / f"{first:04}-{end - 1:04}.jsonl", text)
            new.update((_case(line), line) for line in text.splitlines(keepends=True))
    missing = [case for case in sealed if case not in known and case not in new]
    if missing:
        raise Error(f"no answer came back for {missing[0]} and {len(missing) - 1} more", str(folder))
    _write(file, b"".join(before + [new[case] for case in sorted(new) if case not in known]))
    for part in kept.glob("*.jsonl"):
        part.unlink()
    kept.rmdir()
    return file


# What workers do. Each gets the package's version first: another version may say something else.


def _design_part(texts: tuple[str, str | None], asked: tuple[int | None, int], first: int, last: int) -> str:
    return _rodcal.design_part(texts, *asked, first, last)


def _compare_part(campaign: Campaign, asked: tuple[str, int, int], first: int, last: int) -> list[list[float] | None]:
    return _rodcal.compare_part(campaign._native, *asked, first, last)


def _calibrate_part(
    campaign: Campaign, asked: tuple[str | None, str, bool, int], first: int, last: int
) -> list[tuple[int, list[float]]]:
    return _rodcal.calibrate_part(campaign._native, *asked, first, last)


def _answer_part(trial: tuple[str, str], _: tuple[()], first: int, end: int) -> bytes:
    directory, program = trial
    with tempfile.TemporaryDirectory() as place:
        file = os.path.join(place, "answers.jsonl")
        line = [program, "trial", "answer", directory, "--case-range", f"{first}..{end - 1}", "--answers", file]
        try:
            done = subprocess.run(line, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        except OSError as error:
            raise FileError(f"the program {program!r} cannot be started: {error}", program) from error
        if done.returncode != 0:
            raise Error(done.stderr.strip() or f"{program} ended with status {done.returncode}")
        return pathlib.Path(file).read_bytes()


def _work(version: str, part: Callable[..., Any], shared: Any, asked: Any, first: int, last: int) -> Any:
    if version != _rodcal.__version__:
        found, expected = f"rodcal {_rodcal.__version__} on a worker", f"rodcal {version}, as here"
        raise InputError(f"{found}, expected {expected}", found=found, expected=expected)
    return part(shared, asked, first, last)


# How they are asked.


def _shared(client: Client, value: Any) -> Future[Any]:
    """What all parts need: sent to a worker once, and made again where it is lost."""
    return client.submit(_same, value, pure=False)


def _same(value: Any) -> Any:
    return value


def _parts(count: int, size: int) -> Iterator[_Part]:
    return ((first, min(first + size, count)) for first in range(0, count, size))


def _in_order(
    client: Client,
    part: Callable[..., Any],
    shared: Future[Any],
    asked: tuple[Any, ...],
    parts: Iterable[_Part],
    tell: Callable[[int, int | None], object] | None,
    total: int,
) -> Iterator[tuple[_Part, Any]]:
    """Parts and what came of each, in order. So many are on their way that no thread has to wait."""
    parts = iter(parts)
    waiting: deque[tuple[_Part, Future[Any]]] = deque()
    try:
        while True:
            most = _AHEAD * max(1, sum(client.nthreads().values()))
            for bounds in parts:
                task = client.submit(_work, _rodcal.__version__, part, shared, asked, *bounds, pure=False)
                waiting.append((bounds, task))
                if len(waiting) >= most:
                    break
            if not waiting:
                return
            bounds, task = waiting.popleft()
            result = task.result()
            task.release()
            if tell is not None:
                tell(bounds[1], total)
            yield bounds, result
    finally:
        client.cancel([task for _, task in waiting])


def _positive(name: str, value: int) -> int:
    if value < 1:
        found, expected = str(value), "at least 1"
        raise InputError(f"`{name}` is {found}, expected {expected}", found=found, expected=expected)
    return value


# Trials.


def _sealed(folder: pathlib.Path) -> dict[str, dict[str, str]]:
    """The hashes of a trial's files, by case."""
    manifest = folder / "manifest.json"
    sealed: dict[str, dict[str, str]] = {}
    try:
        for file, sha256 in json.loads(_rodcal.read_text(manifest))["files"].items():
            case, _, name = file.rpartition("/")
            _number(case)
            sealed.setdefault(case, {})[name] = sha256
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        expected = "the manifest of a trial"
        message = f"{manifest}: this is none, expected {expected}"
        raise InputError(message, str(manifest), expected=expected) from error
    return sealed


def _case(line: bytes) -> str:
    return str(json.loads(line)["case"])


def _number(case: str) -> int:
    return int(case.rsplit("-", 1)[-1])


def _whole_lines(file: pathlib.Path) -> list[bytes]:
    """The lines of a file without what has no end; none where there is no file."""
    lines = file.read_bytes().splitlines(keepends=True) if file.exists() else []
    return [line for line in lines if line.endswith(b"\n")]


def _write(file: pathlib.Path, content: bytes) -> None:
    """Writes a file whole or not at all."""
    beside = file.with_name(f".{file.name}.{os.getpid()}")
    beside.write_bytes(content)
    os.replace(beside, file)

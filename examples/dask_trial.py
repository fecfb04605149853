"""A trial answered by the workers of a Dask cluster, compared with one process and with fewer workers.

From the project's folder, after ``pip install './python[distributed]'`` and with ``rodcal`` on the path:
``python examples/dask_trial.py [--cases 64] [--workers 1 2] [--cases-per-task 4]``
"""

from __future__ import annotations

import argparse
import pathlib
import resource
import subprocess
import tempfile
import time

import dask
from distributed import Client, LocalCluster

from rodcal import distributed


def of_children() -> float:
    """Processor time of the programs that this worker has run, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def answered(client: Client, trial: pathlib.Path, answers: pathlib.Path, asked: argparse.Namespace) -> bytes:
    """The answers; what they took is said."""

    def used() -> tuple[float, float, float]:
        return time.monotonic(), sum(client.run(of_children).values()), time.process_time()

    before = used()
    made = distributed.answer_trial(
        client, trial, answers=answers, cases_per_task=asked.cases_per_task, program=asked.program
    )
    seconds, of_workers, here = (after - first for after, first in zip(used(), before))
    threads = sum(client.nthreads().values())
    print(f"{threads} threads: {seconds:.1f} s; processor time: workers {of_workers:.1f} s, here {here:.2f} s")
    return made.read_bytes()


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("--cases", type=int, default=64)
    arguments.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    arguments.add_argument("--cases-per-task", type=int, default=4)
    arguments.add_argument("--program", default="rodcal")
    asked = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        trial = place / "trial"
        made = [asked.program, "trial", "make", str(trial), "--seed", "7", "--cases", str(asked.cases)]
        subprocess.run(made, check=True, capture_output=True)

        found = []
        for run, workers in enumerate(asked.workers):
            # a worker has one thread, and so has the program that it runs
            one_thread = {"distributed.nanny.pre-spawn-environ.RAYON_NUM_THREADS": 1}
            with dask.config.set(one_thread):
                cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
            with cluster, Client(cluster) as client:
                found.append(answered(client, trial, place / f"{run}.jsonl", asked))

        subprocess.run([asked.program, "trial", "answer", str(trial)], check=True, capture_output=True)
        assert all(text == (trial / "answers.jsonl").read_bytes() for text in found)
        print(f"{asked.cases} cases: the same answers, byte for byte, as of one process")


if __name__ == "__main__":
    main()

"""A sweep over millions of rods on a Dask cluster, compared with one process and with fewer workers.

From the project's folder, after ``pip install './python[distributed]'``:
``python examples/dask_sweep.py [--rods 4000000] [--workers 1 2]``, or on a cluster that is there:
``python examples/dask_sweep.py --scheduler tcp://host:8786``
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import dask
from distributed import Client, LocalCluster

import rodcal
from rodcal import distributed


def design(rods: int) -> dict[str, Any]:
    """About so many rods: two lengths, two angles, and the tubes of the built-in catalogue."""
    steps = max(2, round((rods / (2 * 33)) ** 0.5))
    return {
        "geometry": {
            "l1_mm": {"from": 100, "to": 400, "step": 300 / (steps - 1)},
            "l2_mm": {"from": 300, "to": 700, "step": 400 / (steps - 1)},
            "gamma_deg": [90, 120],
        },
        "catalogue": {"file": "builtin"},
        "constraints": {"max_mass_g": 800, "max_flange_moment_nm": 6, "min_reach_mm": 500},
        "objectives": {"minimise": ["c_rod_um", "mass_g"]},
    }


def sweep(client: Client, space: dict[str, Any], rods_per_task: int) -> rodcal.results.RodDesignResult:
    """The front; what it took is said."""

    def used() -> tuple[float, float, float]:
        return time.monotonic(), sum(client.run(time.process_time).values()), time.process_time()

    before = used()
    found = distributed.design_rod(client, space, rods_per_task=rods_per_task, progress=True)
    seconds, of_workers, here = (after - first for after, first in zip(used(), before))
    threads = sum(client.nthreads().values())
    print(
        f"{found.evaluated} rods, {threads} threads: {seconds:.1f} s; processor time: "
        f"workers {of_workers:.1f} s, here {here:.2f} s; front of {len(found.front)}"
    )
    return found


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("--rods", type=int, default=4_000_000)
    arguments.add_argument("--workers", type=int, nargs="+", default=[1, 2])
    arguments.add_argument("--rods-per-task", type=int, default=262_144)
    arguments.add_argument("--scheduler", help="address of a cluster, in place of processes here")
    asked = arguments.parse_args()
    space = design(asked.rods)

    if asked.scheduler:
        with Client(asked.scheduler) as client:
            sweep(client, space, asked.rods_per_task)
        return

    fronts = []
    for workers in asked.workers:
        # a worker has one thread, and so has the library in it
        one_thread = {"distributed.nanny.pre-spawn-environ.RAYON_NUM_THREADS": 1}
        with dask.config.set(one_thread):
            cluster = LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
        with cluster, Client(cluster) as client:
            fronts.append(sweep(client, space, asked.rods_per_task))

    alone = rodcal.design_rod(space)
    assert all(found.to_dict() == alone.to_dict() for found in fronts)
    print(f"front of {len(alone.front)} designs: the same, to the last digit, as of one process")


if __name__ == "__main__":
    main()

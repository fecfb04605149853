#!/usr/bin/env python3
"""Exports of common instruments, converted into the measurements that a campaign of rodcal reads.

    convert.py tracker JOINTS.csv POINTS.txt OUT.csv    one row of joint values for each point
    convert.py bag STATES.csv POINTS.txt OUT.csv        a stream of joint states: its standstills
    convert.py sockets FOLDER OUT_FOLDER --urdf U --base-link B --tip-link T    joint values only

POINTS.txt  a laser tracker's text: a line "name x y z" or "x y z", between spaces, tabs, ; or ,
STATES.csv  `rostopic echo -p` (%time, field.name0, field.position0 ...) or one column per joint
FOLDER      one folder per placement of the tool; in it one CSV per socket, whose name ends in its
            number (hole_0.csv, hole_1.csv): columns of joint values, in the order of recording

Nothing is guessed: units and the joints' order (--joints, base to flange) are stated, and counts
that differ end the program. Adapt it: Python 3.8, no packages. Guide: docs/calibrate-your-robot.md
"""
import argparse
import csv
import math
import os
import re
import sys

ANGLE = {"rad": 180.0 / math.pi, "deg": 1.0}  # to degrees
LENGTH = {"mm": 1.0, "m": 1000.0, "inch": 25.4}  # to millimetres
TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}  # to seconds


def stop(words):
    sys.exit(f"convert.py: {words}")


def number(text, where):
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        stop(f'{where}: "{text}", expected a number')
    return value


def read_csv(path):
    """The header and the rows (with their line numbers) of a CSV file."""
    with open(path, encoding="utf-8-sig", newline="") as file:
        lines = csv.reader(file)
        rows = [(lines.line_num, [cell.strip() for cell in row]) for row in lines if any(row)]
    if len(rows) < 2:
        stop(f"{path}: expected a header and rows")
    width = len(rows[0][1])
    for line, row in rows:
        if len(row) != width:
            stop(f"{path}:{line}: {len(row)} cells, expected {width} as in the header")
    return rows[0][1], rows[1:]


def joint_columns(path, header, row, joints):
    """Where each joint's value stands, from base to flange."""
    if not joints:
        usual = re.compile(r"(q|a|j|joint_?)\d+(_\w+)?", re.I)
        found = [i for i, name in enumerate(header) if usual.fullmatch(name)]
        if not found:
            stop(f"{path}:1: no columns q1, q2 ...: name them with --joints, from base to flange")
        return found
    columns = []
    for joint in joints.split(","):
        # PlotJuggler: /joint_states/NAME/position; rostopic: field.name3 holds NAME in every row
        own = (joint, f"/joint_states/{joint}/position")
        named = [i for i, name in enumerate(header) if name in own]
        for i, name in enumerate(header):
            match = re.fullmatch(r"field\.name(\d+)", name)
            if match and row[i] == joint and f"field.position{match[1]}" in header:
                named.append(header.index(f"field.position{match[1]}"))
        if len(named) != 1:
            stop(f"{path}:1: {len(named)} columns for the joint {joint}, expected one")
        columns.append(named[0])
    return columns


def read_joints(path, joints, unit):
    """The header, the rows as they stand, and the joint values of each in degrees."""
    header, rows = read_csv(path)
    columns = joint_columns(path, header, rows[0][1], joints)
    values = [
        [number(row[i], f"{path}:{line}: {header[i]}") * ANGLE[unit] for i in columns]
        for line, row in rows
    ]
    return header, rows, values


def read_points(path, unit):
    """Points of a tracker as (name or None, [x, y, z] in mm)."""
    points = []
    with open(path, encoding="utf-8-sig") as file:
        for line, text in enumerate(file, 1):
            if not text.strip() or text.strip().startswith(("//", "#", "%")):
                continue
            cells = re.split(r"[\s,;]+", text.strip().strip(",;"))
            if len(cells) not in (3, 4):
                stop(f"{path}:{line}: {len(cells)} cells, expected: name x y z")
            name = cells[0] if len(cells) == 4 else None
            xyz = [number(cell, f"{path}:{line}") * LENGTH[unit] for cell in cells[-3:]]
            points.append((name, xyz))
    return points


def pair(points, names, path):
    """The points in the order of `names`, or as they stand where either has no names."""
    if names and all(name for name, _ in points):
        known = dict(points)
        if len(known) != len(points) or set(known) != set(names):
            stop(f"{path}: other names than those of the joint values, or a name twice")
        return [known[name] for name in names]
    return [xyz for _, xyz in points]


def keep(paths, force):
    """Nothing that is there is overwritten."""
    for path in paths:
        if os.path.exists(path) and not force:
            stop(f"{path} is there already: give another name, or --force")


def write(path, header, rows):
    """Written whole or not at all."""
    with open(f"{path}.part", "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])
    os.replace(f"{path}.part", path)
    print(f"{path}: {len(rows)} rows")


def write_measurements(path, names, joints, points, times=None):
    if len(joints) != len(points):
        stop(f"{len(joints)} rows of joint values, {len(points)} points: expected as many")
    header = ["pose", *(f"q{i + 1}_deg" for i in range(len(joints[0]))), "x_mm", "y_mm", "z_mm"]
    rows = [
        [name, *(f"{q:.6f}" for q in values), *(f"{x:.5f}" for x in xyz)]
        for name, values, xyz in zip(names, joints, points)
    ]
    if times:
        header.append("time_s")
        rows = [[*row, f"{time:.3f}"] for row, time in zip(rows, times)]
    write(path, header, rows)


def tracker(options):
    keep([options.out], options.force)
    header, rows, joints = read_joints(options.joint_values, options.joints, options.angle)
    named = [i for i, name in enumerate(header) if name.lower() in ("pose", "name", "point")]
    names = [row[named[0]] for _, row in rows] if named else None
    points = pair(read_points(options.points, options.length), names, options.points)
    write_measurements(options.out, names or range(1, len(rows) + 1), joints, points)


def standstills(times, joints, least, tolerance):
    """(time, average) of each stretch of `least` seconds or more in which no joint moves."""
    found, start = [], 0
    for end in range(1, len(times) + 1):
        moved = end == len(times) or any(
            abs(now - then) > tolerance for now, then in zip(joints[end], joints[start])
        )
        if moved:
            # the first half may still swing: average the second
            half = joints[(start + end) // 2 : end]
            if times[end - 1] - times[start] >= least:
                mean = [sum(column) / len(half) for column in zip(*half)]
                found.append((times[end - 1], mean))
            start = end
    return found


def bag(options):
    keep([options.out], options.force)
    header, rows, joints = read_joints(options.joint_values, options.joints, options.angle)
    usual = ("%time", "__time", "time", "time_s")
    clocks = [i for i, name in enumerate(header) if name.lower() in usual]
    if len(clocks) != 1:
        stop(f"{options.joint_values}:1: expected one column of time, {', '.join(usual)}")
    clock = [number(row[clocks[0]], f"{options.joint_values}:{line}") for line, row in rows]
    times = [(time - clock[0]) * TIME[options.time] for time in clock]
    still = standstills(times, joints, options.still, options.tolerance)
    points = [xyz for _, xyz in read_points(options.points, options.length)]
    names = range(1, len(still) + 1)
    if not still:
        stop(f"{options.joint_values}: no standstill of {options.still} s")
    write_measurements(options.out, names, [q for _, q in still], points, [t for t, _ in still])


def sockets(options):
    rows = []
    for placement in sorted(os.listdir(options.folder)):
        folder = os.path.join(options.folder, placement)
        if not os.path.isdir(folder):
            continue
        for name in sorted(os.listdir(folder)):
            socket = re.search(r"(\d+)\.csv$", name)
            if socket:
                file = os.path.join(folder, name)
                _, _, joints = read_joints(file, options.joints, options.angle)
                rows += [[placement, socket[1], *(f"{q:.6f}" for q in values)] for values in joints]
    if not rows:
        stop(f"{options.folder}: expected folders with CSV files whose names end in 0 or 1")
    rows = [[number, *row] for number, row in enumerate(rows, 1)]
    header = ["pose", "placement", "socket", *(f"q{i + 1}_deg" for i in range(len(rows[0]) - 3))]
    os.makedirs(options.out, exist_ok=True)
    keep([os.path.join(options.out, name) for name in os.listdir(options.out)], options.force)
    robot = os.path.relpath(options.urdf, options.out).replace(os.sep, "/")

    def campaign(name, measurements, validation=None):
        lines = [f'robot = "{robot}"', f'base_link = "{options.base_link}"']
        lines += [f'tip_link = "{options.tip_link}"', f'measurements = "{measurements}"']
        lines += [f'validation = "{validation}"'] * (validation is not None)
        lines += ["", "[sockets]", f"distance_mm = {options.distance}", ""]
        with open(os.path.join(options.out, name), "w", encoding="utf-8") as file:
            file.write("\n".join(lines))

    write(os.path.join(options.out, "all.csv"), header, rows)
    campaign("campaign.toml", "all.csv")
    # each placement predicted from all others: the honest test of a calibration
    for place in sorted({row[1] for row in rows}):
        here = os.path.join(options.out, f"only-{place}.csv")
        write(here, header, [row for row in rows if row[1] == place])
        others = os.path.join(options.out, f"without-{place}.csv")
        write(others, header, [row for row in rows if row[1] != place])
        campaign(f"holdout-{place}.toml", f"without-{place}.csv", f"only-{place}.csv")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    kinds = parser.add_subparsers(required=True, metavar="tracker|bag|sockets")
    for kind in (tracker, bag, sockets):
        command = kinds.add_parser(kind.__name__)
        command.set_defaults(convert=kind)
        command.add_argument("--joints", help="columns or joint names, base to flange, with commas")
        command.add_argument("--force", action="store_true", help="overwrite what is there")
        command.add_argument("--angle", choices=ANGLE, required=True, help="of the joint values")
        if kind is sockets:
            command.add_argument("folder")
            command.add_argument("out")
            for name in ("--urdf", "--base-link", "--tip-link"):
                command.add_argument(name, required=True)
            command.add_argument("--distance", type=float, default=50.0, help="of the sockets, mm")
            continue
        command.add_argument("joint_values")
        command.add_argument("points")
        command.add_argument("out")
        command.add_argument("--length", choices=LENGTH, required=True, help="unit of the points")
        if kind is bag:
            command.add_argument("--time", choices=TIME, required=True, help="of the stamps")
            command.add_argument("--still", type=float, default=1.0, help="s without motion")
            command.add_argument("--tolerance", type=float, default=0.01, help="degrees")
    options = parser.parse_args()
    options.convert(options)


if __name__ == "__main__":
    try:
        main()
    except (OSError, UnicodeDecodeError) as error:
        stop(error)

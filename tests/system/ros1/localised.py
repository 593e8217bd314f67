#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""How far a localised run lies from the run that made the map, of the same recording.

localised.py BAG CPU_SECONDS MAP.tum RUN.tum: the last poses of the run (all that a localiser keeps) against those of the map
at the same time. Exits with 1 if the median is beyond 0.1 m.
"""
import bisect
import math
import sys


def read(path):
    with open(path, encoding='utf-8') as file:
        rows = (line.split() for line in file if line.strip() and line[0] != '#')
        return [tuple(float(value) for value in row[:3]) for row in rows]


def at(poses, times, time):
    i = min(max(bisect.bisect(times, time), 1), len(poses) - 1)
    (t0, x0, y0), (t1, x1, y1) = poses[i - 1], poses[i]
    share = (time - t0) / (t1 - t0)
    return x0 + share * (x1 - x0), y0 + share * (y1 - y0)


bag, cpu, map_path, run_path = sys.argv[1:]
mapped, run = read(map_path), read(run_path)
times = [pose[0] for pose in mapped]
errors = sorted(math.hypot(x - at(mapped, times, t)[0], y - at(mapped, times, t)[1])
                for t, x, y in run if times[0] <= t <= times[-1])
if not errors:
    sys.exit('localised.py: no pose at a time of the map')
median = errors[len(errors) // 2]
print('%-24s %-8s %10.4f %10s %8.1f the last %d poses, median and largest %.3f m'
      % (bag, 'located', median, '', float(cpu.split()[-1]), len(errors), errors[-1]))
sys.exit(0 if median <= 0.1 else 1)

#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""How far the poses that a node publishes while it localises lie from the run that made the map, of the same recording.

localised.py BAG AS CPU_SECONDS MAP.tum TF.bag: each transform map -> odom of TF.bag with odom -> base_link at its time, against
the pose of MAP.tum at that time. The median is over all of them, those before the robot has found its place as well; it has found
it where it is within 0.5 m for the first time, and the largest error is that from there on. Exits with 1 if the median is
beyond 0.05 m, or if less than half of the run has published poses.
"""
import bisect
import math
import sys

import rosbag


def transforms(path):
    """Lists of (time, x, y, angle) of map -> odom and odom -> base_link, sorted by time."""
    found = {('map', 'odom'): {}, ('odom', 'base_link'): {}}
    with rosbag.Bag(path) as bag:
        for _, message, _ in bag.read_messages(topics=['/tf']):
            for each in message.transforms:
                frames = each.header.frame_id.strip('/'), each.child_frame_id.strip('/')
                if frames in found:
                    move, turn = each.transform.translation, each.transform.rotation
                    found[frames][each.header.stamp.to_sec()] = (move.x, move.y, 2. * math.atan2(turn.z, turn.w))
    return [sorted((time, *pose) for time, pose in part.items()) for part in found.values()]


def read(path):
    with open(path, encoding='utf-8') as file:
        rows = (line.split() for line in file if line.strip() and line[0] != '#')
        return [tuple(float(value) for value in row[:3]) for row in rows]


def at(poses, times, time):
    """Position at a time between the first and the last."""
    i = min(max(bisect.bisect(times, time), 1), len(poses) - 1)
    (t0, x0, y0), (t1, x1, y1) = poses[i - 1][:3], poses[i][:3]
    share = (time - t0) / (t1 - t0)
    return x0 + share * (x1 - x0), y0 + share * (y1 - y0)


bag, label, cpu, map_path, tf_path = sys.argv[1:]
mapped = read(map_path)
odom_in_map, robot_in_odom = transforms(tf_path)
map_times, odom_times = [pose[0] for pose in mapped], [pose[0] for pose in robot_in_odom]
if not odom_in_map or not robot_in_odom:
    sys.exit('localised.py: %d transforms map -> odom, %d odom -> base_link' % (len(odom_in_map), len(robot_in_odom)))
errors = []
for time, x, y, angle in odom_in_map:
    if max(map_times[0], odom_times[0]) <= time <= min(map_times[-1], odom_times[-1]):
        robot_x, robot_y = at(robot_in_odom, odom_times, time)
        true_x, true_y = at(mapped, map_times, time)
        errors.append((time, math.hypot(x + math.cos(angle) * robot_x - math.sin(angle) * robot_y - true_x,
                                        y + math.sin(angle) * robot_x + math.cos(angle) * robot_y - true_y)))
first = next((i for i, (_, error) in enumerate(errors) if error <= 0.5), None)
if first is None:
    sys.exit('localised.py: the robot was never found (%d poses)' % len(errors))
median = sorted(error for _, error in errors)[len(errors) // 2]
print('%-24s %-8s %10.4f %10s %8.1f median of %d published poses; found after %.1f s, then at most %.3f m'
      % (bag, label, median, '', float(cpu.split()[-1]), len(errors), errors[first][0] - map_times[0],
         max(error for _, error in errors[first:])))
covered = (errors[-1][0] - errors[0][0]) / (map_times[-1] - map_times[0])
if covered < 0.5:
    print('localised.py: poses for %.0f %% of the run' % (100. * covered))
sys.exit(0 if median <= 0.05 and covered >= 0.5 else 1)

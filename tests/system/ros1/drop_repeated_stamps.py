#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Copies a bag without odometry and IMU messages that are not later than the one before: drop_repeated_stamps.py IN OUT."""
import sys

import rosbag

last = {}
with rosbag.Bag(sys.argv[1]) as source, rosbag.Bag(sys.argv[2], 'w', compression='bz2') as target:
    for topic, message, time in source.read_messages():
        if message._type in ('nav_msgs/Odometry', 'sensor_msgs/Imu'):
            if topic in last and message.header.stamp <= last[topic]:
                continue
            last[topic] = message.header.stamp
        target.write(topic, message, time)

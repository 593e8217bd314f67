#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""One line of the table: row.py RESULT.json BAG AS CPU_SECONDS. Exits with 1 unless the map is sound."""
import json
import sys

path, bag, run, cpu = sys.argv[1:]
with open(path, encoding='utf-8') as file:
    result = json.load(file)
error = result.get('relations', {}).get('translation', {}).get('mean', float('nan'))
print('%-24s %-8s %10.4f %10d %8.1f %s' % (bag, run, error, result['loops']['accepted'], float(cpu.split()[-1]), result['verdict']))
sys.exit(0 if result['verdict'] == 'sound' else 1)

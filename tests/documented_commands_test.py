#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The cartographer_ext authors
# SPDX-License-Identifier: Apache-2.0
"""Every shell command of docs/ros.md and docs/swap.md is marked with the script that runs it, and that script has it.

A block of commands follows a line `<!-- executed by SCRIPT: NAME -->`. SCRIPT has NAME in it: it takes the block out of the
document by that name, or runs what the block says.

  python3 tests/documented_commands_test.py <root of the project>
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
marker = re.compile(r'<!-- executed by (\S+): (\S+) -->')
errors = []
blocks = 0
for document in ('docs/ros.md', 'docs/swap.md'):
    lines = (root / document).read_text(encoding='utf-8').splitlines()
    for number, line in enumerate(lines):
        if line.strip() != '```sh':
            continue
        blocks += 1
        where = '%s:%d' % (document, number + 1)
        match = marker.fullmatch(lines[number - 1])
        if not match:
            errors.append('%s: commands without a marker of the script that runs them' % where)
            continue
        script, name = root / match.group(1), match.group(2)
        if not script.is_file():
            errors.append('%s: %s is missing' % (where, match.group(1)))
        elif not re.search(r'(?<![\w])%s(?![\w])' % re.escape(name), script.read_text(encoding='utf-8')):
            errors.append('%s: %s does not know %s' % (where, match.group(1), name))
# Commands of several lines can be copied: a line that ends in the middle of one ends in a backslash.
texts = [(path, path.read_text(encoding='utf-8')) for path in [root / 'README.md', *sorted((root / 'docs').rglob('*.md'))]]
for path in sorted((root / 'cartographer_ext/tools').glob('*_main.cc')):
    description = re.search(r'R"\((.*?)\)"', path.read_text(encoding='utf-8'), re.S)
    texts.append((path, description.group(1) if description else ''))
for path, text in texts:
    command = None
    for line in text.splitlines():
        goes_on = command is not None and re.match(command + ' {4,}-[a-z]', line)
        if goes_on and not before.endswith('\\'):
            errors.append('%s: no backslash at the end of: %s' % (path.relative_to(root), before))
        if not goes_on:
            # Also where the command stands in quotes, behind another.
            start = re.match("( *)(?:cartographer_ext_|sbatch .*'cartographer_ext_)", line)
            command = start.group(1) if start else None
        before = line
print('\n'.join(errors) or '%d blocks of commands' % blocks)
sys.exit(1 if errors or blocks < 10 else 0)

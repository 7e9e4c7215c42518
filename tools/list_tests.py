#!/usr/bin/env python3
"""Every test by its name and tier, as the sources have them: tools/list_tests.py [--since REVISION]

With --since, what has come and gone since that revision instead: `new`, `gone`, and `moved` for another tier. Tiers are those of
docs/testing.md: quick, everyday (labelled slow), all. `shorter` marks a test whose file shortens random tests in the everyday
tier (tests/tier.hpp). Exit status: 0, or 2 where git does not know the revision.
"""
import argparse
import fnmatch
import re
import subprocess
import sys

TEST = re.compile(r'^\s*TEST(?:_[FP])?\(\s*(\w+)\s*,\s*(\w+)\s*\)', re.MULTILINE)
ADDED = re.compile(r'(?:add_test\(NAME|halfplane_consumer\()\s*"?([\w.$\{\}]+)')
LABELS = re.compile(r'set_tests_properties\(([\w.$\{\}]+)[^)]*LABELS (\w+)')

SLOW = 'tests/data/slow_tests.txt'


def git(*arguments):
    result = subprocess.run(['git', *arguments], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        print(f'list_tests: {result.stderr.strip().splitlines()[0]}', file=sys.stderr)
        sys.exit(2)
    return result.stdout


def tests_of(revision):
    """{name: tier}; no revision: the index."""
    listed = git('ls-tree', '-r', '--name-only', revision, 'tests') if revision else git('ls-files', 'tests')
    slow = git('show', f'{revision}:{SLOW}').split() if SLOW in listed else ['Stress*']
    tests = {}
    for path in listed.split():
        if not path.endswith(('.cpp', '.hpp', 'CMakeLists.txt')):
            continue
        text = git('show', f'{revision}:{path}')
        if path.endswith('CMakeLists.txt'):
            labels = dict(LABELS.findall(text))
            for name in ADDED.findall(text):
                tests[name] = {'slow': 'everyday'}.get(labels.get(name), labels.get(name, 'quick'))
        else:
            for suite, name in TEST.findall(text):
                is_slow = any(fnmatch.fnmatchcase(f'{suite}.{name}', pattern) for pattern in slow)
                tier = 'everyday' if is_slow else 'quick'
                tests[f'{suite}.{name}'] = tier + (', shorter' if 'test::cases(' in text or 'runs_all()' in text else '')
    return tests


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--since', metavar='REVISION')
    options = parser.parse_args()
    now = tests_of('')
    if not options.since:
        for name, tier in sorted(now.items()):
            print(f'{tier:18} {name}')
        print(f'{len(now)} tests')
        return 0
    before = tests_of(options.since)
    for name in sorted(before | now):
        if name not in before:
            print(f'new     {now[name]:18} {name}')
        elif name not in now:
            print(f'gone    {before[name]:18} {name}')
        elif before[name] != now[name]:
            print(f'moved   {before[name]} -> {now[name]}: {name}')
    print(f'{len(before)} tests before, {len(now)} now')
    return 0


if __name__ == '__main__':
    sys.exit(main())

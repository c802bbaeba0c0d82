#!/usr/bin/env python3
"""Writes what the docs show of the tools' output, from the tools themselves.

    docs/make_docs.py            # rewrite the blocks that differ, and docs/options.md
    docs/make_docs.py --check    # write nothing; exit 1 and name the blocks that differ

A block is a session in a shell: what follows each line with a $ is what that command prints.

    <!-- session -->
    ```
    $ vpl-inspect info lit.vpl
    lit.vpl: lit, 1000 rows, ...
    ```
    <!-- end of session -->

Each session begins in a folder where SETUP has made small files, with the tools on the PATH. Times,
memory, builds and hashes differ from run to run; NORMAL says what is written instead.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STAGES = ('vpl-place', 'vpl-eliminate', 'vpl-estimate', 'vpl-render')

# What the blocks' commands find. Small, so that a test can run it.
SETUP = '''
ln -s '{root}/scenes' scenes
vpl-place scenes/u-shape/scene.toml -o candidates.vpl -n 20k --quiet
vpl-eliminate candidates.vpl -o vpls.vpl -n 1k --quiet
vpl-estimate scenes/u-shape/scene.toml vpls.vpl -o lit.vpl --photons 200k --quiet
vpl-render scenes/u-shape/scene.toml lit.vpl -o image.exr --spp 2 --size 80x60 --layers all --quiet
vpl-render scenes/u-shape/scene.toml -o reference.exr --integrator path --spp 4 --size 80x60 --layers all --quiet
'''

# Seconds, memory, build identities and hashes; and last digits, which depend on the processor.
NORMAL = ((re.compile(r'\b\d+\.\d\d s, peak memory \d+ MiB'), '0.00 s, peak memory 0 MiB'),
          (re.compile(r'\b(\d+\.\d+\.\d+)\+[0-9a-f]{12}\b'), r'\1'),
          (re.compile(r'\b[0-9a-f]{16}\b'), '0123456789abcdef'))

SESSION = re.compile(r'(<!-- session -->\n```[a-z]*\n)(?P<text>.*?)(```\n<!-- end of session -->)', re.S)


def normal(text):
    for pattern, instead in NORMAL:
        text = pattern.sub(instead, text)
    return '\n'.join(line.rstrip() for line in text.splitlines()) + '\n'


def same(a, b):
    """Equal but for numbers, which may differ by a unit in their last shown digits."""
    number = re.compile(r'-?\d+(?:\.\d+)?(?:e[-+]?\d+)?')
    if number.sub('#', a) != number.sub('#', b):
        return False
    return all(abs(float(x) - float(y)) <= 0.02 * max(abs(float(x)), abs(float(y)))
               for x, y in zip(number.findall(a), number.findall(b)))


class Bench:
    def __init__(self, bin_folder, folder):
        self.folder = folder
        self.environment = dict(os.environ, PATH=f'{bin_folder}:{os.environ["PATH"]}', COLUMNS='100')
        done = self.run(SETUP.format(root=ROOT))
        if done.returncode:
            raise SystemExit(f'make_docs: the set-up failed: {done.stderr}')

    def run(self, command):
        return subprocess.run(['bash', '-euc', command], cwd=self.folder, env=self.environment, text=True,
                              capture_output=True)

    def session(self, text):
        """The commands of a session, each with what it prints; in a copy of the folder."""
        commands = [line[2:] for line in text.splitlines() if line.startswith('$ ')]
        with tempfile.TemporaryDirectory(prefix='bnvpl-session.') as folder:
            shutil.copytree(self.folder, folder, symlinks=True, dirs_exist_ok=True)
            marker = '\x1e'
            script = ''.join(f"printf '{marker}'; {{ {command}\n}} 2>&1\n" for command in commands)
            done = subprocess.run(['bash', '-c', script], cwd=folder, env=self.environment, text=True,
                                  capture_output=True)
        printed = done.stdout.split(marker)[1:]
        return ''.join(f'$ {command}\n{normal(output) if output else ""}' for command, output in zip(commands, printed))


def option_rows(options):
    for o in options:
        facts = ', '.join(x for x in (o['unit'], o['range']) if x)
        needs = f' Needs `--{o["needs"].replace("=", " ")}`.' if o['needs'] else ''
        kind = o['type'].replace('|', '\\|')
        yield f'| `--{o["name"]}` | {kind} | {o["default"] or "-"} | {facts or "-"} | {o["help"]}.{needs} |'


def options_page(bench):
    lines = ['# Options', '',
             'Every option of the stages, as `--help` shows them; made by `docs/make_docs.py` from the tables in the code.',
             'An option of a method is refused while another method is chosen.', '']
    head = ['| option | type | default | unit, range | |', '|---|---|---|---|---|']
    for tool in STAGES:
        spec = json.loads(bench.run(f'{tool} --help-json').stdout)
        lines += [f'## {tool}', '', *head, *option_rows(spec['options']), '']
        for slot in spec['slots']:
            needs = f' Needs `--{slot["needs"].replace("=", " ")}`.' if slot['needs'] else ''
            lines += [f'### {tool} --{slot["name"]}', '',
                      f'{slot["help"][0].upper()}{slot["help"][1:]}; default `{slot["default"]}`.{needs}', '']
            for method in slot['methods']:
                lines += [f'- `{method["name"]}`: {method["summary"]}']
            lines += ['']
            for method in slot['methods']:
                if method['options']:
                    lines += [f'With `--{slot["name"]} {method["name"]}`:', '', *head,
                              *option_rows(method['options']), '']
    return '\n'.join(lines)


def pages():
    found = subprocess.run(['git', 'ls-files', '*.md'], cwd=ROOT, capture_output=True, text=True).stdout.split('\n')
    files = [ROOT / f for f in found if f] or sorted(ROOT.glob('**/*.md'))
    return [f for f in files if f.exists() and '<!-- session -->' in f.read_text() and 'docs/lab' not in str(f)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--check', action='store_true', help='write nothing')
    parser.add_argument('--bin', default=ROOT / 'build/release/bin', type=Path, help='folder of the executables')
    arguments = parser.parse_args()
    differing = 0
    with tempfile.TemporaryDirectory(prefix='bnvpl-docs.') as folder:
        bench = Bench(arguments.bin.resolve(), folder)

        def renew(file, old, new, what):
            nonlocal differing
            differing += 1
            print(f'{file.relative_to(ROOT)}: {what} differs')
            if not arguments.check:
                file.write_text(new)

        for file in pages():
            text = file.read_text()

            def block(match):
                now = bench.session(match['text'])
                if same(now, match['text']):
                    return match[0]
                print(f'  {match["text"].splitlines()[0]}')
                return f'{match[1]}{now}{match[3]}'

            new = SESSION.sub(block, text)
            if new != text:
                renew(file, text, new, 'output')
        table = ROOT / 'docs/options.md'
        page = options_page(bench)
        if not table.exists() or table.read_text() != page:
            renew(table, '', page, 'the table of options')
    if differing and arguments.check:
        print('run docs/make_docs.py')
    return 1 if differing and arguments.check else 0


if __name__ == '__main__':
    sys.exit(main())

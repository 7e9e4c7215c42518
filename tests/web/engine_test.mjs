// The module of WebAssembly says what the native program says, byte for byte but for times and progress, and writes the same files:
//   node --test tests/web/engine_test.mjs      with HALFPLANE_SITE (build/web/site) and HALFPLANE_PROGRAM (build/halfplane)
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const site = path.resolve(process.env.HALFPLANE_SITE ?? path.join(root, 'build/web/site'));
const program = path.resolve(process.env.HALFPLANE_PROGRAM ?? path.join(root, 'build/halfplane'));
const { load } = await import(pathToFileURL(path.join(site, 'engine/engine.mjs')).href);
const halfplane = await load();

function filesIn(folder, prefix = '', found = {}) {
  for (const entry of fs.readdirSync(folder, { withFileTypes: true })) {
    const at = path.join(folder, entry.name);
    if (entry.isDirectory()) filesIn(at, `${prefix}${entry.name}/`, found);
    else found[prefix + entry.name] = new Uint8Array(fs.readFileSync(at));
  }
  return found;
}

function native(args, files) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'halfplane-engine-'));
  try {
    for (const [name, content] of Object.entries(files)) fs.writeFileSync(path.join(folder, name), content);
    const { status, stdout, stderr } = spawnSync(program, args, { argv0: 'halfplane', cwd: folder, maxBuffer: 1 << 28, encoding: 'utf8' });
    const made = filesIn(folder);
    for (const name of Object.keys(files)) delete made[name];
    return { status, stdout, stderr, files: made };
  } finally {
    fs.rmSync(folder, { recursive: true });
  }
}

/// Seconds are not compared: members that end in _s, with all that is in them.
function withoutTimes(text) {
  if (!text.startsWith('{')) return text;
  return JSON.stringify(JSON.parse(text, (key, value) => (key.endsWith('_s') ? undefined : value)), null, 1);
}

/// Lines of progress depend on the time.
const withoutProgress = (text) => text.replace(/^.* \d+:\d\d left\n/gm, '');

/// Texts that differ in numbers alone, by less than 1e-8 of their size or 1e-14: the last bits of numbers about 10.
function assertNear(got, expected) {
  const number = /-?\d+\.\d+(e[+-]?\d+)?/g;
  assert.equal(got.replace(number, '#'), expected.replace(number, '#'));
  const wanted = expected.match(number) ?? [];
  for (const [i, found] of (got.match(number) ?? []).entries()) {
    const size = Math.abs(Number(wanted[i]));
    assert.ok(Math.abs(Number(found) - Number(wanted[i])) <= Math.max(1e-8 * size, 1e-14), `${found}, not ${wanted[i]}`);
  }
}

const triangle = fs.readFileSync(path.join(root, 'tests/data/web_triangle.hpt'), 'utf8');
const same = [
  ['render teapot --size 160x120 --json --quiet -o teapot.png --depth teapot.npy'],
  ['render teapot --size 160x120 --engine scalar --json --quiet'],
  ['render teapot --size 160x120 --engine golden --json --quiet'],
  ['render teapot --size 96x64 --engine cycle --json --quiet --what-if cache.lines=16,64 --memory sdram'],
  ['render city --size 160x120 --config full --json --quiet -o city.png --set msaa.samples=4'],
  ['render layers_glass:16 --size 96x64 --json --quiet'],
  ['render teapot --size 64x48 --frames 3 --camera orbit --csv turn.csv --json --quiet'],
  ['compare teapot --size 96x64 --json --quiet -o sheet.png'],
  ['explain teapot 80 60 --size 160x120'],
  ['explain teapot 80 60 --size 160x120 --json --quiet'],
  ['explain drawn.hpt 4 4 --steps --json --quiet', { 'drawn.hpt': triangle }],
  ['depth --near 0.1 --far 100 --mapping std,rev,w,stdinf --format u16,f16'],
  ['widths --config full'],
  ['widths --json --quiet'],
  ['scenes'],
  ['config --config full'],
  ['config --config tiny --sv'],
  ['convert teapot --size 64x48 -o teapot.hpt'],
  ['convert drawn.hpt -o again.hpt', { 'drawn.hpt': triangle }],
  ['convert knot -o knot.hpt'],
  ['vectors --random 20 --stage cull --format hex -o cull'],
  ['stress --case fans --unit 3 --json --quiet'],
  ['stress --case adversarial_depth --unit 1 --config tiny --json --quiet'],
  ['render knot --size 96x64 --engine golden --json --quiet --set depth.mapping=log'],
  ['--version'],
  ['render --help'],
];
/// With numbers that come from pow(), exp() or a sum of many: equal but for the last bits (docs/web.md).
const near = [
  ['compare wires --size 96x64 --json --quiet'],
  ['depth --near 0.1 --far 100 --mapping std,rev,w,stdinf --format u16,f16 --json --quiet'],
  ['depth --near 0.1 --far 100 --mapping log --format u24,uf4.12 --error 0.01 --slope 1'],
  ['depth --scene coplanar --size 64x48 --json --quiet'],
  ['convert city -o city.hpt --quiet'],
];
/// Wrong usage and bad input: the same line, the same status.
const refused = [
  [''],
  ['rendr teapot'],
  ['render teapott'],
  ['render teapot --sise 10x10'],
  ['render teapot --size 0x10'],
  ['render teapot --set depth.bits=99'],
  ['render nowhere.hpt'],
  ['render bad.hpt', { 'bad.hpt': 'halfplane capture 1\nnonsense\n' }],
  ['render bad.glb', { 'bad.glb': 'glTF' }],
];

for (const [line, files = {}] of [...same, ...near, ...refused])
  test(`halfplane ${line} says the same InNodeJs`, async () => {
    const args = line.split(' ').filter(Boolean);
    const expected = native(args, files);
    assert.equal(expected.status > 1, refused.some(([of]) => of === line), expected.stderr);
    const got = await halfplane.run(args, files);
    const times = line === '--version' ? (text) => text.replace(/\(.*\)/, '') : withoutTimes;
    assert.equal(withoutProgress(got.stderr), withoutProgress(expected.stderr));
    assert.equal(got.status, expected.status);
    const isNear = near.some(([of]) => of === line);
    (isNear ? assertNear : assert.equal)(times(got.stdout), times(expected.stdout));
    assert.deepEqual(Object.keys(got.files).sort(), Object.keys(expected.files).sort());
    const text = (bytes) => Buffer.from(bytes).toString();
    for (const [name, bytes] of Object.entries(expected.files)) {
      if (name.endsWith('.csv')) continue; // it has times
      if (isNear) assertNear(text(got.files[name]), text(bytes));
      else assert.ok(Buffer.compare(bytes, got.files[name]) === 0, `${name} differs`);
    }
  });

test('a comparison that finds a difference would fail InNodeJs', async () => {
  const coarse = native('render teapot --size 160x120 --json --quiet --set subpixel.bits=2'.split(' '), {});
  const got = await halfplane.run('render teapot --size 160x120 --json --quiet --set subpixel.bits=3'.split(' '));
  assert.notEqual(withoutTimes(got.stdout), withoutTimes(coarse.stdout));
});

/// As color_hash of the program's results: FNV-1a of the stored codes, which `full` stores as bytes R, G, B, A.
function hashOf(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = BigInt.asUintN(64, (hash ^ BigInt(byte)) * 0x100000001b3n);
  return hash.toString(16).padStart(16, '0');
}

test('live pictures are those of render --frames InNodeJs', () => {
  const { stdout } = native('render teapot --size 64x48 --config full --camera orbit --frames 4 --json --quiet'.split(' '), {});
  const rows = JSON.parse(stdout).frames;
  assert.equal(rows.length, 4);
  for (const [i, row] of rows.entries()) {
    const picture = halfplane.frame({ scene: 'teapot', config: 'full', width: 64, height: 48, camera: 'orbit', turn: i / 4 });
    assert.deepEqual([picture.width, picture.height], [64, 48]);
    assert.ok(row.color_hash.endsWith(hashOf(picture.rgba)), `frame ${i}`);
  }
  assert.throws(() => halfplane.frame({ scene: 'nothing' }), /nothing/);
});

test('a live picture follows its file InNodeJs', () => {
  const of = (text) => halfplane.frame({ scene: 'drawn.hpt', files: { 'drawn.hpt': text } }).rgba;
  const first = of(triangle), second = of(triangle.replace('255 0 0', '0 0 255'));
  assert.notDeepEqual(first, second);
  assert.deepEqual(of(triangle), first);
});

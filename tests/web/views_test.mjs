// Every view, every control, every figure of the page, in headless Chromium:
//   node tests/web/views_test.mjs SITE PROGRAM [VIEW...]
// SITE is the built folder or an address, PROGRAM the native halfplane. Ends with 1 when a check fails.
import fs from 'node:fs';
import path from 'node:path';
import { launch, runProgram, serve } from './browser.mjs';
import { format, valueAt } from '../../web/site/elements.js';
import { contrastFailures } from './contrast.mjs';

const [site, program, ...chosen] = process.argv.slice(2);
if (!program) {
  console.error('views_test.mjs: give the folder of the built site and the native program');
  process.exit(2);
}
const root = path.resolve(import.meta.dirname, '../..');

// States in which each control of a view does something. In a square of two triangles ties lie on the shared edge, whose line meets (-1, -1).
const SQUARE = 'second=shared&a=12,2&b=12,12&c=2,2&d=2,12&grid=16x12&label=value';
const BASES = {
  triangle: [
    `${SQUARE}&marks=both&rule=top_left`,
    `${SQUARE}&samples=4`,
    'draw=line',
    'draw=line&line=diamond&a=1,1&b=9,5&grid=16x12',
    'second=junction&a=2,2&b=14,11&c=2,2.5&d=3,11&sub=0',
  ],
  depth: [
    'page.scene=coplanar&page.size=64x48',
    'page.scene=coplanar&page.size=64x48&planes=above&near=10&far=50&z=20&slope=1',
  ],
  pipeline: [
    'page.scene=city&page.size=64x48&cycle=3000&x=30&y=30',
    'page.scene=floor&unit=trilinear&cycle=9000&memory=ddr3&lines=16',
    'page.scene=city:100&page.size=160x120&cycle=9000&queue=4&lines=16&memory=sdram',
  ],
  pixel: ['page.scene=teapot&page.size=64x48&x=30&y=20&passing=on', 'page.scene=city&page.size=160x120&x=80&y=60'],
  texture: ['x=120&y=110&beside=misses&kb=1&memory=ddr3', 'x=120&y=60&beside=error&repeats=20'],
};
const views = chosen.length ? chosen : Object.keys(BASES);

let checks = 0;
const failures = [];
function check(holds, message) {
  checks += 1;
  if (!holds) {
    failures.push(message);
    console.log(`FAILED: ${message}`);
  }
}

const server = await serve(site);
const browser = await launch();
const page = await browser.newPage();
await page.setViewport({ width: 1280, height: 800 });
page.setDefaultTimeout(120000);
const complaints = [];
page.on('pageerror', (error) => complaints.push(error.message));
page.on('console', (message) => message.type() === 'error' && complaints.push(message.text()));

// All results that were asked for are shown.
const settled = () =>
  page.waitForFunction(
    () => {
      const main = document.querySelector('main');
      return (
        main.dataset.shown &&
        !main.classList.contains('busy') &&
        [...main.querySelectorAll('img')].every((image) => image.complete)
      );
    },
    { polling: 20 },
  );

async function visit(fragment) {
  await page.goto('about:blank');
  await page.goto(server.address + fragment);
  await settled();
}

const errorLine = () => page.$eval('#error', (line) => (line.hidden ? '' : line.textContent));

// What the view shows, without its controls.
const fingerprint = () =>
  page.evaluate(() => {
    const drawn = (image) => {
      const canvas = document.createElement('canvas');
      [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
      canvas.getContext('2d').drawImage(image, 0, 0);
      return canvas.toDataURL();
    };
    const main = document.querySelector('main');
    const figures = [...main.querySelectorAll('table, dl, p, svg, h2, h3, details, button')].map((node) => node.textContent);
    const text = [
      ...figures,
      ...[...main.querySelectorAll('canvas')].filter((canvas) => !canvas.hidden).map((canvas) => canvas.toDataURL()),
      ...[...main.querySelectorAll('img')].map(drawn),
      ...[...main.querySelectorAll('.bar')].map((bar) => bar.style.width),
      document.querySelector('#error').textContent,
    ].join('\n');
    let hash = 0;
    for (let index = 0; index < text.length; index++) hash = (hash * 31 + text.charCodeAt(index)) | 0;
    return `${text.length} ${hash}`;
  });

// Figures of the page against the program's JSON, by the command and the path that each names.
const known = new Map();
async function checkFigures(state) {
  const { figures, commands, curve } = await page.evaluate(() => {
    const main = document.querySelector('main');
    const shown = [...main.querySelectorAll('.figure')].map((node) => ({ text: node.textContent, ...node.dataset }));
    const inCanvas = [...main.querySelectorAll('canvas')].flatMap((canvas) => canvas.grid?.figures ?? []);
    const chart = main.querySelector('.chart');
    return {
      figures: [...shown, ...inCanvas],
      commands: main.commands.map(({ args, files, command }) => ({
        args,
        command,
        files: Object.fromEntries(
          Object.entries(files).map(([name, content]) => [
            name,
            typeof content === 'string' ? content : { bytes: [...content] },
          ]),
        ),
      })),
      curve: chart?.chart && { data: chart.chart.data.map((row) => [...row]), ...chart.dataset },
    };
  });
  const resultOf = (command) => {
    const { args, files } = commands.find((one) => one.command === command);
    const key = JSON.stringify([args, files]);
    if (!known.has(key)) {
      const given = Object.fromEntries(
        Object.entries(files).map(([name, content]) => [name, content.bytes ? Buffer.from(content.bytes) : content]),
      );
      known.set(key, JSON.parse(runProgram(program, args, given).stdout));
    }
    return known.get(key);
  };
  let equal = 0;
  for (const { text, command, path: where } of figures) {
    const expected = format(valueAt(resultOf(command), where));
    // In a cell of the picture bits stand without their 0x.
    if (text === expected || text === expected.replace('0x', '')) equal += 1;
    else check(false, `${state}: '${text}' is shown, the program says '${expected}' at ${where} of ${command}`);
  }
  check(equal > 0, `${state}: no figure is shown`);
  if (curve) {
    const { z, bin_width, first_order } = valueAt(resultOf(curve.command), curve.path);
    const apart = resultOf(curve.apart).rows.filter(({ metric }) => metric === 'separation');
    const near = (is, should) => Math.abs(is - should) <= 1e-8 * Math.abs(should); // powers of ten: docs/web.md
    const at = (depth) => curve.data.slice(1).map((row) => row[curve.data[0].findIndex((z) => near(z, depth))]);
    const isCurve = z.every((depth, index) => near(at(depth)[0], bin_width[index]) && near(at(depth)[1], first_order[index]));
    check(isCurve, `${state}: the chart's curve is not the program's`);
    check(
      apart.length > 0 && apart.every((row) => near(at(Number(row.z))[2], row.value)),
      `${state}: the chart's separations are not the program's`,
    );
  }
  return equal;
}

// Each value of each control that is not disabled; a value counts when it changes what is shown in one of the states.
async function useControls(view) {
  const done = new Map();
  for (const base of BASES[view]) {
    await visit(`#view=${view}&${base}`);
    const controls = await page.$$eval('main [data-key], #scene:not([hidden]) [data-key]', (nodes) =>
      nodes.map((node) => ({
        key: node.dataset.key,
        disabled: node.disabled,
        label: node.labels?.[0]?.textContent || node.getAttribute('aria-label'),
        values: node.tagName === 'SELECT' ? [...node.options].map(({ value }) => value) : [node.min, node.max],
        start: node.value,
      })),
    );
    for (const { key, label, values, start, disabled } of controls) {
      check(label, `${view}: control ${key} has no label`);
      if (disabled || key === 'scene') continue;
      for (const value of values.filter((one) => one !== start)) {
        const name = `${view}, ${key} = ${value}`;
        if (done.get(name)) continue;
        const before = await fingerprint();
        const use = (to) =>
          page
            .$eval(
              `[data-key=${key}]`,
              (node, text) => {
                node.value = text;
                node.dispatchEvent(new Event(node.type === 'range' ? 'input' : 'change', { bubbles: true }));
              },
              to,
            )
            .then(settled);
        await use(value);
        const isChanged = before !== (await fingerprint());
        const isError = (await errorLine()) !== '';
        if (isChanged && !isError) await checkFigures(name);
        done.set(name, isChanged);
        await use(start);
        check(before === (await fingerprint()), `${name} and back to ${start} shows something else than before, in ${base}`);
      }
    }
  }
  for (const [name, isChanged] of done) check(isChanged, `${name} changes nothing`);
  return done.size;
}

async function useButtons(view) {
  await visit(`#view=${view}&${BASES[view][0]}`);
  const selectors = await page.$$eval('main button', (nodes) =>
    nodes.map((node) => Object.entries(node.dataset).map(([name, value]) => `[data-${name}="${value}"]`)[0]),
  );
  for (const selector of selectors) {
    const before = await fingerprint();
    await page.click(`main button${selector}`);
    if (selector.includes('run')) {
      await page.waitForFunction(
        (text) => document.querySelector('main .answer').textContent !== text,
        {},
        await page.$eval('main .answer', (node) => node.textContent),
      );
      await page.click(`main button${selector}`);
    }
    if (selector.includes('jump'))
      await page.waitForFunction(() => !document.querySelector('main .answer').textContent.startsWith('cycle 3000 '), {});
    await settled();
    check(before !== (await fingerprint()), `${view}: button ${selector} changes nothing`);
  }
}

const valueOf = (key) => page.$eval(`[data-key=${key}]`, (node) => node.value);
const linkOf = async () => {
  await page.waitForFunction((shown) => location.hash === document.querySelector('main').dataset.shown);
  return page.evaluate(() => location.hash);
};

// Arrow keys, a drag with the mouse and a touch of the view's canvas.
async function useCanvas(view) {
  if (view === 'depth') return;
  await visit(`#view=${view}&${BASES[view][0]}`);
  let before = await fingerprint();
  await page.focus('main canvas');
  await page.keyboard.press('ArrowRight');
  await settled();
  check(before !== (await fingerprint()), `${view}: an arrow key changes nothing`);
  const box = await (await page.$('main canvas')).boundingBox();
  before = await fingerprint();
  const link = await page.$eval('main', (main) => main.dataset.shown);
  await page.touchscreen.tap(box.x + box.width * 0.41, box.y + Math.min(box.height, 300) * 0.52);
  // The pipeline's view asks for the pixel's write first.
  await page.waitForFunction((old) => document.querySelector('main').dataset.shown !== old, {}, link).catch(() => {});
  await settled();
  check(before !== (await fingerprint()), `${view}: a touch changes nothing`);
  if (view !== 'triangle') return;
  const scale = box.width / 16;
  await page.mouse.move(box.x + 12 * scale, box.y + 2 * scale);
  await page.mouse.down();
  await page.mouse.move(box.x + 9.01 * scale, box.y + 3.02 * scale, { steps: 4 });
  await page.mouse.up();
  await settled();
  check((await linkOf()).includes('a=9,3&'), `triangle: corner A was dragged, the link is ${await linkOf()}`);
}

// At its start the view shows the triangle that docs/spec.md works through by hand.
async function checkStart() {
  await visit('#view=triangle');
  const edges = await page.$$eval('main table tr', (rows) => rows.map((row) => row.innerText.replaceAll(/\s+/g, ' ').trim()));
  for (const row of [
    'A→B right no no 148 0x00000094 2370',
    'B→C right no no 1027 0x00000403 16448',
    'C→A left yes no 596 0x00000254 9538',
  ])
    check(
      edges.some((text) => text.startsWith(row)),
      `the start has no edge '${row}': ${edges}`,
    );
}

// Cracks and double draws that light up are as many as the program counts.
async function checkRules() {
  for (const rule of ['top_left', 'offset_point', 'inclusive', 'exclusive']) {
    await visit(`#view=triangle&${SQUARE}&rule=${rule}`);
    const lit = await page.$eval('main canvas', (canvas) => ({ ...canvas.dataset }));
    const totals = await page.$eval('main', (main) => main.commands.find(({ args }) => args[0] === 'render').json);
    check(
      Number(lit.doubles) === totals.double_draws && Number(lit.cracks) === totals.undrawn_samples,
      `${rule}: ${lit.doubles} double draws and ${lit.cracks} cracks are lit, the program counts ${totals.double_draws} and ${totals.undrawn_samples}`,
    );
    check(
      rule === 'top_left' || totals.double_draws + totals.undrawn_samples > 0,
      `${rule}: the square has no sample on its diagonal`,
    );
  }
}

async function checkErrors() {
  for (const fragment of [
    '#view=pixel&page.scene=teapott',
    '#view=pixel&page.scene=teapot&page.config=tiny',
    '#view=pipeline&page.scene=floor',
  ]) {
    await visit(fragment);
    const command = await page.$$eval('#commands li', (items) => items.map((item) => item.textContent));
    const shown = await errorLine();
    check(
      shown !== '' && !shown.includes('\n') && !shown.startsWith('halfplane'),
      `${fragment}: the error is '${shown}' after ${command}`,
    );
  }
}

async function checkFile() {
  await visit('#view=pixel&x=6&y=3');
  await (await page.$('input[type=file]')).uploadFile(path.join(root, 'docs/spec/triangle.hpt'));
  await page.waitForFunction(() => document.querySelector('#commands ul').textContent.includes('triangle.hpt'), {});
  await settled();
  check((await errorLine()) === '', `a file: ${await errorLine()}`);
  await checkFigures('a file');
  check(
    (await page.$eval('main', (main) => main.textContent)).includes('0x603a'),
    'docs/spec/triangle.hpt: pixel 6 3 has not the depth of docs/spec.md',
  );
}

async function checkNarrow(view) {
  await page.setViewport({ width: 390, height: 844 });
  await visit(`#view=${view}&${BASES[view][0]}`);
  check(
    await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth),
    `${view}: wider than a screen of 390 pixels`,
  );
  await page.setViewport({ width: 1280, height: 800 });
}

// docs/views.md names every key of the link.
async function checkPage() {
  await visit('#view=triangle');
  const text = fs.readFileSync(path.join(root, 'docs/views.md'), 'utf8');
  const keys = await page.$eval('main', (main) =>
    Object.entries(main.rules).map(([view, rules]) => [view, Object.keys(rules)]),
  );
  for (const [view, names] of keys) {
    const row = text.split('\n').findLast((line) => line.startsWith(`| ${view} |`)) ?? '';
    for (const name of names)
      check(row.includes(`\`${view === 'page' ? 'page.' : ''}${name}\``), `docs/views.md does not name ${name} of ${view}`);
  }
}

// Links of the lessons: every key and value is one that the page knows, and the program has no complaint.
async function checkLessons() {
  const folder = path.join(root, 'docs/course');
  const texts = fs.readdirSync(folder).filter((name) => name.endsWith('.md'));
  const links = texts.flatMap((name) =>
    [...fs.readFileSync(path.join(folder, name), 'utf8').matchAll(/index\.html(#[^)]*)\)/g)].map((match) => [name, match[1]]),
  );
  check(links.length >= 8, `${links.length} links from docs/course to the page`);
  for (const [name, link] of links) {
    await visit(link);
    const unknown = await page.$eval(
      'main',
      (main, link) => {
        const words = new URLSearchParams(link.slice(1));
        const view = words.get('view');
        return [...words].filter(([word, text]) => {
          const [of, key] = word.includes('.') ? word.split('.', 2) : [view, word];
          return word !== 'view' && !main.rules[of]?.[key]?.accepts(text);
        });
      },
      link,
    );
    check(unknown.length === 0, `docs/course/${name}: ${link} has ${unknown.join(' ')}`);
    check((await errorLine()) === '', `docs/course/${name}: ${link}: ${await errorLine()}`);
  }
}

await checkPage();
await checkLessons();
for (const failure of contrastFailures(fs.readFileSync(path.join(root, 'web/site/style.css'), 'utf8'))) check(false, failure);
for (const view of views) {
  let figures = 0;
  for (const base of BASES[view]) {
    await visit(`#view=${view}&${base}`);
    check((await errorLine()) === '', `${view}, ${base}: ${await errorLine()}`);
    figures += await checkFigures(`${view}, ${base}`);
    const [shown, hash] = [await fingerprint(), await page.$eval('main', (main) => main.dataset.shown)];
    await visit(hash);
    check(
      shown === (await fingerprint()) && hash === (await page.$eval('main', (main) => main.dataset.shown)),
      `${view}: its link ${hash} shows something else`,
    );
  }
  const values = await useControls(view);
  await useButtons(view);
  await useCanvas(view);
  await checkNarrow(view);
  console.log(`${view}: ${figures} figures, ${values} values of its controls`);
}
if (views.includes('triangle')) await checkStart().then(checkRules);
if (views.includes('pixel')) await Promise.resolve().then(checkErrors).then(checkFile);
check(complaints.length === 0, `the page complains: ${complaints.join('; ')}`);
await browser.close();
server.close();
console.log(`${checks - failures.length} of ${checks} checks hold`);
process.exit(failures.length ? 1 : 0);

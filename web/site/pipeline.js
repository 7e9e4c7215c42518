// Packets in the stages, cycle by cycle: what is where, what waits, and what another size would change.
import { button, group, picker } from './controls.js';
import { Grid, colors } from './grid.js';
import { element, figure, image, list, picture, table } from './elements.js';
import { choice, whole } from './state.js';
import { during, timelineOf } from './timeline.js';

// Values that --what-if tries of a setting.
const VARIED = {
  'cache.lines': '16,64,256,1024',
  'cache.queue': '4,8,16,32,64',
  'cache.victims': '2,4,8,16',
  'stamp.size': '1,2,4',
  'hiz.bits': '0,8,16',
  'queue.stamp': '1,2,8,32',
  memory: 'sram,sdram,psram,ddr3',
};

export const rules = {
  cycle: whole(0, 0, 100000000),
  speed: choice('1', '1', '10', '100', '1000'),
  memory: choice('fixed', 'fixed', ...VARIED.memory.split(',')),
  lines: choice('own', 'own', '16', '64', '1024'),
  queue: choice('own', 'own', '4', '8', '16', '64'),
  stamp: choice('own', 'own', '1', '4'),
  hiz: choice('own', 'own', '0'),
  unit: choice('own', 'own', 'nearest', 'bilinear', 'trilinear'),
  map: choice('progress', 'progress', 'heat'),
  vary: choice('none', 'none', ...Object.keys(VARIED)),
  x: whole(-1, -1, 4095),
  y: whole(-1, -1, 4095),
};
export const showsScene = true;

const SETTINGS = { lines: 'cache.lines', queue: 'cache.queue', stamp: 'stamp.size', hiz: 'hiz.bits', unit: 'texture.unit' };
const OWN = { own: "the configuration's" };
const settings = (state) =>
  Object.entries(SETTINGS)
    .map(([key, name]) => (state[key] === 'own' ? '' : `--set ${name}=${state[key]}`))
    .join(' ');

export function open(root, context) {
  const { set, run, scene } = context;
  const state = () => context.values().pipeline;
  const pick = picker(rules, set);
  const graph = element('div', { class: 'graph' });
  const map = element('div', {});
  const figures = element('div', {});
  const now = element('p', { class: 'answer' });
  const grid = new Grid('The picture as far as it is drawn. Arrow keys choose a pixel, Enter jumps to the cycle of its write.');
  const slide = element('input', {
    type: 'range',
    min: '0',
    max: '1',
    'aria-label': 'cycle',
    class: 'wide',
    'data-key': 'cycle',
  });
  slide.addEventListener('input', () => {
    pause();
    set({ cycle: slide.value });
  });
  const play = button('run', () => (timer ? pause() : start()), { 'data-action': 'run' });
  const step = (sign) =>
    button(
      '',
      () => {
        pause();
        go(Number(state().cycle) + sign * Number(state().speed));
      },
      { 'data-step': sign },
    );
  const back = step(-1);
  const on = step(1);
  root.append(
    element(
      'section',
      { class: 'stage', 'aria-label': 'pipeline and picture' },
      graph,
      now,
      slide,
      element(
        'div',
        { class: 'controls' },
        back,
        play,
        on,
        pick('speed', 'cycles a step'),
        button('to the write', () => jump(), { 'data-action': 'jump' }),
      ),
      map,
      grid.canvas,
      element('p', {}, 'Touch a pixel to jump to the cycle of its write. Tiles that no visit has left yet are pale.'),
    ),
    element(
      'section',
      { 'aria-label': 'controls and figures' },
      group(
        'hardware',
        pick('stamp', 'stamp', OWN),
        pick('hiz', 'HiZ', { ...OWN, 0: 'none' }),
        pick('lines', 'lines of the cache', OWN),
        pick('queue', 'queue before the depth test', OWN),
        pick('memory', 'memory'),
        pick('unit', 'texture unit', OWN),
      ),
      group(
        'shown',
        pick('map', 'picture', { progress: 'as far as drawn', heat: 'cycles of each pixel' }),
        pick('vary', 'what if'),
      ),
      figures,
    ),
  );

  let frame = null;
  let timer = null;
  const go = (cycle) => set({ cycle: Math.max(0, Math.min(frame?.cycles ?? 0, cycle)) });
  function pause() {
    cancelAnimationFrame(timer);
    timer = null;
    play.textContent = 'run';
  }
  function start() {
    play.textContent = 'pause';
    const tick = () => {
      const next = Number(state().cycle) + Number(state().speed);
      if (next >= frame.cycles) pause();
      else timer = requestAnimationFrame(tick);
      go(next);
    };
    timer = requestAnimationFrame(tick);
  }
  const explain = (x, y) => run(`explain ${scene().name} ${x} ${y} ${scene().options} ${settings(state())}`, scene().files);

  // To the cycle in which the pixel's visible primitive was written.
  async function jump(x = Number(state().x), y = Number(state().y)) {
    if (!frame) return;
    pause();
    const [column, row] = [Math.max(0, Math.min(frame.width - 1, x)), Math.max(0, Math.min(frame.height - 1, y))];
    const written = writeOf(await explain(column, row));
    // With another memory the timeline knows: the last visit of that primitive to the pixel's tile.
    const cycle = state().memory === 'fixed' ? written?.cycle : frame.leaves(written?.name, column, row);
    set({ x: column, y: row, ...(cycle === undefined ? {} : { cycle }) });
  }
  grid.ongrab = (x, y) => {
    jump(Math.floor(x), Math.floor(y)).catch(() => set({ x: -1, y: -1 }));
    return null;
  };
  grid.onmove = (dx, dy) => set({ x: Math.max(0, Number(state().x) + dx), y: Math.max(0, Number(state().y) + dy) });
  grid.canvas.addEventListener('keydown', (event) => event.key === 'Enter' && jump());

  return {
    close: pause,
    async update(values) {
      const { name, files, options, config } = scene();
      const hardware = `${settings(values)} --memory ${values.memory}`;
      const render = `render ${name} ${options} --engine cycle ${hardware}`;
      const result = await run(`${render} --trace trace.json --heat heat.png -o picture.png`, files);
      const stages = await run(`config --config ${config} ${settings(values)} --stages`);
      if (frame?.result !== result) {
        frame = timelineOf(result, stages);
        frame.bitmap = await picture(result.made['picture.png']);
        slide.max = frame.cycles;
      }
      slide.value = values.cycle;
      const cycle = Math.min(Number(values.cycle), frame.cycles);
      back.textContent = `−${values.speed}`;
      on.textContent = `+${values.speed}`;
      now.replaceChildren(`cycle ${cycle} of `, figure(result, 'cycles'));
      drawGraph(graph, frame, cycle);
      grid.canvas.hidden = values.map === 'heat';
      if (values.map === 'heat') map.replaceChildren(image(result.made['heat.png'], 'cycles and draws of each pixel'));
      else map.replaceChildren();
      if (values.map === 'progress') drawProgress(grid, frame, cycle, values);
      figures.replaceChildren(...figuresOf(frame, cycle));
      if (values.x !== '-1' && values.y !== '-1') figures.prepend(...writeFigures(await explain(values.x, values.y), values));
      if (values.vary !== 'none') {
        const tried = await run(`${render} --what-if ${values.vary}=${VARIED[values.vary]}`, files);
        figures.prepend(...whatIf(tried));
      }
    },
  };
}

// The last write of a pixel's visible primitive: { index, packet, cycle, name }.
function writeOf({ json }) {
  const { history, final } = json.pixels[0];
  const index = history.findIndex(({ primitive }) => primitive !== null && primitive === final.model.owner);
  const packets = history[index]?.model.hardware?.packets ?? [];
  const packet = packets.findLastIndex(({ arrow }) => arrow === 'write' || arrow === 'color');
  return packet < 0
    ? null
    : { index, packet, cycle: packets[packet].cycle, name: `${history[index].kind} ${history[index].primitive}` };
}

function writeFigures(result, { x, y }) {
  const found = writeOf(result);
  const path = found && `pixels/0/history/${found.index}`;
  return [
    element('h2', {}, `pixel ${x} ${y}`),
    found
      ? list(
          ['written by', figure(result, `${path}/kind`), ' ', figure(result, `${path}/primitive`)],
          [
            'in cycle',
            figure(result, `${path}/model/hardware/packets/${found.packet}/cycle`),
            ' with a memory of fixed latency',
          ],
        )
      : element('p', {}, 'No primitive is seen there.'),
  ];
}

// Pixels of lines join the others in front of the depth test: line_raster stands by itself, at the end.
const ORDER = [
  'cull',
  'triangle_setup',
  'coarse_raster',
  'fine_raster',
  'interpolate',
  'depth_test',
  'texture_unit',
  'framebuffer',
  'memory',
  'line_raster',
];

function drawGraph(place, frame, cycle) {
  const shown = ORDER.filter(
    (stage) => (frame.byStage.get(stage)?.some(({ events }) => events.length) ?? false) || frame.result.json.stages[stage],
  );
  const isChained = (stage) => stage !== undefined && stage !== 'line_raster';
  const columns = place.clientWidth < 560 ? 2 : 4;
  const wide = 178;
  const gap = 26;
  const lineHeight = 17;
  const rows = [];
  for (let index = 0; index < shown.length; index += columns) rows.push(shown.slice(index, index + columns));
  const heightOf = (stage) => 30 + Math.max(1, Math.min(6, frame.byStage.get(stage)?.length ?? 1)) * lineHeight;
  let top = 4;
  const parts = [];
  rows.forEach((stages, rowIndex) => {
    const height = Math.max(...stages.map(heightOf));
    stages.forEach((stage, column) => {
      const left = 2 + column * (wide + gap);
      const items = (frame.byStage.get(stage) ?? []).flatMap((row) => during(row, cycle));
      const latency = frame.latency[stage];
      const isLate = items.some(({ ts }) => latency > 0 && cycle - ts >= latency);
      const group = element(
        'svg:g',
        { 'data-stage': stage },
        element('svg:rect', {
          class: `box ${items.length ? (isLate ? 'waits' : 'works') : ''}`,
          x: left,
          y: top,
          width: wide,
          height,
          rx: 5,
        }),
        element(
          'svg:text',
          { x: left + 8, y: top + 18, 'font-weight': 600 },
          stage === 'line_raster' ? 'line_raster → depth_test' : stage,
        ),
      );
      if (!frame.byStage.get(stage)?.some(({ events }) => events.length))
        group.append(element('svg:text', { x: left + 8, y: top + 18 + lineHeight }, 'not in the timeline'));
      items
        .slice(0, 6)
        .forEach(({ name, ts }, index) =>
          group.append(
            element(
              'svg:text',
              { x: left + 8, y: top + 18 + (index + 1) * lineHeight, 'data-since': ts },
              `${name.replace('triangle', 'tri')} · ${cycle - ts + 1}`,
            ),
          ),
        );
      parts.push(group);
      if (column + 1 < stages.length && isChained(stages[column + 1]))
        parts.push(
          element('svg:path', { class: 'arrow', 'marker-end': 'url(#head)', d: `M${left + wide} ${top + 16}h${gap - 3}` }),
        );
      else if (column + 1 === stages.length && isChained(rows[rowIndex + 1]?.[0]))
        parts.push(
          element('svg:path', {
            class: 'arrow',
            'marker-end': 'url(#head)',
            d: `M${left + wide / 2} ${top + height}v10H${2 + wide / 2}v9`,
          }),
        );
    });
    top += height + 24;
  });
  const svg = element(
    'svg:svg',
    {
      viewBox: `0 0 ${columns * (wide + gap) - gap + 4} ${top - 14}`,
      role: 'img',
      width: '100%',
      'aria-label': `what is in each stage in cycle ${cycle}`,
    },
    element(
      'svg:defs',
      {},
      element(
        'svg:marker',
        { id: 'head', viewBox: '0 0 8 8', refX: 6, refY: 4, markerWidth: 7, markerHeight: 7, orient: 'auto' },
        element('svg:path', { d: 'M0 0L8 4L0 8Z' }),
      ),
    ),
    parts,
  );
  place.replaceChildren(
    svg,
    element(
      'p',
      {},
      element('span', { class: 'key', style: 'background: var(--paper-works)' }, 'at work'),
      element('span', { class: 'key', style: 'background: var(--paper-waits)' }, "longer than the stage's latency: waits"),
      'The number says for how many cycles a packet is in its stage.',
    ),
  );
}

function drawProgress(grid, frame, cycle, { x, y }) {
  const { tile, width, height } = frame;
  grid.resize(width, height);
  grid.picture(frame.bitmap);
  const across = Math.ceil(width / tile);
  const left = new Uint8Array(across * Math.ceil(height / tile));
  const placeOf = ({ name }) =>
    name
      .match(/tile \((\d+), (\d+)\)/)
      ?.slice(1)
      .map(Number);
  for (const visit of frame.visits) {
    const place = visit.ts + visit.dur <= cycle && placeOf(visit);
    if (place) left[place[1] * across + place[0]] = 1;
  }
  grid.pen.globalAlpha = 0.72;
  grid.pen.fillStyle = colors.paper;
  left.forEach(
    (isLeft, index) =>
      !isLeft &&
      grid.pen.fillRect(
        (index % across) * tile * grid.cellSize,
        Math.floor(index / across) * tile * grid.cellSize,
        tile * grid.cellSize,
        tile * grid.cellSize,
      ),
  );
  grid.pen.globalAlpha = 1;
  for (const [stage, color] of [
    ['fine_raster', 'mark-first'],
    ['depth_test', 'mark-second'],
    ['memory', 'mark-double'],
  ])
    for (const event of (frame.byStage.get(stage) ?? []).flatMap((row) => during(row, cycle))) {
      const place = placeOf(event);
      if (place) grid.frame(place[0] * tile, place[1] * tile, tile, colors[color], '', 3);
    }
  if (x !== '-1' && y !== '-1') grid.drawCursor(Number(x), Number(y));
}

function figuresOf({ result, byStage }, cycle) {
  const { json } = result;
  const so = { fill: 0, evict: 0, clear: 0 };
  for (const row of byStage.get('memory') ?? [])
    for (const { name, ts } of row.events) if (ts <= cycle) so[name.split(' ')[0]] += 1;
  const stages = Object.keys(json.stages);
  return [
    element('h2', {}, 'the whole frame'),
    list(
      ['cycles', figure(result, 'cycles'), ' of them to the last write ', figure(result, 'raster_cycles')],
      ['tiles visited', figure(result, 'tiles_visited')],
      ['skipped by HiZ', figure(result, 'skipped/tiles_hiz'), ' tiles'],
      ['outside an edge', figure(result, 'skipped/tiles_outside'), ' tiles'],
      ['covered', figure(result, 'fragments/covered'), ' samples, written ', figure(result, 'fragments/written')],
      json.texture && ['texels', figure(result, 'texture/hits'), ' hits, ', figure(result, 'texture/misses'), ' misses'],
      ['limited by', figure(result, 'bottleneck')],
    ),
    table(
      ['cycles of a stage', 'packets', 'works', 'no packet', 'waits for'],
      stages.map((stage) => [
        stage,
        ...['items', 'works', 'no_item'].map((key) => figure(result, `stages/${stage}/${key}`)),
        Object.keys(json.stages[stage].waits).map((other) => [
          `${other} `,
          figure(result, `stages/${stage}/waits/${other}`),
          ' ',
        ]),
      ]),
    ),
    element('h3', {}, 'cache and memory'),
    table(
      ['bytes', 'depth', 'colour'],
      ['fill', 'evict', 'clear'].map((kind) => [
        kind,
        figure(result, `traffic_bytes/${kind}/depth`),
        figure(result, `traffic_bytes/${kind}/color`),
      ]),
    ),
    element('p', {}, `Up to this cycle the timeline has ${so.fill} fills of lines, ${so.evict} evictions, ${so.clear} clears.`),
  ];
}

function whatIf(result) {
  const most = Math.max(...result.json.what_if.map(({ cycles }) => cycles));
  return [
    element('h2', {}, 'what if'),
    table(
      [result.json.what_if[0].key, 'cycles', 'bytes', ''],
      result.json.what_if.map(({ value, cycles }, index) => [
        value,
        figure(result, `what_if/${index}/cycles`),
        figure(result, `what_if/${index}/bytes`),
        element('span', { class: 'bar', style: `width: ${(6 * cycles) / most}rem` }),
      ]),
    ),
  ];
}

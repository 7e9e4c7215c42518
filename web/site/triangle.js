// Triangles and lines on the subpixel grid: edge values at each pixel, who owns a tie, cracks and double draws.
import { button, group, select, slider } from './controls.js';
import { Grid, colors } from './grid.js';
import { element, figure, format, list, table, valueAt } from './elements.js';
import { UNCOVERED, drawLine, lineFigures, lineRuns } from './line.js';
import { choice, matching, whole } from './state.js';

const place = (start) => matching(start, /^-?\d{1,3}(\.\d{1,6})?,-?\d{1,3}(\.\d{1,6})?$/);

export const rules = {
  draw: choice('triangle', 'triangle', 'line'),
  second: choice('none', 'none', 'shared', 'junction'),
  rule: choice('top_left', 'top_left', 'offset_point', 'inclusive', 'exclusive'),
  line: choice('midpoint', 'midpoint', 'bresenham', 'diamond'),
  sub: whole(4, 0, 8),
  samples: choice('1', '1', '2', '4', '8'),
  pattern: choice('standard', 'standard', 'grid', 'diagonal'),
  tile: choice('8', '4', '8', '16'),
  stamp: choice('2', '1', '2', '4'),
  marks: choice('none', 'none', 'tiles', 'stamps', 'both'),
  edge: choice('AB', 'AB', 'BC', 'CA', 'BD', 'DC'),
  label: choice('value', 'value', 'exact', 'bits', 'none'),
  grid: choice('16x16', '8x6', '16x12', '16x16', '24x18'),
  a: place('2.3,1.2'),
  b: place('14.1,5.5'),
  c: place('4.9,11.5'),
  d: place('14.2,14'),
  x: whole(6, 0, 23),
  y: whole(3, 0, 17),
  hand: choice('pixel', 'pixel', 'a', 'b', 'c', 'd'),
};

const sizeOf = (state) => state.grid.split('x').map(Number);
const point = (text) => text.split(',').map(Number);
const PAPERS = ['first', 'second', 'third'];

// The letters of each triangle's corners in the capture's order.
function lettersOf({ second }) {
  if (second === 'shared') return ['ABC', 'CBD'];
  if (second === 'junction') return ['ABC', 'CMD', 'MBD'];
  return ['ABC'];
}

// The scene as the program reads it. M lies on the edge from B to C until it is snapped.
export function capture(state) {
  const [width, height] = sizeOf(state);
  const [b, c] = [point(state.b), point(state.c)];
  const at = {
    A: point(state.a),
    B: b,
    C: c,
    D: point(state.d),
    M: [0, 1].map((axis) => b[axis] + 0.37 * (c[axis] - b[axis])),
  };
  const colors = ['230 120 40', '60 130 210', '60 160 90'];
  const lines = [
    'halfplane 1',
    `target ${width} ${height}`,
    'clear color 255 255 255 255 depth 1',
    'space window',
    'state depth_test always',
  ];
  if (state.draw === 'line') {
    lines.push(
      `state line_rule ${state.line}`,
      `v ${at.A.join(' ')} .5 1 0 0 0 255`,
      `v ${at.B.join(' ')} .5 1 0 0 0 255`,
      'l 0 1',
    );
    return lines.join('\n') + '\n';
  }
  lettersOf(state).forEach((letters, index) => {
    for (const letter of letters) lines.push(`v ${at[letter].join(' ')} .5 1 ${colors[index]} 255`);
    lines.push(`t ${3 * index} ${3 * index + 1} ${3 * index + 2}`);
  });
  return lines.join('\n') + '\n';
}

// The places of a pixel's samples, of as many as there are: a row along the diagonal, or two columns.
function patternOf({ samples, pattern }) {
  const count = Number(samples);
  if (pattern === 'standard' || count === 1) return 'standard';
  const columns = Math.ceil(Math.sqrt(count));
  const rows = count / columns;
  const places = Array.from({ length: count }, (_, n) =>
    pattern === 'diagonal'
      ? [(n + 0.5) / count, (n + 0.5) / count]
      : [((n % 2) + 0.5) / 2, (Math.floor(n / 2) + 0.5) / (count / 2)],
  );
  return places.map(([x, y]) => `${x},${y}`).join(';');
}

export function disabled(state) {
  const off = {};
  const none = (reason, ...keys) =>
    keys.forEach((key) => {
      off[key] = reason;
    });
  if (state.draw === 'line')
    none('of triangles', 'second', 'rule', 'samples', 'pattern', 'tile', 'stamp', 'marks', 'edge', 'label');
  else none('of lines', 'line');
  if (state.draw === 'triangle' && state.samples !== '1') none('other fill rules are of pixels with one sample', 'rule');
  if (state.samples === '1') none('of several samples a pixel', 'pattern');
  if (state.marks === 'none' || state.marks === 'stamps') none('shown with the marks of tiles', 'tile');
  if (state.marks === 'none' || state.marks === 'tiles') none('shown with the marks of stamps', 'stamp');
  return off;
}

export function open(root, context) {
  const { set } = context;
  const state = () => context.values().triangle;
  const grid = new Grid(
    'The pixels, with the corners A, B, C and D. Arrow keys move the pixel or the corner that is chosen beside it.',
  );
  const panel = element('div', {});
  const legend = element('p', {});
  const names = {
    shared: 'a second triangle on edge BC',
    junction: 'two triangles with a T-junction on BC',
    none: 'none',
    a: 'corner A',
    b: 'corner B',
    c: 'corner C',
    d: 'corner D',
    value: 'value in the hardware',
    exact: 'exact, in square subpixels',
    bits: 'bits, hexadecimal',
    pixel: 'the pixel',
    triangle: 'triangles',
    line: 'a line from A to B',
  };
  const pick = (key, label) => select(key, label, rules[key].values, set, names);
  const arrows = element(
    'div',
    { class: 'controls', role: 'group', 'aria-label': 'move' },
    [
      ['←', 'left', -1, 0],
      ['↑', 'up', 0, -1],
      ['↓', 'down', 0, 1],
      ['→', 'right', 1, 0],
    ].map(([text, name, x, y]) => button(text, () => move(x, y, 1), { 'aria-label': `move ${name}`, 'data-move': name })),
  );
  root.append(
    element('section', { class: 'stage fixed', 'aria-label': 'picture' }, grid.canvas, legend),
    element(
      'section',
      { 'aria-label': 'controls and figures' },
      group('drawn', pick('draw', 'draw'), pick('second', 'beside it'), pick('grid', 'pixels')),
      group(
        'rules',
        pick('rule', 'fill rule'),
        pick('line', 'line rule'),
        slider('sub', 'subpixel bits', rules.sub, set),
        pick('samples', 'samples a pixel'),
        pick('pattern', 'their places'),
      ),
      group(
        'shown',
        pick('edge', 'edge'),
        pick('label', 'figures in the pixels'),
        pick('marks', 'marks'),
        pick('tile', 'tile'),
        pick('stamp', 'stamp'),
      ),
      group('moved', pick('hand', 'arrow keys move'), arrows),
      panel,
    ),
  );

  const bounded = (value, size) => Math.max(-size, Math.min(2 * size, value));
  function put(corner, x, y) {
    const step = 2 ** -Number(state().sub);
    const [width, height] = sizeOf(state());
    const text = [bounded(x, width), bounded(y, height)]
      .map((value) => Number((Math.round(value / step) * step).toFixed(6)))
      .join(',');
    set({ [corner]: text });
  }
  function move(dx, dy, steps) {
    const { hand, x, y, sub } = state();
    const [width, height] = sizeOf(state());
    if (hand === 'pixel') {
      set({ x: Math.max(0, Math.min(width - 1, Number(x) + dx)), y: Math.max(0, Math.min(height - 1, Number(y) + dy)) });
    } else {
      const [px, py] = point(state()[hand]);
      const step = steps * 2 ** -Number(sub);
      put(hand, px + dx * step, py + dy * step);
    }
  }
  const corners = () =>
    state().draw === 'line' ? ['a', 'b'] : state().second === 'none' ? ['a', 'b', 'c'] : ['a', 'b', 'c', 'd'];
  grid.onmove = (dx, dy, isFar) => move(dx, dy, isFar ? 2 ** Number(state().sub) : 1);
  grid.ongrab = (x, y, reach) => {
    const near = corners()
      .map((corner) => [corner, Math.hypot(point(state()[corner])[0] - x, point(state()[corner])[1] - y)])
      .sort((left, right) => left[1] - right[1])[0];
    if (near[1] < reach) return (toX, toY) => put(near[0], toX, toY);
    set({ x: Math.floor(x), y: Math.floor(y) });
    return null;
  };

  const size = () => sizeOf(state());
  return {
    async update(values) {
      const picture =
        values.draw === 'line' ? await lineRuns(context, values, capture(values)) : await triangleRuns(context, values);
      grid.figures = [];
      grid.resize(...size());
      (values.draw === 'line' ? drawLine : drawTriangles)(grid, picture, values);
      drawCorners(grid, corners(), values);
      grid.drawCursor(Number(values.x), Number(values.y));
      legend.replaceChildren(...legendOf(values).filter(Boolean));
      panel.replaceChildren(...(values.draw === 'line' ? lineFigures : triangleFigures)(picture, values));
    },
  };
}

async function triangleRuns({ run }, state) {
  const [width, height] = sizeOf(state);
  const files = (changes) => ({ 'drawn.hpt': capture({ ...state, ...changes }) });
  const subpixels = `--set subpixel.bits=${state.sub}`;
  const samples = state.samples === '1' ? '' : `--set msaa.samples=${state.samples} --set msaa.pattern=${patternOf(state)}`;
  // Another traversal draws the same picture and leaves out the hardware's packets, most of the result.
  const explain = (rule, changes = {}) =>
    run(
      `explain drawn.hpt 0 0 --box ${width}x${height} --near 1000 ${subpixels} ` +
        (state.samples === '1' ? `--traversal bbox --fill-rule ${rule}` : samples),
      files(changes),
    );
  const rule = state.samples === '1' ? state.rule : 'top_left';
  const pixels = await explain(rule);
  const reference =
    rule === 'top_left' && state.second !== 'junction'
      ? pixels
      : await explain('top_left', state.second === 'junction' ? { second: 'shared' } : {});
  const totals = await run(`render drawn.hpt --engine scalar ${subpixels} ${samples || `--fill-rule ${rule}`}`, files());
  let packets = null;
  if (state.marks !== 'none') {
    const sizes = `--set tile.size=${state.tile} --set stamp.size=${state.stamp}`;
    const vectors = await run(`vectors drawn.hpt --stage fine_raster ${sizes} ${subpixels} ${samples} -o -`, files(), false);
    packets = vectors.stdout.trim().split('\n').slice(1).map(JSON.parse);
  }
  return { pixels, reference, totals, packets };
}

// Draws of each sample of a pixel, by primitive: [[0], [0, 1], ...].
function drawsOf(pixel) {
  const draws = [];
  for (const { kind, primitive, sample = 0, model } of pixel.history) {
    draws[sample] ??= [];
    if (kind === 'triangle' && !UNCOVERED.includes(model.verdict)) draws[sample].push(primitive);
  }
  return draws;
}

function drawTriangles(grid, { pixels, reference, packets }, state) {
  const letters = lettersOf(state);
  const counts = { doubles: 0, cracks: 0 };
  pixels.json.pixels.forEach((pixel, index) => {
    const { x, y } = pixel;
    const draws = drawsOf(pixel);
    const others = drawsOf(reference.json.pixels[index]);
    draws.forEach((drawn) => drawn.length && grid.cell(x, y, colors[`paper-${PAPERS[drawn.at(-1)]}`], 1 / draws.length));
    const isDouble = draws.some((drawn, sample) => drawn.length > Math.max(1, others[sample].length));
    const isCrack = draws.some((drawn, sample) => drawn.length === 0 && others[sample].length > 0);
    draws.forEach((drawn, sample) => {
      counts.doubles += Math.max(0, drawn.length - Math.max(1, others[sample].length));
      counts.cracks += drawn.length === 0 && others[sample].length > 0;
    });
    if (isDouble) grid.cell(x, y, colors['paper-double']);
    if (isCrack) grid.cell(x, y, colors['paper-crack']);
  });
  grid.lines();
  if (packets) drawPackets(grid, packets, state);
  for (const [pixelIndex, pixel] of pixels.json.pixels.entries()) {
    for (const [index, event] of pixel.history.entries()) {
      if (event.kind !== 'triangle' || (event.sample ?? 0) !== 0 || state.label === 'none') continue;
      const edge = (event.model.edges ?? []).findIndex(({ from, to }) => {
        const pair = letters[event.primitive][from] + letters[event.primitive][to];
        return pair === state.edge || pair === state.edge[1] + state.edge[0];
      });
      // A shared edge is shown as the first triangle has it.
      if (edge < 0 || (event.primitive > 0 && !state.edge.includes('D'))) continue;
      const path = `pixels/${pixelIndex}/history/${index}/model/edges/${edge}/${state.label}`;
      const { tie, owns_ties } = event.model.edges[edge];
      grid.text(
        pixel.x,
        pixel.y,
        format(valueAt(pixels.json, path)).replace('0x', ''),
        tie && colors[owns_ties ? 'mark-third' : 'mark-crack'],
        { path, result: pixels },
      );
    }
  }
  for (const pixel of pixels.json.pixels) {
    const places = pixel.samples ?? [{ x_pixels: 0.5, y_pixels: 0.5 }];
    drawsOf(pixel).forEach((drawn, sample) =>
      grid.dot(pixel.x + places[sample].x_pixels, pixel.y + places[sample].y_pixels, drawn.length > 0),
    );
  }
  const first = pixels.json.pixels[0].history.filter(({ kind, sample }) => kind === 'triangle' && !sample);
  for (const { primitive, model, golden } of first) {
    const mark = colors[`mark-${PAPERS[primitive]}`];
    if (golden?.corners)
      grid.outline(
        golden.corners.map((corner) => [corner.x_pixels, corner.y_pixels]),
        mark,
        true,
      );
    if (model.corners.length)
      grid.outline(
        model.corners.map((corner) => [corner.x_pixels, corner.y_pixels]),
        mark,
        false,
      );
  }
  grid.canvas.dataset.doubles = counts.doubles;
  grid.canvas.dataset.cracks = counts.cracks;
}

function drawPackets(grid, packets, state) {
  const tile = Number(state.tile);
  const stamp = Number(state.stamp);
  const across = tile / stamp;
  const code = (text) => parseInt(text, 16);
  for (const packet of packets) {
    const [x, y] = [code(packet.tile_x) * tile, code(packet.tile_y) * tile];
    if (packet.packet === 'tile' && code(packet.is_visit) && state.marks !== 'stamps')
      grid.frame(x, y, tile, colors['mark-line'], code(packet.is_inside) ? 'inside' : 'cut', 3);
    if (packet.packet === 'stamp' && BigInt(packet.mask) > 0n && state.marks !== 'tiles') {
      const number = code(packet.stamp);
      grid.frame(x + (number % across) * stamp, y + Math.floor(number / across) * stamp, stamp, colors.ink, '', 1.5);
    }
  }
}

function drawCorners(grid, names, state) {
  for (const name of names) grid.handle(...point(state[name]), name.toUpperCase(), state.hand === name);
}

function legendOf(state) {
  const key = (paper, text) => element('span', { class: 'key', style: `background: var(--paper-${paper})` }, text);
  if (state.draw === 'line') return [key('first', 'pixels of the line')];
  return [
    key('first', 'ABC'),
    ...(state.second === 'none'
      ? []
      : [
          key('second', 'beside it'),
          state.second === 'junction' ? key('third', 'third triangle') : null,
          key('double', 'drawn twice'),
          key('crack', 'drawn by neither'),
        ]),
    'Solid: edges after the snap; dashed: before. Framed figures: the sample lies exactly on the edge, which owns it (green) or does not (red: the value is 0 less the bias, −1).',
  ];
}

function triangleFigures({ pixels, totals }, state) {
  const width = sizeOf(state)[0];
  const index = Number(state.y) * width + Number(state.x);
  const pixel = pixels.json.pixels[index];
  if (!pixel) return [element('p', {}, 'This pixel lies outside of the picture.')];
  const letters = lettersOf(state);
  const parts = [element('h2', {}, `pixel ${pixel.x} ${pixel.y}`)];
  const at = (number, path) => figure(pixels, `pixels/${index}/history/${number}/${path}`);
  const events = pixel.history.map((event, number) => ({ ...event, number })).filter(({ kind }) => kind === 'triangle');
  for (const { primitive, number, model, sample } of events.filter(({ sample }) => !sample)) {
    const names = letters[primitive];
    const nameOf = ({ from, to }) => `${names[from]}→${names[to]}`;
    parts.push(element('h3', {}, names, sample === undefined ? [': ', at(number, 'why')] : ''));
    if (model.edges && sample === undefined) {
      parts.push(
        table(
          ['edge', 'side', 'owns ties', 'on it', 'value', 'bits', 'exact, square subpixels'],
          model.edges.map((edge, place) => [
            nameOf(edge),
            ...['side', 'owns_ties', 'tie', 'value', 'bits', 'exact'].map((key) => at(number, `model/edges/${place}/${key}`)),
          ]),
        ),
      );
    } else if (model.edges) {
      parts.push(
        table(
          ['sample', ...model.edges.map(nameOf), 'result'],
          events
            .filter((event) => event.primitive === primitive)
            .map((event) => [
              String(event.sample),
              ...model.edges.map((_, place) => at(event.number, `model/edges/${place}/value`)),
              at(event.number, 'verdict'),
            ]),
        ),
      );
    }
    if (model.area) parts.push(list(['area, twice', at(number, 'model/area/value'), ' square subpixels']));
  }
  parts.push(
    element('h3', {}, 'in the whole picture'),
    list(
      state.second !== 'junction' && [
        'drawn twice',
        figure(totals, 'double_draws'),
        ' samples, which top_left draws once',
      ],
      state.second !== 'junction' && ['not drawn', figure(totals, 'undrawn_samples'), ' samples that top_left draws'],
      ['covered', figure(totals, 'fragments/covered'), ' samples, once for each triangle'],
    ),
  );
  if (state.second === 'junction')
    parts.push(
      element('p', {}, 'M lies on edge BC until it is snapped. Lit pixels differ from those of two triangles without M.'),
    );
  return parts;
}

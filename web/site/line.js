// A line of the triangle view: its pixels, and the decision at each of them by all rules and textbooks.
import { colors } from './grid.js';
import { element, figure, format, list, table, valueAt } from './elements.js';

// Verdicts of `explain` on primitives that do not reach a sample of the pixel.
export const UNCOVERED = [
  'uncovered',
  'frustum',
  'zero_area',
  'backface',
  'empty',
  'no_sample',
  'scissor',
  'tiles_outside',
  'tiles_hiz',
];

export async function lineRuns({ run }, state, capture) {
  const files = { 'drawn.hpt': capture };
  const explain = (more) => run(`explain drawn.hpt 0 0 --near 1000 --set subpixel.bits=${state.sub} ${more}`, files);
  return { pixels: await explain(`--box ${state.grid} --traversal bbox`), steps: await explain('--steps') };
}

const lineOf = (pixel) => pixel.history.findIndex(({ kind }) => kind === 'line');

export function drawLine(grid, { pixels, steps }, state) {
  const line = lineOf(steps.json.pixels[0]);
  const registers = `pixels/0/history/${line}/model/line/registers/${state.line}`;
  for (const pixel of pixels.json.pixels)
    if (pixel.history.some(({ kind, model }) => kind === 'line' && !UNCOVERED.includes(model.verdict)))
      grid.cell(pixel.x, pixel.y, colors['paper-first']);
  grid.lines();
  if (line < 0) return;
  for (const [index, { x, y, error }] of (valueAt(steps.json, registers) ?? []).entries()) {
    grid.text(x, y, format(error), null, { path: `${registers}/${index}/error`, result: steps });
  }
  const { model, golden } = steps.json.pixels[0].history[line];
  if (golden?.corners)
    grid.outline(
      golden.corners.map((corner) => [corner.x_pixels, corner.y_pixels]),
      colors['mark-first'],
      true,
    );
  grid.outline(
    model.corners.map((corner) => [corner.x_pixels, corner.y_pixels]),
    colors['mark-first'],
    false,
  );
}

export function lineFigures({ steps }, state) {
  const line = lineOf(steps.json.pixels[0]);
  const path = `pixels/0/history/${line}/model/line`;
  const found = valueAt(steps.json, path);
  if (!found) return [element('p', {}, 'The line draws no pixel.')];
  const columns = [
    ['textbook', 'midpoint'],
    ['textbook', 'bresenham'],
    ['registers', 'midpoint'],
    ['registers', 'bresenham'],
    ['registers', 'diamond'],
  ];
  const longest = Math.max(...columns.map(([kind, rule]) => found[kind]?.[rule]?.length ?? 0));
  const cell = (kind, rule, index) => {
    const step = found[kind]?.[rule]?.[index];
    if (!step) return '';
    const at = `${path}/${kind}/${rule}/${index}`;
    return [
      figure(steps, `${at}/x`),
      ' ',
      figure(steps, `${at}/y`),
      ': ',
      figure(steps, `${at}/error`),
      ' ',
      figure(steps, `${at}/decision`),
    ];
  };
  const isChosen = (index) =>
    columns.some(
      ([kind, rule]) => found[kind]?.[rule]?.[index]?.x === Number(state.x) && found[kind][rule][index].y === Number(state.y),
    );
  return [
    element('h2', {}, 'the decision at each pixel'),
    list(
      ['major axis', figure(steps, `${path}/major_axis`)],
      ['D, d', figure(steps, `${path}/major`), ', ', figure(steps, `${path}/minor`), ' subpixels'],
    ),
    table(
      ['step', 'book: 2F', 'book: p', 'midpoint', 'bresenham', 'diamond'],
      Array.from({ length: longest }, (_, index) => [
        `${index}${isChosen(index) ? ' ◂' : ''}`,
        ...columns.map(([kind, rule]) => cell(kind, rule, index)),
      ]),
    ),
  ];
}

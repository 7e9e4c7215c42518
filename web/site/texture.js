// A floor in perspective: affine coordinates, level of detail, weights of the filter, misses of the cache.
import { group, picker, slider } from './controls.js';
import { Grid } from './grid.js';
import { element, figure, image, list, picture } from './elements.js';
import { texels } from './pixel.js';
import { choice, real, whole } from './state.js';

const FILTERS = {
  nearest: ['nearest', 'nearest', 'nearest'],
  linear: ['linear', 'linear', 'bilinear'],
  mipmap: ['linear_mipmap_nearest', 'linear', 'trilinear'],
  trilinear: ['linear_mipmap_linear', 'linear', 'trilinear'],
};

export const rules = {
  interpolation: choice('perspective', 'perspective', 'affine'),
  filter: choice('trilinear', ...Object.keys(FILTERS)),
  bias: whole(0, -4, 4),
  pattern: choice('grid', 'grid', 'chequer', 'gradient'),
  repeats: choice('10', '1', '2', '5', '10', '20'),
  far: real(20, 1.5, 200),
  kb: choice('4', '1', '2', '4', '16', '64'),
  ways: choice('1', '1', '2'),
  memory: choice('fixed', 'fixed', 'sram', 'sdram', 'psram', 'ddr3'),
  beside: choice('perspective', 'perspective', 'misses', 'error'),
  x: whole(120, 0, 239),
  y: whole(100, 0, 149),
};

// A floor of two triangles from w = 1.3 to `far`, as docs/texture/floor.hpt has it.
export function floor({ interpolation, filter, bias, pattern, repeats, far }) {
  const [min, mag] = FILTERS[filter];
  const [near, end] = [1.3, Number(far)];
  const z = (w) => ((400.5 * w - 400) / 399.5).toFixed(6); // clip space, near 0.5, far 400
  const y = (w) => (0.75 * w - 2.2).toFixed(4); // the eye 2.2 above the floor
  return `halfplane 1
target 240 150
planes 0.5 400
texture floor pattern ${pattern} 128 128 mips box_linear
clear color 30 34 48 255 depth 1
space clip
state texture floor
state texture_interp ${interpolation}
state texture_min ${min}
state texture_mag ${mag}
state texture_lod ${bias} 0 12
v -1.375 ${y(near)} ${z(near)} ${near} 255 255 255 255 0 ${repeats}
v 1.375 ${y(near)} ${z(near)} ${near} 255 255 255 255 1 ${repeats}
v 1.375 ${y(end)} ${z(end)} ${end} 255 255 255 255 1 0
v -1.375 ${y(end)} ${z(end)} ${end} 255 255 255 255 0 0
t 0 1 2 0 2 3
`;
}

export function open(root, context) {
  const { set, run } = context;
  const pick = picker(rules, set);
  const grid = new Grid('The floor. Arrow keys move the pixel whose texels are shown.');
  const other = element('figure', {});
  const panel = element('div', {});
  const totals = element('div', {});
  root.append(
    element(
      'section',
      { class: 'stage', 'aria-label': 'pictures' },
      grid.canvas,
      element('p', {}, 'Touch a pixel for its texels.'),
      other,
    ),
    element(
      'section',
      { 'aria-label': 'controls and figures' },
      group(
        'floor',
        pick('pattern', 'texture'),
        pick('repeats', 'images along it'),
        slider('far', 'w at its far end', { least: 1.5, most: 200, step: 0.5 }, set),
      ),
      group(
        'coordinates',
        pick('interpolation', 'interpolation', { perspective: 'over w', affine: 'affine' }),
        pick('filter', 'filter', { mipmap: 'linear, nearest level', trilinear: 'linear, between levels' }),
        slider('bias', 'level bias', rules.bias, set),
      ),
      group('cache', pick('kb', 'kilobytes'), pick('ways', 'places of a block'), pick('memory', 'memory')),
      group(
        'below',
        pick('beside', 'shown below', {
          perspective: 'golden, over w',
          misses: 'misses of the cache',
          error: 'error of the coordinate',
        }),
      ),
      panel,
      totals,
    ),
  );
  const move = (x, y) => set({ x: Math.max(0, Math.min(239, Math.floor(x))), y: Math.max(0, Math.min(149, Math.floor(y))) });
  grid.ongrab = (x, y) => {
    move(x, y);
    return move;
  };
  grid.onmove = (dx, dy, isFar) => {
    const { x, y } = context.values().texture;
    move(Number(x) + dx * (isFar ? 8 : 1), Number(y) + dy * (isFar ? 8 : 1));
  };

  return {
    async update(state) {
      const files = { 'floor.hpt': floor(state) };
      const drawn = await run('render floor.hpt -o picture.png', files);
      const bitmap = await picture(drawn.made['picture.png']);
      grid.resize(drawn.json.width, drawn.json.height);
      grid.picture(bitmap);
      grid.drawCursor(Number(state.x), Number(state.y));
      const unit = `--set texture.unit=${FILTERS[state.filter][2]}`;
      const result = await run(
        `explain floor.hpt ${state.x} ${state.y} ${state.interpolation === 'affine' ? '' : unit}`,
        files,
      );
      const index = result.json.pixels[0].history.findIndex(({ model, verdict }) => model.surface && verdict === 'written');
      panel.replaceChildren(
        element('h2', {}, `pixel ${state.x} ${state.y}`),
        index < 0
          ? element('p', {}, 'The floor does not cover it.')
          : texels(result, `pixels/0/history/${index}/model/surface`),
      );
      const cache = `--set texture.cache_kb=${state.kb} --set texture.ways=${state.ways} --memory ${state.memory}`;
      const cached = await run(`render floor.hpt --engine cycle ${unit} ${cache} --misses misses.png`, files);
      totals.replaceChildren(
        element('h2', {}, 'the texture cache, whole frame'),
        list(
          ['samples', figure(cached, 'texture/samples')],
          ['hits', figure(cached, 'texture/hits')],
          ['misses', figure(cached, 'texture/misses')],
          ['bytes read', figure(cached, 'texture/bytes')],
          ['cycles', figure(cached, 'cycles')],
          ['limited by', figure(cached, 'bottleneck')],
        ),
      );
      if (state.beside === 'misses') {
        other.replaceChildren(image(cached.made['misses.png'], 'lines of texels that each pixel asked memory for'));
      } else {
        const panelName =
          state.interpolation === 'affine' && state.beside === 'error'
            ? 'affine_coordinate'
            : state.beside === 'error'
              ? 'coordinate'
              : 'perspective';
        const compared = await run(`compare floor.hpt --panels ${panelName} -o compared.png`, files);
        other.replaceChildren(image(compared.made['compared.png'], panelName));
      }
    },
  };
}

// Affine coordinates of a floor need no divider, and the texture unit draws them too; two places need a unit with banks.
export function disabled(state) {
  return state.filter === 'nearest' ? { ways: 'the unit of nearest texels has one place for a block' } : {};
}

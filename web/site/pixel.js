// Why the pixel under the pointer is what it is: model, golden, oracle.
import { group, picker } from './controls.js';
import { Grid } from './grid.js';
import { element, figure, format, image, list, picture, table, valueAt } from './elements.js';
import { latest } from './program.js';
import { choice, whole } from './state.js';

export const rules = {
  image: choice('model', 'model', 'golden'),
  passing: choice('off', 'off', 'on'),
  packets: choice('off', 'off', 'on'),
  x: whole(160, 0, 4095),
  y: whole(120, 0, 4095),
};
export const showsScene = true;

const PASSES_BY = ['uncovered', 'frustum', 'zero_area', 'backface', 'empty', 'no_sample', 'scissor', 'tiles_outside'];

export function open(root, context) {
  const { set, run } = context;
  const grid = new Grid('The picture. Arrow keys move the pixel that is explained, with shift by eight.');
  const near = element('div', {});
  const panel = element('div', { 'aria-live': 'off' });
  const pick = picker(rules, set);
  root.append(
    element(
      'section',
      { class: 'stage', 'aria-label': 'picture' },
      grid.canvas,
      element('p', {}, 'Point at a pixel; click or touch holds it.'),
      near,
    ),
    element(
      'section',
      { 'aria-label': 'figures' },
      group(
        'shown',
        pick('image', 'picture'),
        pick('passing', 'primitives that pass by', { on: 'listed', off: 'left out' }),
        pick('packets', 'packets', { on: 'every field', off: 'names and cycles' }),
      ),
      panel,
    ),
  );

  let size = [1, 1];
  let bitmap = null;
  const inside = (value, most) => Math.max(0, Math.min(most - 1, Math.floor(value)));
  const place = (x, y) => set({ x: inside(x, size[0]), y: inside(y, size[1]) });
  grid.onmove = (dx, dy, isFar) =>
    place(Number(context.values().pixel.x) + dx * (isFar ? 8 : 1), Number(context.values().pixel.y) + dy * (isFar ? 8 : 1));
  grid.ongrab = (x, y) => {
    isHeld = true;
    place(x, y);
    return place;
  };
  let isHeld = false;
  const hover = latest(async (x, y) => {
    place(x, y);
    await new Promise(requestAnimationFrame);
  });
  grid.canvas.addEventListener(
    'pointermove',
    (event) => event.pointerType === 'mouse' && !isHeld && hover(...grid.placeOf(event)),
  );
  grid.canvas.addEventListener('pointerleave', () => {
    isHeld = false;
  });

  return {
    async update(state) {
      const scene = context.scene();
      const engine = state.image === 'golden' ? 'golden' : 'functional';
      const drawn = await run(`render ${scene.name} ${scene.options} --engine ${engine} -o picture.png`, scene.files);
      size = [drawn.json.width, drawn.json.height];
      bitmap = await picture(drawn.made['picture.png']);
      const [x, y] = [inside(Number(state.x), size[0]), inside(Number(state.y), size[1])];
      const draw = () => {
        grid.resize(...size);
        grid.picture(bitmap);
        grid.drawCursor(x, y);
      };
      draw();
      const result = await run(`explain ${scene.name} ${x} ${y} ${scene.options} -o pixel.png`, scene.files);
      panel.replaceChildren(...explained(result, state));
      near.replaceChildren(
        element(
          'figure',
          {},
          image(result.made['pixel.png'], `pixel ${x} ${y} and the pixels around it, with edges and samples`),
          element(
            'figcaption',
            {},
            'Around the pixel: lines are edges after the snap, dotted before; a square names the primitive that covers a sample.',
          ),
        ),
      );
    },
  };
}

// Everything that `explain` says of its first pixel.
export function explained(result, state) {
  const path = 'pixels/0';
  const pixel = result.json.pixels[0];
  const at = (where) => figure(result, `${path}/${where}`);
  const parts = [
    element('h2', {}, `pixel ${pixel.x} ${pixel.y}`),
    table(
      ['', 'depth', 'colour', 'primitive'],
      ['model', 'golden', 'hardware']
        .filter((who) => pixel.final[who])
        .map((who) => [
          who,
          at(`final/${who}/depth`),
          at(`final/${who}/color`),
          who === 'hardware' ? '' : at(`final/${who}/owner`),
        ]),
    ),
  ];
  const events = pixel.history
    .map((event, index) => [event, index])
    .filter(([event]) => state.passing === 'on' || !PASSES_BY.includes(event.verdict));
  events.forEach(([event, index]) =>
    parts.push(
      eventOf(
        result,
        event,
        `history/${index}`,
        state,
        event.primitive !== null && event.primitive === pixel.final.model.owner,
      ),
    ),
  );
  if (!result.json.hardware.has_scene)
    parts.push(element('p', {}, 'no record of the hardware: ', figure(result, 'hardware/why_not')));
  const { length } = result.json.differences;
  parts.push(
    element(
      'p',
      {},
      figure(result, 'checks'),
      ` figures of model, golden, oracle and hardware compared with each other: ${length ? `${length} differ` : 'all agree'}.`,
    ),
  );
  return parts;
}

function eventOf(result, event, where, state, isOpen) {
  const { model, oracle, golden, parts } = event;
  const at = (path) => figure(result, `pixels/0/${where}/${path}`);
  const name = event.primitive === null ? event.kind : `${event.kind} ${event.primitive}`;
  const inner = [];
  if (golden || oracle)
    inner.push(
      list(
        ['model', at('model/verdict')],
        oracle && ['oracle covers', at('oracle/covers')],
        golden && ['golden', at('golden/verdict')],
      ),
    );
  if (model.edges?.length)
    inner.push(
      table(
        ['edge', 'side', 'value', 'bits', 'square pixels', 'on it', 'owns ties'],
        model.edges.map(({ from, to }, index) => [
          `${from}→${to}`,
          ...['side', 'value', 'bits', 'real', 'tie', 'owns_ties'].map((key) => at(`model/edges/${index}/${key}`)),
        ]),
      ),
    );
  if (model.planes)
    inner.push(
      table(
        ['', 'before rounding', 'code', 'bits', 'oracle, exact', 'error', 'snap', 'interpolation', 'storage'],
        Object.keys(model.planes).map((plane) => [
          plane,
          at(`model/planes/${plane}/real`),
          at(`model/planes/${plane}/code`),
          at(`model/planes/${plane}/bits`),
          at(`oracle/planes/${plane}/real`),
          ...['total', 'snap', 'interpolation', 'storage'].map((part) => at(`parts/${plane}/${part}`)),
        ]),
      ),
    );
  if (golden?.depth !== undefined)
    inner.push(list(['golden depth', at('golden/depth')], ['golden colour', at('golden/color')]));
  if (model.surface) inner.push(texels(result, `pixels/0/${where}/model/surface`));
  if (model.operations?.length)
    inner.push(
      element(
        'ul',
        {},
        model.operations.map((operation, index) =>
          element(
            'li',
            {},
            at(`model/operations/${index}/operation`),
            ' in ',
            at(`model/operations/${index}/stage`),
            ': ',
            Object.keys(operation)
              .filter((key) => key !== 'operation' && key !== 'stage')
              .map((key) => [`${key} `, at(`model/operations/${index}/${key}`), '  ']),
          ),
        ),
      ),
    );
  const hiz = model.hardware?.hiz;
  if (hiz) inner.push(list(...Object.keys(hiz).map((key) => [`HiZ, ${key}`, at(`model/hardware/hiz/${key}`)])));
  const packets = model.hardware?.packets ?? [];
  if (packets.length)
    inner.push(
      table(
        ['packet', 'number', 'cycle', ...(state.packets === 'on' ? ['fields'] : [])],
        packets.map((packet, index) => [
          packet.arrow,
          at(`model/hardware/packets/${index}/number`),
          at(`model/hardware/packets/${index}/cycle`),
          ...(state.packets === 'on'
            ? [Object.keys(packet.fields).map((key) => [`${key} `, at(`model/hardware/packets/${index}/fields/${key}`), ' '])]
            : []),
        ]),
      ),
    );
  return element(
    'details',
    { class: `event ${event.verdict}`, open: isOpen },
    element('summary', {}, element('b', {}, name), ': ', at('verdict'), ', ', at('why')),
    inner,
  );
}

// The texels of a filter and their weights, of a `surface` of explain: a square is as large as its weight.
export function texels(result, path) {
  const surface = valueAt(result.json, path);
  const at = (key) => figure(result, `${path}/${key}`);
  const color = (texel) => `rgb(${texel.color.slice(0, 3)})`;
  const heaviest = Math.max(...surface.texels.map(({ weight }) => weight));
  const levels = [...new Set(surface.texels.map(({ level }) => level))];
  return element(
    'div',
    {},
    list(
      ['texture', at('texture')],
      ['at, texels', at('coordinate')],
      ['level of detail', at('level_of_detail')],
      ['filter', at('filter')],
      ['between levels', at('between_levels')],
    ),
    element(
      'div',
      { class: 'controls' },
      levels.map((level) => {
        const shown = surface.texels.filter((texel) => texel.level === level);
        return element(
          'figure',
          {},
          element(
            'div',
            { class: 'weights', style: `grid-template-columns: repeat(${Math.ceil(Math.sqrt(shown.length))}, 3rem)` },
            shown.map((texel) =>
              element(
                'div',
                {},
                element('span', { style: `background: ${color(texel)}; width: ${3 * Math.sqrt(texel.weight / heaviest)}rem` }),
              ),
            ),
          ),
          element('figcaption', {}, `level ${level}`),
        );
      }),
    ),
    table(
      ['level', 'texel', 'weight', 'colour', 'byte'],
      surface.texels.map((texel, index) => [
        format(texel.level),
        [at(`texels/${index}/x`), ' ', at(`texels/${index}/y`)],
        at(`texels/${index}/weight`),
        [element('span', { class: 'key', style: `background: ${color(texel)}` }, ' '), at(`texels/${index}/color`)],
        at(`texels/${index}/address`),
      ]),
    ),
  );
}

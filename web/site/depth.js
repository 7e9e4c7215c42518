// How far apart surfaces must be: the exact bins of a depth buffer beside the textbook's step, and fights on a scene.
import { group, picker, powerSlider, slider } from './controls.js';
import { colors } from './grid.js';
import { element, figure, image, list, table } from './elements.js';
import { choice, real, whole } from './state.js';

export const rules = {
  near: real(1, 0.001, 100),
  far: real(1000, 10, 1000000),
  mapping: choice('std', 'std', 'rev', 'stdinf', 'revinf', 'w', 'log'),
  format: choice('u', 'u', 'bins', 'uf3', 'uf4', 'uf5'),
  bits: whole(16, 8, 32),
  z: real(100, 0.001, 1000000),
  slope: choice('0', '0', '0.5', '1', '2'),
  rate: choice('1', '0.1', '1', '5', '10'),
  planes: choice('scene', 'scene', 'above'),
};
export const showsScene = true;

const formatOf = ({ format, bits }) =>
  format.startsWith('uf') ? `${format}.${Number(bits) - Number(format[2])}` : `${format}${bits}`;

export function open(root, { set, run, scene }) {
  const pick = picker(rules, set);
  const chart = element('div', {
    class: 'chart',
    role: 'img',
    'aria-label': 'length of a bin over distance: exact, and the first-order formula of textbooks',
  });
  const fights = element('div', {});
  const bins = element('div', {});
  const answers = element('div', {});
  root.append(
    element(
      'section',
      { class: 'stage', 'aria-label': 'charts and pictures' },
      element('h2', {}, 'how long a step of depth is'),
      chart,
      bins,
      element('h2', {}, 'surfaces that fight'),
      fights,
    ),
    element(
      'section',
      { 'aria-label': 'controls and figures' },
      group('planes', powerSlider('near', 'near', rules.near, set), powerSlider('far', 'far', rules.far, set)),
      group(
        'buffer',
        pick('mapping', 'mapping'),
        pick('format', 'format', {
          u: 'u, unsigned',
          bins: 'bins',
          uf3: 'float, 3 bits of exponent',
          uf4: 'float, 4 bits',
          uf5: 'float, 5 bits',
        }),
        slider('bits', 'bits', rules.bits, set),
      ),
      group('surfaces', powerSlider('z', 'distance z', rules.z, set), pick('slope', 'slope of two surfaces')),
      group(
        'on the scene',
        pick('planes', 'near and far', { scene: "the scene's", above: 'those above' }),
        pick('rate', 'fights allowed, percent'),
      ),
      answers,
    ),
  );

  return {
    async update(state) {
      const { name, files, view, config } = scene();
      const buffer = `--mapping ${state.mapping} --format ${formatOf(state)} --config ${config}`;
      const planes = `--near ${state.near} --far ${state.far}`;
      const theory = await run(`depth ${planes} --z ${state.z} --slope ${state.slope} ${buffer}`);
      bins.replaceChildren(...binsOf(theory, state));
      await drawChart(chart, theory, null);
      const measured = await run(
        `depth --scene ${name} ${view} ${state.planes === 'above' ? planes : ''} --fight-rate ${state.rate}% --fights fights.png ${buffer}`,
        files,
      );
      fights.replaceChildren(
        element(
          'figure',
          {},
          image(measured.made['fights.png'], 'where surfaces of the scene fight'),
          element('figcaption', {}, 'Yellow: two surfaces have the same code; red: the farther one is stored as the nearer.'),
        ),
      );
      answers.replaceChildren(...answersOf(measured));
      const [near, far] = [Number(state.near), Number(state.far)];
      const depths = [1, 2, 3, 4, 5, 6].map((step) => Number((near * (far / near) ** (step / 7)).toPrecision(2)));
      const apart = await run(`depth ${planes} --z ${depths.join(',')} --slope ${state.slope} ${buffer}`);
      await drawChart(chart, theory, apart);
    },
  };
}

// The row of a metric at the depth that was asked for.
function metric(result, name) {
  const index = result.json.rows.findIndex((row) => row.metric === name && row.z !== '');
  return index < 0 ? '–' : figure(result, `rows/${index}/value`);
}

function binsOf(result) {
  return [
    table(
      ['at z', 'result'],
      [
        ['code', metric(result, 'code')],
        ['length of the bin, exact', metric(result, 'bin_width')],
        ['Δz by the textbook, first order', metric(result, 'first_order')],
        ['largest error of a depth', metric(result, 'max_recon_err')],
        ['two surfaces must be apart by', metric(result, 'separation')],
        ['– share of storage', metric(result, 'separation_storage')],
        ['– share of the datapath', metric(result, 'separation_datapath')],
        ['– share of the snap of vertices', metric(result, 'separation_snap')],
        ['pairs of fragments tried at that distance', metric(result, 'pairs_tried')],
        ['– in the wrong order or tied', metric(result, 'fights_at_separation')],
        ['part that fights at half that distance', metric(result, 'fights_at_half')],
      ],
    ),
    element('p', {}, 'extra hardware: ', figure(result, 'series/0/hardware')),
  ];
}

function answersOf(result) {
  const measured = result.json.series[0].measured;
  const bits = result.json.fewest_bits;
  const parts = [element('h2', {}, 'bits')];
  if (bits?.length)
    parts.push(
      ...bits.map((_, index) =>
        element(
          'p',
          { class: 'answer' },
          'You need ',
          figure(result, `fewest_bits/${index}/bits`),
          ' bits of ',
          figure(result, `fewest_bits/${index}/mapping`),
          ' for as few fights as are allowed.',
        ),
      ),
    );
  if (measured) {
    parts.push(
      list(
        ['fragments', figure(result, 'series/0/measured/fragments')],
        ['overlapping pairs', figure(result, 'series/0/measured/pairs')],
        ['same code', figure(result, 'series/0/measured/ties')],
        ['wrong order', figure(result, 'series/0/measured/inversions')],
        ['part that fights', figure(result, 'series/0/measured/rate')],
        ['nearest fight at', figure(result, 'series/0/measured/nearest_fight')],
      ),
    );
    parts.push(
      table(
        ['error of the eye depth', 'rms', 'largest'],
        Object.keys(measured.parts).map((part) => [
          part,
          figure(result, `series/0/measured/parts/${part}/rms`),
          figure(result, `series/0/measured/parts/${part}/max`),
        ]),
      ),
    );
  }
  parts.push(...result.json.answers.map((_, index) => element('p', {}, figure(result, `answers/${index}`))));
  return parts;
}

let charts = null; // uPlot, when it is first needed
async function drawChart(place, result, apart) {
  charts ??= (await import('./vendor/uPlot.esm.js')).default;
  const { curve, name } = result.json.series[0];
  const separations = (apart?.json.rows ?? []).filter(({ metric }) => metric === 'separation');
  const width = Math.max(280, place.clientWidth);
  const powers = (self, splits) =>
    splits.map((value) => {
      const power = Math.log10(value);
      return Math.abs(power - Math.round(power)) < 1e-9 ? String(Number(value.toPrecision(3))) : '';
    });
  const axis = (label) => ({
    label,
    stroke: colors.ink,
    grid: { stroke: colors['paper-panel'] },
    values: powers,
    font: '14px system-ui, sans-serif',
    labelFont: '14px system-ui, sans-serif',
    size: label.startsWith('length') ? 76 : 44,
  });
  const line = (label, stroke, dash) => ({
    label,
    stroke,
    width: 2.5,
    dash,
    points: { show: false },
    value: (self, value) => (value ? value.toPrecision(4) : '–'),
  });
  place.replaceChildren();
  place.chart = new charts(
    {
      width,
      height: 320,
      scales: { x: { time: false, distr: 3 }, y: { distr: 3 } },
      axes: [axis('distance from the eye'), axis('length, in units of distance')],
      series: [
        { label: 'z', value: (self, value) => (value ? value.toPrecision(4) : '–') },
        line(`bin of ${name}, exact`, colors['mark-second']),
        line('textbook, first order', colors['mark-first'], [8, 5]),
        {
          ...line('surfaces must be apart by', colors['mark-double'], [2, 4]),
          points: { show: true, size: 9 },
          spanGaps: true,
        },
      ],
    },
    charts.join([
      [curve.z, curve.bin_width, curve.first_order],
      [separations.map(({ z }) => Number(z)), separations.map(({ value }) => value)],
    ]),
    place,
  );
  Object.assign(place.dataset, { command: result.command, path: 'series/0/curve', apart: apart?.command });
}

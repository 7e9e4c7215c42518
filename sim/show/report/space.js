// Design space
const POINTS = D.points || [], SCENES = distinct(POINTS.map(p => p.scene));
const KEYS = distinct(POINTS.flatMap(p => Object.keys(p.settings)))
  .filter(k => distinct(POINTS.map(p => p.settings[k])).length > 1);
const FIGURES = [['coverage_rms', 'coverage error, rms', 'parts of a pixel'],
  ['coverage_max', 'coverage error, max', 'parts of a pixel'], ['functional_ms', 'functional engine, ms a frame', 'ms'],
  ['depth_eye_rms', 'depth error, rms', 'scene units'], ['depth_eye_max', 'depth error, max', 'scene units'],
  ['depth_lsb_rms', 'depth error, rms', 'LSB of its own depth.bits'], ['depth_lsb_max', 'depth error, max', 'LSB of its own depth.bits'],
  ['depth_range_rms', 'depth error, rms', 'depth range'], ['color_lsb_rms', 'colour error, rms', 'LSB'],
  ['color_lsb_max', 'colour error, max', 'LSB'], ['cycles', 'cycles a frame', ''], ['ms', 'ms a frame', 'ms'],
  ['bytes', 'bytes a frame', ''], ['ecp5.places', 'ECP5 places', ''], ['ecp5.ff', 'ECP5 flip-flops', ''],
  ['ecp5.multipliers', 'ECP5 multipliers', ''], ['ecp5.block_rams', 'ECP5 block RAMs', ''],
  ['ice40.lut4', 'iCE40 LUT4', ''], ['ice40.ff', 'iCE40 flip-flops', ''], ['ice40.block_rams', 'iCE40 RAMs', '']];
const value = (p, name) => name.split('.').reduce((o, k) => known(o) ? o[k] : null, p);
const there = FIGURES.filter(([n]) => POINTS.length && POINTS.every(p => known(value(p, n))));
const named_ = name => FIGURES.find(([n]) => n === name) || [name, name, ''];
const title_ = ([, text, unit]) => unit && unit !== 'ms' ? `${text}, ${unit}` : text;
const shown = (p, name) => { const v = value(p, name); return Number.isInteger(v) ? count(v) : fmt(v); };
const settingsText = p => Object.entries(p.settings).map(([k, v]) => `${k}=${v}`).join(' ') || 'as configured';
const style = () => ({colour: '--c0', dash: [], mark: 'circle'});
const pick = (...names) => (names.map(n => there.find(([m]) => m === n)).find(Boolean) || there[0] || ['cycles'])[0];
const chosen = {x: pick('ecp5.places', 'ice40.lut4', 'cycles'), y: pick('coverage_rms', 'depth_eye_rms', 'depth_range_rms', 'cycles'),
  colour: KEYS[0] || '', scene: SCENES[0]};
if (chosen.x === chosen.y && there[1]) chosen.y = there[1][0];

// ---- what beats what: as the program has it, on two figures or on all of the front ----
const does = (a, b) => Object.keys(b.abilities).every(k => a.abilities[k] >= b.abilities[k]);
function front(rows, x, y) {
  return rows.filter(p => !rows.some(q => does(q, p) && value(q, x) <= value(p, x) && value(q, y) <= value(p, y) &&
    (value(q, x) < value(p, x) || value(q, y) < value(p, y)))).sort((a, b) => value(a, x) - value(b, x));
}
function select(name, label, options) {
  const s = h('select', {id: `choose-${name}`}, options.map(([v, t]) =>
    h('option', {value: v, ...(v === chosen[name] && {selected: ''})}, t)));
  s.onchange = () => { chosen[name] = s.value; charts.forEach(draw); told(); };
  return h('label', null, `${label} `, s);
}

// ---- 1: title ----
function title() {
  const best = POINTS.filter(p => p.on_front);
  main.append(h('h1', null, D.title || 'Design space'), h('p', {class: 'sub', id: 'summary'}, spans([
    D.label && `Base: ${D.label}`, `${POINTS.length} points, ${best.length} on the front`,
    D.memory && `Memory: ${D.memory.kind}, ${D.memory.mhz} MHz`])));
}

// ---- 2: the picture ----
const facts = h('div', {class: 'facts', id: 'facts', 'aria-live': 'polite'});
function tell(p) {
  facts.replaceChildren(h('h3', null, settingsText(p)), h('dl', null, there.flatMap(f =>
    [h('dt', null, title_(f)), h('dd', null, shown(p, f[0]))])));
}
function told() {
  const rows = POINTS.filter(p => p.scene === chosen.scene), line = front(rows, chosen.x, chosen.y);
  document.getElementById('ends').textContent = line.length ? `Not beaten in these two: ${line.length} of ${rows.length}. ` +
    `Least ${named_(chosen.x)[1]}: ${settingsText(line[0])}. Least ${named_(chosen.y)[1]}: ` +
    `${settingsText(line.reduce((a, b) => value(b, chosen.y) < value(a, chosen.y) ? b : a))}.` : '';
}
function picture() {
  if (there.length < 2) return;
  const make = () => {
    const {x, y} = chosen, rows = POINTS.filter(p => p.scene === chosen.scene);
    const point = p => ({x: value(p, x), y: value(p, y), row: p});
    const values = distinct(rows.map(p => chosen.colour ? p.settings[chosen.colour] : ''));
    const scale = name => {
      const all = rows.map(p => value(p, name)), lo = Math.min(...all), hi = Math.max(...all);
      if (lo > 0 && hi / lo > 8) { const d = decadesRound(all); return logAxis(title_(named_(name)), d.lo, d.hi); }
      return axis(title_(named_(name)), {type: 'linear', ticks: {callback: v => fmt(v)}, grace: '5%'});
    };
    const best = front(rows, x, y);
    // front() keeps what can do more as well: the line joins only those that step down
    let least = Infinity;
    const steps = best.filter(p => value(p, y) < least && ((least = value(p, y)), true));
    const datasets = [{label: 'front', type: 'line', stepped: true, data: steps.map(point), borderColor: css('--muted'),
      borderWidth: 1.5, borderDash: [4, 3], pointRadius: 0, order: 2},
    {label: 'ring', type: 'scatter', data: best.map(point), pointRadius: 9, pointStyle: 'circle',
      pointBackgroundColor: 'transparent', pointBorderColor: css('--muted'), pointBorderWidth: 1.5, order: 1},
    ...values.map((v, i) => ({label: v, data: rows.filter(p => !chosen.colour || p.settings[chosen.colour] === v).map(point),
      pointRadius: 5, pointHoverRadius: 7, pointStyle: MARKS[i % 4], borderColor: css(`--c${i % 7}`), borderWidth: 2,
      backgroundColor: c => c.raw && c.raw.row.on_front ? css(`--c${i % 7}`) : 'transparent', order: 0}))];
    const text = t => [settingsText(t.raw.row), ...there.filter(([n]) => n === x || n === y)
      .map(f => `${title_(f)}: ${shown(t.raw.row, f[0])}`)];
    const config = {type: 'scatter', data: {datasets}, options: {interaction: {mode: 'nearest', intersect: true},
      onHover: (_, hits) => hits.length && tell(datasets[hits[0].datasetIndex].data[hits[0].index].row),
      scales: {x: scale(x), y: scale(y)}, plugins: tips(text, () => chosen.scene)}};
    config.options.plugins.tooltip.filter = t => t.dataset.label !== 'front' && t.dataset.label !== 'ring';
    const key = document.getElementById('key');
    if (key) key.replaceChildren(...(chosen.colour ? values : []).map((v, i) => h('span', null,
      h('i', {class: 'box', style: `background: var(--c${i % 7})`}), `${chosen.colour}=${v}`)));
    return config;
  };
  const axes = there.map(f => [f[0], title_(f)]);
  section('Points', 'Lower and further left is better. A ring marks a point that no other one beats in these two figures ' +
    `and in what it can do; a filled mark is on the front of ${(D.front_axes || []).join(', ')}. Hover a point for its settings.`,
  h('div', {class: 'row'}, select('x', 'Across', axes), select('y', 'Up', axes),
    KEYS.length ? select('colour', 'Colour by', KEYS.map(k => [k, k])) : '',
    SCENES.length > 1 ? select('scene', 'Scene', SCENES.map(s => [s, s])) : ''),
  chart('Design space, one mark for each configuration', make), h('div', {class: 'row', id: 'key'}),
  h('p', {class: 'note', id: 'ends'}), facts);
  told();
  const first = POINTS.find(p => p.on_front) || POINTS[0];
  if (first) tell(first);
}

// ---- 3: the points ----
function rows() {
  if (!POINTS.length) return;
  const head = ['Configuration', SCENES.length > 1 && 'Scene', 'Front', ...there.map(title_)].filter(Boolean);
  const line = p => [settingsText(p), ...(SCENES.length > 1 ? [p.scene] : []), p.on_front ? 'front' : '',
    ...there.map(f => shown(p, f[0]))];
  const best = POINTS.filter(p => p.on_front);
  section('The front', 'By the least of the first figure.', table('The front', [head],
    [...best].sort((a, b) => value(a, chosen.x) - value(b, chosen.x)).map(line)));
  if (best.length < POINTS.length) main.append(h('details', null, h('summary', null, `All ${POINTS.length} points`),
    table('All points', [head], POINTS.map(line))));
}

show([title, picture, rows, () => foot(D.missing > 0 && `${D.missing} points are missing`)]);

// Depth precision
const SERIES = D.series || [], MEASURED = SERIES.filter(s => s.measured);
const range = d => `${fmt(d.from)} – ${known(d.to) ? fmt(d.to) : '∞'}`;
const code = v => Number.isInteger(v) && v > 9 ? `${v} (0x${v.toString(16).toUpperCase()})` : fmt(v);

// ---- style of a series: the same colour, dash and mark everywhere ----
const styles = new Map(SERIES.map((s, i) => [s.name, i]));
let free = SERIES.length;
function style(name) {
  if (!styles.has(name)) {
    // a sweep's line, "std u": that of the first series of its mapping and kind of format
    const first = SERIES.findIndex(s => name === s.name.replace(/[\d.]+$/, '') || name === s.name.replace(/\.\d+$/, ''));
    styles.set(name, first >= 0 ? first : free++);
  }
  const i = styles.get(name);
  return {colour: `--c${i % 7}`, dash: DASHES[i % DASHES.length], mark: MARKS[i % MARKS.length]};
}

// ---- 1: title ----
function title() {
  const s = D.scene, answers = D.answers || [];
  main.append(h('h1', null, 'Depth precision'), h('p', {class: 'sub'}, spans([
    s ? `Scene: ${s.name}` : 'Theory only', `Near: ${fmt(D.near)}`, `Far: ${known(D.far) ? fmt(D.far) : 'infinite'}`,
    s && `Size: ${s.width} × ${s.height} pixels`, D.config && `Configuration: ${D.config}`,
    s && `${count(s.triangles)} triangles`, s && `${count(s.fragments)} fragments`,
    s && `Eye depth: ${fmt(s.eye_min)} to ${fmt(s.eye_max)}`])));
  if (answers.length) main.append(h('ul', {class: 'answers'}, answers.map(a => h('li', null, a))));
}

// ---- 2: step by depth ----
function steps() {
  const all = SERIES.filter(s => s.curve && s.curve.z && s.curve.z.length);
  const kinds = [['bin_width', 'bin width'], ['max_recon_err', 'largest reconstruction error'],
    ['first_order', 'first order estimate']].filter(([k]) => all.some(s => (s.curve[k] || []).some(v => v > 0)));
  if (!kinds.length) return;
  // one scale for all kinds, so that switching compares them; a float step near zero would flatten the rest
  const values = kinds.flatMap(([k]) => all.flatMap(s => s.curve[k] || [])), {lo, hi, cut} = decadesRound(values, .02);
  const z = all.flatMap(s => s.curve.z).sort((a, b) => a - b), scene = D.scene && known(D.scene.eye_min) && D.scene;
  let kind = kinds[0];
  const band = {id: 'band', beforeDatasetsDraw({ctx, chartArea: a, scales: {x}}) {
    if (!scene) return;
    const l = Math.max(a.left, x.getPixelForValue(scene.eye_min)), r = x.getPixelForValue(scene.eye_max);
    ctx.fillStyle = css('--muted') + '20';
    ctx.fillRect(l, a.top, Math.min(a.right, r) - l, a.bottom - a.top);
  }};
  const make = () => ({type: 'line', plugins: [band], data: {datasets: all.map((s, i) => {
    const y = s.curve[kind[0]] || [], ok = j => y[j] > 0;
    // a value alone between two gaps makes no line
    const pointRadius = c => ok(c.dataIndex) && !ok(c.dataIndex - 1) && !ok(c.dataIndex + 1) ? 2 : 0;
    return {...lineSet(s.name, i, s.curve.z.map((x, j) => ({x, y: ok(j) ? y[j] : null}))), pointRadius};
  })}, options: {interaction: byX, scales: {x: logAxis('eye depth, scene units', z[0], z[z.length - 1]),
    y: logAxis(`${kind[1]}, scene units`, lo, hi)}, plugins: tips(t => `${t.dataset.label}: ${fmt(t.parsed.y)}`, t =>
    `eye depth ${fmt(t.parsed.x)}`)}});
  const own = charts.length;
  const pick = choice('kind', 'Quantity', kinds, kind, k => { kind = k; draw(charts[own]); });
  const remarks = [scene && 'The grey band is the range of eye depth in the scene.',
    cut && 'Lines that leave the chart at the bottom go much lower.',
    values.some(v => !(v > 0)) && 'A gap in a line is a value that is zero or not known.'];
  section('How fine a step is, by depth', 'The bin width is the span of eye depth that shares one code. Two surfaces ' +
    'closer than that can get the same code. Lower is better.', pick,
  chart('Size of a depth step by eye depth, one line per series', make), legend(all.map(s => s.name)),
  note(remarks.filter(Boolean).join(' ')));
}

// ---- the same figures where they were asked for ----
function figures() {
  const kinds = [['code', 'Code'], ['bin_width', 'Bin width'], ['max_recon_err', 'Largest reconstruction error'],
    ['first_order', 'First order estimate']], lines = new Map();
  for (const r of D.rows || []) {
    if (r.z === '' || !kinds.some(([k]) => k === r.metric)) continue;
    const key = [`${r.mapping} ${r.format}`, r.z].join();
    // a measured row has other metrics
    if (!lines.has(key)) lines.set(key, {name: `${r.mapping} ${r.format}`, z: r.z});
    lines.get(key)[r.metric] = r.metric === 'code' ? code(r.value) : r.value === null ? '\u221e' : fmt(r.value);
  }
  if (!lines.size) return;
  section('At single depths', 'The chart above goes through these figures. Lengths and eye depths are in scene units.',
    table('Figures at single depths', [['Series', 'Eye depth', ...kinds.map(([, t]) => t)]], [...lines.values()].map(l =>
      [named(l.name), l.z, ...kinds.map(([k]) => l[k] || '–')])));
}

// ---- 3: codes by decade ----
const allDecades = lists => [...new Map(lists.flat().map(d => [range(d), d])).values()].sort((a, b) => a.from - b.from);
// cividis, dark to light
const SHADES = [[12, 56, 116], [66, 78, 108], [124, 123, 120], [188, 174, 108], [254, 232, 56]];
function shade(i, n) {
  const t = n > 1 ? i / (n - 1) * 4 : 0, k = Math.min(Math.floor(t), 3);
  return SHADES[k].map((v, j) => Math.round(v + (SHADES[k + 1][j] - v) * (t - k)));
}
function codes() {
  const all = SERIES.filter(s => s.decades && s.decades.length);
  if (!all.length) return;
  const decades = allDecades(all.map(s => s.decades)), colour = i => `rgb(${shade(i, decades.length)})`;
  const of = (s, d) => s.decades.find(e => range(e) === range(d));
  const labels = {id: 'labels', afterDatasetsDraw(c) {
    const {ctx} = c;
    Object.assign(ctx, {font: '12px system-ui, sans-serif', textAlign: 'center', textBaseline: 'middle'});
    c.data.datasets.forEach((set, i) => c.getDatasetMeta(i).data.forEach((bar, j) => {
      const text = `${Number((set.data[j] * 100).toPrecision(3))} %`;
      if (bar.x - bar.base < ctx.measureText(text).width + 8) return;
      ctx.fillStyle = shade(i, decades.length)[1] > 115 ? '#000' : '#fff';
      ctx.fillText(text, (bar.x + bar.base) / 2, bar.y);
    }));
  }};
  const set = (d, i) => ({label: range(d), data: all.map(s => (of(s, d) || {share: 0}).share),
    backgroundColor: colour(i), borderColor: css('--bg'), borderWidth: {right: 1}, maxBarThickness: 34});
  const make = () => ({type: 'bar', plugins: [labels], data: {labels: all.map(s => s.name), datasets: decades.map(set)},
  options: {indexAxis: 'y', plugins: tips(t => `eye depth ${t.dataset.label}: ${percent(t.raw)}`),
    scales: {y: bareAxis('', {title: {display: false}, stacked: true, ticks: {color: css('--ink')}}),
      x: axis('share of codes, %', {stacked: true, min: 0, max: 1, ticks: {callback: v => Math.round(v * 100)}})}}});
  const box = chart('Share of the codes spent on each decade of eye depth, one bar per series', make);
  box.style.height = `${70 + 44 * all.length}px`;
  section('Where the codes go', 'Each bar is all the codes of a series. Its parts are the share spent on each decade ' +
    'of eye depth. A part too thin to see is in the table.', h('div', {class: 'row'}, 'Eye depth, scene units:',
    decades.map((d, i) => h('span', null, h('i', {class: 'box', style: `background: ${colour(i)}`}), range(d)))), box,
  table('Codes by decade', [['Codes', ...decades.map(range)]], all.map(s => [named(s.name),
    ...decades.map(d => of(s, d)).map(d => d ? `${count(d.codes)} (${percent(d.share)})` : '–')])));
}
// ---- 4: limits ----
function limits() {
  if (!SERIES.length) return;
  const bins = s => (s.curve && s.curve.bin_width) || [];
  const lengths = [...new Set(SERIES.flatMap(s => (s.exceeds || []).map(e => e.length)))].sort((a, b) => a - b);
  const exceeds = e => e ? known(e.z) ? fmt(e.z) : 'never' : '–';
  const rows = [['Bits stored', s => fmt(s.storage_bits)], ['Bits in the plane', s => fmt(s.plane_bits)],
    ['Codes used between near and far', s => count(s.codes_used)], ['Bin width at near', s => fmt(bins(s)[0])],
    ['Bin width at far', s => fmt(bins(s)[bins(s).length - 1])],
    ...lengths.map(l => [`Bin first exceeds ${fmt(l)} at`, s => exceeds((s.exceeds || []).find(e => e.length === l))]),
    ['Clear value', s => code(s.clear_code)], ['Comparison', s => fmt(s.order)],
    ['Cost for hardware', s => fmt(s.hardware)]];
  section('Limits', 'Lengths and eye depths are in scene units. “Never” means: not between near and far.',
    table('Limits', [['', ...SERIES.map(s => named(s.name))]], rows.map(([t, f]) => [t, ...SERIES.map(f)])));
}

// ---- what was asked for besides: --slope, --error ----
function asked() {
  const names = {separation: 'Separation', separation_storage: 'of it storage', separation_datapath: 'datapath',
    separation_snap: 'snap', fights_at_separation: 'Fighting there', fights_at_half: 'at half of it',
    longest_bin: 'Longest bin', z_exceeds: 'Bins exceed it from', best_near: 'Least near plane',
    fewest_bits: 'Fewest bits'};
  const lines = new Map();
  for (const r of D.rows || []) {
    if (!names[r.metric]) continue;
    const key = [`${r.mapping} ${r.format}`, r.z];
    if (!lines.has(key.join())) lines.set(key.join(), {key});
    lines.get(key.join())[r.metric] = r.value === null ? '\u221e' : fmt(r.value);
  }
  if (!lines.size) return;
  const used = Object.keys(names).filter(n => [...lines.values()].some(l => l[n]));
  section('Asked for', 'Two surfaces keep their order if they are a separation apart; the part of overlapping fragments ' +
    'that fight was tried on such surfaces. A bin is the depths that share a code.',
    table('Asked for', [['Series', 'Eye depth', ...used.map(n => names[n])]],
      [...lines.values()].map(l => [named(l.key[0]), l.key[1] || 'range', ...used.map(n => l[n] || '–')])));
}

// ---- 5: measured ----
function measured() {
  const full = s => (s.measured.decades || []).filter(d => d.fragments > 0), all = MEASURED.filter(s => full(s).length);
  const parts = MEASURED.filter(s => s.measured.parts), kids = [];
  const bounds = decadesRound(all.flatMap(s => full(s).flatMap(d => [d.max, d.rms, d.bound])));
  if (!bounds && !parts.length) return;
  if (bounds) {
    const decades = allDecades(all.map(full)), bounded = all.flatMap(s =>
      full(s).filter(d => known(d.bound)).map(d => ({over: d.max > d.bound, text: `${s.name} at ${range(d)}`})));
    const over = bounded.filter(b => b.over).map(b => b.text);
    const make = s => () => {
      const colour = css(style(s.name).colour);
      const of = k => decades.map(d => (full(s).find(e => range(e) === range(d)) || {})[k]).map(v => v > 0 ? v : null);
      const room = c => c.chart.chartArea ? Math.min(50, c.chart.chartArea.width / decades.length * .42) : 0;
      return {data: {labels: decades.map(range), datasets: [
        {type: 'bar', label: 'max', data: of('max'), backgroundColor: colour, order: 1},
        {type: 'bar', label: 'rms', data: of('rms'), backgroundColor: colour + '50', order: 1},
        {type: 'line', label: 'bound', data: of('bound'), showLine: false, pointStyle: 'line',
          borderColor: css('--ink'), borderWidth: 3, pointRadius: room, pointHoverRadius: room, clip: 4}]},
      options: {interaction: {mode: 'index', intersect: false}, plugins: tips(t => `${t.dataset.label}: ${fmt(t.raw)}`),
        scales: {x: bareAxis('eye depth, scene units'), y: logAxis('error, scene units', bounds.lo, bounds.hi)},
        datasets: {bar: {categoryPercentage: .8, barPercentage: .95, maxBarThickness: 48}}}};
    };
    const keys = [['background: var(--muted)', 'max error'], ['background: var(--muted); opacity: .4', 'rms error'],
      ['height: 3px; width: 24px; background: var(--ink)', 'predicted bound']];
    const key = ([look, text]) => h('span', null, h('i', {class: 'box', style: look}), text);
    kids.push(h('div', {class: 'row'}, keys.map(key)), h('div', {class: 'grid'}, all.map(s => h('div', {class: 'keep'},
      h('h3', null, named(s.name)), chart(`Measured error by eye depth, ${s.name}`, make(s), true)))));
    if (over.length) kids.push(h('p', null, `The largest error is above the bound for: ${over.join('; ')}.`));
    else if (bounded.length) kids.push(h('p', null, 'No largest error is above its bound.'));
    const rows = all.flatMap(s => full(s).map(d => [named(s.name), range(d), count(d.fragments),
      ...['max', 'rms', 'mean', 'p999', 'bound'].map(k => fmt(d[k])),
      ...['snap', 'interpolation', 'storage'].map(k => d.parts ? fmt(d.parts[k].rms) : '–')]));
    kids.push(h('details', null, h('summary', null, 'All numbers by decade'), table('Measured error by decade',
      [['Series', 'Eye depth', 'Fragments', 'Max', 'Rms', 'Mean', '99.9 %', 'Bound', 'Snap, rms', 'Interpolation, rms',
        'Storage, rms']], rows)));
  }
  if (parts.length) {
    const names = ['snap', 'interpolation', 'storage', 'total'].filter(n => parts.some(s => s.measured.parts[n]));
    const pair = p => p ? [fmt(p.max), fmt(p.rms)] : ['–', '–'];
    kids.push(h('h3', null, 'Where the error comes from'), table('Parts of the error', [[{text: 'Series', rows: 2},
      ...names.map(n => ({text: n[0].toUpperCase() + n.slice(1), span: 2}))], names.flatMap(() => ['max', 'rms'])],
    parts.map(s => [named(s.name), ...names.flatMap(n => pair(s.measured.parts[n]))])));
  }
  section('Measured', 'Errors in eye depth of the fragments that were drawn, in scene units. All charts have the ' +
    'same axes. An error of zero has no bar.', ...kids);
}

// ---- 6: z-fighting ----
function fighting() {
  const all = MEASURED.filter(s => known(s.measured.pairs)), kids = [];
  const sweeps = (D.sweeps || []).filter(s => s.lines && s.lines.some(l => l.x.length));
  if (!all.length && !sweeps.length) return;
  if (all.length) kids.push(table('Z-fighting', [['Series', 'Pairs', 'Ties', 'Inversions', 'Rate']], all.map(s =>
    [named(s.name), ...['pairs', 'ties', 'inversions'].map(k => count(s.measured[k])), percent(s.measured.rate)])));
  const rates = sweeps.flatMap(s => s.lines.flatMap(l => l.rate)), zeros = rates.includes(0);
  const bounds = decadesRound(rates) || {lo: .1, hi: 1};
  // one more decade, whose foot stands for zero
  const lo = zeros ? Number((bounds.lo / 10).toPrecision(1)) : bounds.lo;
  const make = sweep => () => {
    const xs = [...new Set(sweep.lines.flatMap(l => l.x))].sort((a, b) => a - b), end = xs[xs.length - 1];
    const unit = sweep.unit && !sweep.what.includes(sweep.unit) ? `, ${sweep.unit}` : '';
    const pad = Math.max(.5, (end - xs[0]) * .03);
    const afterBuildTicks = scale => { scale.ticks = xs.map(value => ({value})); };
    return {type: 'line', data: {datasets: sweep.lines.map((l, i) => {
      const set = lineSet(l.name, i, l.x.map((x, j) => ({x, y: l.rate[j] === 0 ? lo : l.rate[j], rate: l.rate[j]})));
      const pointBackgroundColor = c => c.raw && c.raw.rate === 0 ? css('--bg') : set.borderColor;
      return {...set, pointBackgroundColor, pointBorderWidth: 2, pointRadius: 4, clip: 8};
    })}, options: {interaction: byX, scales: {y: logAxis('fighting rate, share of pairs', lo, bounds.hi,
      v => zeros && v === lo ? '0' : tickText(v)),
      x: axis(sweep.what + unit, {type: 'linear', min: xs[0] - pad, max: end + pad, afterBuildTicks})},
    plugins: tips(t => `${t.dataset.label}: ${fmt(t.raw.rate)}`, t => `${sweep.what}: ${t.parsed.x}`)}};
  };
  kids.push(h('div', {class: 'grid two'}, sweeps.map(s => h('div', {class: 'keep'}, h('h3', null, `Rate by ${s.what}`),
    chart(`Fighting rate by ${s.what}, one line per mapping`, make(s)), legend(s.lines.map(l => l.name))))));
  if (zeros) kids.push(note('A hollow mark on the bottom line is zero: no pair fought.'));
  section('Z-fighting', 'A pair is two fragments that overlap in a pixel. A tie is a pair with one code. An ' +
    'inversion is a pair in the wrong order. The rate is ties and inversions over pairs.', ...kids);
}

// ---- 7: pictures ----
function pictures() {
  const all = MEASURED.filter(s => s.measured.heat || s.measured.fight);
  const picture = (src, alt) => src ? [h('figure', null, h('img', {src, alt}), h('figcaption', null, alt))] : [];
  const legends = [D.heat_legend && `Error: ${D.heat_legend}`, D.fight_legend && `Fighting: ${D.fight_legend}`];
  if (!all.length) return;
  section('Pictures', 'For each series: where the depth error is, and where fragments fight.',
    ...legends.filter(Boolean).map(note), ...picture(D.heat_scale, 'Error, logarithmic'), ...all.map(s => h('div', {class: 'keep'}, h('h3', null, named(s.name)),
      h('div', {class: 'grid two'}, picture(s.measured.heat, `${s.name}: error`),
        picture(s.measured.fight, `${s.name}: fighting`)))));
}

// of a page without a scene the command has it
const seed = known(D.seed) ? D.seed : ((D.command || '').match(/--seed[ =](\S+)/) || [])[1];
show([title, steps, figures, codes, limits, asked, measured, fighting, pictures, () => foot(known(seed) && `Seed: ${seed}`)]);

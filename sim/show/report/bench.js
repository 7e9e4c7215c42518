// Run time against error
const ROWS = D.rows || [], SKIPS = D.skips || [], GROWTH = D.growth || [];
const ENGINES = distinct(ROWS.map(r => r.engine)), SCENES = distinct(ROWS.map(r => r.scene));
const VARIATIONS = distinct(ROWS.map(r => r.label));
const ms = v => fmt(v * 1e3);

// ---- style: colour by engine and mark by variation in the pictures; by line in the growth ----
const LINES = {depth_back_to_front: 'back to front', depth_front_to_back: 'front to back'};
function style(name) {
  const i = Math.max(0, ENGINES.indexOf(name), name === LINES.depth_front_to_back ? 1 : 0);
  return {colour: `--c${i % 7}`, dash: DASHES[i % DASHES.length], mark: MARKS[i % MARKS.length]};
}
// star and crossRot have no area and would hide in a colour; these are told apart when small
const SHAPES = ['circle', 'rect', 'triangle', 'rectRot', 'star', 'cross', 'crossRot'];
const shape = row => SHAPES[VARIATIONS.indexOf(row.label) % SHAPES.length];
const GLYPHS = ['●', '■', '▲', '◆', '✶', '+', '×'];
const variation = label => label || 'as configured';
const rowName = r => `${r.engine}${r.threads > 1 ? ` with ${r.threads} threads` : ''}${r.label ? `, ${r.label}` : ''}`;

// ---- 1: title ----
function title() {
  const m = D.machine || {}, sizes = distinct(ROWS.map(r => `${r.width} × ${r.height}`));
  main.append(h('h1', null, 'Run time against error'), h('p', {class: 'sub'}, spans([
    D.label && `Configuration: ${D.label}`, sizes.length && `Size: ${sizes.join(', ')} pixels`,
    D.repeat > 1 ? `Median of ${D.repeat} frames, in turns` : 'Single frames', m.processor,
    m.threads && `${m.threads} hardware threads`])));
  // of the configuration itself, each engine at its best
  const answers = SCENES.map(scene => {
    const rows = ROWS.filter(r => r.scene === scene && r.label === ROWS[0].label).sort((a, b) => a.frame_s - b.frame_s);
    const [best, ...others] = rows.filter((r, i) => rows.findIndex(o => o.engine === r.engine) === i);
    if (!best) return '';
    const times = r => fmt(Number((r.frame_s / best.frame_s).toPrecision(2)));
    return `${scene}: ${rowName(best)} takes ${ms(best.frame_s)} ms a frame` +
      others.map((r, i) => `${i ? ',' : ';'} ${rowName(r)} ${times(r)} times that`).join('') + '.';
  }).filter(Boolean);
  if (answers.length) main.append(h('ul', {class: 'answers'}, answers.map(a => h('li', null, a))));
}

// ---- 2: error against time and cycles ----
// an LSB is another length in every depth format: eye space compares them, or the range
const BITS = distinct(ROWS.map(r => r.depth_bits)), many = BITS.length > 1;
const ranged = many && ROWS.some(r => known(r.depth_lsb_rms) && !known(r.depth_eye_rms));
const LSB = many ? 'LSB of its own depth.bits' : 'LSB';
const ERRORS = [['depth_lsb_rms', 'depth, rms', LSB], ['depth_lsb_max', 'depth, max', LSB],
  ...(ranged ? [['depth_range_rms', 'depth, rms of the range', 'depth range'],
    ['depth_range_max', 'depth, max of the range', 'depth range']] : []),
  ['depth_eye_rms', 'depth, rms in eye space', 'scene units'],
  ['depth_eye_max', 'depth, max in eye space', 'scene units'],
  ['color_lsb_rms', 'colour, rms', 'LSB'], ['color_lsb_max', 'colour, max', 'LSB'],
  ['snapped', 'samples missing or extra', 'samples']];
const errorOf = (row, key) => key !== 'snapped' ? row[key]
  : known(row.coverage_missing) ? row.coverage_missing + row.coverage_extra : null;
// cycles of configurations differ by little
const closely = values => ({lo: Number((Math.min(...values) * .95).toPrecision(2)),
  hi: Number((Math.max(...values) * 1.05).toPrecision(2))});
// who is not beaten in both: in order of x, each better than all before
function front(rows, x, y) {
  const sorted = [...rows].sort((a, b) => a[x] - b[x] || errorOf(a, y) - errorOf(b, y));
  let best = Infinity;
  return sorted.filter(r => errorOf(r, y) < best && ((best = errorOf(r, y)), true));
}
function pareto() {
  const kinds = ERRORS.filter(([k]) => ROWS.some(r => errorOf(r, k) > 0));
  if (!kinds.length) return;
  const start = ranged ? 'depth_range_rms' : many || VARIATIONS.some(v => v.includes('depth.')) ? 'depth_eye_rms'
    : 'depth_lsb_rms';
  let kind = kinds.find(([k]) => k === start) || kinds[0];
  const own = [];
  const make = (scene, x, unit) => () => {
    const key = kind[0], scale = x === 'frame_s' ? 1e3 : 1;
    const rows = ROWS.filter(r => r.scene === scene && known(r[x]) && known(errorOf(r, key)));
    const all = ROWS.filter(r => known(r[x]) && known(errorOf(r, key)));
    const ys = decadesRound(all.map(r => errorOf(r, key))) || {lo: .1, hi: 1};
    const xs = x === 'frame_s' ? decadesRound(all.map(r => r[x] * scale)) : closely(rows.map(r => r[x]));
    const zeros = all.some(r => errorOf(r, key) === 0);
    // one more decade, whose foot stands for zero
    const lo = zeros ? Number((ys.lo / 10).toPrecision(1)) : ys.lo;
    const point = r => ({x: r[x] * scale, y: errorOf(r, key) || lo, row: r});
    const best = front(rows, x, key).map(point);
    const datasets = [{label: 'front', data: best, type: 'line', stepped: true,
      borderColor: css('--muted'), borderWidth: 1.5, borderDash: [4, 3], pointRadius: 9, pointStyle: 'circle',
      pointBackgroundColor: 'transparent', pointBorderColor: css('--muted'), pointBorderWidth: 1.5, clip: 12, order: 1},
    ...ENGINES.map(e => ({label: e, data: rows.filter(r => r.engine === e).map(point), pointRadius: 5,
      pointHoverRadius: 7, pointStyle: c => c.raw ? shape(c.raw.row) : 'circle', borderColor: css(style(e).colour),
      borderWidth: 2, clip: 12, order: 0,
      backgroundColor: c => css(c.raw && errorOf(c.raw.row, key) === 0 ? '--bg' : style(e).colour)}))];
    const text = t => `${rowName(t.raw.row)}: ${fmt(t.raw.x)} ${unit}, ${fmt(errorOf(t.raw.row, key))} ${kind[2]}`;
    const config = {type: 'scatter', data: {datasets}, options: {interaction: {mode: 'nearest', intersect: true},
      scales: {x: logAxis(x === 'frame_s' ? 'ms a frame' : 'cycles a frame', xs.lo, xs.hi),
        y: logAxis(`${kind[1]}, ${kind[2]}`, lo, ys.hi, v => zeros && v === lo ? '0' : tickText(v))},
      plugins: tips(text, () => scene)}};
    config.options.plugins.tooltip.filter = t => t.dataset.label !== 'front';
    return config;
  };
  const box = (scene, x, unit) => {
    own.push(charts.length);
    return h('div', {class: 'keep'}, h('h3', null, x === 'frame_s' ? scene : `${scene}: hardware cycles`),
      chart(`Error against ${unit} a frame on ${scene}, one mark for each row`, make(scene, x, unit)));
  };
  const cyclesOn = s => distinct(ROWS.filter(r => r.scene === s && known(r.cycles)).map(r => r.cycles));
  const cycles = SCENES.filter(s => cyclesOn(s).length > 1);
  const boxes = [...SCENES.map(s => box(s, 'frame_s', 'ms')), ...cycles.map(s => box(s, 'cycles', 'cycles'))];
  const dot = e => h('span', null, h('i', {class: 'box', style: `background: var(${style(e).colour})`}), e);
  const compared = ENGINES.filter(e => ROWS.some(r => r.engine === e && kinds.some(([k]) => known(errorOf(r, k)))));
  const aside = ENGINES.filter(e => !compared.includes(e));
  section('Error against time', 'Lower and further left is better. A ring marks a row that no other row beats in ' +
    'both; the dashed line joins them. A hollow mark on the bottom line is an error of zero.',
  choice('error', 'Error', kinds, kind, k => { kind = k; own.forEach(i => draw(charts[i])); }),
  h('div', {class: boxes.length > 1 ? 'grid wide' : ''}, boxes), h('div', {class: 'row'}, compared.map(dot)),
  VARIATIONS.length > 1 ? h('div', {class: 'row'}, VARIATIONS.map((v, i) =>
    h('span', null, h('b', null, GLYPHS[i % GLYPHS.length]), variation(v)))) : '',
  note('Errors are those of halfplane compare: against the golden, which is the reference and has none. functional, ' +
    'scalar, cycle and rtl draw the same bits and share one comparison. An LSB of depth is a code of the stored ' +
    'format; eye space compares formats.' +
    (aside.length ? ` Not compared, so not in the pictures: ${aside.join(', ')}.` : '')));
}

// ---- 3: rows ----
function rows() {
  if (!ROWS.length) return;
  const varied = VARIATIONS.length > 1, cycles = ROWS.some(r => known(r.cycles));
  const errors = ROWS.some(r => known(r.coverage_mismatches));
  const columns = [['Engine', r => r.engine], ['Scene', r => r.scene], varied && ['Variation', r => variation(r.label)],
    ['Threads', r => count(r.threads)], ['ms a frame', r => ms(r.frame_s)], ['Least ms', r => ms(r.frame_s_min)],
    ['Frames', r => count(r.frames)], ['M prim/s', r => fmt(r.mtri_s)], ['M pix/s', r => fmt(r.mpix_s)],
    cycles && ['Cycles', r => count(r.cycles)],
    cycles && ['M cycles/s', r => fmt(known(r.cycles_per_s) ? r.cycles_per_s / 1e6 : null)],
    ...(errors ? [[`Depth rms, ${LSB}`, r => fmt(r.depth_lsb_rms)],
      [`Depth max, ${LSB}`, r => fmt(r.depth_lsb_max)], ['Depth rms, eye space', r => fmt(r.depth_eye_rms)],
      ['Depth max, eye space', r => fmt(r.depth_eye_max)],
      ...(ranged ? [['Depth rms, of the range', r => fmt(r.depth_range_rms)],
        ['Depth max, of the range', r => fmt(r.depth_range_max)]] : []), ['Colour max, LSB', r => fmt(r.color_lsb_max)],
      ['Oracle mismatches', r => count(r.coverage_mismatches)],
      ['Missing or extra', r => count(errorOf(r, 'snapped'))]] : []),
    ['Covered', r => percent(r.coverage)]].filter(Boolean);
  const all = table('All rows', [columns.map(([name]) => name)], ROWS.map(r => columns.map(([, f]) => f(r))));
  section('All rows', 'Pixels are the samples that triangles cover with nothing skipped, the same for every engine. ' +
    'An engine whose first frame took more than two seconds was measured once.',
  ROWS.length > 24 ? h('details', null, h('summary', null, `${ROWS.length} rows`), all) : all);
}

// ---- 4: skips ----
function skips() {
  if (!SKIPS.length) return;
  const made = s => s.made_for ? 'made for it' : '';
  section('What skipping saves', 'Each kind of skipping on and off, with all others on. Saved is its share of the ' +
    'frame time; below zero it costs more than it saves.',
  table('What skipping saves', [['Skip', 'Scene', '', 'ms with', 'ms without', 'Saved', 'Skipped']], SKIPS.map(s =>
    [s.skip, s.scene, made(s), ms(s.with_s), ms(s.without_s), `${(s.saved * 100).toFixed(1)} %`, count(s.counter)])));
}

// ---- 5: growth ----
function growth() {
  if (!GROWTH.length) return;
  const kinds = [['frame_s', 'ms a frame'], ['mtri_s', 'M triangles/s'], ['mpix_s', 'M pixels/s']];
  let kind = kinds[0];
  const own = [], measured = (D.growth_series || []).filter(s => GROWTH.some(g => g.series === s.name));
  const isDepth = s => s.name.startsWith('depth_');
  // both orders of depth in one picture
  const groups = measured.filter((s, i) => !isDepth(s) || measured.findIndex(isDepth) === i).map(s =>
    ({...s, lines: isDepth(s) ? measured.filter(isDepth) : [s]}));
  const heading = s => isDepth(s) ? 'Depth complexity' : (s.name[0].toUpperCase() + s.name.slice(1)).replace('_', ' ');
  const make = group => () => {
    const scale = kind[0] === 'frame_s' ? 1e3 : 1, value = g => g[kind[0]] * scale;
    const of = name => GROWTH.filter(g => g.series === name), all = group.lines.flatMap(s => of(s.name));
    const xs = distinct(all.map(g => g.x)).sort((a, b) => a - b), ys = decadesRound(all.map(value)) || {lo: .1, hi: 1};
    const exact = scale => { scale.ticks = xs.map(v => ({value: v})); };
    const few = xs.length < 9 && (group.name === 'resolution' || group.name === 'threads');
    const last = Math.max(xs[xs.length - 1], xs[0] * 1.5);
    const x = logAxis(group.x, xs[0], last, v => few ? String(v) : tickText(v));
    return {type: 'line', data: {datasets: group.lines.map(({name}, i) => {
      const points = of(name).map(g => ({x: g.x, y: value(g), row: g}));
      return {...lineSet(LINES[name] || name, i, points), pointRadius: 4, clip: 8};
    })},
    options: {interaction: byX,
      scales: {x: few ? {...x, afterBuildTicks: exact} : x, y: logAxis(kind[1], ys.lo, ys.hi)},
      plugins: tips(t => `${group.lines.length > 1 ? `${t.dataset.label}: ` : ''}${ms(t.raw.row.frame_s)} ms, ` +
        `${fmt(t.raw.row.mtri_s)} M triangles/s, ${fmt(t.raw.row.mpix_s)} M pixels/s`,
      t => `${count(t.raw.x)} ${group.x}`)}};
  };
  const box = group => {
    own.push(charts.length);
    return h('div', {class: 'keep'}, h('h3', null, heading(group)), note(group.lines.map(s => s.meaning).join(' ')),
      chart(`${heading(group)}: cost of a frame`, make(group), true),
      group.lines.length > 1 ? legend(group.lines.map(s => LINES[s.name])) : '');
  };
  section('How cost grows', 'The functional engine on grids of triangles. Both axes are logarithmic.',
    choice('growth', 'Quantity', kinds, kind, k => { kind = k; own.forEach(i => draw(charts[i])); }),
    h('div', {class: 'grid two'}, groups.map(box)));
}

show([title, pareto, rows, skips, growth, () => foot(known(D.seed) && `Seed: ${D.seed}`)]);

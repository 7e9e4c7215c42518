// Why is this pixel what it is?
const Chart = {defaults: {font: {}}};  // what page.js sets; this page has no charts
const W = D.window, ASKED = D.box, PIXELS = D.pixels;
const at = (x, y) => PIXELS[(y - W.y) * W.width + x - W.x];
const keyOf = e => `${e.draw}/${known(e.primitive) ? e.primitive : '-'}/${e.piece}`;

// ---- the primitives of the window in program order ----
const ORDER = [...new Map(PIXELS.flatMap(p => p.history).map(e => [keyOf(e), e])).values()]
  .sort((a, b) => a.draw - b.draw || (a.primitive ?? -1) - (b.primitive ?? -1) || a.piece - b.piece);
const POSITION = new Map(ORDER.map((e, i) => [keyOf(e), i]));
const nameOf = e => known(e.primitive) ? `#${e.primitive} ${e.kind}${e.piece ? ` piece ${e.piece}` : ''}`
  : `${e.kind} (command ${e.draw})`;
const covers = e => e.kind !== 'clear' && ['stencil', 'depth', 'alpha', 'masked', 'written'].includes(e.model.verdict);
// of which sample of its pixel an entry tells; and its name, where a pixel has several
const sampleOf = e => e.sample ?? 0;
const sampleName = e => D.samples.length > 1 ? `, sample ${sampleOf(e)}` : '';

// ---- what is looked at: a pixel, and how many primitives have been drawn ----
let pixel = at(ASKED.x, ASKED.y), step = ORDER.length, isPinned = false;

// the channels of a stored colour: how far up each lies, and its bits
const CHANNELS = D.color_format === 'rgba8888' ? [[0, 8], [8, 8], [16, 8], [24, 8]] : [[11, 5], [5, 6], [0, 5]];
const channels = code => CHANNELS.map(([low, bits]) => parseInt(code, 16) >>> low & (1 << bits) - 1);
function rgb(code) {
  return channels(code).slice(0, 3).map((c, i) => c << 8 - CHANNELS[i][1] | c >> 2 * CHANNELS[i][1] - 8);
}
// the last value that an operation left in a sample up to this step, or what lay there before all of them
function stored(p, sample, operation, initial) {
  let value = initial;
  for (const e of p.history) {
    if (POSITION.get(keyOf(e)) >= step) break;
    if (sampleOf(e) !== sample) continue;
    for (const o of e.model.operations) if (o.operation === operation) value = o.after;
  }
  return value;
}
// what a pixel shows: the mean of its samples, channel by channel, halves up; and sample 0's depth
function colorOf(p) {
  const codes = D.samples.map((_, k) => stored(p, k, 'write_color', D.empty.color));
  const n = codes.length, all = codes.map(channels);
  const mean = CHANNELS.map(([low], c) => Math.floor((all.reduce((sum, s) => sum + s[c], 0) + (n >> 1)) / n) * 2 ** low);
  return '0x' + mean.reduce((a, b) => a + b).toString(16).padStart(codes[0].length - 2, '0');
}
const depthOf = p => stored(p, 0, 'write_depth', D.empty.depth);

// ---- the grid ----
const canvas = h('canvas', {id: 'grid', width: 960, height: Math.round(960 * W.height / W.width), tabindex: 0,
  role: 'img', 'aria-label': 'The neighbourhood, enlarged; arrow keys move'});
const scale = 960 / W.width;
const X = x => (x - W.x) * scale, Y = y => (y - W.y) * scale;
function outline(g, corners, dash, colour) {
  if (!corners || corners.length < 2) return;
  g.setLineDash(dash);
  g.strokeStyle = colour;
  g.beginPath();
  corners.forEach((c, i) => i ? g.lineTo(X(c.x_pixels), Y(c.y_pixels)) : g.moveTo(X(c.x_pixels), Y(c.y_pixels)));
  if (corners.length > 2) g.closePath();
  g.stroke();
}
function paint() {
  const g = canvas.getContext('2d'), now = ORDER[step - 1];
  g.setLineDash([]);
  g.lineWidth = 1;
  for (const p of PIXELS) {
    g.fillStyle = `rgb(${rgb(colorOf(p)).join(',')})`;
    g.fillRect(X(p.x), Y(p.y), scale, scale);
    g.strokeStyle = '#7a828a';
    g.strokeRect(X(p.x) + .5, Y(p.y) + .5, scale, scale);
  }
  const room = scale / Math.ceil(Math.sqrt(D.samples.length));
  for (const p of PIXELS) for (const [k, place] of D.samples.entries()) {
    const e = now && p.history.find(entry => keyOf(entry) === keyOf(now) && sampleOf(entry) === k);
    g.beginPath();
    g.arc(X(p.x + place[0]), Y(p.y + place[1]), e && covers(e) ? room / 8 : room / 20, 0, 7);
    g.fillStyle = e && covers(e) ? (e.verdict === 'written' ? '#23c699' : '#f5833c') : '#fff';
    g.strokeStyle = '#14171a';
    g.fill();
    g.stroke();
  }
  g.lineWidth = 3;
  if (now && now.golden) outline(g, now.golden.corners, [4, 8], '#f2bf4b');
  if (now) outline(g, now.model.corners, [], '#4ba3e3');
  g.setLineDash([]);
  g.lineWidth = 4;
  g.strokeStyle = isPinned ? '#f5833c' : '#fff';
  g.strokeRect(X(pixel.x) + 2, Y(pixel.y) + 2, scale - 4, scale - 4);
}

// ---- the history of the pixel ----
const history = h('div', {id: 'history', 'aria-live': 'polite'});
const signed = v => `${v < 0 ? '' : '+'}${v.toFixed(4)}`;
function details(e) {
  const rows = [];
  for (const d of e.model.edges || [])
    rows.push([`edge ${d.from} to ${d.to}`, `${d.bits} = ${d.value}; ${d.real} square pixels; ${d.side}` +
      (d.tie ? `; exactly on it, ${d.owns_ties ? 'owned' : 'not owned'}` : '')]);
  for (const [name, p] of Object.entries(e.model.planes || {})) {
    const parts = e.parts[name];
    rows.push([name, `${p.real} to ${p.bits} = ${p.code}; exact ${e.oracle.planes[name].real}` + (parts
      ? `; off ${signed(parts.total)} LSB: snap ${signed(parts.snap)}, interpolation ${signed(parts.interpolation)}, storage ${signed(parts.storage)}` : '')]);
  }
  for (const t of (e.model.surface || {}).texels || [])
    rows.push([`texel ${t.x} ${t.y} of level ${t.level}`, `weight ${t.weight}: ${t.color.join(' ')}`]);
  for (const o of e.model.operations)
    rows.push([o.operation, Object.entries(o).filter(([k]) => k !== 'operation' && k !== 'stage')
      .map(([k, v]) => `${k} ${Array.isArray(v) ? v.join(' ') : v}`).join('; ')]);
  const hiz = (e.model.hardware || {}).hiz;
  if (hiz) rows.push(['HiZ', `nearest ${hiz.nearest}, farthest of the tile ${hiz.farthest}: ${hiz.rejects ? 'left out' : 'let through'}`]);
  const packets = (e.model.hardware || {}).packets || [];
  if (packets.length) rows.push(['packets', packets.map(p => `${p.arrow} ${p.number}` + (known(p.cycle) ? ` @${p.cycle}` : '')).join(', ')]);
  if (e.rtl) rows.push(['RTL', e.rtl.differing ? e.rtl.packets.flatMap(p => p.differs.map(f => `${p.arrow} ${p.number}: ${f}`)).join('; ')
    : `${e.rtl.packets.length} packets, all equal`]);
  if (known(e.model.shaded_at)) rows.push(['colour from', e.model.shaded_at === 'centre' ? "the pixel's centre" : `sample ${e.model.shaded_at}`]);
  const name = nameOf(e) + sampleName(e);
  return h('details', null, h('summary', null, `${name}: ${e.why}`),
    table(`Figures of ${name}`, [['figure', 'value']], rows));
}
function tell() {
  const rows = pixel.history.map(e => {
    const row = h('tr', {class: POSITION.get(keyOf(e)) === step - 1 ? 'now' : ''}, h('th', {scope: 'row'}, nameOf(e) + sampleName(e)),
      h('td', {class: e.verdict === 'written' ? 'hit' : ''}, e.verdict), h('td', null, e.stage),
      h('td', null, e.golden ? e.golden.verdict : '–'));
    row.onclick = () => { step = POSITION.get(keyOf(e)) + 1; refresh(); };
    return row;
  });
  const f = pixel.final;
  history.replaceChildren(
    h('h2', {id: 'where'}, `Pixel ${pixel.x} ${pixel.y}`),
    h('p', {class: 'note'}, `Here: colour ${colorOf(pixel)}, depth ${depthOf(pixel)}. In the end: model colour ${f.model.color}, ` +
      `depth ${f.model.depth}${known(f.model.owner) ? ` of #${f.model.owner}` : ''}; golden colour ${f.golden.color}, depth ` +
      `${f.golden.depth} (${f.golden.depth_real.toFixed(3)} LSB)${f.rtl ? `; RTL colour ${f.rtl.color}, depth ${f.rtl.depth}` : ''}.`),
    h('div', {class: 'scroll'}, h('table', null, h('thead', null, h('tr', null, ...['primitive', 'verdict', 'stage', 'golden']
      .map(c => h('th', {scope: 'col'}, c)))), h('tbody', null, rows))),
    ...pixel.history.filter(e => e.kind !== 'clear').map(details));
}

// ---- stepping ----
const slider = h('input', {type: 'range', min: 0, max: ORDER.length, value: step, 'aria-label': 'primitives drawn', id: 'step'});
const stepText = h('span', {id: 'drawn'});
const button = (text, by, id) => {
  const b = h('button', {type: 'button', id}, text);
  b.onclick = () => { step = Math.min(ORDER.length, Math.max(0, step + by)); refresh(); };
  return b;
};
slider.oninput = () => { step = Number(slider.value); refresh(); };
function refresh() {
  slider.value = step;
  stepText.textContent = step ? `${step} of ${ORDER.length}: ${nameOf(ORDER[step - 1])}` : `0 of ${ORDER.length}: nothing yet`;
  paint();
  tell();
}
function pixelUnder(event) {
  const box = canvas.getBoundingClientRect();
  return at(W.x + Math.min(W.width - 1, Math.max(0, Math.floor((event.clientX - box.left) / box.width * W.width))),
    W.y + Math.min(W.height - 1, Math.max(0, Math.floor((event.clientY - box.top) / box.height * W.height))));
}
canvas.onmousemove = event => { if (!isPinned) { pixel = pixelUnder(event); refresh(); } };
canvas.onclick = event => { const under = pixelUnder(event); isPinned = !(isPinned && under === pixel); pixel = under; refresh(); };
canvas.onkeydown = event => {
  const move = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
  const next = move && pixel.x + move[0] >= W.x && pixel.x + move[0] < W.x + W.width && pixel.y + move[1] >= W.y &&
    pixel.y + move[1] < W.y + W.height && at(pixel.x + move[0], pixel.y + move[1]);
  if (!next) return;
  event.preventDefault();
  pixel = next;
  isPinned = true;
  refresh();
};

show([() => main.append(h('h1', null, 'Why is this pixel what it is?'), h('p', {class: 'sub'}, spans([`Scene: ${D.scene}`,
    `Configuration: ${D.label}`, `${count(D.primitives)} primitives`, `${count(D.checks)} figures compared, ${D.differences.length} differ`])),
    ...D.differences.map(note),
    h('div', {class: 'two'}, h('div', null, canvas,
      h('div', {class: 'row'}, button('← previous', -1, 'previous'), slider, button('next →', 1, 'next')),
      h('p', null, stepText),
      note('Point at a pixel to see its history, click to keep it. Step through the primitives: blue their edges after the snap, ' +
        'dotted yellow before it; green samples are written, orange ones are covered and not written.')), history)),
  () => foot()]);
refresh();

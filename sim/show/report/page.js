// What the scripts of the pages share: text, tables, charts, colours, printing. Stands before a page's own.
'use strict';
const D = JSON.parse(document.getElementById('data').textContent);
const root = document.documentElement, main = document.getElementById('main');

// ---- text ----
const distinct = values => [...new Set(values)];
const known = v => v !== null && v !== undefined;
const power = e => '10' + String(e).replace(/[-\d]/g, c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]);
// 4 significant digits
function fmt(v) {
  if (typeof v !== 'number') return known(v) ? String(v) : '–';
  const [m, e] = v.toExponential(3).split('e').map(Number);
  return v === 0 || (e >= -3 && e < 5) ? String(Number(v.toPrecision(4))) : `${m} × ${power(e)}`;
}
const count = v => known(v) ? v.toLocaleString('en-US') : '–';
const percent = v => known(v) ? `${fmt(v * 100)} %` : '–';
function tickText(v) {
  const e = Math.round(Math.log10(v));
  return Math.abs(Math.log10(v) - e) < 1e-9 && (e < -3 || e > 4) ? power(e) : fmt(v);
}

// ---- page ----
function h(tag, attrs, ...kids) {
  const svg = tag === 'svg' || tag === 'line';
  const el = svg ? document.createElementNS('http://www.w3.org/2000/svg', tag) : document.createElement(tag);
  for (const [k, v] of Object.entries(attrs || {})) el.setAttribute(k, v);
  el.append(...kids.flat());
  return el;
}
const note = text => h('p', {class: 'note'}, text);
const spans = facts => facts.filter(Boolean).flatMap(f => [h('span', null, f), ' ']);
const section = (title, lead, ...kids) =>
  main.append(h('section', null, h('h2', null, title), h('p', {class: 'lead'}, lead), ...kids));
// a cell of head is text, a node, or {text, span | rows}; the first cell of each row of body is its header
function table(label, head, body) {
  const headCell = (c, row) => known(c.text) ? h('th', c.span ? {colspan: c.span} : {rowspan: c.rows}, c.text)
    : h('th', row ? {scope: 'col', class: 'sub-head'} : {scope: 'col'}, c);
  const cell = (c, i) => i === 0 ? h('th', {scope: 'row'}, c) : h('td', c.length > 24 ? {class: 'text'} : null, c);
  return h('div', {class: 'scroll', tabindex: 0, role: 'region', 'aria-label': label}, h('table', null,
    h('thead', null, head.map((r, i) => h('tr', null, r.map(c => headCell(c, i))))),
    h('tbody', null, body.map(r => h('tr', null, r.map(cell))))));
}

// a group of radio buttons that redraw charts
function choice(name, label, options, chosen, onchange) {
  return h('div', {class: 'row switch', role: 'radiogroup', 'aria-label': label}, options.map(o => {
    const input = h('input', {type: 'radio', name, ...(o === chosen && {checked: ''})});
    input.onchange = () => onchange(o);
    return h('label', null, input, o[1]);
  }));
}

// what the result was made with: command, version, schema, and a fact of the page
function foot(fact) {
  const how = D.command ? [h('h2', null, 'How to reproduce'), h('pre', {tabindex: 0}, D.command)] : [];
  main.append(h('footer', null, how, h('p', {class: 'sub'}, spans([D.version && `Halfplane ${D.version}`, D.schema, fact]))));
}

// ---- keys: style(name), the page's own, gives {colour, dash, mark} ----
const DASHES = [[], [9, 4], [2, 3], [9, 3, 2, 3], [16, 4], [5, 2, 1, 2, 1, 2]];
const MARKS = ['circle', 'rect', 'triangle', 'rectRot', 'crossRot', 'star'];
function named(name) {
  const {colour, dash} = style(name);
  const line = {x2: 36, y1: 6, y2: 6, style: `stroke: var(${colour})`, 'stroke-dasharray': dash.join(' ')};
  const svg = h('svg', {class: 'key', viewBox: '0 0 36 12', 'aria-hidden': 'true'}, h('line', line));
  return h('span', {class: 'name'}, svg, name);
}
const legend = names => h('div', {class: 'row'}, names.map(named));

// ---- charts ----
const charts = [];
const css = name => getComputedStyle(root).getPropertyValue(name).trim();
// make() gives the configuration in the colours of the moment
function chart(label, make, small) {
  const canvas = h('canvas', {role: 'img', 'aria-label': label});
  charts.push({canvas, make, chart: null});
  return h('div', {class: small ? 'chart small' : 'chart'}, canvas);
}
function draw(c) {
  if (c.chart) c.chart.destroy();
  const config = c.make(), plugins = {legend: {display: false}, ...config.options.plugins};
  const sharp = root.classList.contains('paper') ? {devicePixelRatio: 3} : {};
  config.options = {maintainAspectRatio: false, animation: false, ...sharp, ...config.options, plugins};
  c.chart = new Chart(c.canvas, config);
}
function drawAll() {
  Chart.defaults.color = css('--muted');
  Chart.defaults.font.family = 'system-ui, sans-serif';
  Chart.defaults.font.size = innerWidth < 520 ? 11 : 12;
  charts.forEach(draw);
}
const axis = (title, more) =>
  ({title: {display: true, text: title}, grid: {color: css('--grid'), borderColor: css('--muted')}, ...more});
const bareAxis = (title, more) => axis(title, {grid: {display: false, borderColor: css('--muted')}, ...more});
function logTicks(lo, hi) {
  const a = Math.log10(lo) - 1e-9, b = Math.log10(hi) + 1e-9, ticks = [];
  const step = Math.max(1, Math.ceil((b - a - .1) / 10));
  for (let e = Math.floor(a / step) * step; e <= b; e += step) {
    for (const m of b - a < 1.6 ? [1, 2, 5] : [1]) {
      if (Math.log10(m) + e > a && Math.log10(m) + e < b) ticks.push(Number(`${m}e${e}`));
    }
  }
  return ticks.length > 1 ? ticks : [lo, hi];
}
const logAxis = (title, lo, hi, text = tickText) => axis(title, {type: 'logarithmic', min: lo, max: hi,
  afterBuildTicks: scale => { scale.ticks = logTicks(lo, hi).map(value => ({value})); },
  ticks: {autoSkip: false, maxRotation: 0, callback: v => text(v)}});
// whole decades round the positive values; drop: the share of low values to cut if they lie far below the rest
function decadesRound(values, drop = 0) {
  const logs = values.filter(v => v > 0).map(Math.log10).sort((a, b) => a - b);
  if (!logs.length) return null;
  const low = logs[Math.floor(logs.length * drop)], cut = low - logs[0] > 3;
  const lo = Math.floor(cut ? low : logs[0]), hi = Math.max(Math.ceil(logs[logs.length - 1]), lo + 1);
  return {lo: Number(`1e${lo}`), hi: Number(`1e${hi}`), cut};
}
// the last series is drawn on top, so that a solid line does not hide a dashed one
function lineSet(name, i, data) {
  const s = style(name), borderColor = css(s.colour), look = {borderColor, borderDash: s.dash, borderWidth: 2};
  return {label: name, data, order: -i, parsing: false, ...look, backgroundColor: borderColor, pointStyle: s.mark};
}
const byX = {mode: 'nearest', axis: 'x', intersect: false};
const tips = (label, title = t => t.label) =>
  ({tooltip: {callbacks: {label, title: t => t.length ? title(t[0]) : ''}}});

// ---- the parts of the page in their order, then the charts ----
function show(parts) {
  main.replaceChildren();
  if (D.partial) main.append(note('Interrupted: this page is partial, as far as the work came.'));
  parts.forEach(f => f());
  drawAll();
}
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawAll);
function paper(on) {
  document.querySelectorAll('details').forEach(d => { d.open = on; });
  root.classList.toggle('paper', on);
  drawAll();
}
addEventListener('beforeprint', () => paper(true));
addEventListener('afterprint', () => paper(false));

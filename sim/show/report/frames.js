// Frame by frame
const ROWS = D.frames || [];
// what is drawn of each frame: unit, then name and figure of each line
const CHARTS = [
  ['Cycles', 'cycles a frame', [['cycles', r => r.cycles]]],
  ['Memory traffic', 'KB a frame', [['bytes', r => known(r.bytes) ? r.bytes / 1024 : null]]],
  ['Fragments', 'fragments', [['covered', r => r.fragments.covered], ['passed', r => r.fragments.depth_passed],
    ['written', r => r.fragments.written]]],
  ['Primitives', 'primitives', [['drawn', r => r.primitives.drawn], ['culled', r => r.primitives.culled],
    ['clipped', r => r.primitives.clipped]]],
  ['Left out', 'tiles and primitives', [['tiles behind HiZ', r => r.skipped.tiles_hiz],
    ['back faces', r => r.skipped.backface], ['outside the view', r => r.skipped.frustum]]],
  ['Time of this program', 'ms a frame', [['geometry', r => r.time_s.geometry * 1e3],
    ['raster', r => r.time_s.raster * 1e3]]],
].map(([title, unit, lines]) => [title, unit, lines.filter(([, of]) => ROWS.some(r => known(of(r))))])
  .filter(([, , lines]) => lines.length);
const NAMES = CHARTS.flatMap(([, , lines]) => lines.map(([name]) => name));
function style(name) {
  const lines = CHARTS.map(([, , l]) => l.map(([n]) => n)).find(l => l.includes(name)) || NAMES;
  const i = Math.max(0, lines.indexOf(name));
  return {colour: `--c${i % 7}`, dash: DASHES[i % DASHES.length], mark: MARKS[i % MARKS.length]};
}
const timed = ROWS.some(r => known(r.time));
const at = r => timed ? r.time : r.frame;
const range = lines => lines.map(([name, figure]) => {
  const values = ROWS.map(figure).filter(known);
  return `${name} ${fmt(Math.min(...values))} to ${fmt(Math.max(...values))}`;
}).join(', ');

function title() {
  main.append(h('h1', null, 'Frame by frame'), h('p', {class: 'sub'}, spans([
    D.scene && `Scene: ${D.scene}`, `${ROWS.length} frames of ${D.width} × ${D.height} pixels`, `Engine: ${D.engine}`,
    timed && `Time ${fmt(ROWS[0].time)} to ${fmt(ROWS[ROWS.length - 1].time)} s`])));
}
function pictures() {
  const boxes = CHARTS.map(([name, unit, lines]) => {
    const make = () => ({type: 'line',
      data: {datasets: lines.map(([line, of], i) =>
        ({...lineSet(line, i, ROWS.map(r => ({x: at(r), y: of(r)}))), pointRadius: ROWS.length > 80 ? 0 : 2}))},
      options: {interaction: byX, scales: {x: bareAxis(timed ? 'seconds' : 'frame', {type: 'linear'}),
        y: axis(unit, {beginAtZero: true})},
      plugins: tips(t => `${t.dataset.label}: ${fmt(t.parsed.y)}`, t => `${timed ? 'at' : 'frame'} ${fmt(t.parsed.x)}`)}});
    return h('div', {class: 'keep'}, h('h3', null, name), chart(`${name}, ${unit}, over the frames`, make),
      lines.length > 1 ? legend(lines.map(([line]) => line)) : '', note(range(lines)));
  });
  section('Over the frames', 'Each frame is a whole one: its clear, its primitives, its memory.',
    h('div', {class: 'grid'}, boxes));
}
function rows() {
  const head = [['frame', ...(timed ? ['time, s'] : []), 'drawn', 'culled', 'covered', 'written', 'cycles', 'bytes']];
  const body = ROWS.map(r => [String(r.frame), ...(timed ? [fmt(r.time)] : []), count(r.primitives.drawn),
    count(r.primitives.culled), count(r.fragments.covered), count(r.fragments.written), count(r.cycles), count(r.bytes)]);
  main.append(h('details', null, h('summary', null, 'All frames'), table('All frames', head, body)));
}
show([title, pictures, rows]);

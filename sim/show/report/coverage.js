// Functional coverage
const Chart = {defaults: {font: {}}};  // what page.js sets; this page has no charts
const T = D.totals;
const isHole = bin => bin.hits === 0 && bin.excluded === null;
const option = text => h('code', null, text);
const faults = bin => bin.faults.join(' ');

function title() {
  main.append(h('h1', null, 'Functional coverage'), h('p', {class: 'sub'}, spans([
    `${count(T.hit)} of ${count(T.hit + T.holes)} bins`, `${count(T.pairs_hit)} of ${count(T.pairs)} pairs of states`,
    `${count(D.runs.length)} runs`])));
}

function holes() {
  const bins = D.bins.filter(isHole);
  section('Never hit', bins.length ? 'Bins that this hardware has and no run has hit, with options of cosim that hit them.'
    : 'Every bin of this hardware is hit.', bins.length === 0 ? [] : table('Never hit',
    [['Bin', 'Meaning', 'Hit it with', 'Faults that need it']],
    bins.map(bin => [bin.name, bin.what, option(bin.hit_by), faults(bin)])));
}

function pairs() {
  const lead = 'Pairs of values of two draw states that this hardware can draw and no draw has had.';
  section('Never drawn together', D.missing_pairs.length ? lead : 'Every pair of values is drawn.',
    D.missing_pairs.length === 0 ? [] : table('Never drawn together', [['State', 'Other state', 'Draw it with']],
      D.missing_pairs.map(pair => [`${pair.a} ${pair.a_value}`, `${pair.b} ${pair.b_value}`, option(pair.hit_by)])));
}

function all() {
  section('All bins', 'Events counted over all runs; a dash: no run can hit the bin, for the reason given.',
    table('All bins', [['Bin', 'Hits', 'Meaning', 'Faults that need it']], D.bins.map(bin =>
      [bin.name, bin.excluded === null ? count(bin.hits) : '–', bin.excluded === null ? bin.what
        : `${bin.what} (${bin.excluded})`, faults(bin)])));
}

function runs() {
  section('Runs', 'The stimulus of each run.', table('Runs', [['Stimulus', 'Configuration', 'Seed', 'Command']],
    D.runs.map(run => [run.stimulus, run.config, String(run.seed), option(run.command)])));
}

show([title, holes, pairs, all, runs, () => foot()]);

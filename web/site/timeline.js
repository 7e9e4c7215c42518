// What `render --trace` says: which packet is in which stage from which cycle on.

// The timeline of a frame: rows of events { name, ts, dur } by stage.
export function timelineOf(result, stages) {
  const { traceEvents } = JSON.parse(new TextDecoder().decode(result.made['trace.json']));
  const rows = new Map();
  for (const event of traceEvents) if (event.name === 'thread_name') rows.set(event.tid, { name: event.args.name, events: [] });
  for (const event of traceEvents) if (event.ph === 'X') rows.get(event.tid).events.push(event);
  for (const row of rows.values()) row.events.sort((left, right) => left.ts - right.ts);
  const byStage = new Map();
  for (const row of rows.values()) {
    const [stage] = row.name.split(', ');
    byStage.set(stage, [...(byStage.get(stage) ?? []), row]);
  }
  const latency = Object.fromEntries(stages.json.stages.map((stage) => [stage.stage, Number.parseInt(stage.latency, 10)]));
  const { width, height, cycles } = result.json;
  const visits = byStage.get('depth_test')?.flatMap((row) => row.events) ?? [];
  return {
    result,
    byStage,
    latency,
    width,
    height,
    cycles,
    tile: result.json.config['tile.size'],
    visits,
    leaves(name, x, y) {
      const visit = visits.findLast(
        (event) => event.name === `${name}, tile (${Math.floor(x / this.tile)}, ${Math.floor(y / this.tile)})`,
      );
      return visit && visit.ts + visit.dur - 1;
    },
  };
}

// Events of a row that last over this cycle.
export function during(row, cycle) {
  let [low, high] = [0, row.events.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (row.events[middle].ts <= cycle) low = middle + 1;
    else high = middle;
  }
  return row.events.slice(Math.max(0, low - 8), low).filter(({ ts, dur }) => cycle < ts + dur);
}

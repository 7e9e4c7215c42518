// The engine in a worker, for a page that stays responsive: the interface of engine.mjs, each call a promise.

/// What a call that a later one took the place of is rejected with.
export class Stale extends Error {
  constructor() {
    super('a later request took its place');
    this.name = 'Stale';
  }
}

/// Resolves when the module is there. Calls wait for each other. Of calls with the same `topic` that still wait, only the last
/// is made; the others are rejected with Stale. frame() is a topic of its own.
export async function load(url = new URL('worker.mjs', import.meta.url)) {
  const worker = new Worker(url, { type: 'module' });
  const waiting = []; // { call, args, topic, resolve, reject }
  let current = null;
  let count = 0;

  function next() {
    if (current || waiting.length === 0) return;
    current = waiting.shift();
    worker.postMessage({ id: ++count, call: current.call, args: current.args });
  }
  worker.onmessage = ({ data: { result, error } }) => {
    const { resolve, reject } = current;
    current = null;
    if (error === undefined) resolve(result);
    else reject(new Error(error));
    next();
  };
  worker.onerror = (event) => {
    current?.reject(new Error(event.message || 'the worker could not be started'));
    current = null;
    next();
  };

  function ask(call, args, topic) {
    return new Promise((resolve, reject) => {
      const stale = topic === undefined ? -1 : waiting.findIndex((one) => one.topic === topic);
      if (stale >= 0) waiting.splice(stale, 1)[0].reject(new Stale());
      waiting.push({ call, args, topic, resolve, reject });
      next();
    });
  }

  await ask('ready', []);
  return {
    run: (args, files = {}, { topic } = {}) => ask('run', [args, files], topic),
    frame: (request, { topic = 'frame' } = {}) => ask('frame', [request], topic),
    close: () => worker.terminate(),
  };
}

// The engine in a worker of its own. client.mjs speaks to it: { id, call, args } in, { id, result } or { id, error } out.
import { load } from './engine.mjs';

const engine = load();

self.onmessage = async ({ data: { id, call, args } }) => {
  try {
    const halfplane = await engine;
    const result = call === 'ready' ? true : await halfplane[call](...args);
    const bytes = call === 'frame' ? [result.rgba.buffer] : [];
    self.postMessage({ id, result }, bytes);
  } catch (error) {
    self.postMessage({ id, error: error?.message ?? String(error) });
  }
};

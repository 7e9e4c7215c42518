// The program, compiled to WebAssembly: every figure of the page is a result of it.
import * as halfplane from './halfplane.js';

export class ProgramError extends Error {}

const bytesOf = (content) => (typeof content === 'string' ? new TextEncoder().encode(content) : content);
const quoted = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);

const results = new Map(); // by command and files, the last ones asked for at the end
const RESULTS_KEPT = 8;

// A run of a command with --json, or for its text alone: { args, command, files, status, stdout, json, made }. `made` are
// the files that it wrote. No word of `command` holds blanks. A wrong usage or bad input is a ProgramError with the
// program's one line.
export function run(command, files = {}, isJson = true) {
  const args = `${command} ${isJson ? '--json' : ''} --quiet`.split(' ').filter(Boolean);
  const key = JSON.stringify([
    args,
    Object.entries(files).map(([name, content]) => [
      name,
      typeof content === 'string' ? content : `${content.length} bytes of ${content.mark}`,
    ]),
  ]);
  const known = results.get(key);
  results.delete(key);
  const result = known ?? start(args, files, isJson);
  results.set(key, result);
  if (results.size > RESULTS_KEPT) results.delete(results.keys().next().value);
  return result;
}

async function start(args, files, isJson) {
  const given = Object.fromEntries(Object.entries(files).map(([name, content]) => [name, bytesOf(content)]));
  const { status, stdout, stderr, files: made } = await halfplane.run(args, given);
  // 1 says that a bound is broken, which the result states.
  if (status > 1) {
    const line = stderr.split('\n').find((text) => text.startsWith('halfplane: ')) ?? stderr;
    throw new ProgramError(line.replace('halfplane: ', '') || `halfplane ended with status ${status}`);
  }
  const json = isJson ? JSON.parse(stdout) : null;
  return { args, files, status, stdout, json, made, command: ['halfplane', ...args].map(quoted).join(' ') };
}

// Of the calls that come while one is under way only the last one is made.
export function latest(work) {
  let isBusy = false;
  let waiting = null;
  return async function ask(...values) {
    waiting = values;
    if (isBusy) return;
    isBusy = true;
    try {
      while (waiting) {
        const next = waiting;
        waiting = null;
        await work(...next);
      }
    } finally {
      isBusy = false;
    }
  };
}

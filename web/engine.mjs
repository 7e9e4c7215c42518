// Halfplane in JavaScript: the command line and live pictures, in a page, a worker or Node.js. web/README.md.

const decoder = new TextDecoder();
const encoder = new TextEncoder();

/// The bytes at a URL, uncompressed. Node.js cannot fetch files; some servers send .gz as what is in it.
async function bytesAt(url) {
  let bytes;
  if (url.protocol === 'file:' && typeof process === 'object') {
    const { readFile } = await import('node:fs/promises');
    bytes = await readFile(url);
  } else {
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
    bytes = new Uint8Array(await answer.arrayBuffer());
  }
  if (bytes[0] !== 0x1f || bytes[1] !== 0x8b) return bytes;
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}

/// What a run says, byte by byte.
class Said {
  #bytes = new Uint8Array(1 << 12);
  #size = 0;
  put(byte) {
    if (byte === null) return;
    if (this.#size === this.#bytes.length) {
      const larger = new Uint8Array(2 * this.#size);
      larger.set(this.#bytes);
      this.#bytes = larger;
    }
    this.#bytes[this.#size++] = byte;
  }
  take() {
    const text = decoder.decode(this.#bytes.subarray(0, this.#size));
    this.#size = 0;
    return text;
  }
}

/// Arguments of a live picture, a line each, as for `halfplane render`.
function words({ scene, config, set = {}, width, height, camera, convention, animation, light = [] }) {
  const list = [scene];
  if (config) list.push('--config', config);
  for (const [key, value] of Object.entries(set)) list.push('--set', `${key}=${value}`);
  if (width && height) list.push('--size', `${width}x${height}`);
  if (camera) list.push('--camera', camera);
  if (convention) list.push('--convention', convention);
  if (animation) list.push('--animation', animation);
  for (const one of [light].flat()) list.push('--light', one);
  return list.join('\n');
}

/// The folder under `folder`, as relative name -> bytes; `known` is what was put there and did not change.
function filesIn(FS, folder, known, prefix = '', found = {}) {
  for (const name of FS.readdir(folder)) {
    if (name === '.' || name === '..') continue;
    const path = `${folder}/${name}`;
    if (FS.isDir(FS.stat(path).mode)) {
      filesIn(FS, path, known, `${prefix}${name}/`, found);
      continue;
    }
    const bytes = FS.readFile(path);
    if (!isSame(known[prefix + name], bytes)) found[prefix + name] = bytes;
  }
  return found;
}

/// Strings and bytes; those of a worker are copies.
function isSame(a, b) {
  return a === b || (a !== undefined && typeof a !== 'string' && a.length === b.length && a.every((byte, i) => byte === b[i]));
}

const work = '/work';
const scenes = '/scenes'; // of live pictures

function putFile(FS, folder, name, bytes) {
  const slash = name.lastIndexOf('/');
  if (slash > 0) FS.mkdirTree(`${folder}/${name.slice(0, slash)}`);
  FS.writeFile(`${folder}/${name}`, bytes);
}

/// An instance of the module at `url`, the folder of halfplane.js and halfplane.wasm.gz.
export async function load(url = new URL('.', import.meta.url)) {
  const base = new URL(url, import.meta.url);
  const [{ default: Halfplane }, wasmBinary] =
      await Promise.all([import(new URL('halfplane.js', base).href), bytesAt(new URL('halfplane.wasm.gz', base))]);
  const compiled = await WebAssembly.compile(wasmBinary);

  const start = (out, err) => Halfplane({
    instantiateWasm(imports, ready) {
      WebAssembly.instantiate(compiled, imports).then((instance) => ready(instance, compiled));
      return {};
    },
    stdin: () => null,
    stdout: (byte) => out.put(byte),
    stderr: (byte) => err.put(byte),
    thisProgram: 'halfplane',
  });
  const ignored = new Said();
  const live = await start(ignored, ignored);
  let inLive = {}; // name -> bytes of the files of live pictures

  return {
    /// Runs `halfplane ARGS` in an empty folder with `files` in it (name -> string or bytes): in an instance of its own, so
    /// that nothing of one run is left for the next.
    async run(args, files = {}) {
      const out = new Said(), err = new Said();
      const module = await start(out, err);
      const { FS } = module;
      const known = {};
      FS.mkdir(work);
      FS.chdir(work);
      for (const [name, content] of Object.entries(files)) {
        known[name] = typeof content === 'string' ? encoder.encode(content) : content;
        putFile(FS, work, name, known[name]);
      }
      let status;
      try {
        status = module.callMain([...args]);
      } catch (error) {
        // The stack is full, or there is no more memory.
        return { status: 3, stdout: out.take(), stderr: `${err.take()}halfplane: the module stopped: ${error?.message ?? error}\n`, files: {} };
      }
      return { status, stdout: out.take(), stderr: err.take(), files: filesIn(FS, work, known) };
    },

    /// Draws a frame of a live picture: { width, height, rgba }. `turn`: part of the camera's orbit; `time`: seconds of the
    /// scene's animation. The other members are those of the command line; a scene of `files` is given by its name.
    frame({ turn = 1, time = -1, files = {}, ...request }) {
      const { FS } = live;
      if (Object.keys(files).some((name) => !isSame(inLive[name], files[name]))) {
        if (!FS.analyzePath(scenes).exists) FS.mkdir(scenes);
        for (const [name, content] of Object.entries(files)) putFile(FS, scenes, name, content);
        inLive = { ...files };
        live._live_close();
      }
      if (FS.analyzePath(scenes).exists) FS.chdir(scenes);
      const line = encoder.encode(`${words(request)}\0`);
      const at = live._malloc(line.length);
      live.HEAPU8.set(line, at);
      let size;
      try {
        size = live._live_frame(at, turn, time);
      } finally {
        live._free(at);
        FS.chdir('/');
        ignored.take();
      }
      if (size < 0) {
        const start = live._live_message();
        throw new Error(decoder.decode(live.HEAPU8.subarray(start, live.HEAPU8.indexOf(0, start))));
      }
      const width = size >>> 16, height = size & 0xffff, pixels = live._live_pixels();
      return { width, height, rgba: new Uint8ClampedArray(live.HEAPU8.slice(pixels, pixels + 4 * width * height).buffer) };
    },
  };
}

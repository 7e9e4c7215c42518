// Halfplane in JavaScript: the command line and live pictures, in a page, a worker or Node.js. web/README.md.

const decoder = new TextDecoder();
const encoder = new TextEncoder();

/// The bytes at a URL; Node.js cannot fetch files.
async function bytesAt(url) {
  if (url.protocol === 'file:' && typeof process === 'object') {
    const { readFile } = await import('node:fs/promises');
    return readFile(url);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
  return new Uint8Array(await answer.arrayBuffer());
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
    const before = known[prefix + name];
    if (!before || before.length !== bytes.length || before.some((byte, i) => byte !== bytes[i])) found[prefix + name] = bytes;
  }
  return found;
}

function removeFolder(FS, folder) {
  for (const name of FS.readdir(folder)) {
    if (name === '.' || name === '..') continue;
    const path = `${folder}/${name}`;
    if (FS.isDir(FS.stat(path).mode)) removeFolder(FS, path);
    else FS.unlink(path);
  }
  FS.rmdir(folder);
}

const work = '/work';
const scenes = '/scenes'; // of live pictures

function putFile(FS, folder, name, bytes) {
  const slash = name.lastIndexOf('/');
  if (slash > 0) FS.mkdirTree(`${folder}/${name.slice(0, slash)}`);
  FS.writeFile(`${folder}/${name}`, bytes);
}

/// An instance of the module at `url`, the folder of halfplane.js and halfplane.wasm.
export async function load(url = new URL('.', import.meta.url)) {
  const base = new URL(url, import.meta.url);
  const [{ default: Halfplane }, wasmBinary] =
      await Promise.all([import(new URL('halfplane.js', base).href), bytesAt(new URL('halfplane.wasm', base))]);
  const compiled = await WebAssembly.compile(wasmBinary);
  const out = new Said(), err = new Said();

  const start = () => Halfplane({
    instantiateWasm(imports, ready) {
      WebAssembly.instantiate(compiled, imports).then((instance) => ready(instance, compiled));
      return {};
    },
    stdin: () => null,
    stdout: (byte) => out.put(byte),
    stderr: (byte) => err.put(byte),
    thisProgram: 'halfplane',
  });
  let module = await start();
  let inLive = {}; // name -> bytes of the files of live pictures

  return {
    /// Runs `halfplane ARGS` in an empty folder with `files` in it (name -> string or bytes).
    async run(args, files = {}) {
      const { FS } = module;
      const known = {};
      FS.mkdir(work);
      FS.chdir(work);
      for (const [name, content] of Object.entries(files)) {
        known[name] = typeof content === 'string' ? encoder.encode(content) : content;
        putFile(FS, work, name, known[name]);
      }
      try {
        const status = module.callMain([...args]);
        return { status, stdout: out.take(), stderr: err.take(), files: filesIn(FS, work, known) };
      } catch (error) {
        // The module's memory may be in any state: the stack is full, or there is no more memory.
        const stderr = `${err.take()}halfplane: the module stopped: ${error?.message ?? error}\n`;
        const stdout = out.take();
        module = await start();
        inLive = {};
        return { status: 3, stdout, stderr, files: {} };
      } finally {
        if (module.FS.analyzePath(work).exists) {
          module.FS.chdir('/');
          removeFolder(module.FS, work);
        }
      }
    },

    /// Draws a frame of a live picture: { width, height, rgba }. `turn`: part of the camera's orbit; `time`: seconds of the
    /// scene's animation. The other members are those of the command line; a scene of `files` is given by its name.
    frame({ turn = 1, time = -1, files = {}, ...request }) {
      const { FS } = module;
      if (Object.keys(files).some((name) => inLive[name] !== files[name])) {
        if (!FS.analyzePath(scenes).exists) FS.mkdir(scenes);
        for (const [name, content] of Object.entries(files)) putFile(FS, scenes, name, content);
        inLive = { ...files };
        module._live_close();
      }
      if (FS.analyzePath(scenes).exists) FS.chdir(scenes);
      const line = encoder.encode(`${words(request)}\0`);
      const at = module._malloc(line.length);
      module.HEAPU8.set(line, at);
      let size;
      try {
        size = module._live_frame(at, turn, time);
      } finally {
        module._free(at);
        FS.chdir('/');
        err.take();
      }
      if (size < 0) {
        const start = module._live_message();
        throw new Error(decoder.decode(module.HEAPU8.subarray(start, module.HEAPU8.indexOf(0, start))));
      }
      const width = size >>> 16, height = size & 0xffff, pixels = module._live_pixels();
      return { width, height, rgba: new Uint8ClampedArray(module.HEAPU8.slice(pixels, pixels + 4 * width * height).buffer) };
    },
  };
}

// The scene that all views show: a built-in one, what the triangle or texture view draws, or a dropped file.
import { floor } from './texture.js';
import { capture } from './triangle.js';

export const dropped = { name: null, bytes: null };

export async function drop(file) {
  dropped.name = file.name.replaceAll(/[^\w.-]/g, '_');
  dropped.bytes = new Uint8Array(await file.arrayBuffer());
  dropped.bytes.mark = `${file.name} ${file.lastModified}`;
}

// { name, files, options, config }: what a command is given. Captures say their own size.
export function sceneOf(values) {
  const { scene, size, config } = values.page;
  const options = config === 'embedded' ? [] : ['--config', config];
  if (scene === 'drawn') return { name: 'drawn.hpt', files: { 'drawn.hpt': capture(values.triangle) }, options, config };
  if (scene === 'floor') return { name: 'floor.hpt', files: { 'floor.hpt': floor(values.texture) }, options, config };
  if (scene === 'dropped') {
    if (!dropped.name) throw new Error('a link does not hold a dropped file; open it, or choose another scene');
    const isCapture = dropped.name.endsWith('.hpt');
    return {
      name: dropped.name,
      files: { [dropped.name]: dropped.bytes },
      options: isCapture ? options : ['--size', size, ...options],
      config,
    };
  }
  return { name: scene, files: {}, options: ['--size', size, ...options], config };
}

// The scene that all views show: a built-in one, what the triangle or texture view draws, or a dropped file.
import { floor } from './texture.js';
import { capture } from './triangle.js';

export const dropped = { name: null, bytes: null };

export async function drop(file) {
  dropped.name = file.name.replaceAll(/[^\w.-]/g, '_');
  dropped.bytes = new Uint8Array(await file.arrayBuffer());
  dropped.bytes.mark = `${file.name} ${file.lastModified}`;
}

// A capture says its own size and view.
export const isCapture = ({ page }) =>
  ['drawn', 'floor'].includes(page.scene) || (page.scene === 'dropped' && /\.hpt$/.test(dropped.name));

// { name, files, options, view, config }: what a command is given. `options` are the view (size and camera) and the configuration.
export function sceneOf(values) {
  const { scene, size, turn, config } = values.page;
  const set = config === 'embedded' ? '' : `--config ${config}`;
  const view = `--size ${size} ${turn === '0' ? '' : `--camera orbit=${turn}`}`;
  if (scene === 'drawn')
    return { name: 'drawn.hpt', files: { 'drawn.hpt': capture(values.triangle) }, options: set, view: '', config };
  if (scene === 'floor')
    return { name: 'floor.hpt', files: { 'floor.hpt': floor(values.texture) }, options: set, view: '', config };
  if (scene === 'dropped') {
    if (!dropped.name) throw new Error('a link does not hold a dropped file; open it, or choose another scene');
    const files = { [dropped.name]: dropped.bytes };
    return isCapture(values)
      ? { name: dropped.name, files, options: set, view: '', config }
      : { name: dropped.name, files, options: `${view} ${set}`, view, config };
  }
  return { name: scene, files: {}, options: `${view} ${set}`, view, config };
}

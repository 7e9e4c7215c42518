// The program in a worker: what the page's modules import. web/README.md.
import { load } from './engine/client.mjs';

const halfplane = load();

export const run = async (...of) => (await halfplane).run(...of);

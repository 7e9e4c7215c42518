// Chromium on a served folder, and the native program to compare with.
import { spawnSync } from 'node:child_process';
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const MODULES = process.env.HALFPLANE_NODE_MODULES ?? path.resolve(import.meta.dirname, '../../build/web/node_modules');
const TYPES = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.css': 'text/css',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml',
};

// A server of files, as plain as any; `site` may be an address that is served already.
export async function serve(site) {
  if (/^https?:/.test(site)) return { address: site.replace(/\/?$/, '/'), close() {} };
  const server = http.createServer((request, response) => {
    const name = path.normalize(new URL(request.url, 'http://localhost').pathname).replace(/\/$/, '/index.html');
    const file = path.join(site, name);
    if (!fs.existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': TYPES[path.extname(file)] ?? 'application/octet-stream' });
    return fs.createReadStream(file).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

export async function launch() {
  const { default: puppeteer } = await import(
    pathToFileURL(path.join(MODULES, 'puppeteer-core/lib/esm/puppeteer/puppeteer-core.js'))
  );
  return puppeteer.launch({
    executablePath: process.env.HALFPLANE_CHROMIUM ?? '/usr/bin/chromium',
    headless: true,
    args: ['--no-sandbox', '--disable-gpu'],
  });
}

// The program's own result of a command: { status, stdout, stderr }.
export function runProgram(program, args, files) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'halfplane-web-'));
  for (const [name, content] of Object.entries(files)) fs.writeFileSync(path.join(folder, name), content);
  const { status, stdout, stderr } = spawnSync(path.resolve(program), args, {
    cwd: folder,
    maxBuffer: 1 << 28,
    encoding: 'utf8',
  });
  fs.rmSync(folder, { recursive: true });
  return { status, stdout, stderr };
}

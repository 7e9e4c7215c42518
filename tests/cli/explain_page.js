// Runs the page of `halfplane explain -o FILE.html` in Node.js with as much of a browser as it uses: hovers over every pixel,
// steps through every primitive, and prints what the page then says, as JSON. A page without pixels, that of `cover`, just
// says what it says. `node explain_page.js FILE.html`
'use strict';
const page = require('fs').readFileSync(process.argv[2], 'utf8');
const scripts = [...page.matchAll(/<script([^>]*)>([^]*?)<\/script>/g)];
const painted = {fillRect: 0, stroke: 0, arc: 0};

class Element {
  constructor(tag) { this.tag = tag; this.kids = []; this.attributes = {}; this.classList = {toggle() {}, contains: () => false}; }
  setAttribute(k, v) { this.attributes[k] = String(v); if (k === 'id') byId[v] = this; if (k === 'value') this.value = String(v); }
  append(...kids) { this.kids.push(...kids); }
  replaceChildren(...kids) { this.kids = kids; }
  get textContent() { return this.kids.map(k => k instanceof Element ? k.textContent : String(k)).join(' '); }
  set textContent(text) { this.kids = [text]; }
  getBoundingClientRect() { return {left: 0, top: 0, width: 900, height: 900}; }
  getContext() {
    return new Proxy({}, {get: (_, name) => (...a) => {
      if (name in painted) ++painted[name];
      if (a.some(v => typeof v === 'number' && !Number.isFinite(v))) throw new Error(`${String(name)} of ${a}`);
    }, set: () => true});
  }
}
const byId = {data: new Element('script'), main: new Element('main')};
byId.data.textContent = scripts.find(s => s[1].includes('application/json'))[2];
globalThis.document = {getElementById: id => byId[id], createElement: tag => new Element(tag), documentElement: new Element('html'),
  createElementNS: (_, tag) => new Element(tag), querySelectorAll: () => []};
globalThis.matchMedia = () => ({addEventListener() {}});
globalThis.addEventListener = () => {};
globalThis.getComputedStyle = () => ({getPropertyValue: () => '#000'});
globalThis.innerWidth = 1000;
const code = scripts.filter(s => !s[1].includes('application/json')).map(s => s[2]).join('\n');
(0, eval)(code.replace(/'use strict';/g, ''));

if (!byId.grid) {
  console.log(JSON.stringify({main: byId.main.textContent}));
  process.exit();
}
const data = JSON.parse(byId.data.textContent), w = data.window, hovered = [], steps = [];
byId.next.onclick();
for (let y = 0; y < w.height; ++y)
  for (let x = 0; x < w.width; ++x) {
    byId.grid.onmousemove({clientX: (x + .5) * 900 / w.width, clientY: (y + .5) * 900 / w.height});
    hovered.push(byId.history.textContent);
  }
byId.step.value = '0';
byId.step.oninput();
for (let i = 0; i < Number(byId.step.attributes.max); ++i) {
  steps.push(byId.drawn.textContent);
  byId.next.onclick();
}
steps.push(byId.drawn.textContent);
console.log(JSON.stringify({main: byId.main.textContent, hovered, steps, painted}));

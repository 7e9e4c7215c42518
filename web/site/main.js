// The page: its views, the link, the scene, errors.
import { fill, select, slider } from './controls.js';
import { element } from './elements.js';
import { ProgramError, latest, run } from './program.js';
import { drop, isCapture, sceneOf } from './scene.js';
import { choice, formatLink, matching, parseLink, whole } from './state.js';
import * as depth from './depth.js';
import * as pipeline from './pipeline.js';
import * as pixel from './pixel.js';
import * as texture from './texture.js';
import * as triangle from './triangle.js';

const views = { triangle, depth, pipeline, pixel, texture };
const page = {
  scene: matching('teapot', /^[\w:]+$/),
  size: choice('320x240', '16x16', '64x48', '160x120', '320x240', '640x480'),
  turn: whole(0, -180, 180), // degrees about the scene
  config: choice('embedded', 'tiny', 'small', 'embedded', 'full'),
};
const rules = { ...Object.fromEntries(Object.entries(views).map(([name, view]) => [name, view.rules])), page };

let state = parseLink(location.hash, rules);
let shown = null; // { name, root, update }
const main = document.querySelector('main');
main.rules = rules; // tests read this, the commands, and what the results are of
const sceneControls = document.querySelector('#scene');
const errorLine = document.querySelector('#error');
let linkTimer = null;
let commands = []; // whose results are shown

function say(error) {
  errorLine.hidden = !error;
  main.classList.toggle('stale', Boolean(error)); // what is shown is of an earlier state
  errorLine.textContent = error ?? '';
}

// What a view may use.
const context = {
  set: (changes) => set(state.view, changes),
  values: () => state.values,
  scene: () => sceneOf(state.values),
  async run(command, files, isJson) {
    const result = await run(command, files, isJson);
    if (!commands.includes(result)) commands.push(result);
    return result;
  },
};

function set(view, changes) {
  for (const [key, value] of Object.entries(changes))
    if (rules[view][key].accepts(String(value))) state.values[view][key] = String(value);
    else return say(`${key}: '${value}' is no value of it`);
  clearTimeout(linkTimer); // browsers refuse a link that changes with every move of the pointer
  linkTimer = setTimeout(() => history.replaceState(null, '', formatLink(state, rules)), 200);
  refresh();
}

// Shows the state: the controls at once, the program's results when they are there.
const results = latest(async () => {
  main.classList.add('busy');
  commands = [];
  const { update } = shown;
  try {
    await update(state.values[state.view]);
    if (update === shown.update) say(null);
  } catch (error) {
    if (!(error instanceof ProgramError)) console.error(error);
    if (update === shown.update) say(error.message);
  }
  main.classList.remove('busy');
  document.querySelector('#commands ul').replaceChildren(...commands.map(({ command }) => element('li', {}, command)));
  main.commands = commands;
  main.dataset.shown = formatLink(state, rules);
});

function refresh() {
  if (shown?.name !== state.view) open();
  fill(shown.root, state.values[state.view], views[state.view].disabled?.(state.values[state.view]));
  const { scene } = state.values.page;
  const names = sceneControls.querySelector('[data-key=scene]');
  if (![...names.options].some(({ value }) => value === scene)) names.append(element('option', { value: scene }, scene));
  const reason = 'a capture says its own size and view';
  fill(sceneControls, state.values.page, isCapture(state.values) ? { size: reason, turn: reason } : {});
  sceneControls.hidden = !views[state.view].showsScene;
  results();
}

function open() {
  shown?.close?.();
  const view = views[state.view];
  const root = element('div', { class: 'view' });
  main.replaceChildren(root);
  shown = { name: state.view, root, ...view.open(root, context) };
  document.title = `Halfplane: ${state.view}`;
  for (const link of document.querySelectorAll('nav a'))
    if (link.dataset.view === state.view) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
}

function show(view) {
  clearTimeout(linkTimer);
  state.view = view;
  history.pushState(null, '', formatLink(state, rules));
  refresh();
}

async function start() {
  document.querySelector('nav').append(
    ...Object.keys(views).map((name) =>
      element(
        'a',
        {
          href: `#view=${name}`,
          'data-view': name,
          onclick: (event) => {
            event.preventDefault();
            show(name);
          },
        },
        name,
      ),
    ),
  );
  const built = (await run('scenes')).json.scenes.map(({ name }) => name);
  const setPage = (changes) => set('page', changes);
  const open = element('input', {
    type: 'file',
    accept: '.hpt,.obj,.glb,.gltf',
    onchange: () => open.files[0] && take(open.files[0]),
  });
  sceneControls.append(
    select('scene', 'scene', [...built, 'drawn', 'floor', 'dropped'], setPage, {
      drawn: 'drawn (triangle view)',
      floor: 'floor (texture view)',
      dropped: 'a file',
    }),
    select('size', 'size', page.size.values, setPage),
    slider('turn', 'turn', { ...page.turn, step: 5 }, setPage),
    select('config', 'configuration', page.config.values, setPage),
    element('label', { class: 'control' }, 'open a file', open),
  );
  refresh();
}

async function take(file) {
  await drop(file);
  if (!views[state.view].showsScene) state.view = 'pixel';
  set('page', { scene: 'dropped' });
}

addEventListener('hashchange', () => {
  state = parseLink(location.hash, rules);
  refresh();
});
addEventListener('popstate', () => {
  state = parseLink(location.hash, rules);
  refresh();
});
addEventListener('resize', () => refresh());
addEventListener('dragover', (event) => {
  event.preventDefault();
  document.body.classList.add('dropping');
});
addEventListener('dragleave', () => document.body.classList.remove('dropping'));
addEventListener('drop', (event) => {
  event.preventDefault();
  document.body.classList.remove('dropping');
  if (event.dataTransfer.files[0]) take(event.dataTransfer.files[0]);
});
start().catch((error) => say(error.message));

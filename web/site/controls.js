// Controls of the page. Each changes one key of the state; `set` is given the change.
import { element } from './elements.js';

let count = 0;
function labelled(label, control, extra = null) {
  control.id = `control-${++count}`;
  return element('div', { class: 'control' }, element('label', { for: control.id }, label), control, extra);
}

// `names`: what a value is called, where that is not the value.
export function select(key, label, values, set, names = {}) {
  const control = element(
    'select',
    { 'data-key': key, onchange: () => set({ [key]: control.value }) },
    values.map((value) => element('option', { value }, names[value] ?? value)),
  );
  return labelled(label, control);
}

// select() for the keys of a view, whose values its rules have.
export const picker = (rules, set) => (key, label, names) => select(key, label, rules[key].values, set, names);

export function slider(key, label, { least, most, step = 1 }, set) {
  const control = element('input', {
    type: 'range',
    min: least,
    max: most,
    step,
    'data-key': key,
    oninput: () => set({ [key]: control.value }),
  });
  return labelled(label, control, element('output', { for: '' }));
}

// A slider over powers of ten: the state holds the number in two digits.
export function powerSlider(key, label, { least, most }, set) {
  const control = element('input', {
    type: 'range',
    min: Math.log10(least),
    max: Math.log10(most),
    step: 0.05,
    'data-key': key,
    'data-power': true,
    oninput: () => set({ [key]: String(Number((10 ** control.value).toPrecision(2))) }),
  });
  return labelled(label, control, element('output', { for: '' }));
}

export const button = (label, action, attributes = {}) =>
  element('button', { type: 'button', onclick: action, ...attributes }, label);

export const group = (title, ...controls) => element('fieldset', {}, element('legend', {}, title), controls);

// Puts the state into the controls below `root`. `disabled`: keys that mean nothing in this state, and why.
export function fill(root, state, disabled = {}) {
  for (const control of root.querySelectorAll('[data-key]')) {
    const { key, power } = control.dataset;
    if (!(key in state)) continue;
    const value = power === undefined ? state[key] : String(Math.log10(Number(state[key])));
    if (document.activeElement !== control || control.type !== 'range') control.value = value;
    const output = control.parentNode.querySelector('output');
    if (output) output.textContent = state[key];
    control.setAttribute('aria-valuetext', state[key]);
    control.disabled = key in disabled;
    control.title = disabled[key] ?? control.title;
  }
}

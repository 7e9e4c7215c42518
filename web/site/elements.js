// Elements of the page, and figures that say where in a result of the program they come from.

export function element(tag, attributes = {}, ...children) {
  const node = tag.startsWith('svg:')
    ? document.createElementNS('http://www.w3.org/2000/svg', tag.slice(4))
    : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

export const valueAt = (json, path) => path.split('/').reduce((value, key) => value?.[key], json);

// Whole numbers, texts and small fractions as they are, other numbers in four significant digits.
export function format(value) {
  if (value === null || value === undefined) return '–';
  if (Array.isArray(value)) return value.map(format).join(' ');
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (typeof value !== 'number' || Number.isInteger(value)) return String(value);
  const size = Math.abs(value);
  return size >= 1e-4 && size < 1e7 ? String(Number(value.toPrecision(size >= 1000 ? 8 : 4))) : value.toExponential(3);
}

// A figure of `result` (of program.js) at a path such as 'pixels/0/final/model/depth'. Tests read both attributes.
export const figure = (result, path) =>
  element('span', { 'data-command': result.command, 'data-path': path, class: 'figure' }, format(valueAt(result.json, path)));

export const table = (head, rows, attributes = {}) =>
  element(
    'div',
    { class: 'scroll', tabindex: '0' },
    element(
      'table',
      attributes,
      element(
        'thead',
        {},
        element(
          'tr',
          {},
          head.map((text) => element('th', { scope: 'col' }, text)),
        ),
      ),
      element(
        'tbody',
        {},
        rows.map(([first, ...rest]) =>
          element(
            'tr',
            {},
            element('th', { scope: 'row' }, first),
            rest.map((cell) => element('td', {}, cell)),
          ),
        ),
      ),
    ),
  );

export const list = (...pairs) =>
  element(
    'dl',
    {},
    pairs.filter(Boolean).map(([name, ...value]) => [element('dt', {}, name), element('dd', {}, value)]),
  );

// A picture that the program wrote.
export async function picture(bytes) {
  return createImageBitmap(new Blob([bytes], { type: 'image/png' }));
}

export function image(bytes, alternative) {
  const url = URL.createObjectURL(new Blob([bytes], { type: 'image/png' }));
  return element('img', { src: url, alt: alternative, onload: () => URL.revokeObjectURL(url) });
}

// What the page shows is a table of strings a view. The link's fragment holds what differs from the start:
// #view=triangle&sub=2&pixel.x=160 is the shown view, its keys, and keys of the other views with their name.

// A key's rule: its start and whether a text is a value of it.
export const choice = (start, ...values) => ({ start, values, accepts: (text) => values.includes(text) });
export const whole = (start, least, most) => ({
  start: String(start),
  least,
  most,
  accepts: (text) => /^-?\d+$/.test(text) && Number(text) >= least && Number(text) <= most,
});
export const real = (start, least, most) => ({
  start: String(start),
  least,
  most,
  accepts: (text) => /^-?\d+(\.\d+)?(e-?\d+)?$/.test(text) && Number(text) >= least && Number(text) <= most,
});
export const matching = (start, pattern) => ({ start, accepts: (text) => pattern.test(text) });

export const starts = (rules) => Object.fromEntries(Object.entries(rules).map(([key, rule]) => [key, rule.start]));

// `rules`: the rules of each view by its name. Keys and values that no rule knows are left out.
export function parseLink(fragment, rules) {
  const words = new URLSearchParams(fragment.replace(/^#/, ''));
  const names = Object.keys(rules);
  const view = names.includes(words.get('view')) ? words.get('view') : names[0];
  const values = Object.fromEntries(names.map((name) => [name, starts(rules[name])]));
  for (const [word, text] of words) {
    const [name, key] = word.includes('.') ? word.split('.', 2) : [view, word];
    if (rules[name]?.[key]?.accepts(text)) values[name][key] = text;
  }
  return { view, values };
}

export function formatLink({ view, values }, rules) {
  const words = new URLSearchParams({ view });
  for (const name of [view, ...Object.keys(rules).filter((other) => other !== view)])
    for (const [key, rule] of Object.entries(rules[name]))
      if (values[name][key] !== rule.start) words.set(name === view ? key : `${name}.${key}`, values[name][key]);
  return '#' + words.toString().replaceAll('%2C', ',');
}

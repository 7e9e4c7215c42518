// Contrast of the style sheet's colours, by WCAG 2.2: 4.5 for text, 3 for marks.
const TEXT = [
  ['ink', 'paper'],
  ['ink', 'paper-panel'],
  ['ink-muted', 'paper'],
  ['ink-muted', 'paper-panel'],
  ['ink-link', 'paper'],
  ['ink-link', 'paper-panel'],
  ['ink-on-accent', 'paper-accent'],
  ['ink-error', 'paper-error'],
  ...['first', 'second', 'third', 'double', 'crack', 'idle', 'works', 'waits'].map((paper) => ['ink', `paper-${paper}`]),
];

function luminance(color) {
  const [red, green, blue] = [1, 3, 5].map((start) => {
    const part = parseInt(color.slice(start, start + 2), 16) / 255;
    return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

export function contrast(one, other) {
  const [dark, light] = [luminance(one), luminance(other)].sort((left, right) => left - right);
  return (light + 0.05) / (dark + 0.05);
}

export function contrastFailures(css) {
  const colors = Object.fromEntries([...css.matchAll(/--([\w-]+): (#[0-9a-f]{6});/g)].map(([, name, color]) => [name, color]));
  const marks = Object.keys(colors)
    .filter((name) => name.startsWith('mark-'))
    .map((name) => [name, 'paper']);
  const used = new Set([...TEXT, ...marks].flat());
  return [
    ...Object.keys(colors)
      .filter((name) => !used.has(name))
      .map((name) => `--${name} has no pair whose contrast is held`),
    ...[
      [TEXT, 4.5],
      [marks, 3],
      [[['paper-accent', 'paper']], 3],
    ].flatMap(([pairs, least]) =>
      pairs
        .filter(([one, other]) => !(contrast(colors[one], colors[other]) >= least))
        .map(
          ([one, other]) =>
            `--${one} on --${other}: contrast ${contrast(colors[one], colors[other]).toFixed(2)}, at least ${least}`,
        ),
    ),
  ];
}

// A canvas of enlarged pixels: cells, figures in them, outlines, handles; pointer and arrow keys.
import { element } from './elements.js';

// The style sheet's colours by their name without the dashes.
export const colors = new Proxy(
  {},
  { get: (_, name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim() },
);

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Grid {
  figures = []; // { text, path, command } of the figures in the cells: tests read them
  onmove = null; // (dx, dy, isFar): an arrow key, with shift or without
  ongrab = null; // (x, y, reach): the pointer goes down; gives what follows its moves, or null

  constructor(label) {
    this.canvas = element('canvas', { tabindex: '0', role: 'application', 'aria-label': label });
    this.canvas.grid = this;
    this.pen = this.canvas.getContext('2d');
    this.canvas.addEventListener('keydown', (event) => {
      if (!(event.key in ARROWS) || !this.onmove) return;
      event.preventDefault();
      this.onmove(...ARROWS[event.key], event.shiftKey);
    });
    let drag = null;
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      // A finger covers some 22 pixels of the screen either way.
      drag = this.ongrab?.(...this.placeOf(event), (event.pointerType === 'touch' ? 24 : 16) / this.cellSize) ?? null;
    });
    this.canvas.addEventListener('pointermove', (event) => drag?.(...this.placeOf(event)));
    this.canvas.addEventListener('pointerup', () => {
      drag = null;
    });
    this.canvas.addEventListener('pointercancel', () => {
      drag = null;
    });
  }

  placeOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return [((event.clientX - box.left) / box.width) * this.width, ((event.clientY - box.top) / box.height) * this.height];
  }

  // Pixels of the picture; as large as the place beside it and the window's height allow.
  resize(width, height) {
    const room = Math.min(this.canvas.parentNode.clientWidth - 2, (Math.max(300, innerHeight - 190) * width) / height);
    this.cellSize = Math.max(2, room / width);
    const ratio = devicePixelRatio || 1;
    Object.assign(this, { width, height });
    this.canvas.width = Math.round(width * this.cellSize * ratio);
    this.canvas.height = Math.round(height * this.cellSize * ratio);
    this.canvas.style.width = `${width * this.cellSize}px`;
    this.pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.pen.imageSmoothingEnabled = false;
  }

  cell(x, y, color, alpha = 1) {
    this.pen.globalAlpha = alpha;
    this.pen.fillStyle = color;
    this.pen.fillRect(x * this.cellSize, y * this.cellSize, this.cellSize, this.cellSize);
    this.pen.globalAlpha = 1;
  }

  lines() {
    this.pen.strokeStyle = colors['mark-line'];
    this.pen.lineWidth = 0.5;
    this.pen.beginPath();
    for (let x = 0; x <= this.width; x++) {
      this.pen.moveTo(x * this.cellSize, 0);
      this.pen.lineTo(x * this.cellSize, this.height * this.cellSize);
    }
    for (let y = 0; y <= this.height; y++) {
      this.pen.moveTo(0, y * this.cellSize);
      this.pen.lineTo(this.width * this.cellSize, y * this.cellSize);
    }
    this.pen.stroke();
  }

  // A figure at the bottom of its cell, a long one above and below the sample; with a frame of that colour or without.
  text(x, y, text, frameColor, { path, result }) {
    this.figures.push({ text, path, command: result.command });
    const most = this.cellSize - 4;
    const font = (size) => `${frameColor ? 'bold ' : ''}${size}px system-ui, "Liberation Sans", sans-serif`;
    this.pen.font = font(10);
    const half = Math.ceil(text.length / 2);
    const parts = text.length > 6 ? [text.slice(0, half), text.slice(half)] : [text];
    const widest = Math.max(...parts.map((part) => this.pen.measureText(part).width));
    this.pen.font = font(Math.min(16, this.cellSize * 0.32, (10 * most) / widest));
    this.pen.fillStyle = colors.ink;
    this.pen.textAlign = 'center';
    this.pen.textBaseline = 'alphabetic';
    parts
      .reverse()
      .forEach((part, line) => this.pen.fillText(part, (x + 0.5) * this.cellSize, (y + 0.94 - 0.57 * line) * this.cellSize));
    if (frameColor) this.frame(x + 0.06, y + 0.06, 0.88, frameColor, '', 2);
  }

  dot(x, y, isFilled) {
    this.pen.beginPath();
    this.pen.arc(x * this.cellSize, y * this.cellSize, Math.max(1.2, Math.min(3.5, this.cellSize / 14)), 0, 2 * Math.PI);
    this.pen.lineWidth = 1;
    this.pen.strokeStyle = this.pen.fillStyle = colors.ink;
    if (isFilled) this.pen.fill();
    else this.pen.stroke();
  }

  frame(x, y, size, color, name, thickness) {
    this.pen.strokeStyle = color;
    this.pen.lineWidth = thickness;
    this.pen.strokeRect(x * this.cellSize, y * this.cellSize, size * this.cellSize, size * this.cellSize);
    if (!name) return;
    this.pen.font = '600 13px system-ui, "Liberation Sans", sans-serif';
    this.pen.textAlign = 'left';
    this.pen.textBaseline = 'top';
    this.pen.fillStyle = colors['ink-muted'];
    this.pen.fillText(name, x * this.cellSize + 5, y * this.cellSize + 4);
  }

  outline(points, color, isDashed) {
    this.pen.beginPath();
    points.forEach(([x, y]) => this.pen.lineTo(x * this.cellSize, y * this.cellSize));
    this.pen.closePath();
    this.pen.setLineDash(isDashed ? [5, 4] : []);
    this.pen.strokeStyle = color;
    this.pen.lineWidth = isDashed ? 1 : 2;
    this.pen.stroke();
    this.pen.setLineDash([]);
  }

  handle(x, y, name, isChosen) {
    const [atX, atY] = [x, y].map((value) => value * this.cellSize);
    this.pen.beginPath();
    this.pen.arc(atX, atY, 11, 0, 2 * Math.PI);
    this.pen.globalAlpha = 0.9;
    this.pen.fillStyle = isChosen ? colors['paper-accent'] : colors.paper;
    this.pen.fill();
    this.pen.globalAlpha = 1;
    this.pen.strokeStyle = colors['paper-accent'];
    this.pen.lineWidth = 2;
    this.pen.stroke();
    this.pen.fillStyle = isChosen ? colors['ink-on-accent'] : colors.ink;
    this.pen.font = '600 13px system-ui, "Liberation Sans", sans-serif';
    this.pen.textAlign = 'center';
    this.pen.textBaseline = 'middle';
    this.pen.fillText(name, atX, atY + 0.5);
  }

  drawCursor(x, y) {
    this.frame(x, y, 1, colors['paper-accent'], '', 3);
  }

  picture(bitmap) {
    this.pen.drawImage(bitmap, 0, 0, this.width * this.cellSize, this.height * this.cellSize);
  }
}

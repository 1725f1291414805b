'use strict';

// An axis for each column, a line for each point, and ranges of axes that choose points.

const kTop = 44;
const kBottom = 24;
const kAxisGap = 112; // pixels between axes, at least
const kStep = 0.05; // of an axis, for keys

/** Place of a share 0 .. 1 of an axis. */
function heightOf(share) {
  const height = element('axes').clientHeight;
  return height - kBottom - share * (height - kTop - kBottom);
}

function acrossOf(index) {
  const width = element('axes').clientWidth;
  return columns.length === 1 ? width / 2 : kAxisGap / 2 + (index * (width - kAxisGap)) / (columns.length - 1);
}

function shareOf(column, value) {
  const {low, high} = rangeOf(column);
  return (value - low) / (high - low);
}

function drawLine(pen, row) {
  let joined = false;
  pen.beginPath();
  columns.forEach((column, index) => {
    const value = column.value(row);
    if (value !== null) pen[joined ? 'lineTo' : 'moveTo'](acrossOf(index), heightOf(shareOf(column, value)));
    joined = value !== null;
  });
  pen.stroke();
}

function drawLines() {
  const canvas = element('lines');
  const box = element('axes');
  const scale = window.devicePixelRatio;
  Object.assign(canvas, {width: box.clientWidth * scale, height: box.clientHeight * scale});
  const pen = canvas.getContext('2d');
  pen.scale(scale, scale);
  const chosen = new Set(chosenRows());
  const colour = rampColours();
  pen.strokeStyle = styleColour('line');
  for (const row of withFigures) if (!chosen.has(row)) drawLine(pen, row);
  pen.globalAlpha = chosen.size > 100 ? 0.5 : 0.85;
  pen.lineWidth = 1.4;
  for (const row of withFigures) {
    pen.strokeStyle = colour(row);
    if (chosen.has(row)) drawLine(pen, row);
  }
  pen.globalAlpha = 1;
  pen.lineWidth = 3.5;
  pen.strokeStyle = styleColour('ink');
  if (withFigures.includes(state.point)) drawLine(pen, state.point);
  canvas.dataset.chosen = chosen.size;
}

/** The words of a title in lines of a few letters. */
function linesOf(title) {
  const lines = [];
  for (const word of title.split(/[ .]/)) {
    if (lines.length && `${lines.at(-1)} ${word}`.length <= 16) lines.push(`${lines.pop()} ${word}`);
    else lines.push(word);
  }
  return lines;
}

function endText(column, value) {
  return column.names ? column.names[value] : shown(value, 3);
}

function rangeText(column) {
  const {low, high} = rangeOf(column);
  const [from, to] = state.ranges[column.name] ?? [low, high];
  const inner = column.names?.filter((_, i) => i >= from && i <= to).join(', ');
  return inner ?? `${shown(from)} to ${shown(to)}`;
}

function scaleOf(column, index) {
  const x = acrossOf(index);
  const {low, high} = rangeOf(column);
  const [top, bottom] = [heightOf(1), heightOf(0)];
  const parts = linesOf(column.title).slice(0, 2).map((line, i) => (
    drawn('text', {class: 'name', x, y: 12 + 13 * i}, line)));
  parts.push(drawn('text', {x, y: top - 4}, endText(column, high)), drawn('text', {x, y: bottom + 15}, endText(column, low)),
             drawn('line', {x1: x, x2: x, y1: top, y2: bottom}));
  const range = state.ranges[column.name];
  if (range) {
    const [from, to] = range.map((value) => heightOf(clamp(shareOf(column, value), 0, 1)));
    parts.push(drawn('rect', {class: 'range', x: x - 8, width: 16, y: to, height: Math.max(from - to, 2)}));
  }
  parts.push(drawn('rect', {class: 'grip', x: x - 16, width: 32, y: top - 8, height: bottom - top + 16, rx: 4}));
  return drawn('g', {id: `scale-${index}`, tabindex: 0, role: 'slider', 'aria-label': column.title,
                     'aria-orientation': 'vertical', 'aria-valuemin': low, 'aria-valuemax': high,
                     'aria-valuenow': range ? range[0] : low, 'aria-valuetext': rangeText(column)}, ...parts);
}

function showScales() {
  const focused = document.activeElement?.id;
  element('scales').replaceChildren(...columns.map(scaleOf));
  if (focused?.startsWith('scale-')) element(focused).focus();
  const chosen = chosenRows().length;
  element('brushed').textContent = chosen === rows.length ? `All ${rows.length} points` : `${chosen} of ${counted(rows.length, 'point')}`;
  element('clear').disabled = chosen === rows.length;
}

function placeIn(event) {
  const box = element('axes').getBoundingClientRect();
  return {x: event.clientX - box.left, y: event.clientY - box.top};
}

function valueAt(column, y) {
  const {low, high} = rangeOf(column);
  const share = clamp((heightOf(0) - y) / (heightOf(0) - heightOf(1)), 0, 1);
  return low + share * (high - low);
}

/** The row whose line is nearest to a place between axes, and near. */
function rowAt({x, y}) {
  const left = clamp(columns.findLastIndex((_, index) => acrossOf(index) <= x), 0, columns.length - 2);
  const share = (x - acrossOf(left)) / (acrossOf(left + 1) - acrossOf(left));
  let best = null;
  let least = 12; // pixels
  for (const row of chosenRows()) {
    const [a, b] = [columns[left], columns[left + 1]].map((column) => {
      const value = column.value(row);
      return value === null ? NaN : heightOf(shareOf(column, value));
    });
    const distance = Math.abs(a + share * (b - a) - y);
    if (distance < least) [best, least] = [row, distance];
  }
  return best;
}

let drag = null; // {column, from}: y where it began

function listenToPointerOnAxes() {
  const box = element('axes');
  box.addEventListener('pointerdown', (event) => {
    const index = Number(event.target.closest('g')?.id.slice('scale-'.length) ?? -1);
    if (index < 0) return;
    drag = {column: columns[index], from: placeIn(event).y};
    box.setPointerCapture(event.pointerId);
  });
  box.addEventListener('pointermove', (event) => {
    if (!drag || Math.abs(placeIn(event).y - drag.from) < 4) return;
    const ends = [drag.from, placeIn(event).y].map((y) => valueAt(drag.column, y));
    chooseRange(drag.column.name, ends.sort((a, b) => a - b));
  });
  box.addEventListener('pointerup', (event) => {
    const point = drag ? null : rowAt(placeIn(event));
    if (drag && Math.abs(placeIn(event).y - drag.from) < 4) chooseRange(drag.column.name, null);
    drag = null;
    if (point) choose({point});
  });
  box.addEventListener('pointercancel', () => { drag = null; });
}

/** Whether an axis has taken the key. */
function axisKey(target, key, shift) {
  const column = columns[Number(target.id?.match(/^scale-(\d+)$/)?.[1] ?? -1)];
  if (!column) return false;
  const {low, high} = rangeOf(column);
  let [from, to] = state.ranges[column.name] ?? [low, high];
  const step = column.names ? 1 : kStep * (high - low);
  if (key === 'Delete' || key === 'Backspace' || key === 'Escape') [from, to] = [low, high];
  else if (key === 'ArrowUp' && shift) to = Math.min(to + step, high);
  else if (key === 'ArrowUp') from = Math.min(from + step, to);
  else if (key === 'ArrowDown' && shift) from = Math.max(from - step, low);
  else if (key === 'ArrowDown') to = Math.max(to - step, from);
  else return false;
  chooseRange(column.name, from <= low && to >= high ? null : [from, to]);
  return true;
}

function layOutAxes() {
  element('axes').style.minWidth = `${columns.length * kAxisGap}px`;
  showScales();
  drawLines();
}

function setUpParallelAxes() {
  if (withFigures.length === 0 || columns.length < 2) return;
  element('parallel').hidden = false;
  listenToPointerOnAxes();
  element('clear').addEventListener('click', () => choose({ranges: {}}));
  layOutAxes();
  whenever(['ranges'], showScales);
  whenever(['ranges', 'point', 'z'], drawLines);
  new ResizeObserver(layOutAxes).observe(element('axes-box'));
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawLines);
}

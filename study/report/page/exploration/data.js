'use strict';

// What the page knows: a row for each point, and the columns that differ between them.

const data = JSON.parse(document.getElementById('data').textContent);
const rows = data.rows;
const inOrder = [...rows].sort((a, b) => a.number - b.number);

/** A property that the space varies: numbers, or names that are numbered in the order of the space. */
function axisColumn(name, index) {
  const texts = [...new Set(inOrder.map((row) => row.values[index]))];
  const numeric = texts.every((text) => text.trim() !== '' && Number.isFinite(Number(text)));
  return {
    name, title: name, better: 0, names: numeric ? null : texts,
    value: (row) => (numeric ? Number(row.values[index]) : texts.indexOf(row.values[index])),
    text: (row) => row.values[index],
  };
}

function figureColumn({name, title, more_is_better: more}, index) {
  const value = (row) => row.figures[index];
  const around = (half) => (half === null ? '' : ` ± ${shown(half, 2)}`);
  const text = (row) => shown(value(row)) + around(row.half_widths[index]);
  return {name, title, better: more ? 1 : -1, names: null, value, text};
}

const allColumns = [...data.axes.map(axisColumn), ...data.columns.map(figureColumn)];

for (const column of allColumns) {
  const values = rows.map(column.value).filter((value) => value !== null);
  column.range = {low: Math.min(...values), high: Math.max(...values), count: values.length};
}

function rangeOf(column) {
  return column.range;
}

/** Those that differ between points. */
const columns = allColumns.filter((column) => {
  const {low, high, count} = rangeOf(column);
  return count > 0 && low < high;
});

function columnOf(name) {
  return allColumns.find((column) => column.name === name);
}

const withFigures = rows.filter((row) => row.figures.some((value) => value !== null));
const lastRung = Math.max(...rows.map((row) => row.rung));

/** Whether the figures of a row are of a shorter clip than those of others, so that they cannot be compared with them. */
function isDropped(row) {
  return row.rung > 0 && row.rung < lastRung;
}

/** The properties that differ and that the row has, as "schedule tiled, sensor.bit_depth 8". */
function nameOf(row) {
  const parts = data.axes.map((name, i) => [name, row.values[i]])
    .filter(([name, value]) => value !== '' && columns.some((column) => column.name === name))
    .map(([name, value]) => `${name} ${value}`);
  return parts.join(', ') || row.values.slice(0, 4).join(', ');
}

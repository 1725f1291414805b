'use strict';

// What the reader has chosen: columns, ranges of columns, the order of the table, a point.

/** The first of these columns that differs between points, else any. */
function firstOf(names, others) {
  const differing = columns.map((column) => column.name);
  return names.find((name) => differing.includes(name)) ??
    differing.find((name) => !others.includes(name)) ?? names[0];
}

const state = (() => {
  const x = firstOf(['slots_per_second', 'megabits_per_second'], ['psnr_db']);
  const z = firstOf(['energy_uj_per_slot'], [x, 'psnr_db']);
  return {x, y: 'psnr_db', z, ranges: {}, sort: {name: '', down: true}, point: withFigures[0] ?? rows[0] ?? null, most: 200};
})();

/** The rows within all ranges. */
function chosenRows() {
  const ranges = Object.entries(state.ranges).map(([name, range]) => [columnOf(name), range]);
  return rows.filter((row) => ranges.every(([column, [low, high]]) => {
    const value = column.value(row);
    return value !== null && value >= low && value <= high;
  }));
}

/** null: all. */
function chooseRange(name, range) {
  const ranges = {...state.ranges};
  delete ranges[name];
  if (range) ranges[name] = range;
  choose({ranges});
}

/** The chosen rows in the order of the table: best first, or by a column; rows without a value last. Dropped
 * points lie below the others. */
function sortedRows() {
  const sorted = sortedAlike(chosenRows());
  return [...sorted.filter((row) => !isDropped(row)), ...sorted.filter(isDropped)];
}

function sortedAlike(chosen) {
  const column = columnOf(state.sort.name);
  if (!column && state.sort.name !== 'number') return chosen;
  const value = column ? column.value : (row) => row.number;
  const sign = state.sort.down ? -1 : 1;
  return chosen.sort((a, b) => {
    const [p, q] = [value(a), value(b)];
    return p === null || q === null ? (p === null) - (q === null) : sign * (p - q);
  });
}

function movePoint(step) {
  const order = sortedRows();
  const at = order.indexOf(state.point);
  if (order.length) choose({point: order[clamp(at + step, 0, order.length - 1)]});
}

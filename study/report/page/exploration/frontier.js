'use strict';

// A chart of two columns with the points that no other one beats in both, and a third column as colour.

/** Parts red, green and blue of a colour of the style, 0 .. 255. */
function partsOf(name) {
  return styleColour(name).match(/[0-9a-f]{2}/gi).map((part) => parseInt(part, 16));
}

/** A function: the colour of a row by the column of the ramp. */
function rampColours() {
  const column = columnOf(state.z);
  const {low, high} = rangeOf(column);
  const [from, to] = [partsOf('series-1'), partsOf('series-2')];
  return (row) => {
    const value = column.value(row);
    if (value === null || isDropped(row)) return styleColour('line');
    const share = high > low ? (value - low) / (high - low) : 0;
    return `rgb(${from.map((part, i) => Math.round(part + share * (to[i] - part))).join(' ')})`;
  };
}

/** Rows that no other row equals or beats in both columns, by their x; none where a column has no better end. */
function frontierOf(some, x, y) {
  if (!x.better || !y.better) return [];
  const known = some.filter((row) => !isDropped(row) && x.value(row) !== null && y.value(row) !== null);
  known.sort((a, b) => x.better * (x.value(b) - x.value(a)) || y.better * (y.value(b) - y.value(a)));
  const frontier = [];
  for (const row of known) {
    const last = frontier.at(-1);
    if (!last || y.better * (y.value(row) - y.value(last)) > 0) frontier.push(row);
  }
  return frontier;
}

/** Rows that no other row equals or beats in all of the chosen columns with a better end, but in being the same. */
function unbeatenOf(some) {
  const ends = [...new Set([state.x, state.y, state.z])].map(columnOf).filter((column) => column.better);
  const known = some.filter((row) => !isDropped(row) && ends.length && ends.every((column) => column.value(row) !== null));
  const scores = known.map((row) => ends.map((column) => column.better * column.value(row)));
  const beats = (a, b) => a.every((score, i) => score >= b[i]) && a.some((score, i) => score > b[i]);
  return new Set(known.filter((_, i) => !scores.some((other) => beats(other, scores[i]))));
}

let unbeaten = {key: null, rows: new Set()}; // it takes long for thousands of rows

function unbeatenRows(some) {
  const key = [state.ranges, state.x, state.y, state.z];
  if (unbeaten.key?.every((part, i) => part === key[i])) return unbeaten.rows;
  unbeaten = {key, rows: unbeatenOf(some)};
  return unbeaten.rows;
}

function frontierAxis(column) {
  const scale = axis(column.title, {type: 'linear', grace: '5%'});
  if (column.names) {
    scale.ticks.stepSize = 1;
    scale.ticks.callback = (value) => column.names[value] ?? '';
  }
  return scale;
}

function pointOptions(some, best) {
  const colour = rampColours();
  const size = (row) => (row === state.point ? 9 : best.has(row) ? 6.5 : 4);
  return {
    pointRadius: some.map(size), pointHoverRadius: some.map((row) => size(row) + 2),
    pointBackgroundColor: some.map(colour),
    pointBorderColor: some.map((row) => styleColour(row === state.point ? 'ink' : 'card')),
    pointBorderWidth: some.map((row) => (row === state.point ? 3 : 1)),
  };
}

function frontierChart() {
  const [x, y] = [columnOf(state.x), columnOf(state.y)];
  const some = chosenRows().filter((row) => x.value(row) !== null && y.value(row) !== null);
  const frontier = frontierOf(some, x, y);
  const place = (row) => ({x: x.value(row), y: y.value(row), row});
  const options = chartOptions({x: frontierAxis(x), y: frontierAxis(y)}, {
    interaction: {mode: 'nearest', intersect: false},
    onClick: (event, found) => { if (found.length) choose({point: found[0].element.$context.raw.row}); },
  });
  options.plugins.legend.display = false;
  options.plugins.tooltip = {
    filter: (item) => item.raw.row !== undefined,
    callbacks: {title: () => '', label: ({raw: {row}}) => [`${row.number}: ${nameOf(row)}`,
      ...[state.x, state.y, state.z].map((name) => `${columnOf(name).title}: ${columnOf(name).text(row)}`)]},
  };
  return {
    type: 'scatter',
    data: {datasets: [
      {data: some.map(place), ...pointOptions(some, unbeatenRows(some))},
      {type: 'line', data: frontier.map(place), borderColor: styleColour('quiet'), borderWidth: 1.5, borderDash: [5, 4],
       pointRadius: 0, pointHitRadius: 0}]},
    options,
  };
}

function showFrontier() {
  const [x, y, z] = [state.x, state.y, state.z].map(columnOf);
  showChart('frontier-chart', frontierChart);
  const {low, high} = rangeOf(z);
  element('ramp-low').textContent = endText(z, low);
  element('ramp-high').textContent = endText(z, high);
  const best = frontierOf(chosenRows(), x, y);
  const end = ({better, title}) => `${better > 0 ? 'more' : 'less'} ${title}`;
  const line = best.length === 0 ? 'One of the axes has no better end, so there is no frontier.' :
    `The line joins the ${counted(best.length, 'point')} (${best.map((row) => row.number).sort((a, b) => a - b).join(', ')}) ` +
    `that no other one beats: ${end(x)}; ${end(y)}.`;
  element('frontier-hint').textContent = `${line} Larger points are unbeaten with the colour too. A click chooses a point.` +
    (rows.some(isDropped) ? ' Grey points were dropped on a shorter clip.' : '');
}

function setUpFrontier() {
  if (withFigures.length === 0) return;
  element('frontier').hidden = false;
  for (const key of ['x', 'y', 'z']) {
    const known = allColumns.filter((column) => columns.includes(column) || column.name === state[key]);
    const select = element(`${key}-column`);
    fillSelect(select, known.map((column) => ({value: column.name, text: column.title})), state[key]);
    select.addEventListener('change', () => choose({[key]: select.value}));
  }
  whenever(['x', 'y', 'z', 'ranges', 'point'], showFrontier);
}

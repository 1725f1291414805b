'use strict';

// A region of the pictures with its statistics, and the light along a line. What the pointer draws is
// chosen by `state.tool`; Shift draws a region and Alt a line whatever it is.

function toolOf(event) {
  if (event.shiftKey) return 'region';
  if (event.altKey) return 'line';
  return state.tool;
}

/** The shown pictures that have light: {name, codes}. */
async function shownLight() {
  const sides = state.a === state.b ? ['a'] : ['a', 'b'];
  const found = await Promise.all(sides.map(async (side) => {
    const view = viewOf(side);
    return {name: view.name, codes: await view.codes?.(state.slot)};
  }));
  return found.filter(({codes}) => codes);
}

/** Mean, standard deviation, least and most luminance of the pixels of a region. */
function statisticsOf(codes, {row, col, rows, cols}) {
  let [sum, squares, least, most] = [0, 0, Infinity, 0];
  for (let r = row; r < row + rows; ++r)
    for (let c = col; c < col + cols; ++c) {
      const light = luminanceAt(codes, r * area.cols + c);
      sum += light;
      squares += light * light;
      least = Math.min(least, light);
      most = Math.max(most, light);
    }
  const count = rows * cols;
  const average = sum / count;
  return {count, mean: average, deviation: Math.sqrt(Math.max(squares / count - average * average, 0)), least, most};
}

async function showRegion() {
  const {region} = state;
  element('region').hidden = !region;
  if (!region) return;
  element('region-name').textContent = `rows ${region.row + area.first_row} to ${region.row + area.first_row + region.rows - 1}, ` +
    `columns ${region.col + area.first_col} to ${region.col + area.first_col + region.cols - 1}, slot ${state.slot}`;
  const pictures = await shownLight();
  const rows = pictures.map(({name, codes}) => {
    const {count, mean: average, deviation, least, most} = statisticsOf(codes, region);
    const snr = deviation > 0 ? `${(20 * Math.log10(average / deviation)).toFixed(1)} dB` : '–';
    return [name, `${count}`, shown(average), shown(deviation, 3), shown(least), shown(most), snr];
  });
  fillTable(element('region-table'), [['picture', 'pixels', 'mean', 'standard deviation', 'least', 'most',
                                       'mean / deviation'], ...rows]);
}

/** The pixels of a line, one for each step along its longer side. */
function pixelsOfLine({from, to}) {
  const steps = Math.max(Math.abs(to.row - from.row), Math.abs(to.col - from.col), 1);
  return Array.from({length: steps + 1}, (_, i) => ({
    row: Math.round(from.row + ((to.row - from.row) * i) / steps),
    col: Math.round(from.col + ((to.col - from.col) * i) / steps)}));
}

function profileChart(pictures, pixels) {
  const points = (codes) => pixels.map(({row, col}, x) => ({x, y: luminanceAt(codes, row * area.cols + col)}));
  return () => ({
    type: 'line',
    data: {datasets: pictures.map(({name, codes}, i) => ({
      label: name, data: points(codes), borderColor: styleColour(`series-${i + 1}`),
      backgroundColor: styleColour(`series-${i + 1}`), borderWidth: 1.5, pointRadius: 0, stepped: 'middle'}))},
    options: chartOptions({x: axis('pixel along the line', {type: 'linear', max: pixels.length - 1}),
                           y: axis('light (luminance)', {beginAtZero: true})}),
  });
}

async function showProfile() {
  const {line} = state;
  element('profile').hidden = !line;
  if (!line) return;
  const name = ({row, col}) => `row ${row + area.first_row}, column ${col + area.first_col}`;
  element('profile-name').textContent = `${name(line.from)} to ${name(line.to)}, slot ${state.slot}`;
  showChart('profile-chart', profileChart(await shownLight(), pixelsOfLine(line)));
}

/** The rectangle between two pixels, both included. */
function regionBetween(a, b) {
  return {row: Math.min(a.row, b.row), col: Math.min(a.col, b.col),
          rows: Math.abs(a.row - b.row) + 1, cols: Math.abs(a.col - b.col) + 1};
}

function showMarks() {
  const {pixel, region, line} = state;
  const marks = () => [
    ...(pixel ? [drawn('rect', {class: 'pixel', x: pixel.col, y: pixel.row, width: 1, height: 1})] : []),
    ...(region ? [drawn('rect', {class: 'region', x: region.col, y: region.row, width: region.cols, height: region.rows})] : []),
    ...(line ? [drawn('line', {class: 'line', x1: line.from.col + 0.5, y1: line.from.row + 0.5,
                               x2: line.to.col + 0.5, y2: line.to.row + 0.5})] : [])];
  for (const side of ['a', 'b']) element(`marks-${side}`).replaceChildren(...marks());
}

/** A drag draws what the tool says, or moves a zoomed picture; a click chooses a pixel. */
function listenToDrags() {
  const stage = element('stage');
  let drag = null;
  stage.addEventListener('pointerdown', (event) => {
    if (event.button !== 0 || element('divider').contains(event.target)) return;
    const layer = layerAt(event);
    drag = {layer, tool: toolOf(event), from: pixelAt(placeIn(layer, event)), last: placeIn(layer, event), moved: false};
    stage.setPointerCapture(event.pointerId);
  });
  stage.addEventListener('pointermove', (event) => {
    if (!drag) return;
    const place = placeIn(drag.layer, event);
    const [right, down] = [place.x - drag.last.x, place.y - drag.last.y];
    if (!drag.moved && Math.hypot(right, down) < 0.006) return;
    drag.moved = true;
    if (drag.tool === 'region') choose({region: regionBetween(drag.from, pixelAt(place))});
    else if (drag.tool === 'line') choose({line: {from: drag.from, to: pixelAt(place)}});
    else pan(right, down);
    drag.last = place;
  });
  stage.addEventListener('pointerup', () => {
    if (drag && !drag.moved) choosePixel(drag.from.row, drag.from.col);
    drag = null;
  });
  stage.addEventListener('pointercancel', () => { drag = null; });
}

function setUpSelection() {
  listenToDrags();
  element('tool').addEventListener('change', (event) => choose({tool: event.target.value}));
  element('region-close').addEventListener('click', () => choose({region: null}));
  element('profile-close').addEventListener('click', () => choose({line: null}));
  whenever(['pixel', 'region', 'line'], showMarks);
  whenever(['region', 'slot', 'a', 'b', 'pictures'], showRegion);
  whenever(['line', 'slot', 'a', 'b', 'pictures'], showProfile);
}

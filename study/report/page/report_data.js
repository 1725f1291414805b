'use strict';

// What the page knows, and questions about it.

const data = JSON.parse(document.getElementById('data').textContent);
const area = data.area ?? {rows: 0, cols: 0, planes: 1, first_row: 0, first_col: 0};
const pixelCount = area.rows * area.cols;
const featuredRun = data.videos[data.featured]?.run ?? 0;

/** Light of each code of a picture. */
const lightOfCode = (() => {
  const table = new Float64Array(65536);
  const {darkest, codes_per_stop: perStop} = data.light_code ?? {darkest: 1, codes_per_stop: 1};
  for (let code = 1; code < table.length; ++code) table[code] = darkest * 2 ** ((code - 1) / perStop);
  return table;
})();

/** The slot whose picture stands for this one: some may be left out. */
function pictureSlot(slot) {
  return slot - (slot % data.picture_step);
}

function picture(video, slot) {
  return plane(`v${video}-${pictureSlot(slot)}`);
}

/** The response of a pixel of the area to an exposure. */
function responseOf(run, pixel, {light_slots: lightSlots, readout}) {
  const {response_rows: rows, response_cols: cols, responses} = run.samples;
  const row = (pixel.row + area.first_row) % rows;
  const col = (pixel.col + area.first_col) % cols;
  return responses[readout][row * cols + col][lightSlots];
}

/** Mean light of a slot of the exposure and its standard deviation, by the sensor's calibration. */
function lightOfSample(response, dn, lightSlots) {
  const saturated = dn >= response.saturated_dn;
  const sum = saturated ? response.bound : response.zero + response.per_dn * dn;
  const variance = response.dark_variance + response.variance_per_light * Math.max(sum, 0);
  return {dn, saturated, light: sum / lightSlots, deviation: Math.sqrt(variance) / lightSlots};
}

/** Planes of DN of a stream: a mosaic of colours has one. */
function dnPlanes(run) {
  return run.filter ? 1 : area.planes;
}

/** The DN that are read at the end of a slot, pixel by pixel; null if there are none. */
function dnPlane(runIndex, slot) {
  return plane(`r${runIndex}d-${slot}`, dnPlanes(data.runs[runIndex]));
}

/** Which of the DN of a pixel measures this colour; -1 if none does. */
function dnIndex(run, pixel, colour) {
  if (!run.filter) return colour;
  const row = (pixel.row + area.first_row) % 2;
  const col = (pixel.col + area.first_col) % 2;
  return run.filter[2 * row + col] === colour ? 0 : -1;
}

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

/** Light of a pixel in all pictures of a video, as [slot, light]. */
async function lightOverTime(video, pixel, colour) {
  const at = colour * pixelCount + pixel.row * area.cols + pixel.col;
  const points = [];
  for (let slot = 0; slot < data.slots; slot += data.picture_step) {
    const codes = await picture(video, slot);
    if (codes) points.push([slot, lightOfCode[codes[at]]]);
  }
  return points;
}

/** The response of a pixel of the area to an exposure with so many open slots. */
function responseOf(run, pixel, lightSlots) {
  const {response_rows: rows, response_cols: cols, responses} = run.samples;
  const row = (pixel.row + area.first_row) % rows;
  const col = (pixel.col + area.first_col) % cols;
  return responses[row * cols + col][lightSlots];
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

/** The sample of a pixel that is read at the end of `slot`, or null. */
async function sampleAt(runIndex, slot, pixel, colour) {
  const run = data.runs[runIndex];
  const index = dnIndex(run, pixel, colour);
  const kinds = index < 0 ? null : await plane(`r${runIndex}k-${slot}`);
  const at = pixel.row * area.cols + pixel.col;
  if (!kinds || kinds[at] === 0) return null;
  const dn = await dnPlane(runIndex, slot);
  let before = 0;
  for (let i = 0; i < at; ++i) before += kinds[i] > 0;
  const exposure = run.samples.exposures[kinds[at] - 1];
  const first = slot - exposure.span_slots + 1;
  const response = responseOf(run, pixel, exposure.light_slots);
  return {first, slot, exposure,
          ...lightOfSample(response, dn[before * dnPlanes(run) + index], exposure.light_slots)};
}

/** All samples of a pixel, by the slot in which they are read. */
async function samplesOverTime(runIndex, pixel, colour) {
  const samples = [];
  for (let slot = 0; slot < data.slots; ++slot) {
    const sample = await sampleAt(runIndex, slot, pixel, colour);
    if (sample) samples.push(sample);
  }
  return samples;
}

'use strict';

// What a report has in itself: planes, packed as report/report_page.h says, and what they tell of a pixel.

function bytesOfBase64(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Adds up the differences from the value `step` before; the lowest bit of each is its sign. */
function valuesOf(bytes, step) {
  const count = bytes.length / 2;
  const values = new Uint16Array(count);
  for (let i = 0; i < count; ++i) {
    const folded = bytes[i] | (bytes[count + i] << 8);
    const difference = folded & 1 ? -((folded + 1) >> 1) : folded >> 1;
    values[i] = (i < step ? 0 : values[i - step]) + difference;
  }
  return values;
}

async function broughtPlane(id, step) {
  const text = document.getElementById(id)?.textContent;
  if (text?.startsWith('=')) return plane(text.slice(1), step); // equals that one
  return text ? valuesOf(await inflated(bytesOfBase64(text)), step) : null;
}

/** The slots that charts show: [first, end]. */
function chartSlots() {
  return [0, data.slots];
}

/** Further views of allViews. */
function furtherViews() {
  return [];
}

/** What is to be said of a picture beside its name. */
function pictureNote() {
  return '';
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
  const response = responseOf(run, pixel, exposure);
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

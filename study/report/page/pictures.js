'use strict';

// Pictures of light, of samples and of errors, as pixels of a canvas.

const kErrorRange = 0.25; // light, at exposure 0
const kNoSample = [22, 25, 32];

async function lightImage(video, slot) {
  const codes = await picture(video, slot);
  if (!codes) return null;
  const {red, green, blue, single} = displayOfCodes();
  const image = new ImageData(area.cols, area.rows);
  const second = area.planes === 3 ? pixelCount : 0;
  for (let i = 0; i < pixelCount; ++i) {
    const code = single ? codeOfLight(luminanceAt(codes, i)) : codes[i];
    image.data[4 * i] = red[code];
    image.data[4 * i + 1] = green[single ? code : codes[i + second]];
    image.data[4 * i + 2] = blue[single ? code : codes[i + 2 * second]];
    image.data[4 * i + 3] = 255;
  }
  return image;
}

/** What the chip delivers at the end of a slot; other pixels go on exposing. */
async function sampleImage(runIndex, slot) {
  const run = data.runs[runIndex];
  const image = new ImageData(area.cols, area.rows);
  const kinds = await plane(`r${runIndex}k-${slot}`);
  const dn = await dnPlane(runIndex, slot);
  const planes = dnPlanes(run);
  const {red, green, blue} = displayOfCodes();
  for (let i = 0, next = 0; i < pixelCount; ++i) {
    image.data.set([...kNoSample, 255], 4 * i);
    if (!kinds || kinds[i] === 0) continue;
    const exposure = run.samples.exposures[kinds[i] - 1];
    const response = responseOf(run, {row: Math.floor(i / area.cols), col: i % area.cols}, exposure);
    for (const [colour, table] of [red, green, blue].entries()) {
      const value = dn[next + Math.min(colour, planes - 1)];
      const {light} = lightOfSample(response, value, exposure.light_slots);
      image.data[4 * i + colour] = table[codeOfLight(Math.max(light, 0))];
    }
    next += planes;
  }
  return image;
}

/** Blue where the video is too dark, orange where it is too bright; `x` is -1..1. */
function errorColour(x) {
  const stops = x < 0 ? [[0, 0, 0], [26, 95, 180], [90, 200, 255]] : [[0, 0, 0], [194, 65, 12], [255, 195, 107]];
  const at = Math.min(Math.abs(x), 1) * 2;
  const low = Math.min(Math.floor(at), 1);
  return stops[low].map((from, i) => from + (at - low) * (stops[low + 1][i] - from));
}

const errorTable = Array.from({length: 513}, (_, i) => errorColour((i - 256) / 256));

async function errorImage(video, slot, stops) {
  const codes = await picture(video, slot);
  const truth = await picture(data.truth, slot);
  if (!codes || !truth) return null;
  const gain = 2 ** stops / kErrorRange / area.planes;
  const image = new ImageData(area.cols, area.rows);
  for (let i = 0; i < pixelCount; ++i) {
    let error = 0;
    for (let at = i; at < codes.length; at += pixelCount) error += lightOfCode[codes[at]] - lightOfCode[truth[at]];
    const x = Math.max(-1, Math.min(1, error * gain));
    image.data.set([...errorTable[Math.round(256 + 256 * x)], 255], 4 * i);
  }
  return image;
}

/** All that a picture can show: {id, name, image(slot, stops), kind}, and of light its codes(slot). */
function allViews() {
  const lights = data.videos.map((video, i) => (
    {id: `light-${i}`, name: video.name, kind: 'light', image: (slot) => lightImage(i, slot),
     codes: (slot) => picture(i, slot)}));
  const samples = data.runs.map((run, i) => (
    {id: `samples-${i}`, name: `samples, ${run.name}`, kind: 'samples', image: (slot) => sampleImage(i, slot)}));
  const errors = data.truth === null ? [] : data.videos.map((video, i) => (
    {id: `error-${i}`, name: `error, ${video.name}`, kind: 'error',
     image: (slot, stops) => errorImage(i, slot, stops)})).filter((_, i) => i !== data.truth);
  return [...lights, ...samples, ...errors, ...furtherViews()];
}

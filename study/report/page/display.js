'use strict';

// How light becomes the colour of a screen: a tone curve, or light between two limits.

/** As io/tone_map.h: Reinhard's curve with a white point, then the power 1/2.2. */
function toneMapped(light) {
  const white = data.white_light;
  const x = Math.min(light, white);
  return 255 * ((x * (1 + x / (white * white))) / (1 + x)) ** (1 / 2.2);
}

const kFalseColours = ['#30123b', '#4454c4', '#448ffe', '#1fc8de', '#29efa2', '#7dff56', '#c1f334', '#f1ca3a',
                       '#fe922a', '#ea4f0d', '#be2102', '#7a0403'] // Turbo, Google Research 2019
  .map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));

/** A colour of kFalseColours, `x` is 0..1. */
function falseColour(x) {
  const at = clamp(x, 0, 1) * (kFalseColours.length - 1);
  const low = Math.min(Math.floor(at), kFalseColours.length - 2);
  return kFalseColours[low].map((from, i) => from + (at - low) * (kFalseColours[low + 1][i] - from));
}

/** Grey, or red, green and blue, of light by each display. */
const kDisplays = {
  tone: {name: 'tone curve', show: (light) => toneMapped(light * 2 ** state.stops)},
  linear: {name: 'linear', limits: true,
           show: (light) => 255 * clamp((light - state.low) / (state.high - state.low), 0, 1)},
  gamma: {name: 'power 1/2.2', limits: true,
          show: (light) => 255 * clamp((light - state.low) / (state.high - state.low), 0, 1) ** (1 / 2.2)},
  log: {name: 'logarithmic', limits: true,
        show: (light) => 255 * clamp(Math.log(Math.max(light, 1e-9) / lowLog()) / Math.log(state.high / lowLog()), 0, 1)},
  colour: {name: 'false colour', limits: true, single: true,
           show: (light) => falseColour((light - state.low) / (state.high - state.low))},
};

/** Zero has no logarithm. */
function lowLog() {
  return Math.max(state.low, state.high / 4096);
}

let displayTable = {key: ''};

/** By code: {red, green, blue}, and whether a picture is shown by its luminance alone (`single`). */
function displayOfCodes() {
  const {display, stops, low, high} = state;
  const key = [display, stops, low, high].join();
  if (displayTable.key === key) return displayTable;
  const [red, green, blue] = [0, 1, 2].map(() => new Uint8ClampedArray(65536));
  const {show, single} = kDisplays[display];
  for (let code = 0; code < 65536; ++code) {
    if (code > 0 && lightOfCode[code] > 1e9) { // brighter than any sensor tells
      for (const table of [red, green, blue]) table.fill(table[code - 1], code);
      break;
    }
    const colour = show(lightOfCode[code]);
    red[code] = colour[0] ?? colour;
    green[code] = colour[1] ?? colour;
    blue[code] = colour[2] ?? colour;
  }
  displayTable = {key, red, green, blue, single: Boolean(single)};
  return displayTable;
}

/** The code of light. */
function codeOfLight(light) {
  const {darkest, codes_per_stop: perStop} = data.light_code;
  return light < darkest ? 0 : Math.min(65535, 1 + Math.round(perStop * Math.log2(light / darkest)));
}

/** Rec. 709 luminance of a pixel of a picture, or its light. */
function luminanceAt(codes, pixel) {
  if (area.planes === 1) return lightOfCode[codes[pixel]];
  return 0.2126 * lightOfCode[codes[pixel]] + 0.7152 * lightOfCode[codes[pixel + pixelCount]] +
    0.0722 * lightOfCode[codes[pixel + 2 * pixelCount]];
}

/** Light below which a part of the pixels lies. */
function quantile(sorted, part) {
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
}

/** The limits that leave out the darkest and the brightest thousandth of the left picture. */
async function limitsOfPicture() {
  const view = viewOf('a');
  const codes = view.codes ? await view.codes(state.slot) : null;
  if (!codes) return;
  const sorted = codes.slice().sort();
  const [low, high] = [lightOfCode[quantile(sorted, 0.001)], lightOfCode[quantile(sorted, 0.999)]];
  chooseLimits(low, Math.max(high, low + 1e-4));
}

function chooseLimits(low, high) {
  if (Number.isFinite(low) && Number.isFinite(high) && high > low && low >= 0) choose({low, high});
  showLimits();
}

function showLimits() {
  element('low').value = shown(state.low, 3);
  element('high').value = shown(state.high, 3);
}

/** Steps of an eighth of a stop: how many values of the left picture have such light. */
async function showHistogram() {
  const canvas = element('histogram');
  const codes = await viewOf('a').codes?.(state.slot);
  const context = canvas.getContext('2d');
  context.clearRect(0, 0, canvas.width, canvas.height);
  if (!codes) return;
  const step = data.light_code.codes_per_stop / 8;
  const counts = new Map();
  for (const code of codes) counts.set(Math.floor(code / step), (counts.get(Math.floor(code / step)) ?? 0) + 1);
  const bins = [...counts.keys()].filter((bin) => bin > 0);
  const [first, last] = [Math.min(...bins, codeOfLight(state.low) / step), Math.max(...bins, codeOfLight(state.high) / step) + 1];
  const highest = Math.max(...counts.values());
  const xOf = (bin) => ((bin - first) / (last - first)) * canvas.width;
  context.fillStyle = styleColour('series-1');
  for (const bin of bins) {
    const height = Math.max(1, (counts.get(bin) / highest) * canvas.height);
    context.fillRect(xOf(bin), canvas.height - height, Math.max(1, xOf(bin + 1) - xOf(bin) - 1), height);
  }
  if (!kDisplays[state.display].limits) return;
  context.fillStyle = styleColour('sample');
  for (const light of [state.low, state.high]) context.fillRect(xOf(codeOfLight(light) / step) - 1, 0, 2, canvas.height);
}

function setUpDisplay() {
  fillSelect(element('display'), Object.entries(kDisplays).map(([value, {name}]) => ({value, text: name})), state.display);
  element('display').addEventListener('change', (event) => choose({display: event.target.value}));
  for (const id of ['low', 'high'])
    element(id).addEventListener('change', () => chooseLimits(Number(element('low').value), Number(element('high').value)));
  element('limits-auto').addEventListener('click', limitsOfPicture);
  whenever(['display'], () => {
    const limits = Boolean(kDisplays[state.display].limits);
    element('limits').hidden = !limits;
    element('stops').disabled = limits;
    element('display').value = state.display;
  });
  whenever(['low', 'high'], showLimits);
  whenever(['slot', 'a', 'display', 'low', 'high', 'pictures'], showHistogram);
}

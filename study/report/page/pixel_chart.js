'use strict';

// A pixel over time: its light in each video, and its samples with their error bars.

const kColours = ['red', 'green', 'blue'];
let shownSamples = [];
let pixelRequest = 0;

/** The open slots of a sample as [first, end]. */
function openRuns(sample) {
  return sample.exposure.open.map(([first, slots]) => [sample.first + first, sample.first + first + slots]);
}

function drawErrorBar(ctx, x, low, high) {
  ctx.beginPath();
  ctx.moveTo(x, low);
  ctx.lineTo(x, high);
  for (const y of [low, high]) {
    ctx.moveTo(x - 3, y);
    ctx.lineTo(x + 3, y);
  }
  ctx.stroke();
}

/** A saturated sample points upwards. */
function drawBound(ctx, x, y) {
  ctx.beginPath();
  ctx.moveTo(x - 5, y - 3);
  ctx.lineTo(x + 5, y - 3);
  ctx.lineTo(x, y - 11);
  ctx.fill();
}

function drawSample(chart, sample) {
  const {ctx, scales: {x, y}} = chart;
  const floor = y.type === 'logarithmic' ? y.min : -Infinity;
  const at = (light) => y.getPixelForValue(Math.max(light, floor));
  const [low, high] = [at(sample.light - sample.deviation), at(sample.light + sample.deviation)];
  for (const [first, end] of openRuns(sample)) {
    const [left, right] = [x.getPixelForValue(first), x.getPixelForValue(end)];
    ctx.globalAlpha = 0.16;
    if (!sample.saturated) ctx.fillRect(left, high, right - left, low - high);
    ctx.globalAlpha = 1;
    ctx.fillRect(left + 1, at(sample.light) - 1.25, right - left - 2, 2.5);
  }
  const middle = x.getPixelForValue((sample.first + sample.slot + 1) / 2);
  if (sample.saturated) drawBound(ctx, middle, at(sample.light));
  else drawErrorBar(ctx, middle, low, high);
}

const sampleBars = {
  id: 'sampleBars',
  afterDatasetsDraw(chart) {
    const {ctx, chartArea: box} = chart;
    ctx.save();
    ctx.beginPath();
    ctx.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    ctx.clip();
    ctx.fillStyle = ctx.strokeStyle = styleColour('sample');
    for (const sample of shownSamples) drawSample(chart, sample);
    ctx.restore();
  },
};

/** Light has the unit of the footage; the sensor says how many electrons that is. */
function lightTitle() {
  const calibration = data.runs[state.run]?.stream.calibration;
  return calibration ? `light (1.0: ${shown(calibration.electrons_per_unit)} e per slot)` : 'light';
}

function pixelChart(lines) {
  const lights = lines.flatMap((line) => line.points.map(([, y]) => y));
  const highest = Math.max(1e-3, ...shownSamples.map((s) => s.light + s.deviation), ...lights);
  const lowest = Math.min(highest, ...[...lights, ...shownSamples.map((s) => s.light)].filter((y) => y > 0));
  const lightAxis = () => {
    const scale = axis(lightTitle(), state.log ? {type: 'logarithmic', min: Math.max(lowest / 2, highest / 3000)}
                                               : {type: 'linear', beginAtZero: true, suggestedMax: highest * 1.05});
    scale.ticks.format = {minimumFractionDigits: 0};
    return scale;
  };
  return () => ({
    type: 'line',
    data: {datasets: [
      ...lines.map(({video, points}) => slotLine(
        data.videos[video].name, points, videoColour(video),
        {borderDash: videoDash(video), borderWidth: video === data.truth ? 2.5 : 1.75})),
      ...(shownSamples.length ? [slotLine('samples ± 1 σ', [], styleColour('sample'))] : [])]},
    options: chartOptions({x: slotAxis(), y: lightAxis()}, {showSlot: true}),
    plugins: [sampleBars],
  });
}

function fillPixelTable(samples, lines) {
  const truth = lines.find(({video}) => video === data.truth);
  const mean = (sample) => {
    const open = truth.points.filter(([slot]) => openRuns(sample).some(([first, end]) => slot >= first && slot < end));
    return shown(open.reduce((sum, [, light]) => sum + light, 0) / open.length);
  };
  const head = ['slots', 'open slots', 'DN', 'light', '± 1 σ', ...(truth ? ['truth'] : [])];
  fillTable(element('pixel-table'), [head, ...samples.map((sample) => [
    sample.first === sample.slot ? `${sample.slot}` : `${sample.first} to ${sample.slot}`,
    `${sample.exposure.light_slots}`, `${sample.dn}${sample.saturated ? ', saturated' : ''}`,
    `${sample.saturated ? '≥ ' : ''}${shown(sample.light)}`, shown(sample.deviation, 2),
    ...(truth ? [mean(sample)] : [])])]);
}

/** The videos of this run, and those of no run such as the truth. */
function videosOfRun() {
  return data.videos.map((_, i) => i).filter((i) => [null, state.run].includes(data.videos[i].run));
}

/** The colour that the chosen pixel of a mosaic measures; -1 without a mosaic. */
function ownColour() {
  const run = data.runs[state.run];
  return run?.filter ? kColours.findIndex((_, colour) => dnIndex(run, state.pixel, colour) === 0) : -1;
}

/** Another pixel of a mosaic is shown in its own colour, of which it has samples. */
function followFilter() {
  if (!state.pixel || ownColour() < 0) return;
  choose({colour: ownColour()});
  element('plane').value = state.colour;
}

async function showPixel() {
  if (!state.pixel) return;
  const request = ++pixelRequest;
  const {row, col} = state.pixel;
  const lines = [];
  for (const video of videosOfRun())
    lines.push({video, points: await lightOverTime(video, state.pixel, state.colour)});
  const samples = data.runs.length ? await samplesOverTime(state.run, state.pixel, state.colour) : [];
  if (request !== pixelRequest) return; // another pixel was chosen meanwhile
  shownSamples = samples;
  element('pixel-name').textContent = `row ${row + area.first_row}, column ${col + area.first_col}` +
    `${ownColour() < 0 ? '' : `, ${kColours[ownColour()]} filter`}: ${counted(samples.length, 'sample')}`;
  fillPixelTable(samples, lines);
  showChart('pixel-chart', pixelChart(lines));
}

function setUpPixel() {
  if (data.videos.length === 0) return;
  element('pixel').hidden = false;
  element('plane-label').hidden = area.planes === 1;
  element('run-label').hidden = data.runs.length < 2;
  choose({run: featuredRun});
  fillSelect(element('plane'), kColours.map((text, value) => ({value, text})), '1');
  fillSelect(element('run'), data.runs.map((run, value) => ({value, text: run.name})), state.run);
  element('plane').addEventListener('change', (event) => choose({colour: Number(event.target.value)}));
  element('run').addEventListener('change', (event) => choose({run: Number(event.target.value)}));
  element('log-light').addEventListener('change', (event) => choose({log: event.target.checked}));
  choose({colour: area.planes === 3 ? 1 : 0});
  choosePixel(Math.floor(area.rows / 2), Math.floor(area.cols / 3)); // beside the divider
  whenever(['pixel', 'run'], followFilter);
  whenever(['pixel', 'colour', 'run', 'log'], showPixel);
}

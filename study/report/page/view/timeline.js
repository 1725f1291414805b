'use strict';

// Saturation and losses over all slots, and the readout of the shown slot.

const kTimelineMs = 700;
let timeline = null; // what the server told last

function drawTimeline() {
  const canvas = element('timeline-strip');
  const context = canvas.getContext('2d');
  const {width, height} = canvas;
  context.clearRect(0, 0, width, height);
  if (!timeline) return;
  const {slots_per_bin: step} = timeline;
  const xOf = (slot) => (slot / Math.max(data.slots, 1)) * width;
  timeline.samples.forEach((samples, bin) => {
    const x = xOf(bin * step);
    const wide = Math.max(xOf((bin + 1) * step) - x - (step === 1 && data.slots < width / 4 ? 1 : 0), 1);
    const saturated = samples ? timeline.saturated[bin] / samples : 0;
    context.fillStyle = styleColour('series-2');
    context.fillRect(x, height * (1 - saturated), wide, height * saturated);
    context.fillStyle = styleColour('series-5');
    if (timeline.dropped[bin]) context.fillRect(x, 8, wide, 6);
    context.fillStyle = styleColour('sample');
    if (timeline.missing[bin]) context.fillRect(x, 0, wide, 6);
  });
  context.fillStyle = styleColour('line');
  context.fillRect(xOf(timeline.slots), height - 2, width, 2); // not yet read
  context.fillStyle = styleColour('accent');
  context.fillRect(xOf(state.slot), 0, Math.max(xOf(1), 2), height);
}

function sum(values) {
  return values.reduce((all, value) => all + value, 0);
}

function showTimeline() {
  const {samples, saturated, missing, dropped, damage, failure} = timeline;
  const text = [`${shown((100 * sum(saturated)) / Math.max(sum(samples), 1), 3)} % of ${sum(samples)} samples are saturated`,
                `${counted(sum(missing), 'slot')} missing in part or whole`];
  if (sum(dropped)) text.push(`rows dropped in ${counted(sum(dropped), 'slot')}`);
  if (failure) text.push(failure);
  element('timeline-hint').textContent = `${text.join('; ')}. The strip is full where all samples are saturated. Click to go to a slot.`;
  element('timeline-damage').hidden = damage.length === 0;
  element('timeline-damage').replaceChildren(...damage.map(({byte, cause}) => made('li', {}, `byte ${byte}: ${cause}`)));
  drawTimeline();
}

async function askTimeline() {
  const run = Number(element('timeline-run').value);
  timeline = await answered('timeline', {run}) ?? timeline;
  if (!timeline) return;
  showTimeline();
  if (!timeline.complete) setTimeout(askTimeline, kTimelineMs);
}

/** The rows of the readout: when each is selected, converted and on the link. */
async function showLanes() {
  const {slot} = state;
  element('lanes').hidden = element('follow').checked && data.running_camera !== null; // they change too fast
  if (element('lanes').hidden) return;
  const lanes = await answered('readout', {run: state.run, slot});
  if (slot !== state.slot) return;
  element('lanes').hidden = !lanes;
  if (!lanes) return;
  const canvas = element('lanes-strip');
  const context = canvas.getContext('2d');
  const {width, height} = canvas;
  const last = Math.max(lanes.slot_clocks, ...lanes.rows.map((row) => row[5]));
  const first = Math.min(0, ...lanes.rows.map((row) => row[1]));
  const left = 90;
  const xOf = (clock) => left + ((clock - first) / (last - first)) * (width - left - 4);
  context.clearRect(0, 0, width, height);
  context.font = '20px system-ui, sans-serif';
  [['row select', 1, 2, 'series-1'], ['ADC', 2, 3, 'series-3'], ['link', 4, 5, 'series-4']].forEach(([name, from, to, colour], lane) => {
    const y = 8 + lane * 46;
    context.fillStyle = styleColour('quiet');
    context.fillText(name, 0, y + 26);
    context.fillStyle = styleColour('page');
    context.fillRect(left, y, width - left, 36);
    context.fillStyle = styleColour(colour);
    for (const row of lanes.rows) context.fillRect(xOf(row[from]), y, Math.max(xOf(row[to]) - xOf(row[from]) - 0.5, 0.5), 36);
  });
  context.fillStyle = styleColour('sample');
  context.fillRect(xOf(lanes.slot_clocks) - 1, 0, 2, height);
  const us = (clocks) => `${shown((clocks / lanes.clock_hz) * 1e6)} µs`;
  element('lanes-hint').textContent = `${counted(lanes.rows.length, 'row')} read in ` +
    `${us(lanes.rows.length ? lanes.rows.at(-1)[5] - first : 0)} of a slot of ${us(lanes.slot_clocks)}, after slot ${slot} has exposed. ` +
    'For a waveform viewer: stipple timing --vcd FILE.';
}

function setUpTimeline() {
  if (data.runs.length === 0) return;
  whenever(['slot', 'run'], showLanes);
  if (data.running_camera) return;
  element('timeline').hidden = false;
  element('timeline-label').hidden = data.runs.length < 2;
  fillSelect(element('timeline-run'), data.runs.map((run, value) => ({value, text: run.name})), 0);
  element('timeline-run').addEventListener('change', askTimeline);
  element('timeline-strip').addEventListener('click', (event) => {
    const box = event.target.getBoundingClientRect();
    chooseSlot(Math.floor(((event.clientX - box.left) / box.width) * data.slots));
  });
  whenever(['slot'], drawTimeline);
  askTimeline();
}

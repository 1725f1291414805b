'use strict';

// The exposure schedule as a timing diagram: a lane per pixel, a box per exposure, a dot where it is read.

const kLaneHeight = 24;
const kLaneLeft = 74;
// From few slots of light to many: viridis with a lighter end, for dark pages
const kLengthColours = ['#fde725', '#addc30', '#5ec962', '#28ae80', '#21918c', '#2c728e', '#3b6aa0', '#4b55a5',
                        '#5f3fa0'];
let scheduleRun = featuredRun;
let scheduleRequest = 0;

function lightSlots(runs) {
  return runs.reduce((sum, [, slots]) => sum + slots, 0);
}

/** Charge stores of a pixel that the schedule takes. */
function storeCount(run) {
  return run.stream.schedule.interleaved ? 2 : 1;
}

/** Lengths of the exposures of a run, each with a colour. */
function lengthColours(run) {
  const lengths = [...new Set([...run.samples.exposures.map((exposure) => exposure.light_slots),
                               ...run.lanes.flatMap((lane) => lane.exposures.map((e) => lightSlots(e[3])))])];
  lengths.sort((a, b) => a - b);
  const step = (kLengthColours.length - 1) / Math.max(lengths.length - 1, 1);
  return new Map(lengths.map((length, i) => [length, kLengthColours[Math.round(i * step)]]));
}

function drawExposure(group, [first, store, span, runs], lane) {
  const {colours, xOf, top, slots, stores} = lane;
  const height = (kLaneHeight - 6) / stores;
  const y = top + 3 + store * height;
  const right = (slot) => xOf(Math.min(slot, slots));
  if (runs.length > 1)
    group.append(drawn('line', {class: 'gap', x1: xOf(first), x2: right(first + span), y1: y + height / 2,
                                y2: y + height / 2}));
  for (const [open, length] of runs) {
    if (first + open >= slots) continue;
    const x = xOf(first + open);
    group.append(drawn('rect', {x: x + 0.5, y, width: Math.max(right(first + open + length) - x - 1, 1), height, rx: 2,
                                class: 'box', fill: colours.get(lightSlots(runs)) ?? kLengthColours[4]}));
  }
  if (first + span <= slots)
    group.append(drawn('circle', {class: 'read', cx: xOf(first + span), cy: y + height / 2, r: 3}));
}

function drawLane(name, exposures, lane, className) {
  const group = drawn('g', {class: className});
  const middle = lane.top + kLaneHeight / 2;
  group.append(drawn('rect', {class: 'lane', x: lane.xOf(0), y: lane.top + 2, rx: 3, height: kLaneHeight - 4,
                              width: lane.xOf(lane.slots) - lane.xOf(0)}),
               drawn('text', {x: kLaneLeft - 8, y: middle + 4, 'text-anchor': 'end'}, name));
  for (const exposure of exposures) drawExposure(group, exposure, lane);
  return group;
}

/** The charge store of each exposure: in their order, each takes the first that is free. */
function storesOf(samples, stores) {
  const ends = new Array(stores).fill(0);
  return samples.map(({first, exposure}) => {
    const store = Math.max(ends.findIndex((end) => end <= first), 0);
    ends[store] = first + exposure.span_slots;
    return store;
  });
}

/** The exposures of the chosen pixel that were read, in the form of the other lanes. */
async function chosenLane() {
  if (!state.pixel || data.videos.length === 0) return [];
  const run = data.runs[scheduleRun];
  const colour = [0, 1, 2].find((c) => dnIndex(run, state.pixel, c) >= 0);
  const samples = (await samplesOverTime(scheduleRun, state.pixel, colour)).sort((a, b) => a.first - b.first);
  const stores = storesOf(samples, storeCount(run));
  return samples.map((s, i) => [s.first, stores[i], s.exposure.span_slots, s.exposure.open]);
}

function ruler(slots, xOf, y) {
  const step = [1, 2, 4, 8, 16, 32, 64].find((s) => xOf(s) - xOf(0) > 28) ?? 64;
  const ticks = [];
  for (let slot = 0; slot <= slots; slot += step)
    ticks.push(drawn('text', {x: xOf(slot), y, 'text-anchor': 'middle'}, String(slot)));
  return ticks;
}

async function showSchedule() {
  const box = element('schedule-lanes');
  const run = data.runs[scheduleRun];
  const request = ++scheduleRequest;
  const chosen = await chosenLane();
  if (request !== scheduleRequest) return; // another pixel was chosen meanwhile
  const width = Math.max(box.clientWidth, 260);
  const slots = Math.min(data.slots, 64, width < 600 ? 24 : 64);
  const xOf = (slot) => kLaneLeft + (slot / slots) * (width - kLaneLeft - 12);
  const lanes = run.lanes.map((lane) => [`${lane.row}, ${lane.col}`, lane.exposures, '']);
  if (chosen.length)
    lanes.push([`${state.pixel.row + area.first_row}, ${state.pixel.col + area.first_col}`, chosen, 'chosen']);
  const stores = storeCount(run);
  const colours = lengthColours(run);
  const height = lanes.length * kLaneHeight + 22;
  const svg = drawn('svg', {viewBox: `0 0 ${width} ${height}`, height, role: 'img',
                            'aria-label': `exposures of ${counted(lanes.length, 'pixel')} over ${counted(slots, 'slot')}`});
  lanes.forEach(([name, exposures, className], i) => (
    svg.append(drawLane(name, exposures, {colours, xOf, slots, stores, top: i * kLaneHeight}, className))));
  svg.append(drawn('rect', {class: 'now', id: 'schedule-now', y: 0, height: lanes.length * kLaneHeight}),
             ...ruler(slots, xOf, height - 4));
  box.replaceChildren(svg);
  svg.addEventListener('click', (event) => {
    const x = event.clientX - svg.getBoundingClientRect().left;
    if (x > kLaneLeft) chooseSlot(Math.floor(((x - kLaneLeft) / (xOf(slots) - kLaneLeft)) * slots));
  });
  markScheduleSlot(xOf, slots);
  whenScheduleSlot = () => markScheduleSlot(xOf, slots);
}

let whenScheduleSlot = () => {};

function markScheduleSlot(xOf, slots) {
  const now = element('schedule-now');
  now.setAttribute('x', xOf(state.slot));
  now.setAttribute('width', state.slot < slots ? xOf(state.slot + 1) - xOf(state.slot) : 0);
}

function switchesText({stream}) {
  return (stream.switches ?? []).map(({slot, schedule}) => ` From slot ${slot} on: schedule ${schedule}.`).join('');
}

function showScheduleText() {
  const {schedule} = data.runs[scheduleRun].stream;
  const swatch = ([length, colour]) => {
    const mark = made('i');
    mark.style.background = colour;
    return made('span', {}, mark, counted(length, 'slot'));
  };
  element('schedule-legend').replaceChildren(...[...lengthColours(data.runs[scheduleRun])].map(swatch));
  element('schedule-hint').textContent =
    `Schedule ${schedule.name}: tile of ${schedule.tile_cols} × ${schedule.tile_rows} pixels, period ` +
    `${counted(schedule.period_slots, 'slot')}, ${shown(schedule.samples_per_pixel_slot)} samples per pixel and slot, ` +
    `${shown(100 * schedule.light_throughput)} % of the light. A lane is a pixel (row, column), a box an exposure, a ` +
    `dot its readout${storeCount(data.runs[scheduleRun]) > 1 ? ', its upper and lower half a charge store' : ''}. ` +
    `The last lane is the chosen pixel.${switchesText(data.runs[scheduleRun])}`;
}

function setUpSchedule() {
  if (data.runs.length === 0) return;
  element('schedule').hidden = false;
  fillSelect(element('schedule-run'), data.runs.map((run, value) => ({value, text: run.name})), scheduleRun);
  element('schedule-run').parentElement.hidden = data.runs.length < 2;
  element('schedule-run').addEventListener('change', (event) => {
    scheduleRun = Number(event.target.value);
    showScheduleText();
    showSchedule();
  });
  showScheduleText();
  whenever(['pixel'], showSchedule);
  whenever(['slot'], () => whenScheduleSlot());
  let width = element('schedule-lanes').clientWidth;
  new ResizeObserver(([entry]) => {
    if (Math.abs(entry.contentRect.width - width) < 1) return;
    width = entry.contentRect.width;
    showSchedule();
  }).observe(element('schedule-lanes'));
}

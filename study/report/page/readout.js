'use strict';

// What the readout of each slot costs: bits over the link, and time where the sensor's clocks are known.

let loadRun = featuredRun;

/** Mbit/s of bits in a slot. */
function rateOf(bits, run) {
  return bits / run.stream.slot_us;
}

function mean(values) {
  return values.reduce((sum, value) => sum + value, 0) / values.length;
}

function loadChart() {
  const run = data.runs[loadRun];
  const points = run.loads.payload_bits.map((bits, slot) => ({x: slot + 0.5, y: rateOf(bits, run)}));
  const full = rateOf(run.loads.full_bits, run);
  const highest = Math.max(full, ...points.map(({y}) => y));
  return {
    type: 'bar',
    data: {datasets: [
      slotLine('every pixel in every slot', [[-1, full], [data.slots, full]], styleColour('series-2'),
               {type: 'line', borderDash: [6, 4], stepped: false}),
      {label: 'samples', data: points, backgroundColor: styleColour('series-1'), barPercentage: 1,
       categoryPercentage: 0.9}]},
    options: chartOptions({x: slotAxis(), y: axis('data rate of a slot, Mbit/s', {beginAtZero: true, suggestedMax: 1.05 * highest})}, {showSlot: true}),
  };
}

function clocksChart() {
  const {clocks} = data.runs[loadRun].loads;
  const us = (values) => values.map((value, slot) => [slot, (value / clocks.clock_hz) * 1e6]);
  const slotUs = (clocks.slot_clocks / clocks.clock_hz) * 1e6;
  return {
    type: 'line',
    data: {datasets: [
      slotLine('readout', us(clocks.readout), styleColour('series-1')),
      slotLine('conversion', us(clocks.convert), styleColour('series-3')),
      slotLine('link', us(clocks.link), styleColour('series-4')),
      slotLine('slot', [[-1, slotUs], [data.slots, slotUs]], styleColour('series-2'),
               {borderDash: [6, 4], stepped: false})]},
    options: chartOptions({x: slotAxis(), y: axis('time, µs', {beginAtZero: true, suggestedMax: 1.05 * slotUs})}, {showSlot: true}),
  };
}

function loadText(run) {
  const {loads} = run;
  const share = mean(loads.payload_bits) / loads.full_bits;
  const text = [`On average ${shown(mean(loads.samples), 5)} samples and ` +
    `${shown(rateOf(mean(loads.payload_bits), run), 3)} Mbit/s, ${shown(100 * share, 3)} % of a camera that reads ` +
    `every pixel in every slot.`];
  const missing = loads.samples.filter((samples, slot) => samples < loads.due[slot]).length;
  if (missing) text.push(`${counted(missing, 'slot')} with fewer samples than the schedule makes.`);
  const overruns = loads.overrun.filter(Boolean).length;
  if (overruns) text.push(`The readout of ${counted(overruns, 'slot')} took longer than the slot.`);
  const dropped = loads.dropped.filter(Boolean).length;
  if (dropped) text.push(`Rows that did not fit into their slot were dropped in ${counted(dropped, 'slot')}.`);
  text.push(loads.clocks ? `Slowest step of the slots: ${[...new Set(loads.clocks.limit)].join(', ').replaceAll('_', ' ')}.`
                         : 'The sensor has no clocks ([timing]), so the time of the readout is not known.');
  return text.join(' ');
}

function showLoads() {
  const {clocks} = data.runs[loadRun].loads;
  element('load-hint').textContent = loadText(data.runs[loadRun]);
  showChart('load-chart', loadChart);
  element('clocks-box').hidden = !clocks;
  if (clocks) showChart('clocks-chart', clocksChart);
}

function setUpReadout() {
  if (data.runs.length === 0) return;
  element('load').hidden = false;
  fillSelect(element('load-run'), data.runs.map((run, value) => ({value, text: run.name})), loadRun);
  element('load-run').closest('.bar').hidden = data.runs.length < 2;
  element('load-run').addEventListener('change', (event) => {
    loadRun = Number(event.target.value);
    showLoads();
  });
  showLoads();
}

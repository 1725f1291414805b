'use strict';

// What the charts have in common. Chart.js draws them; where the build had none, a text says so.

const charts = new Map(); // id of the canvas -> {chart, make}

/** A mark at the shown slot, across a chart whose x axis is time in slots. */
const slotMark = {
  id: 'slotMark',
  beforeDatasetsDraw(chart) {
    if (!chart.options.showSlot) return;
    const {ctx, chartArea, scales: {x}} = chart;
    const left = Math.max(x.getPixelForValue(state.slot), chartArea.left);
    const right = Math.min(x.getPixelForValue(state.slot + 1), chartArea.right);
    ctx.save();
    ctx.fillStyle = styleColour('accent');
    ctx.globalAlpha = 0.16;
    ctx.fillRect(left, chartArea.top, right - left, chartArea.bottom - chartArea.top);
    ctx.restore();
  },
};

function axis(title, more = {}) {
  return {
    title: {display: true, text: title, color: styleColour('quiet')},
    ticks: {color: styleColour('quiet'), maxRotation: 0, autoSkipPadding: 12},
    grid: {color: styleColour('line'), borderColor: styleColour('line'), offset: false},
    ...more,
  };
}

/** With the length of a slot, if it is that of all runs. */
function slotTitle() {
  const lengths = new Set(data.runs.map((run) => run.stream.slot_us));
  return lengths.size === 1 ? `time, slots of ${shown([...lengths][0] / 1000)} ms` : 'time, slots';
}

/** With ticks at whole slots only: by their distance Chart.js also chooses the width of bars. */
function slotAxis() {
  const [min, max] = chartSlots();
  const slots = axis(slotTitle(), {type: 'linear', min, max, offset: false});
  slots.ticks.precision = 0;
  return slots;
}

/** A line of values that hold for a whole slot each: `points` are [slot, value]. */
function slotLine(label, points, colour, more = {}) {
  const line = points.map(([slot, y]) => ({x: slot + 0.5, y}));
  if (line.length) {
    line.unshift({...line[0], x: points[0][0]});
    line.push({...line.at(-1), x: points.at(-1)[0] + 1});
  }
  return {
    label, data: line, borderColor: colour, backgroundColor: colour,
    borderWidth: 2, pointRadius: 0, pointHitRadius: 6, stepped: 'middle', ...more,
  };
}

function chartOptions(scales, more = {}) {
  return {
    animation: false, responsive: true, maintainAspectRatio: false, scales,
    interaction: {mode: 'nearest', axis: 'x', intersect: false},
    plugins: {
      legend: {labels: {color: styleColour('ink'), boxWidth: 16, boxHeight: 2}},
      tooltip: {callbacks: {title: () => '', label: (item) => `${item.dataset.label}: ${shown(item.parsed.y)}`}},
    },
    onClick: (event, _, chart) => {
      if (chart.options.showSlot) chooseSlot(Math.floor(chart.scales.x.getValueForPixel(event.x)));
    },
    ...more,
  };
}

/** Draws in the canvas `id` what `make` says, now and when the colours of the page change. */
function showChart(id, make) {
  if (typeof Chart === 'undefined') {
    element(id).replaceWith(made('p', {class: 'missing', id}, 'This build of Stipple has no library of charts: ' +
      'install the package libjs-chart.js, and configure and build again.'));
    return;
  }
  const known = charts.get(id)?.chart;
  if (known) {
    const {data: points, options} = make();
    Object.assign(known, {data: points, options});
    known.update('none');
  }
  charts.set(id, {make, chart: known ?? new Chart(element(id), make())});
}

function markSlots() {
  for (const {chart} of charts.values()) if (chart.options.showSlot) chart.draw();
}

function setUpCharts() {
  if (typeof Chart === 'undefined') return;
  Chart.register(slotMark);
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  const redraw = () => { for (const [id, {make}] of [...charts]) showChart(id, make); };
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
}

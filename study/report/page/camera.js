'use strict';

// The figures of `stipple characterize`: photon transfer and EMVA 1288.

const kCameraFigures = [
  ['gain_dn_per_e', 'system gain K', 1, 'DN/e'], ['quantum_efficiency', 'quantum efficiency', 100, '%'],
  ['dark_noise_e', 'dark noise', 1, 'e'], ['saturation_e', 'saturation capacity', 1, 'e'],
  ['dsnu_e', 'DSNU', 1, 'e'], ['dsnu_high_pass_e', 'DSNU without shading', 1, 'e'], ['prnu', 'PRNU', 100, '%'],
  ['prnu_high_pass', 'PRNU without shading', 100, '%'], ['snr_max', 'maximum SNR', 1, ': 1'],
  ['sensitivity_threshold_p', 'sensitivity threshold', 1, 'photons'], ['dynamic_range', 'dynamic range', 1, ': 1'],
  ['linearity_error', 'linearity error', 100, '%']];

function cameraChart() {
  const {measured, photon_transfer: points, saturation_point: saturation} = data.camera;
  const full = points[saturation][1];
  const fitEnd = 0.7 * full;
  const line = (label, from, to, colour, more) => ({
    type: 'line', label, data: [from, to], borderColor: colour, backgroundColor: colour, borderWidth: 2,
    pointRadius: 0, ...more});
  return {
    type: 'scatter',
    data: {datasets: [
      {label: 'pairs of images', data: points.map(([, x, y]) => ({x, y})), backgroundColor: styleColour('series-1'),
       pointRadius: 3},
      line(`fit, K = ${shown(measured.gain_dn_per_e)} DN/e`, {x: 0, y: 0},
           {x: fitEnd, y: measured.gain_dn_per_e * fitEnd}, styleColour('series-2')),
      line('saturation', {x: full, y: 0}, {x: full, y: points[saturation][2]}, styleColour('quiet'),
           {borderDash: [5, 4], borderWidth: 1.5})]},
    options: chartOptions(
      {x: axis('mean − dark mean, DN', {type: 'linear', beginAtZero: true}),
       y: axis('variance − dark variance, DN²', {min: 0})},
      {interaction: {mode: 'nearest', intersect: true}}),
  };
}

function fillCameraTable() {
  const {measured, configured} = data.camera;
  const head = ['figure', 'measured', ...(configured ? ['configured', 'deviation'] : []), 'unit'];
  const row = ([key, name, scale, unit]) => {
    const value = measured[key];
    const expected = configured?.[key];
    const decibels = unit === ': 1' && value > 0 ? ` (${shown(20 * Math.log10(value))} dB)` : '';
    const deviation = expected ? `${shown(100 * (value / expected - 1), 2)} %` : '';
    return [name, shown((value ?? null) === null ? null : value * scale) + decibels,
            ...(configured ? [(expected ?? null) === null ? '–' : shown(expected * scale), deviation] : []), unit];
  };
  fillTable(element('camera-table'), [head, ...kCameraFigures.map(row)]);
  element('camera-notes').replaceChildren(...(data.camera.notes ?? []).map((note) => made('li', {}, note)));
}

function setUpCamera() {
  if (!data.camera) return;
  element('camera').hidden = false;
  fillCameraTable();
  showChart('camera-chart', cameraChart);
}

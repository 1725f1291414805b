'use strict';

// Quality of each video against the truth: by frame, and of the whole.

const kMetrics = [['psnr_db', 'PSNR, dB'], ['psnr_gamma_db', 'PSNR (gamma 2.2), dB'], ['pu21_psnr_db', 'PU21-PSNR, dB'],
                  ['ssim', 'SSIM']];

function comparedVideos() {
  return data.videos.map((video, i) => ({...video, index: i})).filter((video) => video.quality);
}

function qualityChart() {
  const metric = element('metric').value;
  const title = element('metric').selectedOptions[0].textContent;
  return {
    type: 'line',
    data: {datasets: comparedVideos().map((video) => slotLine(
      video.name, video.quality.frames[metric].map((y, slot) => [slot, y]), videoColour(video.index),
      {borderDash: videoDash(video.index)}))},
    options: chartOptions({x: slotAxis(), y: axis(title)}, {showSlot: true}),
  };
}

function fillQualityTable() {
  const videos = comparedVideos();
  const best = Object.fromEntries(kMetrics.map(([key]) => [key, Math.max(...videos.map((v) => v.quality[key]))]));
  const swatch = (video) => {
    const mark = made('i');
    mark.style.background = videoColour(video.index);
    return made('span', {title: video.text}, mark, video.name);
  };
  fillTable(element('quality-table'), [['video', ...kMetrics.map(([, name]) => name)], ...videos.map((video) => [
    swatch(video), ...kMetrics.map(([key]) => (
      {text: video.quality[key]?.toFixed(key === 'ssim' ? 4 : 2) ?? '–', best: video.quality[key] === best[key]}))])]);
}

function setUpQuality() {
  if (comparedVideos().length === 0) return;
  element('quality').hidden = false;
  const {margin, max_value: most, peak, cd_per_unit: unit} = data.quality_options;
  element('quality-hint').textContent =
    `Against the truth, whole frames${most === null ? '' : `, light clipped to ${shown(most)}`}` +
    `${margin ? `; the table without the first and last ${counted(margin, 'frame')}` : ''}. Peak ${shown(peak)}, light 1.0 is ${shown(unit)} cd/m².`;
  element('metric').addEventListener('change', () => showChart('quality-chart', qualityChart));
  showChart('quality-chart', qualityChart);
  fillQualityTable();
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', fillQualityTable);
}

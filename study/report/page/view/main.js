'use strict';

// The parts of the page of `stipple view` in their order.

showHeader();
showSettings();
setUpCharts();
setUpViewer();
setUpPixel();
setUpSchedule();
setUpTimeline();
setUpCamera();
document.body.classList.add('view');
whenever(['slot'], markSlots);
whenever(['slot', 'a', 'b'], () => shownVideos().forEach(improve));
whenever(['pictures'], () => {
  drawSide('a');
  drawSide('b');
  showPixel();
});
let chartFirst = chartSlots()[0];
whenever(['slot'], () => {
  if (chartFirst !== chartSlots()[0]) showPixel();
  [chartFirst] = chartSlots();
});
setUpKeys();
askStatus();
document.documentElement.dataset.ready = 'true';

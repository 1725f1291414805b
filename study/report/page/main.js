'use strict';

// The parts of a report in their order.

showHeader();
showSettings();
setUpCharts();
setUpViewer();
setUpPixel();
setUpQuality();
setUpReadout();
setUpSchedule();
setUpCamera();
whenever(['slot'], markSlots);
if (data.videos.length) document.addEventListener('keydown', takeKey);
document.documentElement.dataset.ready = 'true';

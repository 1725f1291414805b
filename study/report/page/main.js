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
if (data.videos.length) setUpKeys();
document.documentElement.dataset.ready = 'true';

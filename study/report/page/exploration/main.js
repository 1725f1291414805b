'use strict';

// Header, keys, and the parts of the page in their order.

function showHeader() {
  element('title').textContent = data.title;
  element('program').textContent = data.program;
  element('command').textContent = data.command || 'not known';
  const facts = [['Points', `${data.points}`], ['With figures', `${withFigures.length}`]];
  const failed = rows.filter((row) => row.problem).length;
  if (failed) facts.push(['With a problem', `${failed}`]);
  if (data.rungs.length > 1) facts.push(['Slots of the rungs', data.rungs.join(', ')]);
  if (data.seeds > 1) facts.push(['Seeds of a point', `${data.seeds}`]);
  const compared = withFigures.filter((row) => !isDropped(row)).map(columnOf('psnr_db').value).filter((value) => value !== null);
  const [low, high] = [Math.min(...compared), Math.max(...compared)];
  if (compared.length) facts.push(['PSNR', low < high ? `${low.toFixed(1)} to ${high.toFixed(1)} dB` : `${low.toFixed(1)} dB`]);
  element('facts').replaceWith(termList(facts, 'facts'));
  element('notes').hidden = data.notes.length === 0;
  element('notes').replaceChildren(...data.notes.map((note) => made('li', {}, note)));
}

function takeKey(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches('select, input')) return;
  const scrolls = event.target.matches('.scroll') && event.target.scrollWidth > event.target.clientWidth;
  if (axisKey(event.target, event.key, event.shiftKey)) { /* done */ }
  else if (event.key === 'ArrowLeft' && !scrolls) movePoint(-1);
  else if (event.key === 'ArrowRight' && !scrolls) movePoint(1);
  else return;
  event.preventDefault();
}

showHeader();
setUpCharts();
setUpFrontier();
setUpParallelAxes();
setUpTable();
setUpPoint();
document.addEventListener('keydown', takeKey);
document.documentElement.dataset.ready = 'true';

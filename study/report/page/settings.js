'use strict';

// Header of the page, and what was set.

function factsOf() {
  const facts = [];
  const run = data.runs[featuredRun];
  if (data.videos.length) {
    const size = ({cols, rows}) => `${cols} × ${rows}`;
    facts.push(['Frame', `${size(data.frame)}${area.planes === 3 ? ' RGB' : ''}`]);
    if (area.cols < data.frame.cols || area.rows < data.frame.rows) facts.push(['Shown', size(area)]);
    if (!data.running_camera) facts.push(['Slots', `${data.slots}`]);
  }
  if (run) {
    const {schedule, slot_us: slot} = run.stream;
    // Of several runs these are those of the one that is shown in detail.
    const of = data.runs.length > 1 ? `, ${run.name}` : '';
    facts.push([`Slot${of}`, `${shown(slot / 1000)} ms`], [`Schedule${of}`, schedule.name],
               [`Compression ratio${of}`, `${shown(1 / schedule.samples_per_pixel_slot, 3)} : 1`]);
  }
  const featured = data.videos[data.featured];
  if (featured?.quality?.psnr_db) facts.push([`PSNR, ${featured.name}`, `${featured.quality.psnr_db.toFixed(1)} dB`]);
  if (data.camera) facts.push(['System gain', `${shown(data.camera.measured.gain_dn_per_e)} DN/e`],
                              ['Dynamic range', `${shown(data.camera.measured.dynamic_range)} : 1`]);
  return facts;
}

function showHeader() {
  element('title').textContent = data.title;
  element('subtitle').textContent = data.runs.map((run) => run.name).join(' · ');
  element('program').textContent = data.program;
  element('facts').replaceWith(termList(factsOf(), 'facts'));
  const notes = [...data.notes];
  if (typeof DecompressionStream === 'undefined')
    notes.push('This browser cannot unpack the pictures (DecompressionStream); use one of 2023 or later.');
  element('notes').hidden = notes.length === 0;
  const look = (note) => (note.includes(': the stream is damaged') ? {class: 'warning'} : {});
  element('notes').replaceChildren(...notes.map((note) => made('li', look(note), note)));
}

function calibrationOf({stream}) {
  const c = stream.calibration;
  const pairs = [
    ['slot', `${shown(stream.slot_us)} µs`], ['array', `${stream.cols} × ${stream.rows}, ${counted(stream.planes, 'plane')}`],
    ['colour filter', stream.cfa], ['bit depth', c.bit_depth], ['gain', `${shown(c.gain_e_per_dn)} e/DN`],
    ['black level', `${shown(c.black_level_dn)} DN`], ['read noise', `${shown(c.read_noise_e)} e`],
    ['full well', `${shown(c.full_well_e)} e`], ['light 1.0 in a slot', `${shown(c.electrons_per_unit)} e`],
    ['dark signal', `${shown(c.dark_e_per_slot)} e per slot`], ['samples', stream.samples],
    ['payload', `${shown(stream.payload_bits / 8e6)} MB`]];
  return pairs.filter(([, value]) => value !== undefined);
}

function runSettings(run) {
  const parts = [made('h3', {}, run.name), termList(calibrationOf(run), 'settings-grid')];
  if (run.command) parts.push(made('h3', {}, 'Command that makes the stream again'), made('pre', {}, run.command));
  if (run.stream.provenance)
    parts.push(made('details', {}, made('summary', {}, 'Provenance'), made('pre', {}, run.stream.provenance)));
  return parts;
}

function showSettings() {
  element('settings-runs').replaceChildren(...data.runs.flatMap(runSettings));
  element('command').textContent = data.command || 'not known';
}

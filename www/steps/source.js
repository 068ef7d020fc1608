/** The step Source: what is open, and how to open something else. */
import { choice, facts, fold, select, toggle } from '../controls.js';
import { nameOf } from '../doc.js';
import { doctor, untold, worthALook } from '../doctor.js';
import { h, show } from '../dom.js';
import { chosen, isGltf } from '../files.js';
import { count, duration, number, plural, title } from '../format.js';
import { lesson } from '../lesson.js';
import { upright } from '../upright.js';
import { gallery as pairGallery } from './gallery.js';
import { warnings } from './warnings.js';

export const sourceStep = {
  id: 'source',
  title: 'Source',
  summary(app) {
    if (!app.sequence) return '';
    const notes = worthALook(app.sequence);
    return notes ? `${nameOf(app.doc.open)} · ${plural(notes, 'note')}` : nameOf(app.doc.open);
  },
  build,
};

export const ACCEPT = '.glb,.gltf,.bin,.obj,.mtl,.png,.jpg,.jpeg,.off,.ply,.stl,.zip,model/gltf-binary,model/gltf+json,application/zip';
const DETAIL = [3_000, 12_000, 50_000, 200_000];
const RATES = [6, 12, 24, 30, 60];
const REFERENCES = [['bind', 'bind pose'], ['nodes', 'as placed in the file'], ['first-frame', 'first pose']];

/** @param {import('../app.js').App} app */
function build(app) {
  const current = h('div', { class: 'stack' });
  const health = doctor(app, 'source');
  const gallery = h('div');
  const update = () => {
    const { source, sequence } = app;
    show(gallery, choice('Creature', app.about.creatures.map((name) => [name, title(name)]),
      source?.kind === 'zoo' ? source.recipe.name : null, (name) => app.opener.openCreature({ name })));
    if (!sequence) return;
    show(current,
      h('p', { class: 'name' }, nameOf(app.doc.open)),
      facts([
        ['Vertices', count(sequence.sizes.vertices)],
        ['Faces', count(sequence.sizes.faces)],
        ['Poses', count(sequence.sizes.poses)],
        sequence.timed && ['Length', duration(sequence.times.at(-1) - sequence.times[0])],
        ['Diagonal', number(sequence.diagonal), 'Of the bounding box of the reference pose, in the units of the file'],
      ]),
      ...warnings(app, untold(sequence.warnings)),
      source.kind === 'zoo' ? creatureOptions(app) : isGltf(app) && animationOptions(app), upright(app, 'source', 'step'));
    health.update();
  };
  app.on('source', update);
  update();
  return h('div', { class: 'step' }, h('h2', {}, 'Source'), current, health.element,
    h('h3', {}, 'Creatures'), gallery,
    h('h3', {}, 'Worth seeing'), pairGallery(app),
    h('h3', {}, 'Your own'), fileButton(app),
    h('p', { class: 'small faint' }, 'Or drop it anywhere: a glTF or GLB with an animation, numbered OBJ, OFF, PLY or STL files, a folder or zip of them; poses may also follow their mesh. It never leaves this computer.'),
    fold('What a source is', { load: () => lesson('source') }));
}

function fileButton(app) {
  const input = h('input', { type: 'file', multiple: true, accept: ACCEPT, class: 'hidden', id: 'files', on: {
    change: () => {
      if (input.files.length) app.opener.openFiles(chosen(input.files));
      input.value = '';
    },
  } });
  return h('div', { class: 'file' }, input, h('label', { for: 'files', class: 'button' }, 'Open files'));
}

function creatureOptions(app) {
  const { recipe } = app.source;
  const sizes = [...new Set([...DETAIL, recipe.faces])].sort((a, b) => a - b);
  const motions = app.about.motions[app.about.creatures.indexOf(recipe.name)] ?? [];
  return h('div', { class: 'stack' },
    motions.length > 1 && select('Motion', motions.map((name) => [name, title(name)]), recipe.motion || motions[0],
      (motion) => app.opener.openCreature({ ...recipe, motion: motion === motions[0] ? '' : motion })),
    select('Detail', sizes.map((faces) => [String(faces), plural(faces, 'face')]), String(recipe.faces),
      (faces) => app.opener.openCreature({ ...recipe, faces: Number(faces) })),
    toggle('One bone for each vertex', recipe.exact, (exact) => app.opener.openCreature({ ...recipe, exact }),
      'Every vertex follows exactly one bone, so that the true parts are known exactly'));
}

function animationOptions(app) {
  const { options } = app.source;
  const { clips, clip } = app.sequence;
  const rate = options.sampling?.rate;
  const rates = [...new Set([...RATES, ...(rate ? [rate] : [])])].sort((a, b) => a - b);
  return h('div', { class: 'stack' },
    clips.length > 0 && select('Clip', clips.map(({ name, seconds }, i) => [String(i), `${/^\d+$/.test(name) ? `Clip ${i + 1}` : name} · ${duration(seconds)}`]),
      String(clip), (index) => app.opener.reopen({ clip: index })),
    select('Poses', [...rates.map((value) => [String(value), `${value} a second`]), ['keys', 'at every key']],
      rate ? String(rate) : 'keys', (value) => app.opener.reopen({ sampling: value === 'keys' ? 'keys' : { rate: Number(value) } })),
    select('Reference', REFERENCES, options.reference, (reference) => app.opener.reopen({ reference })),
    toggle('Weld seams', options.weld, (weld) => app.opener.reopen({ weld }), 'Join vertices that agree in every pose'));
}

/** The page's own benchmark: how long a visitor waits. */
import { most } from './crew.js';

const RUNS = 3;
/** The figures between which a point is dragged: about 5,000 vertices each. */
const PAIR = { faces: 10_000, poses: 16 };
/** The horse whose key points are chosen: about 2,500 vertices. */
const SOUGHT = { name: 'horse', faces: 5_000, poses: 10 };
const POINTS = 12;
const DRAGS = 15;

/** @returns {Promise<{name: string, milliseconds: number}[]>} */
export async function bench(app) {
  const results = [];
  const [first] = performance.getEntriesByName('first-picture');
  if (first) results.push({ name: 'first picture', milliseconds: first.startTime });
  const { name, sizes } = app.sequence;
  const taken = [];
  for (let run = 0; run < RUNS; run++) {
    const start = performance.now();
    await app.engine.call('segment', { parameters: app.parameters });
    taken.push(performance.now() - start);
  }
  results.push({ name: `segment ${name}, ${sizes.faces} faces × ${sizes.poses} poses`, milliseconds: median(taken) });
  return results.concat(await sought(app), await dragged(app));
}

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];

/**
 * How long the choice of key points takes in the worker alone, the first time and later, and in a crew where the machine has
 * cores for one. Nothing moves meanwhile: drawing without a graphics card would keep all cores busy.
 */
async function sought(app) {
  await app.opener.openCreature(SOUGHT);
  const { vertices, poses } = app.sequence.sizes;
  const parameters = { ...app.about.keypoints, points: POINTS };
  const crews = [...new Set([1, most()])];
  const taken = crews.map(() => []);
  app.held = true;
  try {
    for (let run = 0; run < RUNS; run++) {
      for (const [i, crew] of crews.entries()) {
        const start = performance.now();
        await app.engine.call('keypoints', { parameters, crew });
        taken[i].push(performance.now() - start);
      }
    }
  } finally {
    app.held = false;
  }
  const what = `${POINTS} key points, ${vertices} vertices × ${poses} poses`;
  const rows = crews.map((crew, i) => ({ name: `${what}, ${crew === 1 ? 'alone' : `by ${crew} workers`}`, milliseconds: median(taken[i]) }));
  return [{ name: `${what}, the first time, alone`, milliseconds: taken[0][0] }, ...rows];
}

/** How long the motion takes to follow a point that is dragged over the target: in the engine, and until the page has it. */
async function dragged(app) {
  await app.opener.openCreature({ name: 'horse', ...PAIR });
  app.setStep('target');
  await app.target.openTwin({ name: 'camel', ...PAIR });
  while (!app.transfer.motion || app.busy) await new Promise((resolve) => setTimeout(resolve, 50));
  const { faces, sizes } = app.target.sequence;
  const corner = faces.indexOf(app.doc.points[0].target);
  const engine = [];
  const all = [];
  app.held = true;
  for (let i = 0; i < DRAGS; i++) {
    const begun = performance.now();
    const followed = new Promise((resolve) => app.addEventListener('motion', resolve, { once: true }));
    app.target.place(0, faces[corner - (corner % 3) + (i % 3)], 'drag');
    await followed;
    engine.push(app.transfer.motion.took * 1000);
    all.push(performance.now() - begun);
  }
  app.held = false;
  app.history.rest();
  const what = `a dragged point of ${app.doc.count}, ${sizes.vertices} vertices × ${app.sequence.sizes.poses} poses`;
  return [
    { name: `${what}: engine`, milliseconds: median(engine) },
    { name: `${what}: until the page has it`, milliseconds: median(all) },
  ];
}

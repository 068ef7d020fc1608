/** The page's own benchmark: how long a visitor waits. */

const RUNS = 3;

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
  taken.sort((a, b) => a - b);
  results.push({ name: `segment ${name}, ${sizes.faces} faces × ${sizes.poses} poses`, milliseconds: taken[RUNS >> 1] });
  return results;
}

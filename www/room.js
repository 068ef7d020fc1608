/** How far undo goes back: states are small, but the meshes and results that they refer to are not. */

/** What undo holds beside the last source, target and search before those in force has at most so many bytes. */
const MOST_HELD = 256 << 20;

/** The big things of a state. */
const BIG = [({ open }) => open?.sequence, ({ target }) => target?.sequence, ({ run }) => run];

/** Forgets the oldest states as far as there is no room for them. @param {import('./history.js').History} history */
export function makeRoom(history) {
  const seen = BIG.map((of) => new Set([of(history.now)]));
  const held = new Set(BIG.flatMap((of) => buffersOf(of(history.now))));
  let bytes = 0;
  const hold = (thing, free) => {
    for (const buffer of buffersOf(thing)) {
      if (!free && !held.has(buffer)) bytes += buffer.byteLength;
      held.add(buffer);
    }
  };
  history.trim((state) => {
    BIG.forEach((of, k) => {
      const thing = of(state);
      if (!thing || seen[k].has(thing)) return;
      seen[k].add(thing);
      hold(thing, seen[k].size <= 2);
    });
    return bytes <= MOST_HELD;
  });
}

/** The buffers of all typed arrays in a thing. @returns {ArrayBuffer[]} */
function buffersOf(thing) {
  if (ArrayBuffer.isView(thing)) return [thing.buffer];
  return thing && typeof thing === 'object' ? Object.values(thing).flatMap(buffersOf) : [];
}
